// burnish inspect: what a scene, picture, cubemap or probe folder holds and what is wrong with it; what a substance is.
#include "inspect.h"

#include <fmt/format.h>

#include <fstream>

#include "commands.h"
#include "messages.h"
#include "samples.h"
#include "scene_options.h"

namespace cli {
namespace fs = std::filesystem;
using burnish::fail;
using burnish::Result;

namespace {

constexpr std::uint64_t kMostBytes = 2048ull << 20;

enum class Kind { Scene, Picture, Cubemap };

/// By magic bytes, as the engine itself tells them apart; what is no picture is left to the scene loader and its errors.
Kind kindOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  char head[4096] = {};
  in.read(head, sizeof head);
  const std::string_view text(head, std::size_t(in.gcount()));
  // An EXR file of ours says in its header that it holds all levels of a cubemap.
  if (text.starts_with("DDS ") || text.starts_with("\xabKTX 20\xbb") || (text.starts_with("\x76\x2f\x31\x01") && text.find("BurnishLayout") != std::string_view::npos)) return Kind::Cubemap;
  const bool picture = text.starts_with("\x89PNG") || text.starts_with("\xff\xd8\xff") || text.starts_with("\x76\x2f\x31\x01") ||
                       text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE");
  return picture ? Kind::Picture : Kind::Scene;
}

Result<burnish::Image> readPicture(const fs::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error || size > kMostBytes) return fail(file.string(), error ? "cannot be read: " + error.message() : fmt::format("is too large ({} bytes)", size), "");
  std::vector<std::byte> bytes(size);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size))) return fail(file.string(), "cannot be read", "check the disk");
  return burnish::makeDecoderPool()->decode(bytes, file.string());
}

int inspectCubemap(const fs::path& file, const std::string& given) {
  Progress progress;
  progress.stage("loading " + file.string());
  burnish::Report report;
  burnish::EnvironmentFileOptions options;
  options.asStored = true;
  const auto cube = burnish::readEnvironment(file, report, options);
  progress.finish();
  if (!cube) return printError(cube.error());
  printCubemap(*cube, report, given);
  return kOk;
}

int inspectProbes(const fs::path& folder, const std::string& given) {
  Progress progress;
  progress.stage("loading " + folder.string());
  const auto found = burnish::inspectProbes(folder);
  progress.finish();
  if (!found) return printError(found.error());
  printProbes(*found, given);
  return kOk;
}

int inspectFile(const std::string& given) {
  std::error_code error;
  if (fs::path(given).filename().string().find("%s") != std::string::npos && !fs::exists(given, error)) return inspectCubemap(given, given);
  const auto file = resolveScene(given);
  if (!file) return printError(file.error());
  if (fs::exists(*file / "probes.json", error) || fs::exists(*file / "work/lock", error)) return inspectProbes(*file, given);
  if (fs::is_directory(*file, error)) return inspectCubemap(*file, given);
  if (!fs::is_regular_file(*file, error)) return printError({given, "is no regular file", "give a .gltf, .glb, .png, .jpg, .hdr, .exr, .dds or .ktx2 file or a folder of cubemap faces or probes"});
  const Kind kind = kindOf(*file);
  if (kind == Kind::Cubemap) return inspectCubemap(*file, given);
  Progress progress;
  progress.stage("loading " + file->string());
  if (kind == Kind::Picture) {
    const auto picture = readPicture(*file);
    progress.finish();
    if (!picture) return printError(picture.error());
    printPicture(*picture, given);
    return kOk;
  }
  burnish::Report report;
  const auto scene = burnish::loadScene(*file, {}, report);
  progress.finish();
  if (!scene) return printError(scene.error());
  printScene(*scene, report, given);
  return kOk;
}

int inspectSubstance(const std::string& name) {
  if (const burnish::Substance* substance = burnish::findSubstance(name)) return printSubstance(*substance), kOk;
  std::vector<std::string> names;
  for (const burnish::Substance& substance : burnish::substances()) names.emplace_back(substance.name);
  return printError({name, "no such substance" + didYouMean(name, names), "choose one of: " + listed(names)});
}

}  // namespace

Command addInspect(CLI::App& program) {
  struct Options {
    std::string file, substance;
  };
  auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand("inspect", "What a scene, picture, cubemap or probe folder holds and what is wrong with it; what a substance is");
  CLI::Option* file = app->add_option("FILE", options->file, "a scene (.gltf, .glb, a sample's name), a picture (.png, .jpg, .hdr, .exr) or a cubemap (.dds, .ktx2, .exr, a folder of faces, a pattern like face_%s.exr) or a folder of probes")->type_name("");
  CLI::Option* substance = app->add_option("--substance", options->substance, "a substance of the library: F0, IOR, code, colour")->type_name("NAME");
  file->excludes(substance);
  return {app, [options, app] {
            if (!options->substance.empty()) return inspectSubstance(options->substance);
            if (!options->file.empty()) return inspectFile(options->file);
            fmt::print(stderr, "burnish: FILE or --substance is required: see 'burnish {} --help'\n", app->get_name());
            return int(kUsage);
          }};
}

}  // namespace cli
