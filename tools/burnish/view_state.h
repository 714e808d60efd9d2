// What the viewer's panels and keys change, and how the command line sets it up.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene_options.h"
#include "view_camera.h"
#include "view_pictures.h"

namespace cli::viewer {

enum class Panel : std::uint8_t { Picture, Quality, Times, Plan, Compare, Keys };
/// In order of the enum, as --panel spells them.
inline constexpr std::array<std::string_view, 6> kPanelNames{"picture", "quality", "times", "plan", "compare", "keys"};

/// The command line's part.
struct Arguments {
  SceneOptions scene;
  burnish::DebugView debugView = burnish::DebugView::Final;
  int frames = 0;            ///< quits after so many; 0: stays open
  std::string screenshot;    ///< of the window, at the end
  std::vector<std::string> split, panels;
  bool heat = false;
  float uiScale = 0;         ///< 0: as the window system says
};

/// How quality B differs from A.
struct Other {
  std::optional<burnish::Quality> file;  ///< read from fileName; its tone map and exposure do not count
  std::string fileName;
  std::size_t preset = 0;    ///< 0: as A, or as the file has it; else presetNames()[preset - 1]
  struct Set {
    std::size_t term, rung;
  };
  std::vector<Set> sets;     ///< over that
  [[nodiscard]] burnish::Quality of(const burnish::Quality& a) const;
  [[nodiscard]] std::string name() const;  ///< "specular=ggx-smith"
};
/// "TERM=RUNG", a preset or a quality file (a name that ends in .json), over what `other` has. The error text says what is wrong with the word.
burnish::Result<void> addWord(Other& other, const std::string& word);

struct State {
  State(LoadedScene& scene, const Arguments& arguments);

  LoadedScene& loaded;
  FlyCamera camera;
  std::optional<burnish::Id<burnish::Camera>> follows;  ///< the scene's camera that is looked through, until it is left
  burnish::Quality quality;  ///< A
  Other other;               ///< B
  burnish::DebugView debugView;
  Layout layout = Layout::One;
  float divider = 0.5f;      ///< of the picture's width
  double heatScale = 0, threshold = 0.01;
  // Animations.
  double time = 0, length = 0;  ///< seconds; length: of the longest one that plays
  bool playing = false;
  std::uint64_t moment = 0;
  // Probes: those that were loaded, while their light is off.
  std::optional<burnish::ProbeSet> putAside;
  // The window.
  std::array<bool, kPanelNames.size()> open{};
  bool showUi = true, smallWhileMoving = true, continuous = false;
  std::string message;       ///< the last thing that happened, or went wrong
  bool savePicture = false, printCamera = false;  ///< asked for
  std::string qualityFile = "quality.json";      ///< what is saved and loaded

  [[nodiscard]] burnish::Scene& scene() { return loaded.scene; }
  [[nodiscard]] burnish::Quality otherQuality() const { return other.of(quality); }
  void pose(double seconds);              ///< moves the animations there
  void lookThrough(burnish::Id<burnish::Camera> id);
  void frameAll(float aspect);            ///< shows the whole scene
  void lightFromProbes(bool on);           ///< nothing changes where no probes were loaded
  void saveQuality();                     ///< A as `qualityFile`; `message` says how it went
  void loadQuality();                     ///< likewise; the exposure stays
};

/// The scene's cameras, in order, with names for people.
std::vector<std::pair<burnish::Id<burnish::Camera>, std::string>> camerasOf(const burnish::Scene& scene);

}  // namespace cli::viewer
