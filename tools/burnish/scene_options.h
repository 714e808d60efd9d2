// The options of every subcommand that takes a SCENE, and what follows from them: the scene, the view, the quality, the context.
#pragma once
#include <burnish/plan.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "messages.h"

namespace cli {

struct SceneOptions {
  std::string scene, camera, environment, probes;
  std::optional<glm::dvec3> eye, target, up;
  std::optional<double> fovDegrees;
  glm::ivec2 size{1280, 720};
  std::string preset = "default";  ///< or the file's name, for people
  /// --quality named a file: what it says, or why it could not be read. It stands in for the preset.
  std::optional<burnish::Result<burnish::Quality>> qualityFile;
  std::vector<std::pair<std::string, std::string>> sets;  ///< term and rung, in the order given
  burnish::Quality development;                           ///< tone map and exposure
  std::optional<float> scale;                             ///< Quality::resolutionScale
  bool toneMapGiven = false;                              ///< else a quality file's counts
  burnish::Backend backend = burnish::Backend::Egl;
  int threads = 0;  ///< 0: as many as there are
  std::optional<double> time;  ///< seconds; none: the pose that the file stores
  std::string animation;       ///< name or index; empty: those that play side by side

  /// Adds SCENE and its options. Values are checked while parsing: what is no number, size or known name is a usage error.
  /// `required`: parsing fails without a SCENE.
  void addTo(CLI::App& app, bool required = true);
  /// The same without what belongs to a picture: view, size, development, probes.
  void addSceneTo(CLI::App& app, bool required = true);
  /// The preset or the file with what --set changed, and the development. loadScene() fails where the file could not be read.
  [[nodiscard]] burnish::Quality quality() const;

 private:
  void addViewTo(CLI::App& app);
  void takeQuality(const std::string& text);
};

struct LoadedScene {
  burnish::Scene scene;
  burnish::View view;
  std::string cameraName;  ///< for people: "camera hero", "eye 1,2,3", "a view of everything"
  burnish::Report report;
};

/// Reads the scene, its environment and probes, and finds the view. Fails first where the quality file could not be read.
burnish::Result<LoadedScene> loadScene(const SceneOptions& options, Progress& progress);

/// Opens the backend's context; threads as asked for (Mesa's software renderer reads LP_NUM_THREADS when it starts).
burnish::Result<std::unique_ptr<burnish::Context>> openContext(const SceneOptions& options);

/// An option that takes one of a few names; `take` gets the index. An unknown name is a usage error that lists them.
CLI::Option* addChoice(CLI::App& app, const std::string& flag, std::vector<std::string> names, std::function<void(std::size_t)> take,
                       const std::string& description);

std::vector<std::string> warningTexts(const burnish::Report& report);

}  // namespace cli
