// A reference picture that is not finished yet, in a file.
#pragma once
#include <filesystem>

#include "core/hash.h"
#include "pathtrace/film.h"

namespace burnish::pathtrace {

/// What a film's samples follow from: scene, view, rungs and the options that change them (not how many samples, how long or on how many threads).
core::Hash128 keyOf(const Scene& scene, const View& view, const shading::Rungs& rungs, const ReferenceOptions& options);
/// Complete or absent.
Result<void> writeState(const std::filesystem::path& file, const core::Hash128& key, const Film& film);
/// Fills the film, whose size is set. false: there is no file. Errors: it is damaged, or of something else.
Result<bool> readState(const std::filesystem::path& file, const core::Hash128& key, Film& film);

}  // namespace burnish::pathtrace
