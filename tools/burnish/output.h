// Files that are complete or absent, and a standard output that says when it could not be written.
#pragma once
#include <burnish/image.h>
#include <burnish/result.h>

#include <filesystem>
#include <nlohmann/json.hpp>

namespace cli {

using Json = nlohmann::ordered_json;

/// Ctrl-C (SIGINT), SIGTERM and SIGHUP end the program at once, except while a file is being put in place: then right after it.
void installSignals();
/// From now on the first of these signals only asks the work to end (stopAsked); the next one ends the program.
void deferSignals();
bool stopAsked();

/// Says early what would go wrong late: the folder exists and takes new files, the path is no folder or device.
burnish::Result<void> checkOutput(const std::filesystem::path& file);
/// Writes .png or .exr (three channels) by the file's ending.
burnish::Result<void> writePicture(const std::filesystem::path& file, const burnish::Image& rgba);
/// The same of a cubemap: a file, or a folder that is new or holds nothing but cubemap faces.
burnish::Result<void> checkCubemapOutput(const std::filesystem::path& file);
/// burnish::writeCubemap; a signal waits for it.
burnish::Result<void> saveCubemap(const std::filesystem::path& file, const burnish::Cubemap& cubemap, burnish::PixelType type, burnish::Report& report);
/// Writes the document; "-" is standard output. Numbers that are not finite become null.
burnish::Result<void> writeJson(const std::filesystem::path& file, const Json& document);
/// Standard output arrived where it was sent (a full disk is an error).
burnish::Result<void> flushStandardOutput();

}  // namespace cli
