// The hard cases of the text of captured places, of their harmonics and of occlusion.
#include <burnish/image.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "prefilter/cube.h"
#include "stability/case_text.h"
#include "stability/text_words.h"

namespace burnish::stability {
namespace {

using Random = std::mt19937;

double largest(const vec4& v) { return double(std::max({v.x, v.y, v.z})); }

double uniform(Random& random, double low, double high) { return low + (high - low) * (double(random()) + 0.5) * 0x1p-32; }
dvec3 within(Random& random, const dvec3& extent) { return extent * dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)); }
dvec3 unit(Random& random) {
  const double z = uniform(random, -1, 1), phi = uniform(random, 0, 6.283185307179586), s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

// H1: two boxes that may overlap, points in and around them.
std::string boxesGlsl() { return "blendCase(a.xyz, b, c.xyz, d, e.xyz)"; }
TextVariant boxes() {
  return {{},
          boxesGlsl(),
          [](const ShaderCase& in) { return f64::blendCase(exactly(in[0]), dvec4(in[1]), exactly(in[2]), dvec4(in[3]), exactly(in[4])); },
          [](const ShaderCase& in) { return f32::blendCase(of(in[0]), in[1], of(in[2]), in[3], of(in[4])); }};
}
TextCase shares() {
  TextCase c{"H1", "shares of overlapping places and of the sky: off a sum of 1, negative, or sky inside a box", 1e-6, {}, {boxes()}, {}};
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    dvec3 size[2];
    for (dvec3& s : size) s = {uniform(random, 0.3, 2), uniform(random, 0.3, 2), uniform(random, 0.3, 2)};
    if (size[0].x * size[0].y * size[0].z > size[1].x * size[1].y * size[1].z) std::swap(size[0], size[1]);
    const dvec3 center = within(random, dvec3(1.5)), other = within(random, dvec3(1.5));
    dvec3 p = within(random, dvec3(2.5));
    // Every fourth point lies on a face of the first box.
    if (i % 4 == 0) p = center + within(random, size[0]), p[i / 4 % 3] = double(float(center[i / 4 % 3])) + double(float(size[0][i / 4 % 3]));
    c.inputs.push_back({vec4(vec3(p), 0), vec4(vec3(size[0]), float(uniform(random, 0.05, 0.3))), vec4(vec3(center), 0), vec4(vec3(size[1]), float(uniform(random, 0.05, 0.3))), vec4(vec3(other), 0)});
  }
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec4& w = out[i];
      const double sum = std::abs(w.x + w.y + w.z - 1), negative = -std::min({w.x, w.y, w.z, 0.0});
      // The whole of a box is inside, to half a rounding of its place.
      bool inside = false;
      for (const int box : {1, 3}) {
        const dvec3 q = glm::abs(exactly(in[i][0]) - exactly(in[i][std::size_t(box) + 1])) - exactly(in[i][std::size_t(box)]);
        inside = inside || std::max({q.x, q.y, q.z}) < -1e-6;
      }
      worst.worse(std::max({sum, negative, inside ? w.z : 0.0}), fmt::format("p ({:.3f}, {:.3f}, {:.3f})", in[i][0].x, in[i][0].y, in[i][0].z));
    }
    return worst;
  };
  return c;
}

// H2: along lines through a box that lies in a large one; the share of the small one is its influence, which changes by 1/fade a metre along each axis.
TextCase borders() {
  constexpr int kSteps = 400;
  constexpr double kStep = 2e-3;
  TextCase c{"H2", "shares along lines across a box's border: largest step over what its fade permits", 1.01, {}, {boxes()}, {}};
  Random random(2);
  for (int line = 0; line < 40; ++line) {
    const dvec3 size(uniform(random, 0.3, 1), uniform(random, 0.3, 1), uniform(random, 0.3, 1)), center = within(random, dvec3(0.5)), d = unit(random);
    const dvec3 from = center + within(random, size * 0.9) - d * (kStep * kSteps / 2);
    const float fade = float(uniform(random, 0.05, 0.3));
    for (int i = 0; i < kSteps; ++i)
      c.inputs.push_back({vec4(vec3(from + d * (kStep * i)), i == 0), vec4(vec3(size), fade), vec4(vec3(center), 0), vec4(40, 40, 40, 1), vec4(0)});
  }
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 1; i < in.size(); ++i) {
      if (in[i][0].w == 1) continue;
      const dvec3 way = glm::abs(exactly(in[i][0]) - exactly(in[i - 1][0]));
      const double allowed = (way.x + way.y + way.z) / double(in[i][1].w) + 0x1p-20;  // the least share on a face
      worst.worse(std::max(std::abs(out[i].x - out[i - 1].x), std::abs(out[i].y - out[i - 1].y)) / allowed, fmt::format("fade {:.2f} m", in[i][1].w));
    }
    return worst;
  };
  return c;
}

/// Where the ray leaves the box, by halving the way until inside and outside are a rounding apart.
dvec3 leaves(const dvec3& p, const dvec3& d, const dvec3& extent) {
  double in = 0, out = 4 * glm::length(extent) + 1;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (in + out);
    const dvec3 q = glm::abs(p + d * middle) - extent;
    (std::max({q.x, q.y, q.z}) > 0 ? out : in) = middle;
  }
  return p + d * in;
}
/// a = p, b = d, c = half sizes, d = capture; boxes of 1 cm to 1 km a side that need not be cubes. `degenerate`: on faces, edges and corners, parallel to faces and along edges.
std::vector<ShaderCase> asks(unsigned seed, int count, bool degenerate) {
  Random random(seed);
  std::vector<ShaderCase> all;
  for (int i = 0; i < count; ++i) {
    const double size = std::exp2(uniform(random, -6, 9));
    const dvec3 extent = size * dvec3(std::exp2(uniform(random, -2, 0)), std::exp2(uniform(random, -2, 0)), std::exp2(uniform(random, -2, 0)));
    vec3 e(extent), p(within(random, extent)), d(unit(random));
    if (degenerate) {
      const unsigned held = 1 + random() % 7, parallel = random() % 8;
      for (int k = 0; k < 3; ++k)
        if (held & (1u << k)) p[k] = random() & 1 ? e[k] : -e[k], d[k] = std::copysign(d[k], -p[k]);
      vec3 flat = d;
      for (int k = 0; k < 3; ++k)
        if (parallel & (1u << k)) flat[k] = random() & 1 ? 0.0f : -0.0f;
      if (glm::dot(flat, flat) > 0.01f) d = glm::normalize(flat);
    }
    all.push_back({vec4(p, float(uniform(random, 0, 1))), vec4(d, 0), vec4(e, 0), vec4(vec3(within(random, extent * 0.9)), 0)});
  }
  return all;
}
TextVariant lookup() {
  return {{}, "lookupCase(a.xyz, b.xyz, c.xyz, d.xyz, a.w)", [](const ShaderCase& in) { return f64::lookupCase(exactly(in[0]), exactly(in[1]), exactly(in[2]), exactly(in[3]), double(in[0].w)); },
          [](const ShaderCase& in) { return f32::lookupCase(of(in[0]), of(in[1]), of(in[2]), of(in[3]), in[0].w); }};
}
TextCase projection(bool degenerate) {
  TextCase c{degenerate ? "H5" : "H4", degenerate ? "points on a box's face, edge or corner, rays parallel to a face: off ray-box in double, share of the box's size" : "captured off the box's middle, looked up from anywhere in it: off ray-box in double, share of the box's size",
             1e-4, asks(degenerate ? 5 : 4, 10'000, degenerate), {lookup()}, {}};
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 truth = leaves(exactly(in[i][0]), exactly(in[i][1]), exactly(in[i][2]));
      worst.worse(glm::length(dvec3(out[i]) + exactly(in[i][3]) - truth) / largest(in[i][2]), fmt::format("box of {:.3g} m", 2 * largest(in[i][2])));
    }
    return worst;
  };
  return c;
}

// H3: the lookup's direction does not know the roughness, and box-rough's level is that of the listing: never rougher.
TextCase oneRoughness() {
  TextCase c{"H3", "roughness of the lookup by distance (box-rough): off the listing, and never rougher", 1e-5, asks(3, 4000, false), {lookup()}, {}};
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 hit = leaves(exactly(in[i][0]), exactly(in[i][1]), exactly(in[i][2]));
      const double r = double(in[i][0].w), ratio = glm::length(hit - exactly(in[i][0])) / glm::length(hit - exactly(in[i][3])), nearer = std::min(ratio, 1.0) * r;
      worst.worse(std::max(std::abs(out[i].w - (nearer * (1 - r) + r * r)), out[i].w - r), fmt::format("roughness {:.3f}", r));
    }
    return worst;
  };
  return c;
}

// H5: from outside, in boxes without a size along one, two or three axes.
TextCase outside() {
  TextCase c{"H5", "points outside the box, boxes without a size: lookups that are not finite, have no direction, or end outside the box", 0, asks(55, 4000, true), {}, {}};
  Random random(56);
  for (std::size_t i = 0; i < c.inputs.size(); ++i) {
    ShaderCase& in = c.inputs[i];
    if (i % 2 == 0)
      for (int k = 0; k < 3; ++k) in[0][k] *= float(uniform(random, 0.5, 4));
    for (int k = 0; k < 3; ++k)
      if (i >> k & 1) in[2][k] = 0;
  }
  c.variants.push_back({{},
                        "vec4(probeHit(a.xyz, b.xyz, c.xyz), dot(probeDirection(probeHit(a.xyz, b.xyz, c.xyz), b.xyz, d.xyz), vec3(1.0)))",
                        [](const ShaderCase& in) {
                          const dvec3 hit = f64::probeHit(exactly(in[0]), exactly(in[1]), exactly(in[2]));
                          return dvec4(hit, glm::dot(f64::probeDirection(hit, exactly(in[1]), exactly(in[3])), dvec3(1)));
                        },
                        [](const ShaderCase& in) {
                          const vec3 hit = f32::probeHit(of(in[0]), of(in[1]), of(in[2]));
                          return vec4(hit, glm::dot(f32::probeDirection(hit, of(in[1]), of(in[3])), vec3(1)));
                        }});
  c.judge = [](Inputs in, Outputs out) {
    Finding bad;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 over = glm::abs(dvec3(out[i])) - exactly(in[i][2]) * (1 + 4e-6);
      if ((!finite(out[i]) || std::max({over.x, over.y, over.z}) > 1e-6 * largest(in[i][2])) && bad.value++ == 0)
        bad.where = fmt::format("box ({:g}, {:g}, {:g}), p ({:g}, {:g}, {:g})", in[i][2].x, in[i][2].y, in[i][2].z, in[i][0].x, in[i][0].y, in[i][0].z);
    }
    return bad;
  };
  return c;
}

// H10: one bright direction, de-ringed: nowhere below zero.
TextCase ringing() {
  TextCase c{"H10", "harmonics of one bright direction, de-ringed: how far below 0, share of the peak", 1e-6, {}, {}, {}};
  const dvec3 sun = glm::normalize(dvec3(0.4, 0.8, -0.3));
  CubeLevel level{32, 0, {}};
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) level.texels.insert(level.texels.end(), 3, glm::dot(prefilter::texelDirection(32, face, x, y), sun) > std::cos(0.08) ? 100.0f : 0.001f);
  const auto sh = irradianceSh(level, true, 1);
  std::array<float, 9> k{};
  for (std::size_t i = 0; sh && i < 9; ++i) k[i] = float((*sh)[i][0]);
  Random random(10);
  c.inputs.push_back({vec4(vec3(sun), 0), vec4(k[0], k[1], k[2], k[3]), vec4(k[4], k[5], k[6], k[7]), vec4(k[8])});
  for (int i = 0; i < 5000; ++i) c.inputs.push_back({vec4(vec3(unit(random)), 0), vec4(k[0], k[1], k[2], k[3]), vec4(k[4], k[5], k[6], k[7]), vec4(k[8])});
  c.variants.push_back({{},
                        "vec4(irradianceSh(a.xyz, vec3(b.x), vec3(b.y), vec3(b.z), vec3(b.w), vec3(c.x), vec3(c.y), vec3(c.z), vec3(c.w), vec3(d.x), AMBIENT_SH_L2), 0.0)",
                        [](const ShaderCase& in) {
                          const auto v = [](float x) { return dvec3(double(x)); };
                          const vec4 &b = in[1], &m = in[2];
                          return dvec4(f64::irradianceSh(unitOf(in[0]), v(b.x), v(b.y), v(b.z), v(b.w), v(m.x), v(m.y), v(m.z), v(m.w), v(in[3].x), AMBIENT_SH_L2), 0);
                        },
                        [](const ShaderCase& in) {
                          const auto v = [](float x) { return vec3(x); };
                          const vec4 &b = in[1], &m = in[2];
                          return vec4(f32::irradianceSh(of(in[0]), v(b.x), v(b.y), v(b.z), v(b.w), v(m.x), v(m.y), v(m.z), v(m.w), v(in[3].x), AMBIENT_SH_L2), 0);
                        }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    if (!(out[0].x > 0)) return Finding{std::nan(""), "there is no peak"};
    for (std::size_t i = 0; i < in.size(); ++i) worst.worse(-out[i].x / out[0].x, fmt::format("({:.2f}, {:.2f}, {:.2f})", in[i][0].x, in[i][0].y, in[i][0].z));
    return worst;
  };
  return c;
}

// H22: a slice of occlusion with grazing normals, occluders at the point itself and far beyond the radius: it sees no less than nothing and loses no more than it sees. acos is good to the root of
// a rounding at its ends, 3.5e-4.
TextCase slices() {
  TextCase c{"H22", "screen occlusion of a slice, grazing, occluders from 0 to 1e9 m: values that are not finite or leave their bounds", 0, {}, {}, {}};
  Random random(22);
  for (int i = 0; i < 6000; ++i) {
    const dvec3 v = unit(random), side = unit(random);
    const double cosine = std::pow(10.0, -uniform(random, 0, 8));
    const dvec3 t = glm::normalize(glm::cross(v, side)), n = glm::normalize(v * cosine + t * std::sqrt(1 - cosine * cosine));
    const double lengths[] = {0, 1e-30, 1e-4, 0.3, 0.9, 5, 1e9};
    c.inputs.push_back({vec4(vec3(n), 0), vec4(vec3(v), 0), vec4(vec3(unit(random)), 0), vec4(vec3(unit(random) * lengths[i % 7]), 0)});
  }
  c.variants.push_back({{}, "occlusionCase(a.xyz, b.xyz, c.xyz, d.xyz)", [](const ShaderCase& in) { return f64::occlusionCase(unitOf(in[0]), unitOf(in[1]), exactly(in[2]), exactly(in[3])); },
                        [](const ShaderCase& in) { return f32::occlusionCase(of(in[0]), of(in[1]), of(in[2]), of(in[3])); }});
  c.judge = [](Inputs in, Outputs out) {
    Finding bad;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec4& o = out[i];  // weight times seeable, lost, 1, cosine of the horizon
      const bool good = finite(o) && o.z >= 0 && o.z <= 1 + 1e-5 && o.x >= -1e-5 && o.x <= 1.5708 && o.y >= -5e-4 && o.y <= o.x + 5e-4 && std::abs(o.w) <= o.z + 1e-5;
      if (!good && bad.value++ == 0) bad.where = fmt::format("n ({:g}, {:g}, {:g}): sees {:g}, loses {:g}", in[i][0].x, in[i][0].y, in[i][0].z, o.x, o.y);
    }
    return bad;
  };
  return c;
}

}  // namespace

std::vector<TextCase> probeTextCases() {
  std::vector<TextCase> all;
  all.push_back(shares());
  all.push_back(borders());
  all.push_back(oneRoughness());
  all.push_back(projection(false));
  all.push_back(projection(true));
  all.push_back(outside());
  all.push_back(ringing());
  all.push_back(slices());
  return all;
}

}  // namespace burnish::stability
