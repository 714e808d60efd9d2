#include "view_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "output.h"

namespace cli::viewer {
using burnish::fail;
using burnish::Result;

burnish::Quality Other::of(const burnish::Quality& a) const {
  burnish::Quality b = file.value_or(a);
  b.toneMap = a.toneMap;
  b.exposureEv = a.exposureEv;
  if (preset > 0) (void)burnish::setPreset(b, burnish::presetNames()[preset - 1]);
  for (const Set& set : sets) burnish::setRung(b, set.term, set.rung);
  return b;
}

std::string Other::name() const {
  std::vector<std::string> parts;
  if (file) parts.push_back(shown(std::filesystem::path(fileName).filename().string()));
  if (preset > 0) parts.emplace_back(burnish::presetNames()[preset - 1]);
  for (const Set& set : sets) parts.push_back(fmt::format("{}={}", burnish::terms()[set.term].name, burnish::terms()[set.term].rungs[set.rung].name));
  return parts.empty() ? "the same" : listed(parts);
}

Result<void> addWord(Other& other, const std::string& word) {
  if (word.ends_with(".json")) {
    auto read = burnish::readQuality(word);
    if (!read) return fail(read.error());
    other.file = *read;
    other.fileName = word;
    return {};
  }
  const std::size_t equals = word.find('=');
  if (equals == std::string::npos) {
    const auto names = burnish::presetNames();
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) return fail(word, "is neither TERM=RUNG nor a preset nor a .json file", fmt::format("presets: {}; 'burnish render --list-rungs' lists terms", fmt::join(names, ", ")));
    other.preset = std::size_t(found - names.begin()) + 1;
    return {};
  }
  burnish::Quality checked;
  if (auto set = burnish::setRung(checked, word.substr(0, equals), word.substr(equals + 1)); !set) return set;
  for (std::size_t t = 0; t < burnish::terms().size(); ++t)
    if (burnish::terms()[t].name == word.substr(0, equals)) other.sets.push_back({t, burnish::rungOf(checked, t)});
  return {};
}

namespace {

constexpr Panel kUsual[] = {Panel::Picture, Panel::Times};
constexpr Panel kUsualSplit[] = {Panel::Compare};

void openPanels(State& state, const Arguments& arguments) {
  for (const std::string& name : arguments.panels) {
    const auto found = std::find(kPanelNames.begin(), kPanelNames.end(), name);
    if (found != kPanelNames.end()) state.open[std::size_t(found - kPanelNames.begin())] = true;
    if (name == "none") state.showUi = false;
  }
  if (!arguments.panels.empty()) return;
  const bool compared = state.layout != Layout::One;
  for (const Panel panel : compared ? std::span<const Panel>(kUsualSplit) : std::span<const Panel>(kUsual)) state.open[std::size_t(panel)] = true;
}

}  // namespace

State::State(LoadedScene& scene, const Arguments& arguments)
    : loaded(scene), camera(scene.view, scene.scene.bounds()), quality(arguments.scene.quality()), debugView(arguments.debugView) {
  for (const std::string& word : arguments.split) (void)addWord(other, word);  // checked when they were parsed
  if (!arguments.split.empty()) layout = Layout::Split;
  if (arguments.heat) layout = Layout::Heat;
  for (const auto id : burnish::playedTogether(loaded.scene)) length = std::max(length, loaded.scene.animations.get(id)->length());
  time = arguments.scene.time.value_or(0);
  if (!arguments.scene.eye && !arguments.scene.fovDegrees)
    for (const auto& [id, name] : camerasOf(loaded.scene))
      if (!follows && sameView(burnish::viewOf(loaded.scene, *loaded.scene.cameras.get(id)), loaded.view)) follows = id;
  openPanels(*this, arguments);
}

void State::pose(double seconds) {
  time = seconds;
  burnish::animate(scene(), seconds);
  ++moment;
  if (follows)
    if (const burnish::Camera* seen = scene().cameras.get(*follows)) camera.set(burnish::viewOf(scene(), *seen));
}

void State::lookThrough(burnish::Id<burnish::Camera> id) {
  const burnish::Camera* seen = scene().cameras.get(id);
  if (!seen) return;
  follows = id;
  camera.set(burnish::viewOf(scene(), *seen));
}

void State::frameAll(float aspect) {
  follows.reset();
  camera.set(burnish::framingView(scene(), aspect));
}

void State::lightFromProbes(bool on) {
  if (on != putAside.has_value() || (!on && !scene().probes.lit())) return;
  const std::uint64_t revision = scene().probes.revision + 1;
  if (on)
    scene().probes = std::move(*putAside), putAside.reset();
  else
    putAside = std::exchange(scene().probes, burnish::ProbeSet{});
  scene().probes.revision = std::max(revision, scene().probes.revision + 1);
  ++moment;
}

void State::saveQuality() {
  auto good = checkOutput(qualityFile);
  if (good) good = burnish::writeQuality(qualityFile, quality, "from burnish view");
  message = good ? "saved " + qualityFile : good.error().message();
}

void State::loadQuality() {
  auto read = burnish::readQuality(qualityFile);
  if (read) read->exposureEv = quality.exposureEv;
  if (read) quality = *read;
  message = read ? "loaded " + qualityFile : read.error().message();
}

std::vector<std::pair<burnish::Id<burnish::Camera>, std::string>> camerasOf(const burnish::Scene& scene) {
  std::vector<std::pair<burnish::Id<burnish::Camera>, std::string>> all;
  scene.cameras.each([&](burnish::Id<burnish::Camera> id, const burnish::Camera& camera) {
    all.emplace_back(id, camera.name.empty() ? fmt::format("camera {}", all.size()) : shown(camera.name));
  });
  return all;
}

}  // namespace cli::viewer
