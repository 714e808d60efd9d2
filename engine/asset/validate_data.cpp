// What the bytes of accessors hold: finite numbers inside the declared bounds, sparse indices in order, joints that
// exist, times that grow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "asset/elements.h"

namespace burnish::asset {
namespace {

// A file may name the same bytes from many accessors, or none at all (zeros); the work stays in proportion to what the
// file weighs.
std::uint64_t elementBudget(std::uint64_t sourceBytes) { return (std::uint64_t(256) << 20) + 32 * sourceBytes; }

void checkSparseOrder(Check& check, const Accessor& a, const Elements& e, const std::string& path) {
  std::uint64_t before = 0;
  for (std::uint64_t k = 0; k < a.sparse->count; ++k) {
    const std::uint64_t index = e.sparseIndex(k);
    if (index >= a.count)
      return check.fail(path + "/sparse/indices",
                        fmt::format("index {} of element {} is out of range ({} elements)", index, k, a.count));
    if (k && index <= before)
      return check.fail(path + "/sparse/indices", fmt::format("index {} follows {}: they must grow", index, before));
    before = index;
  }
}

// Writers round what they print; integers are exact.
double slack(const Accessor& a, double bound) {
  return a.component == Component::F32 ? 1e-3 * std::abs(bound) + 1e-6 : 0;
}

struct Bounds {
  double low[16], high[16];
  std::uint64_t badIndex = 0;
  double bad = 0;
  bool found = false;
};

void checkValues(Check& check, const Accessor& a, const Elements& e, const std::string& path) {
  const int n = a.components();
  Bounds b;
  std::fill(b.low, b.low + 16, INFINITY);
  std::fill(b.high, b.high + 16, -INFINITY);
  e.each([&](std::uint64_t i, const double* v) {
    for (int c = 0; c < n; ++c) {
      if (!std::isfinite(v[c]) && !b.found) b.found = true, b.badIndex = i, b.bad = v[c];
      b.low[c] = std::min(b.low[c], v[c]);
      b.high[c] = std::max(b.high[c], v[c]);
    }
  });
  if (b.found)
    return check.fail(path, fmt::format("element {} is {}: only finite numbers are allowed", b.badIndex, b.bad));
  for (int c = 0; c < n; ++c) {
    const std::size_t k = std::size_t(c);
    if (!a.min.empty() && b.low[c] < a.min[k] - slack(a, a.min[k]))
      return check.fail(fmt::format("{}/min/{}", path, c),
                        fmt::format("an element is {}, less than the declared minimum {}", b.low[c], a.min[k]));
    if (!a.max.empty() && b.high[c] > a.max[k] + slack(a, a.max[k]))
      return check.fail(fmt::format("{}/max/{}", path, c),
                        fmt::format("an element is {}, more than the declared maximum {}", b.high[c], a.max[k]));
  }
}

void checkJointValues(Check& check, const Document& doc, int accessor, std::size_t joints, const std::string& path) {
  const Elements e(doc, doc.accessors[std::size_t(accessor)]);
  if (!e.available()) return;
  double low = 0, high = 0;
  e.each([&](std::uint64_t, const double* v) {
    for (int c = 0; c < 4; ++c) low = std::min(low, v[c]), high = std::max(high, v[c]);
  });
  if (low < 0) check.fail(path, fmt::format("weight {} is negative", low));
  if (high >= double(joints))
    check.fail(path, fmt::format("joint {} does not exist (a skin of this mesh has {})", high, joints));
}

// Each accessor is looked at once, for the skin with the fewest joints that it meets.
void checkJoints(Check& check, const Document& doc) {
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> joints(doc.meshes.size(), kAny);
  for (const NodeSource& n : doc.nodes)
    if (n.skin >= 0)
      joints[std::size_t(n.mesh)] = std::min(joints[std::size_t(n.mesh)], doc.skins[std::size_t(n.skin)].joints.size());
  struct Use {
    std::size_t joints = kAny, mesh = 0, primitive = 0;
    const std::string* semantic = nullptr;
  };
  std::map<int, Use> uses;
  for (std::size_t m = 0; m < doc.meshes.size(); ++m)
    for (std::size_t p = 0; p < doc.meshes[m].primitives.size(); ++p)
      for (const Attribute& at : doc.meshes[m].primitives[p].attributes) {
        const bool isJoints = at.semantic.starts_with("JOINTS_");
        if (!isJoints && !at.semantic.starts_with("WEIGHTS_")) continue;
        Use& use = uses[at.accessor];
        const std::size_t limit = isJoints ? joints[m] : kAny;
        if (!use.semantic || limit < use.joints) use = {limit, m, p, &at.semantic};
      }
  for (const auto& [accessor, use] : uses)
    if (check.ok())
      checkJointValues(check, doc, accessor, use.joints,
                       fmt::format("/meshes/{}/primitives/{}/attributes/{}", use.mesh, use.primitive, *use.semantic));
}

void checkInverseBindMatrices(Check& check, const Document& doc) {
  std::set<int> checked;
  for (std::size_t s = 0; check.ok() && s < doc.skins.size(); ++s) {
    const int accessor = doc.skins[s].inverseBindMatrices;
    if (accessor < 0 || !checked.insert(accessor).second) continue;
    const Accessor& a = doc.accessors[std::size_t(accessor)];
    const Elements e(doc, a);
    if (!e.available() || a.view < 0) continue;
    bool affine = true;
    e.each([&](std::uint64_t, const double* m) {
      affine = affine && m[3] == 0 && m[7] == 0 && m[11] == 0 && std::abs(m[15] - 1) < 1e-3;
    });
    if (!affine)
      check.fail(fmt::format("/skins/{}/inverseBindMatrices", s),
                 "a matrix is not affine (its last row is not 0, 0, 0, 1)");
  }
}

void checkTimes(Check& check, const Document& doc, int accessor, const std::string& path) {
  const Accessor& a = doc.accessors[std::size_t(accessor)];
  const Elements e(doc, a);
  if (!e.available() || (a.view < 0 && !a.sparse)) return;
  double before = -1;
  bool negative = false, grows = true;
  e.each([&](std::uint64_t, const double* v) {
    negative = negative || *v < 0;
    grows = grows && *v > before;
    before = *v;
  });
  if (negative) check.fail(path, "a time is negative");
  if (!grows) check.fail(path, "the times do not grow from key frame to key frame");
}

// Rotations far from unit length are no rounding. Of cubic splines only the middle of each three elements is a
// rotation.
void checkRotations(Check& check, const Document& doc, const SamplerSource& s, const std::string& path) {
  const Accessor& a = doc.accessors[std::size_t(s.output)];
  const Elements e(doc, a);
  if (!e.available() || (a.view < 0 && !a.sparse)) return;
  double worst = 1;
  e.each([&](std::uint64_t i, const double* v) {
    if (s.cubic() && i % 3 != 1) return;
    const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]) * e.scale();
    if (std::abs(length - 1) > std::abs(worst - 1)) worst = length;
  });
  if (std::abs(worst - 1) > 0.1) check.fail(path, fmt::format("a rotation has length {}, not 1", worst));
}

void checkAnimations(Check& check, const Document& doc) {
  std::vector<bool> checked(doc.accessors.size() * 2);  // times, rotations
  for (std::size_t i = 0; i < doc.animations.size(); ++i) {
    const AnimationSource& animation = doc.animations[i];
    for (std::size_t s = 0; check.ok() && s < animation.samplers.size(); ++s) {
      const std::size_t input = std::size_t(animation.samplers[s].input);
      if (!checked[input * 2])
        checkTimes(check, doc, int(input), fmt::format("/animations/{}/samplers/{}/input", i, s));
      checked[input * 2] = true;
    }
    for (std::size_t c = 0; check.ok() && c < animation.channels.size(); ++c) {
      const SamplerSource& s = animation.samplers[std::size_t(animation.channels[c].sampler)];
      const std::size_t output = std::size_t(s.output);
      if (animation.channels[c].path != "rotation" || checked[output * 2 + 1]) continue;
      checked[output * 2 + 1] = true;
      checkRotations(check, doc, s, fmt::format("/animations/{}/channels/{}/sampler", i, c));
    }
  }
}

}  // namespace

void validateData(Check& check, const Document& doc, std::uint64_t sourceBytes) {
  std::uint64_t left = elementBudget(sourceBytes);
  for (std::size_t i = 0; check.ok() && i < doc.accessors.size(); ++i) {
    const Accessor& a = doc.accessors[i];
    if (!a.readable()) continue;
    const std::string path = fmt::format("/accessors/{}", i);
    const std::uint64_t cost = a.count * a.elementBytes();
    if (cost > left)
      return check.fail(path,
                        fmt::format("the accessors stand for far more data than the {} bytes of the file", sourceBytes),
                        "store each element once");
    left -= cost;
    const Elements e(doc, a);
    if (!e.available() || (a.view < 0 && !a.sparse)) continue;
    if (a.sparse) checkSparseOrder(check, a, e, path);
    if (check.ok() && (a.component == Component::F32 || !a.min.empty() || !a.max.empty()))
      checkValues(check, a, e, path);
  }
  if (check.ok()) checkJoints(check, doc);
  if (check.ok()) checkInverseBindMatrices(check, doc);
  if (check.ok()) checkAnimations(check, doc);
}

}  // namespace burnish::asset
