#include "plan/builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/formats.h"

namespace burnish::plan {
namespace {

// The frame, from top to bottom.
constexpr Step kSteps[] = {addDeformation, addShadowMaps, addHostDepth, addGBuffer, addForward, addTiles, addOcclusion, addLightClear, addLighting, addEmissive, addBackground, addHostDraw, addTransparent, addMotionVectors, addTemporalAntialiasing, addExposure, addNonfiniteCount, addBloom, addToneMapping, addEdgeAntialiasing, addDebugView, addDepthOut};

template <class T>
void addOnce(std::vector<T>& list, const T& item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

}  // namespace

std::span<const Step> steps() { return kSteps; }

std::string define(std::string_view name, int value) { return fmt::format("{} {}", name, value); }
std::string defineNormals(const Quality& quality) { return define("NORMAL_STORAGE", int(quality.normalStorage)); }

std::vector<std::string> Builder::thoseOn(std::initializer_list<std::string_view> effects) const {
  std::vector<std::string> result;
  for (std::string_view e : effects)
    if (s.on(e)) result.emplace_back(e);
  return result;
}

PassPlan& Builder::pass(std::string_view name, std::initializer_list<std::string_view> effects, std::vector<std::string> reads, std::vector<std::string> writes) {
  PassPlan& p = plan_.passes.emplace_back();
  p.name = name;
  p.effects = thoseOn(effects);
  p.reads = std::move(reads);
  p.writes = std::move(writes);
  return p;
}

void Builder::use(PassPlan& pass, const ProgramPlan& program) {
  addOnce(plan_.programs, program);
  addOnce(pass.programs, program.name);
}

void Builder::useScreen(PassPlan& pass, std::string name, std::string fragment, std::vector<std::string> defines) {
  use(pass, {std::move(name), "post/screen.vert", std::move(fragment), std::move(defines)});
}

void Builder::target(std::string_view name, std::string_view format, std::initializer_list<std::string_view> effects, glm::ivec2 size, int levels, int layers) {
  const auto found = std::find_if(plan_.targets.begin(), plan_.targets.end(), [&](const TargetPlan& t) { return t.name == name; });
  const bool known = found != plan_.targets.end();
  TargetPlan& t = known ? *found : plan_.targets.emplace_back();
  for (const std::string& e : thoseOn(effects)) addOnce(t.effects, e);
  if (known) return;
  if (size == glm::ivec2(0)) size = s.shaded;
  t.name = name;
  t.format = format;
  t.width = size.x;
  t.height = size.y;
  t.levels = levels;
  t.layers = layers;
  t.bytes = 0;
  for (int k = 0; k < levels; ++k) t.bytes += std::uint64_t(bytesOf(format)) * std::uint64_t(std::max(size.x >> k, 1)) * std::uint64_t(std::max(size.y >> k, 1)) * std::uint64_t(std::max(layers, 1));
}

FramePlan Builder::finish() {
  plan_.effects = s.effects;
  for (EffectPlan& e : plan_.effects) {
    const auto serves = [&](const std::vector<std::string>& effects) { return std::find(effects.begin(), effects.end(), e.name) != effects.end(); };
    for (const PassPlan& p : plan_.passes) {
      if (!serves(p.effects)) continue;
      e.passes.push_back(p.name);
      for (const std::string& program : p.programs) addOnce(e.programs, program);
    }
    for (const TargetPlan& t : plan_.targets) {
      if (!serves(t.effects)) continue;
      e.targets.push_back(t.name);
      e.bytes += t.bytes;
    }
  }
  for (const TargetPlan& t : plan_.targets)
    if (t.name.starts_with("gbuffer_")) plan_.gbufferBytesPerPixel += bytesOf(t.format);
  return std::move(plan_);
}

}  // namespace burnish::plan
