// From a parsed glTF file to a Scene.
#pragma once
#include <burnish/scene.h>

#include <chrono>

#include "asset/asset.h"

namespace burnish::scene {

/// Checks LoadOptions::seconds between the steps of a load.
class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds), start_(std::chrono::steady_clock::now()) {}
  [[nodiscard]] bool passed() const {
    return seconds_ > 0 && std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() > seconds_;
  }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point start_;
};

/// Converts an asset (its geometry is moved out). One Mesh for each primitive, one Instance for each use of it. The
/// environment is not read here.
Result<Scene> importAsset(asset::Asset asset, const Deadline& deadline, Report& report);

/// A lat-long picture of any kind as linear F32 RGB, its values finite and in 0..65504; mended ones are counted in one
/// warning.
Image environmentMap(const Image& image, const std::string& place, Report& report);

/// Decodes a picture file into the scene's environment. `place` names it in errors and warnings.
Result<void> decodeEnvironment(Scene& scene, std::span<const std::byte> file, const std::string& place,
                               ImageDecoder& decoder, Report& report);

}  // namespace burnish::scene
