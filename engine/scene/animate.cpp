// Animations at a time: curves (glTF 2.0, section 3.11 and appendix C), and what they move. All in double.
#include <burnish/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace burnish {
namespace {

/// Where a time lies in a curve: the key frame before it, and how far towards the next, 0..1.
struct Place {
  std::size_t key = 0;
  double fraction = 0, seconds = 0;  ///< seconds: from the key frame to the next; 0: the key frame alone counts
};
Place placeIn(const std::vector<float>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time, [](double t, float key) { return t < double(key); });
  if (after == times.begin()) return {};
  const std::size_t key = std::size_t(after - times.begin()) - 1;
  if (after == times.end()) return {key};
  const double begin = double(times[key]), seconds = double(*after) - begin;
  if (!(seconds > 0)) return {key};
  return {key, std::clamp((time - begin) / seconds, 0.0, 1.0), seconds};
}

using Vector = std::vector<double>;

/// A unit quaternion; one without a direction is none (NaN), which evaluate() refuses.
void normalize(double* q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int c = 0; c < 4; ++c) q[c] = length > 1e-6 ? q[c] / length : NAN;
}

/// Spherical linear interpolation along the shorter arc (glTF 2.0, appendix C.4); a to the result.
void slerp(double* a, double* b, double t) {
  normalize(a);
  normalize(b);
  double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const double sign = dot < 0 ? -1 : 1;
  dot = std::min(std::abs(dot), 1.0);
  const double angle = std::acos(dot), sine = std::sin(angle);
  // Below that the arc is straight in double precision.
  const bool straight = angle < 1e-6;
  const double wa = straight ? 1 - t : std::sin((1 - t) * angle) / sine, wb = sign * (straight ? t : std::sin(t * angle) / sine);
  for (int c = 0; c < 4; ++c) a[c] = wa * a[c] + wb * b[c];
  normalize(a);
}

/// Cubic Hermite spline between key frames of in-tangent, value, out-tangent (glTF 2.0, appendix C.5).
double hermite(double p0, double m0, double p1, double m1, const Place& at) {
  const double t = at.fraction, t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * p0 + at.seconds * (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * p1 + at.seconds * (t3 - t2) * m1;
}

}  // namespace

bool evaluate(const Curve& curve, double time, int width, bool rotation, double* out) {
  const bool cubic = curve.interpolation == Interpolation::CubicSpline;
  const std::size_t w = std::size_t(std::max(width, 0)), stride = cubic ? 3 * w : w;
  if (w == 0 || curve.times.empty() || curve.values.size() != curve.times.size() * stride || (rotation && w != 4)) return false;
  const Place at = placeIn(curve.times, std::isfinite(time) ? time : 0);
  // `from`: the value at the key frame; the in-tangent stands before it, the out-tangent after it.
  const float* from = curve.values.data() + at.key * stride + (cubic ? w : 0);
  Vector a(from, from + w);
  if (at.seconds > 0 && curve.interpolation != Interpolation::Step) {
    const float* to = from + stride;
    if (cubic) {
      for (std::size_t c = 0; c < w; ++c) a[c] = hermite(double(from[c]), double(from[c + w]), double(to[c]), double(*(to + c - w)), at);
    } else if (rotation) {
      Vector b(to, to + w);
      slerp(a.data(), b.data(), at.fraction);
    } else {
      // Not std::lerp, which hides a NaN.
      for (std::size_t c = 0; c < w; ++c) a[c] = (1 - at.fraction) * a[c] + at.fraction * double(to[c]);
    }
  }
  if (rotation) normalize(a.data());
  if (!std::all_of(a.begin(), a.end(), [](double v) { return std::isfinite(v); })) return false;
  std::copy(a.begin(), a.end(), out);
  return true;
}

double Animation::length() const {
  double last = 0;
  for (const Curve& c : curves)
    if (!c.times.empty() && std::isfinite(c.times.back())) last = std::max(last, double(c.times.back()));
  return last;
}

double Animation::looped(double time) const {
  const double end = length();
  if (!(end > 0) || !std::isfinite(time)) return 0;
  const double t = std::fmod(time, end);
  const double in = t < 0 ? t + end : t;
  return in < end ? in : 0;  // a negative time next to zero rounds up to the end
}

namespace {

const Curve* curveOf(const Animation& a, int index) {
  return index >= 0 && std::size_t(index) < a.curves.size() ? &a.curves[std::size_t(index)] : nullptr;
}

void moveNode(Scene& scene, const Animation& a, const Animation::NodeTrack& track, double time) {
  const Node* node = scene.nodes.get(track.node);
  if (!node) return;
  glm::dvec3 t = track.restTranslation, s = track.restScale;
  glm::dquat r = track.restRotation;
  bool moved = false;
  const auto read = [&](int index, int width, double* to) {
    const Curve* curve = curveOf(a, index);
    const bool good = curve && evaluate(*curve, time, width, width == 4, to);
    moved = moved || good;
    return good;
  };
  std::array<double, 4> v{};
  if (read(track.translation, 3, v.data())) t = {v[0], v[1], v[2]};
  if (read(track.rotation, 4, v.data())) r = glm::dquat(v[3], v[0], v[1], v[2]);
  if (read(track.scale, 3, v.data())) s = {v[0], v[1], v[2]};
  if (!moved) return;
  const glm::dmat3 rotation = glm::mat3_cast(r);
  const glm::dmat4 local(glm::dvec4(rotation[0] * s.x, 0), glm::dvec4(rotation[1] * s.y, 0), glm::dvec4(rotation[2] * s.z, 0), glm::dvec4(t, 1));
  if (local != node->local) scene.nodes.edit(track.node)->local = local;
}

void weigh(Scene& scene, const Animation& a, const Animation::WeightTrack& track, double time) {
  const Curve* curve = curveOf(a, track.curve);
  if (!curve || track.width <= 0) return;
  Vector v(std::size_t(track.width));
  if (!evaluate(*curve, time, track.width, false, v.data())) return;
  const std::vector<float> weights(v.begin(), v.end());
  for (const Id<Instance> id : track.instances)
    if (const Instance* instance = scene.instances.get(id); instance && instance->morphWeights != weights)
      scene.instances.edit(id)->morphWeights = weights;
}

}  // namespace

void animate(Scene& scene, Id<Animation> id, double time) {
  const Animation* a = scene.animations.get(id);
  if (!a) return;
  const double t = a->looped(time);
  for (const Animation::NodeTrack& track : a->nodes) moveNode(scene, *a, track, t);
  for (const Animation::WeightTrack& track : a->weights) weigh(scene, *a, track, t);
}

std::vector<Id<Animation>> playedTogether(const Scene& scene) {
  std::vector<Id<Animation>> played;
  std::set<std::pair<bool, std::uint32_t>> taken;  // nodes and instances that move
  scene.animations.each([&](Id<Animation> id, const Animation& a) {
    std::vector<std::pair<bool, std::uint32_t>> moves;
    for (const Animation::NodeTrack& t : a.nodes) moves.emplace_back(false, t.node.index);
    for (const Animation::WeightTrack& t : a.weights)
      for (const Id<Instance> instance : t.instances) moves.emplace_back(true, instance.index);
    if (std::any_of(moves.begin(), moves.end(), [&](const auto& m) { return taken.contains(m); })) return;
    taken.insert(moves.begin(), moves.end());
    played.push_back(id);
  });
  return played;
}

void animate(Scene& scene, double time) {
  for (const Id<Animation> id : playedTogether(scene)) animate(scene, id, time);
}

Animation validated(Animation animation, Report& report) {
  const auto sound = [&](int index, int width, bool& faulty) {
    if (index < 0) return false;
    const Curve* c = curveOf(animation, index);
    const std::size_t values = std::size_t(width) * (c && c->interpolation == Interpolation::CubicSpline ? 3 : 1);
    bool good = c && width > 0 && !c->times.empty() && c->values.size() == c->times.size() * values;
    for (std::size_t i = 0; good && i < c->times.size(); ++i)
      good = std::isfinite(c->times[i]) && (i == 0 || c->times[i] > c->times[i - 1]);
    good = good && std::all_of(c->values.begin(), c->values.end(), [](float v) { return std::isfinite(v); });
    faulty = faulty || !good;
    return good;
  };
  std::size_t dropped = 0;
  for (Animation::NodeTrack& t : animation.nodes)
    for (const auto& [index, width] : {std::pair(&t.translation, 3), std::pair(&t.rotation, 4), std::pair(&t.scale, 3)}) {
      bool faulty = false;
      if (!sound(*index, width, faulty)) *index = -1;
      dropped += faulty;
    }
  dropped += std::erase_if(animation.weights, [&](const Animation::WeightTrack& t) {
    bool faulty = false;
    return !sound(t.curve, t.width, faulty);
  });
  std::erase_if(animation.nodes, [](const Animation::NodeTrack& t) { return t.translation < 0 && t.rotation < 0 && t.scale < 0; });
  if (dropped > 0)
    report.warn(fmt::format("animation \"{}\"", animation.name),
                fmt::format("{} tracks were dropped: their curves are empty, have times that do not grow, numbers that are not finite or sizes that disagree", dropped));
  return animation;
}

}  // namespace burnish
