// The sidebar's panels and what is written over the pictures.
#pragma once
#include "view_gl.h"
#include "view_pictures.h"
#include "view_state.h"
#include "view_ui.h"

namespace cli::viewer {

/// Where things are in the window, pixels.
struct Places {
  glm::ivec2 window{0};
  Rect picture;                                ///< all pictures together
  int sidebar = 0;                             ///< its width
  std::array<Rect, 3> panes;                   ///< of A, B and the difference; Layout::Split: A's and B's are the whole of `picture`
  int divider = 0;                             ///< Layout::Split: pixels of A from the left
};
Places placesFor(const State& state, glm::ivec2 window, float scale);

void drawSidebar(State& state, Pictures& pictures, const Places& places);
/// Labels of A and B, the divider, the scale of the difference.
void drawOverlay(const State& state, const Pictures& pictures, const Places& places);

void picturePanel(State& state, const Pictures& pictures);
void qualityPanel(State& state);
void timesPanel(const Pictures& pictures, float scale);
void planPanel(const Pictures& pictures);
void comparePanel(State& state, Pictures& pictures);
void keysPanel();

/// What was measured of A and B, as text: one line a figure.
std::vector<std::string> comparisonLines(const State& state, const Pictures& pictures);
/// The same as a table, with the colours of A and B.
void comparisonTable(const State& state, const Pictures& pictures);
/// "CPU time of the process (software renderer)" or "GPU time".
std::string_view clockName(const Pictures& pictures);

constexpr ImU32 kColorA = IM_COL32(255, 190, 90, 255), kColorB = IM_COL32(110, 190, 255, 255);

}  // namespace cli::viewer
