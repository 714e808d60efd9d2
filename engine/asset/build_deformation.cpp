// Joints, weights and morph targets of a primitive (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
#include <fmt/format.h>

#include <array>

#include "asset/gather.h"

namespace burnish::asset {
namespace {

// Of all sets of four the four largest weights of each vertex, scaled to the sum that they all had. Returns the largest
// share that a vertex loses.
double strongest(const std::vector<std::vector<glm::u16vec4>>& joints, const std::vector<std::vector<glm::vec4>>& weights,
                 Primitive& out) {
  double lost = 0;
  std::vector<std::pair<float, std::uint16_t>> all;
  for (std::size_t v = 0; v < out.joints.size(); ++v) {
    all.clear();
    double sum = 0, kept = 0;
    for (std::size_t s = 0; s < joints.size(); ++s)
      for (int c = 0; c < 4; ++c) {
        all.emplace_back(weights[s][v][c], joints[s][v][c]);
        sum += double(weights[s][v][c]);
      }
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t c = 0; c < 4; ++c) kept += double(all[c].first);
    for (int c = 0; c < 4; ++c) {
      const auto& [weight, joint] = all[std::size_t(c)];
      out.joints[v][c] = joint;
      out.weights[v][c] = kept > 0 ? float(double(weight) * (sum / kept)) : 0;
    }
    if (sum > 0) lost = std::max(lost, 1 - kept / sum);
  }
  return lost;
}

void gatherJoints(const Gather& gather, Primitive& out) {
  std::vector<std::vector<glm::u16vec4>> joints;
  std::vector<std::vector<glm::vec4>> weights;
  for (int set = 0; gather.source.find(fmt::format("JOINTS_{}", set)) >= 0; ++set) {
    joints.push_back(gather.operator()<glm::u16vec4>(fmt::format("JOINTS_{}", set)));
    weights.push_back(gather.operator()<glm::vec4>(fmt::format("WEIGHTS_{}", set)));
    if (!gather.b.check.ok()) return;
  }
  if (joints.empty()) return;
  out.joints = joints[0];
  out.weights = weights[0];
  if (joints.size() == 1) return;
  const double lost = strongest(joints, weights, out);
  if (lost > 0)
    gather.b.check.warn(gather.path + "/attributes/JOINTS_1",
                        fmt::format("vertices hang on more than four joints: the strongest four of each are kept, which "
                                    "leaves out up to {:.2g} % of a vertex's weight",
                                    100 * lost));
}

}  // namespace

bool deformationMissing(const Builder& b, const PrimitiveSource& p) {
  const auto missing = [&](const Attribute& a) { return !Elements(b.doc, accessorAt(b, a.accessor)).available(); };
  for (const Attribute& a : p.attributes)
    if ((a.semantic.starts_with("JOINTS_") || a.semantic.starts_with("WEIGHTS_")) && missing(a)) return true;
  for (const auto& target : p.targets)
    if (std::any_of(target.begin(), target.end(), missing)) return true;
  return false;
}

void gatherDeformation(const Gather& gather, Primitive& out) {
  gatherJoints(gather, out);
  for (const auto& source : gather.source.targets) {
    MorphTarget& target = out.targets.emplace_back();
    for (const Attribute& a : source) {
      if (a.semantic == "POSITION")
        target.positions = gather.read<glm::vec3>(a.accessor);
      else if (a.semantic == "NORMAL" && !out.normals.empty())
        target.normals = gather.read<glm::vec3>(a.accessor);
      else if (a.semantic == "TANGENT" && !out.tangents.empty())
        target.tangents = gather.read<glm::vec3>(a.accessor);
      else if (a.semantic != "NORMAL" && a.semantic != "TANGENT")
        gather.b.check.warn(gather.path + "/targets",
                            fmt::format("morph targets of {} are not supported and ignored", a.semantic));
    }
  }
}

}  // namespace burnish::asset
