// burnish doctor: what this machine's OpenGL can do.
#include <burnish/context.h>
#include <fmt/format.h>

#include <optional>

#include "commands.h"
#include "messages.h"
#include "scene_options.h"

namespace cli {
namespace {

void row(std::string_view name, const std::string& value) { fmt::print("  {:<24} {}\n", name, value); }
std::string yes(bool has) { return has ? "yes" : "no"; }

void print(const burnish::Capabilities& c) {
  row("vendor", c.vendor);
  row("renderer", c.renderer + (c.software ? " (software)" : ""));
  row("version", c.version);
  row("anisotropic filtering", yes(c.anisotropic));
  row("program binaries", yes(c.programBinary));
  row("debug output", yes(c.debugOutput));
  row("parallel compilation", yes(c.parallelCompile));
  row("draw parameters", yes(c.drawParameters));
  row("timer queries", c.timerQueries ? (c.software ? "yes (per-pass times are right with --profile only)" : "yes") : "no");
  row("largest texture", fmt::format("{} pixels", c.maxTextureSize));
  row("texture units", std::to_string(c.maxTextureUnits));
  row("uniform block", fmt::format("{} bytes", c.maxUniformBlockBytes));
  row("storage block", fmt::format("{} bytes", c.maxStorageBlockBytes));
  row("texture buffer", fmt::format("{} texels", c.maxTextureBufferTexels));
  row("largest point", fmt::format("{:g} pixels", c.maxPointSize));
  row("extensions", std::to_string(c.extensions.size()));
}

/// Whether the backend can be used.
bool examine(burnish::Backend backend, bool extensions) {
  fmt::print("{}\n", burnish::backendName(backend));
  SceneOptions options;
  options.backend = backend;
  const auto context = openContext(options);
  if (!context) {
    row("not available", shown(context.error().message()));
    return false;
  }
  const auto capabilities = burnish::queryCapabilities((*context)->procAddress());
  if (!capabilities) {
    row("not usable", shown(capabilities.error().message()));
    return false;
  }
  print(*capabilities);
  if (extensions)
    for (const std::string& name : capabilities->extensions) fmt::print("    {}\n", name);
  return true;
}

}  // namespace

Command addDoctor(CLI::App& program) {
  struct Options {
    std::optional<burnish::Backend> backend;
    bool extensions = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand("doctor", "What this machine's OpenGL can do");
  addChoice(*app, "--backend", {"egl", "osmesa", "glfw"}, [options](std::size_t i) { options->backend = burnish::Backend(i); }, "look at this one only");
  app->add_flag("--extensions", options->extensions, "list the extensions too");
  return {app, [options] {
            int usable = 0;
            for (const auto backend : {burnish::Backend::Egl, burnish::Backend::OsMesa, burnish::Backend::Glfw})
              if (!options->backend || *options->backend == backend) usable += examine(backend, options->extensions) ? 1 : 0;
            if (usable > 0) return int(kOk);
            return printError({"doctor", "no backend gives OpenGL 4.5 core", "install Mesa: apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6"});
          }};
}

}  // namespace cli
