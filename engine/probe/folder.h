// A folder of probes: written so that its manifest is what makes a set complete, read as what nobody vouches for (docs/probe_files.md).
#pragma once
#include "probe/manifest.h"

namespace burnish::probe {

/// Writes a set with what a bake says of it (or nullptr). Payloads have their hash in their names and come first, the manifest then takes the old one's place in one step, and last the payloads that
/// nothing names any more go: whatever stops it, the folder holds the old set or the new one. On an error the folder is as it was. The caller keeps other writers away.
Result<void> writeSet(const std::filesystem::path& folder, const ProbeSet& set, const BakeNotes* notes);

struct StoredSet {
  Manifest manifest;
  ProbeSet set;
};
Result<StoredSet> readSet(const std::filesystem::path& folder, Report& report);
/// The manifest alone, without a look at the payloads.
Result<Manifest> readManifest(const std::filesystem::path& folder, Report& report);
/// The bytes of a payload, whose length and hash are the manifest's.
Result<std::vector<std::byte>> readPayload(const std::filesystem::path& folder, const FileEntry& file);

/// Makes the folder if it is missing (its parent must be there); an existing one must be empty, hold probes, or hold a bake's work. true: it was made.
Result<bool> ensureFolder(const std::filesystem::path& folder);

}  // namespace burnish::probe
