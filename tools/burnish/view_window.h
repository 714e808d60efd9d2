// The window's loop: events, pictures, panels; it rests when nothing changes.
#pragma once
#include <burnish/renderer.h>

#include <chrono>
#include <memory>
#include <vector>

#include "view_gl.h"
#include "view_panels.h"
#include "view_pictures.h"
#include "view_state.h"
#include "view_ui.h"

namespace cli::viewer {

/// A key that went down: GLFW's number of it.
struct Press {
  int key = 0;
  bool control = false;  ///< was held
};

class Window {
 public:
  /// Opens the window. `loaded` stays the caller's and must outlive it.
  static burnish::Result<std::unique_ptr<Window>> open(const Arguments& arguments, LoadedScene& loaded);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  /// Until it is closed, or until Arguments::frames are drawn.
  burnish::Result<void> run();
  /// What was drawn and measured, on standard output.
  void printSummary() const;
  [[nodiscard]] const burnish::Report& report() const { return renderer_->report(); }

 private:
  using Clock = std::chrono::steady_clock;
  Window(const Arguments& arguments, LoadedScene& loaded) : arguments_(arguments), state_(loaded, arguments) {}
  void listen();
  bool waitForWork();
  void takeInput();
  [[nodiscard]] Wanted wanted() const;
  burnish::Result<void> drawPictures();
  void showPictures();
  void drawUi();
  burnish::Result<void> saveScreenshot();
  void savePicture();
  void printCamera();
  [[nodiscard]] bool scripted() const { return arguments_.frames > 0; }

  const Arguments& arguments_;
  State state_;
  // Gone in reverse order: what lives in the context before it.
  std::unique_ptr<burnish::Context> context_;
  std::unique_ptr<burnish::Renderer> renderer_;
  std::unique_ptr<Gl> gl_;
  std::unique_ptr<Canvas> heat_;
  std::unique_ptr<Ui> ui_;
  std::unique_ptr<Pictures> pictures_;
  Places places_;
  int awake_ = 3;              ///< frames that the panels are drawn for, whatever the pictures do
  std::vector<Press> presses_; ///< since the last frame, in order
  bool moving_ = false, dragging_ = false;
  double fullMs_ = 0;          ///< wall time of the last whole frame
  long long heatOf_ = -1;      ///< Pictures::framesDrawn of the map in heat_
  Clock::time_point lastFrame_ = Clock::now(), lastEvent_ = Clock::now() - std::chrono::hours(1);
};

}  // namespace cli::viewer
