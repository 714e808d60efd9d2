// The files beside probes.json: a KTX2 cube a reflection probe, flat KTX2 pictures for a grid (docs/probe_files.md).
#pragma once
#include "probe/manifest.h"

namespace burnish::probe {

/// A probe's radiance as half floats over a power of two; `radiance` has passed checkSet. The same radiance gives the same bytes, and so does what decodeRadiance reads from them.
struct EncodedRadiance {
  std::vector<std::byte> bytes;
  double scale = 1;
};
EncodedRadiance encodeRadiance(const Cubemap& radiance);
/// Radiance in cd/m². Errors name the file and the place in it: also where size, levels, scale or lobe are not those of the manifest.
Result<Cubemap> decodeRadiance(std::span<const std::byte> bytes, const std::string& name, const Manifest::Reflection& expected, std::optional<ReflectionLobe> lobe);

/// 9 · counts.x wide, counts.y · counts.z high; and kDistanceSize times counts.x and counts.y · counts.z. Points that have no distances have zeros.
std::vector<std::byte> encodeIrradiance(const AmbientGrid& grid);
std::vector<std::byte> encodeDistances(const AmbientGrid& grid);
/// Into points that are there. Distances of points that are not valid stay away where they are zeros.
Result<void> decodeIrradiance(std::span<const std::byte> bytes, const std::string& name, AmbientGrid& grid);
Result<void> decodeDistances(std::span<const std::byte> bytes, const std::string& name, AmbientGrid& grid);

}  // namespace burnish::probe
