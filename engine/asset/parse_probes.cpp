// Places of probes: extras.burnish.probe and extras.burnish.probe_grid of nodes, and empty nodes with the names that artists give them (docs/probes.md, "Placing probes").
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "asset/document.h"

namespace burnish::asset {
namespace {

constexpr Range kSize{0, 1e9, true};
constexpr Range kLength{0, 1e9};

glm::dvec3 vectorOf(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

glm::dvec3 halfSize(const At& at, const char* key, Check& check) {
  std::array<double, 3> v{1, 1, 1};
  check.numbers(at, key, v, kSize);
  return vectorOf(v);
}

/// One number for all axes, or three.
std::optional<glm::dvec3> perAxis(const At& at, const char* key, Check& check, const Range& range) {
  const auto found = at->find(key);
  if (found == at->end()) return {};
  if (!found->is_array()) return glm::dvec3(check.number(at, key, 0, range));
  std::array<double, 3> v{};
  check.numbers(at, key, v, range);
  return vectorOf(v);
}

std::optional<double> lengthOf(const At& at, const char* key, Check& check) {
  if (!at->contains(key)) return {};
  return check.number(at, key, 0, kLength);
}

void parseProbe(const At& at, Check& check, NodeSource& node) {
  check.known(at, {"box_half_size", "capture", "fade", "margin"});
  ProbeBox& probe = node.probe.emplace();
  probe.halfSize = halfSize(at, "box_half_size", check);
  std::array<double, 3> capture{};
  if (check.numbers(at, "capture", capture)) probe.capture = vectorOf(capture);
  probe.fade = perAxis(at, "fade", check, kLength);
  probe.margin = lengthOf(at, "margin", check);
}

std::optional<glm::ivec3> counts(const At& at, Check& check) {
  std::array<double, 3> v{};
  if (!check.numbers(at, "counts", v, Range{1, double(kMaxProbePoints)})) return {};
  for (const double n : v)
    if (n != std::floor(n)) check.fail(at.path() + "/counts", "whole numbers are expected");
  if (v[0] * v[1] * v[2] > double(kMaxProbePoints))
    check.fail(at.path() + "/counts", fmt::format("{:.0f} points, at most {} can be taken", v[0] * v[1] * v[2], kMaxProbePoints), "use fewer points");
  return glm::ivec3(vectorOf(v));
}

void parseProbeGrid(const At& at, Check& check, NodeSource& node) {
  check.known(at, {"half_size", "spacing", "counts", "margin"});
  ProbeGrid& grid = node.probeGrid.emplace();
  grid.halfSize = halfSize(at, "half_size", check);
  if (at->contains("spacing") && at->contains("counts")) check.fail(at, "it has both spacing and counts", "keep one of them");
  if (const auto spacing = perAxis(at, "spacing", check, kSize)) grid.spacing = *spacing;
  grid.counts = counts(at, check);
  grid.margin = lengthOf(at, "margin", check);
}

/// `false` instead of an object: whatever the node is called, it is none.
bool refused(const At& ours, const char* key) {
  const auto found = ours->find(key);
  return found != ours->end() && found->is_boolean() && !found->get<bool>();
}

bool named(std::string_view name, std::initializer_list<std::string_view> starts) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::any_of(starts.begin(), starts.end(), [&](std::string_view start) {
    return name.size() >= start.size() && std::equal(start.begin(), start.end(), name.begin(), [&](char a, char b) { return a == lower(b); });
  });
}

}  // namespace

void parseProbes(const At& at, Check& check, NodeSource& node) {
  bool mentioned = false;
  check.withOwnExtras(at, [&](const At& ours) {
    mentioned = ours->contains("probe") || ours->contains("probe_grid");
    if (!refused(ours, "probe")) check.withObject(ours, "probe", [&](const At& probe) { parseProbe(probe, check, node); });
    if (!refused(ours, "probe_grid")) check.withObject(ours, "probe_grid", [&](const At& grid) { parseProbeGrid(grid, check, node); });
  });
  if (mentioned || node.mesh >= 0 || node.camera >= 0 || node.light >= 0) return;
  if (named(node.name, {"irradiancevolume", "irradiance_volume"}))
    node.probeGrid.emplace();
  else if (named(node.name, {"probe_", "probe.", "reflectionprobe", "reflection_probe", "reflectioncubemap", "lightprobe", "light_probe"}))
    node.probe.emplace();
}

}  // namespace burnish::asset
