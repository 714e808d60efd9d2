// Places of probes in a file become the scene's.
#include "scene/import_probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/transforms.h"

namespace burnish::scene {
namespace {

/// An oriented box: where a box along a node's axes comes to lie.
struct Box {
  glm::dvec3 center{0}, halfSize{0};
  glm::dmat3 axes{1};
  bool usable = true, skewed = false;
};

/// The rotation nearest to a matrix of unit columns (Higham 1986, "Computing the Polar Decomposition"): each step takes the mean of it and of its inverse transposed.
glm::dmat3 nearestRotation(glm::dmat3 m) {
  for (int i = 0; i < 60; ++i) {
    const glm::dmat3 next = (m + glm::transpose(glm::inverse(m))) * 0.5;
    const glm::dmat3 change = next - m;
    m = next;
    if (glm::dot(change[0], change[0]) + glm::dot(change[1], change[1]) + glm::dot(change[2], change[2]) < 1e-30) break;
  }
  return m;
}

constexpr double kEndless = 1e9;  // metres

Box boxOf(const glm::dmat4& world, glm::dvec3 halfSize) {
  Box box;
  box.center = glm::dvec3(world[3]);
  for (int k = 0; k < 3; ++k) {
    const double length = glm::length(glm::dvec3(world[k]));
    box.halfSize[k] = halfSize[k] * length;
    box.usable = box.usable && box.halfSize[k] > 1e-9 && box.halfSize[k] < kEndless && std::abs(box.center[k]) < kEndless;
    box.axes[k] = glm::dvec3(world[k]) / length;
  }
  if (!box.usable) return box;
  // A box looks the same in a mirror: one axis turned round makes a rotation of it.
  const double handed = glm::determinant(box.axes);
  if (handed < 0) box.axes[2] = -box.axes[2];
  if (std::abs(handed) < 1e-6) {
    box.usable = false;
    return box;
  }
  const glm::dmat3 rotation = nearestRotation(box.axes);
  for (int k = 0; k < 3; ++k) box.skewed = box.skewed || glm::length(rotation[k] - box.axes[k]) > 1e-4;
  box.axes = rotation;
  return box;
}

class Importer {
 public:
  Importer(const asset::Asset& asset, Scene& scene, Report& report) : asset_(asset), scene_(scene), report_(report), world_(worldMatrices(scene)) {}

  void run(std::span<const Id<Node>> nodes) {
    for (std::size_t n = 0; n < asset_.nodes.size(); ++n) {
      const asset::Node& node = asset_.nodes[n];
      if (node.probe) reflection(node, world_[nodes[n].index]);
      if (node.probeGrid) lattice(node, world_[nodes[n].index]);
    }
    if (!scene_.probes.reflections.empty() || scene_.probes.grid) ++scene_.probes.revision;
    for (const Fault& f : faults_)
      report_.warn(fmt::format("{}: node '{}'", asset_.name, f.node), f.count == 1 ? f.what : fmt::format("{} (and {} more like it)", f.what, f.count - 1));
    if (grids_ > 1) report_.warn(asset_.name, fmt::format("{} nodes ask for a lattice of ambient probes, a scene has one: that of '{}' is taken", grids_, scene_.probes.grid->name));
  }

 private:
  struct Fault {
    std::string what, node;
    int count = 0;
  };
  /// One warning for each kind of fault: a file decides how many faults it has, not how long the report is.
  void warn(const asset::Node& node, std::string_view what) {
    const auto found = std::find_if(faults_.begin(), faults_.end(), [&](const Fault& f) { return f.what == what; });
    if (found != faults_.end())
      ++found->count;
    else
      faults_.push_back({std::string(what), node.name, 1});
  }

  /// Nothing where the box has no inside.
  std::optional<Box> usable(const asset::Node& node, const glm::dmat4& world, glm::dvec3 halfSize) {
    const Box box = boxOf(world, halfSize);
    if (!box.usable) {
      warn(node, "its transform makes the probe's box flat or endless: the probe is left out");
      return {};
    }
    if (box.skewed) warn(node, "its transform skews the probe's box: the nearest box with right angles is taken");
    return box;
  }

  void reflection(const asset::Node& node, const glm::dmat4& world) {
    const std::optional<Box> box = usable(node, world, node.probe->halfSize);
    if (!box) return;
    ReflectionProbe probe;
    probe.name = node.name;
    probe.center = probe.capture = box->center;
    probe.axes = box->axes;
    probe.halfSize = box->halfSize;
    if (const auto capture = node.probe->capture) {
      if (glm::any(glm::greaterThan(glm::abs(*capture), node.probe->halfSize)))
        warn(node, "the point of its capture lies outside its box: the box's middle is taken");
      else
        probe.capture = glm::dvec3(world * glm::dvec4(*capture, 1));
    }
    if (const auto fade = node.probe->fade) probe.fade = *fade;
    if (const auto margin = node.probe->margin) probe.margin = *margin;
    scene_.probes.reflections.push_back(std::move(probe));
  }

  void lattice(const asset::Node& node, const glm::dmat4& world) {
    const std::optional<Box> box = usable(node, world, node.probeGrid->halfSize);
    if (!box || grids_++ > 0) return;
    AmbientGrid grid;
    grid.name = node.name;
    grid.axes = box->axes;
    grid.counts = node.probeGrid->counts ? *node.probeGrid->counts : countsFor(node, *box);
    for (int k = 0; k < 3; ++k) grid.spacing[k] = 2 * box->halfSize[k] / std::max(grid.counts[k] - 1, 1);
    grid.origin = box->center - grid.axes * (grid.spacing * glm::dvec3(grid.counts - 1) * 0.5);
    if (const auto margin = node.probeGrid->margin) grid.margin = *margin;
    scene_.probes.grid = std::move(grid);
  }

  /// So many that neighbours are no farther apart than asked for, the outermost ones on the box's faces.
  glm::ivec3 countsFor(const asset::Node& node, const Box& box) {
    glm::dvec3 spacing = node.probeGrid->spacing;
    for (int tries = 0;; ++tries) {
      const glm::dvec3 counts = glm::ceil(2.0 * box.halfSize / spacing - 1e-9) + 1.0;
      const double points = counts.x * counts.y * counts.z;
      if (points <= double(asset::kMaxProbePoints)) {
        if (tries > 0) warn(node, fmt::format("its spacing makes more than {} points: it is enlarged to {:.3g} x {:.3g} x {:.3g} m", asset::kMaxProbePoints, spacing.x, spacing.y, spacing.z));
        return glm::ivec3(counts);
      }
      spacing *= std::max(1.01, std::cbrt(points / double(asset::kMaxProbePoints)));
    }
  }

  const asset::Asset& asset_;
  Scene& scene_;
  Report& report_;
  std::vector<glm::dmat4> world_;
  std::vector<Fault> faults_;
  int grids_ = 0;
};

}  // namespace

void importProbes(const asset::Asset& asset, std::span<const Id<Node>> nodes, Scene& scene, Report& report) { Importer(asset, scene, report).run(nodes); }

}  // namespace burnish::scene
