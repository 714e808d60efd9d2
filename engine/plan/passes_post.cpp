// From the light buffer to the target.
#include "plan/bloom.h"
#include "plan/builder.h"
#include "plan/temporal.h"

namespace burnish::plan {

void addHostDraw(Builder& b) {
  if (b.s.on("host_draw")) b.pass("host_draw", {"host_draw"}, {"depth"}, {"light"});
}

// What has gone before stands in two targets that take turns. Its picture takes the light buffer's place for all that follows.
void addTemporalAntialiasing(Builder& b) {
  const Situation& s = b.s;
  if (!s.on("temporal_antialiasing")) return;
  const bool linear = s.options.output == Output::Linear, motion = s.on("motion_vectors") && s.hasDepth();
  PassPlan& pass = b.pass("temporal_antialiasing", {"temporal_antialiasing"}, {"light"}, {});
  for (int which : {0, 1}) {
    const std::string names[] = {historyName(s.options.sequence, which), historyDistanceName(s.options.sequence, which)};
    b.target(names[0], linear ? "RGBA32F" : "RGBA16F", {"temporal_antialiasing"});
    b.target(names[1], "R16F", {"temporal_antialiasing"});
    for (const std::string& name : names) {
      pass.reads.push_back(name);
      pass.writes.push_back(name);
    }
  }
  if (s.hasDepth()) pass.reads.emplace_back("depth");
  if (motion) pass.reads.emplace_back("velocity");
  for (bool o : s.projections())
    for (bool still : {false, true})
      b.useScreen(pass, std::string(still ? "temporal_still" : "temporal") + (o ? "+ortho" : ""), "post/temporal.frag",
                  {define("GEOMETRY", s.hasDepth()), define("MOTION", motion && !still), define("ORTHOGRAPHIC", o), define("STILL", still), define("WEIGHTED", !linear)});
}

namespace {

/// What the passes after lighting read: the light buffer, or the mean over frames in its place (the two targets take turns).
std::vector<std::string> pictureOf(const Situation& s) {
  if (!s.on("temporal_antialiasing")) return {"light"};
  return {historyName(s.options.sequence, 0), historyName(s.options.sequence, 1)};
}

}  // namespace

void addExposure(Builder& b) {
  if (!b.s.on("auto_exposure")) return;
  b.target("exposure", "RG32F", {"auto_exposure"}, {1, 1});
  b.useScreen(b.pass("exposure", {"auto_exposure"}, pictureOf(b.s), {"exposure"}), "exposure", "post/exposure.frag", {});
}

void addNonfiniteCount(Builder& b) {
  if (b.s.on("nonfinite_count")) b.pass("nonfinite_count", {"nonfinite_count"}, {"light"}, {});
}

void addBloom(Builder& b) {
  if (!b.s.on("bloom")) return;
  PassPlan& pass = b.pass("bloom", {"bloom"}, pictureOf(b.s), {"bloom"});
  b.target("bloom", "RGBA16F", {"bloom"}, bloomSize(b.s.shaded), bloomLevels(b.s.shaded.y));
  for (const char* name : {"bloom_first", "bloom_down", "bloom_up"}) b.useScreen(pass, name, std::string("post/") + name + ".frag", {});
}

void addToneMapping(Builder& b) {
  const Situation& s = b.s;
  if ((!s.on("tone_mapping") && !s.on("linear_output")) || s.developsInPlace()) return;
  const bool automatic = s.on("auto_exposure"), host = s.on("host_depth_in"), linear = s.options.output == Output::Linear;
  const bool bloom = s.on("bloom"), edges = s.on("edge_antialiasing");
  PassPlan& pass = b.pass("tonemap", {"tone_mapping", "linear_output", "host_depth_in", "upscaling"}, pictureOf(s), {edges ? "display" : "target"});
  if (edges) b.target("display", "RGBA8", {"edge_antialiasing"}, s.options.size);
  if (bloom) pass.reads.emplace_back("bloom");
  if (automatic) pass.reads.push_back("exposure");
  if (host) pass.reads.insert(pass.reads.end(), {"gbuffer_b", "depth"});
  std::vector<std::string> defines = {define("AUTO_EXPOSURE", automatic), define("BLOOM", bloom), define("DISPLAY_LUMA", edges), define("HOST_DEPTH", host), define("LINEAR", linear)};
  if (host) defines.push_back(defineNormals(s.quality));
  defines.push_back(define("TONEMAP", linear ? 0 : int(s.quality.toneMap)));
  defines.push_back(define("UPSCALE", s.on("upscaling")));
  b.useScreen(pass, "tonemap", "post/tonemap.frag", std::move(defines));
}

void addEdgeAntialiasing(Builder& b) {
  if (!b.s.on("edge_antialiasing")) return;
  b.useScreen(b.pass("edge_antialiasing", {"edge_antialiasing"}, {"display"}, {"target"}), "edge_antialiasing", "post/edge_antialiasing.frag", {define("HOST_DEPTH", b.s.on("host_depth_in"))});
}

namespace {

/// The targets that the debug view shows.
std::vector<std::string> shownBy(const Situation& s) {
  if (s.options.debugView == DebugView::Nonfinite) return {"light"};
  if (!s.hasDepth()) return {};
  switch (s.options.debugView) {
    case DebugView::Albedo:
    case DebugView::Substance: return {"gbuffer_a", "depth"};
    case DebugView::Normal:
    case DebugView::Roughness: return {"gbuffer_b", "depth"};
    case DebugView::Occlusion:
      if (s.on("screen_occlusion")) return {"occlusion", "depth"};
      if (s.on("baked_occlusion")) return {"gbuffer_c", "depth"};
      break;
    case DebugView::Anisotropy:
      if (s.detailTarget()) return {"gbuffer_a", "gbuffer_b", "gbuffer_d", "depth"};
      break;
    case DebugView::DiffuseRoughness:
      if (s.detailTarget()) return {"gbuffer_d", "depth"};
      break;
    default: break;
  }
  return {"depth"};
}

}  // namespace

void addDebugView(Builder& b) {
  const Situation& s = b.s;
  if (!s.on("debug_view")) return;
  if (s.viewsLights()) {
    b.use(b.pass("debug_view", {"debug_view"}, {"light lists"}, {"target"}), {"debug_lights", "post/lights.vert", "post/lights.frag", {}});
    return;
  }
  PassPlan& pass = b.pass("debug_view", {"debug_view"}, shownBy(s), {"target"});
  for (bool o : s.projections())
    b.useScreen(pass, o ? "debug_view+ortho" : "debug_view", "post/debug.frag",
                {define("DETAIL", s.detailTarget()), define("GEOMETRY", s.hasDepth()), defineNormals(s.quality), define("OCCLUSION", s.on("baked_occlusion") || s.on("screen_occlusion")), define("ORTHOGRAPHIC", o), define("VIEW", int(s.options.debugView))});
}

void addDepthOut(Builder& b) {
  if (!b.s.on("host_depth_out")) return;
  b.useScreen(b.pass("depth_out", {"host_depth_out", "upscaling"}, {"depth"}, {"host depth"}), "depth_out", "post/depth_out.frag", {define("GEOMETRY", b.s.hasDepth()), define("UPSCALE", b.s.on("upscaling"))});
}

}  // namespace burnish::plan
