#include "text_domains.h"

#include <bit>
#include <cfloat>
#include <cmath>

namespace burnish::test {

using glm::vec3;
using glm::vec4;

float uniform(Random& random, float lo, float hi) { return lo + (hi - lo) * (float(random() >> 8) * 0x1p-24f); }

namespace {

template <std::size_t N>
float pick(Random& random, const float (&values)[N]) {
  return values[random() % N];
}

constexpr float kBelowOne = 1 - 0x1p-24f, kAboveOne = 1 + 0x1p-23f;

float anyNumber(Random& random) {
  static constexpr float kSpecial[] = {0,     FLT_TRUE_MIN, 1e-40f, FLT_MIN,   1e-30f, 1e-20f, 1e-12f, 1e-6f, 0x1p-24f, 4e-4f,
                                       0.02f, 0.5f,         1,      kBelowOne, kAboveOne, 2,   1e3f,   1e9f,  1e18f,    1.9e19f, 1e30f, FLT_MAX};
  const float sign = random() & 1 ? 1.0f : -1.0f;
  switch (random() % 6) {
    case 0: return uniform(random, 0, 1);
    case 1: return uniform(random, -2, 2);
    case 2: return sign * std::exp2(uniform(random, -149, 127.9f));
    case 3: return 1 + sign * float(random() % 16) * 0x1p-24f;
    default: return sign * pick(random, kSpecial);
  }
}
float unitNumber(Random& random) {
  static constexpr float kSpecial[] = {0, -0.0f, FLT_TRUE_MIN, 1e-40f, FLT_MIN, 1e-30f, 1e-12f, 1e-7f, 0x1p-24f, 1e-6f, 4e-4f, 0.5f, 1 - 1e-6f, 1 - 0x1p-23f, kBelowOne, 1, 1};
  switch (random() % 4) {
    case 0: return uniform(random, 0, 1);
    case 1: return std::exp2(-uniform(random, 0, 60));
    case 2: return 1 - std::exp2(-uniform(random, 0, 26));
    default: return pick(random, kSpecial);
  }
}
float ordinaryAlpha(Random& random) {
  const float r = uniform(random, 0.02f, 1);
  return r * r;
}
float ordinaryPower(Random& random) { return shading::f32::powerFromAlpha(ordinaryAlpha(random)); }
float positive(Random& random) { return std::abs(anyNumber(random)); }
template <int Lo, int Hi>  // in hundredths
float span(Random& random) {
  return uniform(random, Lo / 100.0f, Hi / 100.0f);
}

vec3 unitOf(const vec3& v) { return v / std::sqrt(dot(v, v)); }

vec4 table(Random& random, float (*number)(Random&), float most) {
  const float a = number(random) * most, b = number(random) * most, c = number(random) * (most - a), d = number(random) * (most - b);
  return {a, c, b, d};
}

/// Every other light near the mirrored direction, where the lobe is; l and v at least 6 degrees above the surface.
Case ordinaryDirections(Random& random) {
  for (;;) {
    const vec3 n = randomUnit(random), v = randomUnit(random);
    if (dot(n, v) < 0.1f) continue;
    const float alpha = ordinaryAlpha(random);
    vec3 l = randomUnit(random);
    if (random() & 1) {
      const vec3 h = glm::normalize(n + l * (1.5f * alpha));
      l = glm::normalize(2 * dot(h, v) * h - v);
    }
    if (dot(n, l) < 0.1f || dot(l, v) < -0.9f) continue;
    return {vec4(n, alpha), vec4(l, 0), vec4(v, 0), vec4(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1))};
  }
}
Case hardDirections(Random& random) {
  const vec3 n = hardUnit(random), v = random() & 1 ? hardNear(random, n) : hardUnit(random);
  vec3 l = hardUnit(random);
  switch (random() % 4) {
    case 0: l = hardNear(random, v); break;
    case 1: l = hardNear(random, n); break;
    case 2: l = hardNear(random, glm::normalize(2 * dot(n, v) * n - v)); break;
    default: break;
  }
  return {vec4(n, unitNumber(random)), vec4(l, 0), vec4(v, 0), vec4(unitNumber(random), unitNumber(random), unitNumber(random), unitNumber(random))};
}

}  // namespace

constinit const Input kCosine{span<2, 100>, anyNumber};
constinit const Input kUnit{span<0, 100>, unitNumber};
constinit const Input kSin2{[](Random& random) { return std::exp2(-uniform(random, 0, 30)); }, anyNumber};
constinit const Input kAlpha{ordinaryAlpha, anyNumber};
constinit const Input kAlphaUnit{ordinaryAlpha, unitNumber};
constinit const Input kPower{ordinaryPower, positive};
constinit const Input kAny{span<-100, 100>, anyNumber};
constinit const Input kIndex{span<105, 400>, anyNumber};
constinit const Input kInside{span<30, 95>, anyNumber};
constinit const Input kExtinction{span<50, 800>, anyNumber};
constinit const Input kRandom{span<0, 100>, [](Random& random) { return std::min(std::abs(unitNumber(random)), kBelowOne); }};
constinit const Input kInteger{[](Random& random) { return float(random() >> 8); }, [](Random& random) { return float((random() >> 8) >> random() % 25); }};
constinit const Input kCoefficient{span<-100, 100>, [](Random& random) { return anyNumber(random) / 32; }};
constinit const Input kRadiance{[](Random& random) { return std::exp2(uniform(random, -14, 10)); }, positive};
constinit const Input kDistance2{[](Random& random) { return std::exp2(uniform(random, -13, 12)); }, [](Random& random) { return std::max(positive(random), 1e-4f); }};
constinit const Input kByte{[](Random& random) { return float(random() % 256) / 255; }, unitNumber};
constinit const Input kZero{[](Random&) { return 0.0f; }, [](Random&) { return 0.0f; }};

Domain numbers(std::string name, std::initializer_list<Input> inputs) {
  const auto make = [kinds = std::vector<Input>(inputs)](Random& random, bool adverse) {
    Case made{};
    for (std::size_t i = 0; i < kinds.size(); ++i) made[i / 4][int(i % 4)] = (adverse ? kinds[i].adverse : kinds[i].ordinary)(random);
    return made;
  };
  return {std::move(name), [make](Random& random) { return make(random, false); }, [make](Random& random) { return make(random, true); }};
}

vec3 randomUnit(Random& random) {
  const double z = 2 * double(random()) * 0x1p-32 - 1, phi = 2 * kPi * double(random()) * 0x1p-32, s = std::sqrt(1 - z * z);
  return vec3(glm::dvec3(s * std::cos(phi), s * std::sin(phi), z));
}

vec3 hardUnit(Random& random) {
  static constexpr float kSmall[] = {0, -0.0f, FLT_TRUE_MIN, -1e-40f, 1e-30f, -1e-12f, 1e-7f, -1e-4f, 0.01f};
  if (random() & 1) return randomUnit(random);
  vec3 v(pick(random, kSmall), pick(random, kSmall), pick(random, kSmall));
  const int axis = int(random() % 3);
  v[axis] = random() & 1 ? 1.0f : -1.0f;
  if (random() % 4 == 0) v[(axis + 1) % 3] = 1;
  return unitOf(v);
}

vec3 hardNear(Random& random, const vec3& from) {
  const vec3 other = randomUnit(random), side = glm::cross(from, other);
  if (dot(side, side) < 1e-6f) return from;
  const vec3 across = unitOf(side);
  const float turn = std::exp2(-uniform(random, 0, 25)) * (random() & 1 ? 1.0f : -1.0f);
  switch (random() % 6) {
    case 0: return from;
    case 1: return -from;
    case 2: return across;
    case 3: return unitOf(from + across * turn);
    case 4: return unitOf(across * turn - from);
    default: return unitOf(across + from * turn);
  }
}

const Domain kShading{"shading",
                      [](Random& random) {
                        Case made = ordinaryDirections(random);
                        made[4] = table(random, span<0, 100>, 0.95f);
                        made[5] = table(random, span<0, 100>, 0.95f);
                        return made;
                      },
                      [](Random& random) {
                        Case made = hardDirections(random);
                        made[4] = table(random, unitNumber, 1);
                        made[5] = table(random, unitNumber, 1);
                        return made;
                      }};
const Domain kMetal{"shading of metals",
                    [](Random& random) {
                      Case made = ordinaryDirections(random);
                      // No tangent near the normal, where the frame turns with every rounding.
                      const vec3 n(made[0]), across = glm::cross(n, randomUnit(random));
                      if (dot(across, across) > 0.01f) made[4] = vec4(across * 2.0f + n * 0.3f, uniform(random, 0, 1));
                      const bool named = random() & 1;
                      made[5] = vec4(named ? uniform(random, 0.05f, 4) : 0.0f, uniform(random, 0.05f, 4), uniform(random, 0.5f, 8), uniform(random, 0.5f, 8));
                      return made;
                    },
                    [](Random& random) {
                      Case made = hardDirections(random);
                      switch (random() % 3) {
                        case 0: made[4] = vec4(anyNumber(random), anyNumber(random), anyNumber(random), anyNumber(random)); break;
                        case 1: made[4] = vec4(hardNear(random, vec3(made[0])), unitNumber(random)); break;
                        default: made[4] = vec4(randomUnit(random) * std::exp2(uniform(random, -126, 120)), unitNumber(random));
                      }
                      made[5] = vec4(anyNumber(random), anyNumber(random), anyNumber(random), anyNumber(random));
                      return made;
                    }};

}  // namespace burnish::test
