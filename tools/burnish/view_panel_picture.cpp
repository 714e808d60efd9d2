// What is seen and how it is developed: cameras, debug views, exposure, animation, probes.
#include <fmt/format.h>

#include <algorithm>

#include "view_panels.h"

namespace cli::viewer {
namespace {

void chooseCamera(State& state) {
  const auto cameras = camerasOf(state.scene());
  std::vector<std::string> names{"free"};
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    names.push_back(cameras[i].second);
    if (state.follows && *state.follows == cameras[i].first) chosen = i + 1;
  }
  if (combo("camera", chosen, names)) {
    if (chosen == 0)
      state.follows.reset();
    else
      state.lookThrough(cameras[chosen - 1].first);
  }
  tooltip("The scene's cameras; keys 1 to 9. Flying leaves them.");
  const glm::dvec3 eye = state.camera.view().eye;
  dimText(fmt::format("eye {:.2f} {:.2f} {:.2f} m, {:.2f} m/s", eye.x, eye.y, eye.z, state.camera.speed()));
  if (ImGui::Button("print options")) state.printCamera = true;
  tooltip("--eye and --target of this view, on standard output and in the clipboard (P)");
  ImGui::SameLine();
  if (ImGui::Button("save picture")) state.savePicture = true;
  tooltip("The picture without this sidebar, as PNG in the folder where the program was started (F12)");
}

void chooseExposure(State& state, const Pictures& pictures) {
  bool automatic = !state.quality.exposureEv;
  float ev = state.quality.exposureEv.value_or(pictures.exposureEv());
  if (ImGui::Checkbox("automatic exposure", &automatic)) state.quality.exposureEv = automatic ? std::nullopt : std::optional(ev);
  if (automatic && state.debugView == burnish::DebugView::Final) {
    ImGui::SameLine();
    dimText(fmt::format("EV {:.2f}", pictures.exposureEv()));
  }
  if (!automatic && ImGui::SliderFloat("EV100", &ev, -8, 20, "%.2f")) state.quality.exposureEv = ev;
  auto tone = std::size_t(state.quality.toneMap);
  if (combo("tone map", tone, burnish::toneMapNames())) state.quality.toneMap = burnish::ToneMap(tone);
}

void playAnimation(State& state) {
  if (state.length <= 0) return;
  if (ImGui::Button(state.playing ? "pause" : "play")) state.playing = !state.playing;
  ImGui::SameLine();
  auto time = float(state.time);
  if (ImGui::SliderFloat("time", &time, 0, float(state.length), "%.2f s")) state.pose(double(time));
}

void probes(State& state) {
  if (!state.scene().probes.lit() && !state.putAside) return;
  bool on = !state.putAside;
  if (ImGui::Checkbox("light from probes", &on)) state.lightFromProbes(on);
  ImGui::SameLine();
  const burnish::ProbeSet& set = state.putAside ? *state.putAside : state.scene().probes;
  dimText(fmt::format("{} places{}", set.reflections.size(), set.grid ? fmt::format(", {} points", set.grid->points.size()) : std::string()));
}

}  // namespace

void picturePanel(State& state, const Pictures& pictures) {
  chooseCamera(state);
  auto view = std::size_t(state.debugView);
  if (combo("view", view, burnish::debugViewNames())) state.debugView = burnish::DebugView(view);
  chooseExposure(state, pictures);
  playAnimation(state);
  probes(state);
  if (pictures.onCpu()) {
    ImGui::Checkbox("coarser while moving", &state.smallWhileMoving);
    tooltip("Fewer pixels while the camera flies, something plays or a slider is dragged; the picture gets sharp when it rests.");
    ImGui::SameLine();
  }
  ImGui::Checkbox("keep drawing", &state.continuous);
  tooltip("Draws on although nothing changes. Otherwise the picture rests after some frames, which time it.");
  const burnish::FrameStats& stats = pictures.stats();
  dimText(fmt::format("{} x {}, {} draws, {} triangles", pictures.drawn().size.x / std::max(pictures.shrink(), 1), pictures.drawn().size.y / std::max(pictures.shrink(), 1), stats.draws, stats.triangles));
  dimText(fmt::format("{} of {} lights in view, {:.1f} MB of textures", stats.lightsInView, stats.lights, double(stats.textureBytes) / 1e6));
  for (const std::string& error : stats.glErrors) wrappedDimText("GL error: " + error);
}

}  // namespace cli::viewer
