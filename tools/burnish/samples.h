// The sample scenes that come with the program, found relative to it.
#pragma once
#include <burnish/result.h>

#include <filesystem>

namespace cli {

/// ../share/burnish/samples from the program's own folder.
std::filesystem::path samplesFolder();
/// Names that stand for a scene, sorted.
std::vector<std::string> sampleNames();
/// The file that SCENE means: an existing file, or a sample's name.
burnish::Result<std::filesystem::path> resolveScene(const std::string& scene);

}  // namespace cli
