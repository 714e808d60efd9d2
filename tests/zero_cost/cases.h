// What the suite draws, and a row an effect: what makes nothing call for it, and what calls for it. A new effect needs its row in cases.cpp.
#pragma once
#include <fmt/format.h>

#include "render/scenes.h"

namespace burnish::test {

/// A frame to be drawn, by one view of the whole target.
struct Subject {
  std::string name;
  Scene scene;
  View view;
  glm::ivec2 size{96, 54};
  Quality quality;
  Output output = Output::Display;
  DebugView debugView = DebugView::Final;
  bool countNonfinite = false, hostDepthIn = false, hostDepthOut = false, hostDraw = false;
  bool moves = false;  ///< an instance stands elsewhere in the second frame
};

struct EffectCase {
  std::string_view effect;
  void (*off)(Subject&);  ///< afterwards nothing calls for it, whatever did
  void (*on)(Subject&);   ///< calls for it, on the stand; off() came before
};
/// In the order of effectList().
std::span<const EffectCase> effectCases();
const EffectCase* caseOf(std::string_view effect);

/// A ball on a floor under a sun, with a fixed exposure: nothing calls for more.
Subject stand();
/// "fps", "rts" or "space" as its hero camera sees it. Pictures are reduced to a few texels: how many there are counts here, not how large they are.
const Subject& sample(std::string_view name);
inline constexpr std::string_view kSamples[] = {"fps", "rts", "space"};

}  // namespace burnish::test
