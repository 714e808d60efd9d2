// The hard cases that the shading text itself must bear.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plan/rungs.h"
#include "prefilter/dfg.h"
#include "reference/energy.h"
#include "reference/quadrature.h"
#include "stability/text_words.h"

namespace burnish::stability {
namespace {

// A normal that no axis favours, with its frame.
struct Frame {
  dvec3 n, t, b;
  explicit Frame(dvec3 normal = glm::normalize(dvec3(0.36, 0.72, 0.59))) : n(normal) {
    t = glm::normalize(glm::cross(dvec3(0.3, -0.2, 0.9), n));
    b = glm::cross(n, t);
  }
  [[nodiscard]] dvec3 world(const dvec3& local) const { return t * local.x + b * local.y + n * local.z; }
};

// H12: white metal, albedo by summing over directions that are dense where the lobe is, against quadrature in double.
TextCase whiteMetal(const shading::Rungs& k) {
  struct Cell {
    double roughness, nov, truth;
  };
  const Frame frame;
  TextCase c{"H12", fmt::format("white metal, roughness 0.01 to 0.1, {}: relative error of its albedo", nameOf(k)), 0.01, {}, {shadeVariant({}, k)}, {}};
  std::vector<Cell> cells;
  for (const double r : {0.01, 0.02, 0.05, 0.1})
    for (const double nov : {1.0, 0.7, 0.3}) {
      const double alpha = double(float(r * r));
      const glm::dvec2 truth = reference::lobeAlbedo(k, nov, alpha, true);
      const vec3 v(frame.world(reference::directionAt(nov)));
      reference::visitHalf(nov, alpha, reference::Resolution{24, 24}, [&](const dvec3& l, double weight) {
        // Half of the directions stand for both sides of the plane of incidence.
        c.inputs.push_back({vec4(vec3(frame.n), float(alpha)), vec4(vec3(frame.world(l)), float(weight)), vec4(v, 0), vec4(1), vec4(0), vec4(0, 0, float(cells.size()), 0)});
      });
      cells.push_back({r, nov, truth.x + truth.y});
    }
  c.judge = [cells](Inputs in, Outputs out) {
    std::vector<double> sums(cells.size());
    for (std::size_t i = 0; i < in.size(); ++i) sums[std::size_t(in[i][5].z)] += out[i].x * double(in[i][1].w);
    Finding worst;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (const double error = std::abs(sums[i] / cells[i].truth - 1); !(error <= worst.value)) worst = {error, fmt::format("roughness {:g}, n.v {:g}", cells[i].roughness, cells[i].nov)};
    return worst;
  };
  return c;
}

// The lobe near the normal, where pow is off by 0.74.
TextCase stableLobe() {
  TextCase c{"H12", "(n.h)^p by the stable rung, roughness 0.02 to 0.2, eye within 26 degrees of the normal: absolute error", 1e-4, {}, {}, {}};
  const Frame frame;
  for (const double r : {0.02, 0.03, 0.05, 0.1, 0.2}) {
    const float alpha = float(r * r);
    for (int i = 0; i < 4000; ++i) {
      const double phi = 2.399963 * i, angle = 3 * double(alpha) * (i + 0.5) / 4000, theta = 0.45 * ((i * 7) % 4000) / 4000;
      const dvec3 h = glm::normalize(dvec3(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle)));
      const dvec3 v(std::sin(theta), 0, std::cos(theta)), l = h * (2 * glm::dot(h, v)) - v;
      c.inputs.push_back({vec4(vec3(frame.n), alpha), vec4(vec3(frame.world(l)), 0), vec4(vec3(frame.world(v)), 0)});
    }
  }
  TextVariant v;
  v.glsl = "vec4(lobeStable(sinSquaredHalf(a.xyz, b.xyz, dot(a.xyz, b.xyz), c.xyz - a.xyz * dot(a.xyz, c.xyz), 1.0 / (2.0 + 2.0 * dot(b.xyz, c.xyz))), powerFromAlpha(a.w)))";
  v.inDouble = [](const ShaderCase& k) {
    const dvec3 n = unitOf(k[0]), l = unitOf(k[1]), e = unitOf(k[2]);
    return dvec4(f64::lobeStable(f64::sinSquaredHalf(n, l, dot(n, l), e - n * dot(n, e), 1 / (2 + 2 * dot(l, e))), f64::powerFromAlpha(double(k[0].w))));
  };
  v.inFloat = [](const ShaderCase& k) {
    const vec3 n(k[0]), l(k[1]), e(k[2]);
    return vec4(f32::lobeStable(f32::sinSquaredHalf(n, l, dot(n, l), e - n * dot(n, e), 1 / (2 + 2 * dot(l, e))), f32::powerFromAlpha(k[0].w)));
  };
  c.variants.push_back(v);
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 h = glm::normalize(unitOf(in[i][1]) + unitOf(in[i][2])), x = glm::cross(unitOf(in[i][0]), h);
      const double truth = std::exp(0.5 * f64::powerFromAlpha(double(in[i][0].w)) * std::log1p(-dot(x, x))), error = std::abs(out[i].x - truth);
      if (!(error <= worst.value)) worst = {error, fmt::format("roughness {:.2f}", std::sqrt(in[i][0].w))};
    }
    return worst;
  };
  return c;
}

// H15: alpha, not roughness, where the equation says alpha.
TextCase occlusionTakesAlpha() {
  TextCase c{"H15", "specular occlusion takes alpha, not roughness: absolute error", 1e-4, {}, {}, {}};
  for (float r = 0.02f; r <= 1; r += 0.07f)
    for (float nov = 0.05f; nov <= 1; nov += 0.19f)
      for (float ao = 0; ao <= 1; ao += 0.2f) c.inputs.push_back({vec4(nov, ao, r, 0)});
  c.variants.push_back({{},
                        "vec4(specularOcclusion(a.x, a.y, alphaFromRoughness(a.z), SPECULAR_OCCLUSION_LAGARDE))",
                        [](const ShaderCase& k) { return dvec4(f64::specularOcclusion(double(k[0].x), double(k[0].y), f64::alphaFromRoughness(double(k[0].z)), SPECULAR_OCCLUSION_LAGARDE)); },
                        [](const ShaderCase& k) { return vec4(f32::specularOcclusion(k[0].x, k[0].y, f32::alphaFromRoughness(k[0].z), SPECULAR_OCCLUSION_LAGARDE)); }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double nov = double(in[i][0].x), ao = double(in[i][0].y), r = double(in[i][0].z);
      const double truth = std::clamp(std::pow(std::max(nov + ao, 1e-4), std::exp2(-16 * r * r - 1)) - 1 + ao, 0.0, 1.0), error = std::abs(out[i].x - truth);
      if (!(error <= worst.value)) worst = {error, fmt::format("roughness {:.2f}, n.v {:.2f}, ao {:.1f}", r, nov, ao)};
    }
    return worst;
  };
  return c;
}

// H19: the highlight of a smooth sphere whose normals and roughness go through the G-buffer, at several places of the sphere.
// A exp(-B x) is fitted to the radiance over x = sin² of the angle between the true normal and the half vector, by least squares (Gauss and Newton).
struct Fit {
  std::vector<std::pair<double, double>> samples;
  double a = 0, b = 0;
  void solve(double alpha) {
    for (const auto& [x, radiance] : samples) a = std::max(a, radiance);
    b = 1 / (alpha * alpha);
    for (int step = 0; step < 30; ++step) {
      double aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;
      for (const auto& [x, radiance] : samples) {
        const double e = std::exp(-b * x), ja = e, jb = -a * x * e, rest = radiance - a * e;
        aa += ja * ja, ab += ja * jb, bb += jb * jb, ra += ja * rest, rb += jb * rest;
      }
      const double determinant = aa * bb - ab * ab;
      a += (bb * ra - ab * rb) / determinant;
      b += (aa * rb - ab * ra) / determinant;
    }
  }
  [[nodiscard]] double peak() const { return a; }
  [[nodiscard]] double halfWidth() const { return std::sqrt(std::log(2.0) / b); }
};
TextCase highlight(bool width) {
  struct Spot {
    double roughness;
    int place;
  };
  constexpr int kSide = 40;
  TextCase c{"H19", width ? "highlight through the quantised G-buffer, roughness 0.05 to 1: relative error of its half-width" : "highlight through the quantised G-buffer, roughness 0.05 to 1: relative error of its peak",
             width ? 0.04 : 0.05, {}, {}, {}};
  const shading::Rungs k = plan::rungsOf(Quality{});
  const double spread = 0.35;  // l and v, radians from the half vector
  std::vector<Spot> spots;
  for (const double r : {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0})
    for (int place = 0; place < 6; ++place) {
      const double z = 1 - (place + 0.5) / 3, phi = 2.399963 * place + 0.4, s = std::sqrt(1 - z * z);
      const Frame frame(dvec3(s * std::cos(phi), s * std::sin(phi), z));
      const vec3 l(frame.world({std::sin(spread), 0, std::cos(spread)})), v(frame.world({-std::sin(spread), 0, std::cos(spread)}));
      const double alpha = r * r, reach = std::min(2 * alpha, 0.8);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const double tx = reach * (2 * (x + 0.5) / kSide - 1), ty = reach * (2 * (y + 0.5) / kSide - 1);
          c.inputs.push_back({vec4(vec3(glm::normalize(frame.world({tx, ty, 1}))), float(alpha)), vec4(l, 0), vec4(v, 0), vec4(1), vec4(0), vec4(0, 0, float(spots.size()), 0)});
        }
      spots.push_back({r, place});
    }
  TextVariant t;
  t.glsl = "shadeCase(vec4(unpackNormal(floor(packNormal(a.xyz) * 255.0 + 0.5) / 255.0), decodeAlpha(floor(encodeAlpha(storedAlpha(a.w)) * 255.0 + 0.5) / 255.0)), b, c, d, e, f.xy, " + glslOf(k) + ")";
  const TextVariant plain = shadeVariant({}, k);
  t.inDouble = [plain](const ShaderCase& in) {
    ShaderCase q = in;
    const double code = std::floor(f64::encodeAlpha(f64::storedAlpha(double(in[0].w))) * 255 + 0.5) / 255;
    q[0] = vec4(vec3(f64::unpackNormal(glm::floor(f64::packNormal(unitOf(in[0])) * 255.0 + 0.5) / 255.0)), float(f64::decodeAlpha(code)));
    return plain.inDouble(q);
  };
  t.inFloat = [plain](const ShaderCase& in) {
    ShaderCase q = in;
    const float code = std::floor(f32::encodeAlpha(f32::storedAlpha(in[0].w)) * 255 + 0.5f) / 255;
    q[0] = vec4(f32::unpackNormal(glm::floor(f32::packNormal(vec3(in[0])) * 255.0f + 0.5f) / 255.0f), f32::decodeAlpha(code));
    return plain.inFloat(q);
  };
  c.variants.push_back(t);
  c.judge = [width, spots, plain](Inputs in, Outputs out) {
    std::vector<Fit> stored(spots.size()), exact(spots.size());
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 h = glm::normalize(unitOf(in[i][1]) + unitOf(in[i][2])), x = glm::cross(unitOf(in[i][0]), h);
      stored[std::size_t(in[i][5].z)].samples.emplace_back(dot(x, x), out[i].x);
      exact[std::size_t(in[i][5].z)].samples.emplace_back(dot(x, x), plain.inDouble(in[i]).x);
    }
    Finding worst;
    for (std::size_t i = 0; i < spots.size(); ++i) {
      const double alpha = spots[i].roughness * spots[i].roughness;
      stored[i].solve(alpha);
      exact[i].solve(alpha);
      const double error = std::abs((width ? stored[i].halfWidth() / exact[i].halfWidth() : stored[i].peak() / exact[i].peak()) - 1);
      if (!(error <= worst.value)) worst = {error, fmt::format("roughness {:g}, place {}", spots[i].roughness, spots[i].place)};
    }
    return worst;
  };
  return c;
}

// H21: cones of 0 and 180 degrees, inner = outer, lights at the shaded point, far away, with and without a range.
TextCase lights() {
  TextCase c{"H21", "spot cones of 0 and 180 degrees, inner = outer, light at the point, range 0: values that are not finite or leave their bounds", 0, {}, {}, {}};
  for (const float cosine : {-1.0f, -1e-7f, 0.0f, 0.5f, 0.9999999f, 1.0f, 1.0000001f})
    for (const float scale : {0.0f, 1.0f, 1e4f, 1e10f, 3e38f})
      for (const float d2 : {0.0f, 1e-30f, 1e-4f, 1.0f, 1e10f, 1e20f, 3e38f})
        for (const float range4 : {0.0f, 1e-12f, 1.0f, 1e12f}) c.inputs.push_back({vec4(cosine, scale, -0.7f * scale, d2), vec4(range4, range4 > 0 ? 0.0f : 1e-3f, 0, 0)});
  c.variants.push_back({{},
                        "vec4(spotAttenuation(a.x, a.y, a.z), distanceAttenuation(max(a.w, BURNISH_GUARD_DISTANCE2), 1.0 / max(a.w, BURNISH_GUARD_DISTANCE2), b.x, b.y), 0.0, 0.0)",
                        [](const ShaderCase& k) {
                          const double d2 = std::max(double(k[0].w), 1e-4);
                          return dvec4(f64::spotAttenuation(double(k[0].x), double(k[0].y), double(k[0].z)), f64::distanceAttenuation(d2, 1 / d2, double(k[1].x), double(k[1].y)), 0, 0);
                        },
                        [](const ShaderCase& k) {
                          const float d2 = std::max(k[0].w, 1e-4f);
                          return vec4(f32::spotAttenuation(k[0].x, k[0].y, k[0].z), f32::distanceAttenuation(d2, 1 / d2, k[1].x, k[1].y), 0, 0);
                        }});
  c.judge = [](Inputs in, Outputs out) {
    Finding bad;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double most = 1 / std::max(double(in[i][0].w), 1e-4);
      const bool good = finite(out[i]) && out[i].x >= 0 && out[i].x <= 1 && out[i].y >= 0 && out[i].y <= most * (1 + 1e-5);
      if (!good && bad.value++ == 0) bad.where = fmt::format("cosine {:g}, scale {:g}, distance² {:g}", in[i][0].x, in[i][0].y, in[i][0].w);
    }
    return bad;
  };
  return c;
}

// H26: no half vector, light or eye under the surface or grazing.
TextCase grazing() {
  TextCase c{"H26", "l = -v, l or v under the surface, n.l and n.v to 0, every rung: values that are not finite, negative, or lit from below", 0, {}, everyShadeVariant(), {}};
  const vec3 n(0, 0, 1);
  std::vector<vec3> directions{n, -n, vec3(1, 0, 0), vec3(0, -1, 0)};
  for (const float z : {1e-38f, 1e-7f, 1e-4f, 0.01f, 0.7f, -1e-38f, -1e-7f, -1e-4f, -0.3f})
    for (const vec3 side : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0.6f, 0.8f, 0)}) directions.emplace_back(side * std::sqrt(1 - z * z) + n * z);
  for (const vec3& v : directions)
    for (std::size_t i = 0; i <= directions.size(); ++i)
      for (const float alpha : {4e-4f, 0.09f, 1.0f})
        for (const vec4& material : {vec4(0, 0, 0, 1), vec4(1, 1, 1, 1), vec4(1, 1, 1, 0), vec4(0.5f, 0.5f, 0.5f, 0.7f)})
          c.inputs.push_back({vec4(n, alpha), vec4(i < directions.size() ? directions[i] : -v, 0), vec4(v, 0), material, vec4(0.6f, 0.1f, 0.3f, 0.2f), vec4(0.6f, 0.1f, 0, 0)});
  c.judge = [](Inputs in, Outputs out) {
    Finding bad;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const bool below = in[i][1].z <= 0 && in[i][2].z >= 0;
      const bool good = finite(out[i]) && out[i].x >= -1e-6 && (!below || out[i].x == 0);
      if (!good && bad.value++ == 0)
        bad.where = fmt::format("{:g} for l ({:g}, {:g}, {:g}), v ({:g}, {:g}, {:g}), alpha {:g}", out[i].x, in[i][1].x, in[i][1].y, in[i][1].z, in[i][2].x, in[i][2].y, in[i][2].z, in[i][0].w);
    }
    return bad;
  };
  return c;
}

// H26: a light that rises through the horizon, in steps of a hundredth of a degree.
TextCase horizon() {
  TextCase c{"H26", "a light that crosses the horizon: largest step of 0.01 degrees over the largest value", 0.05, {}, {}, {}};
  for (TextVariant& v : everyShadeVariant())
    if (v.name != "phong" && v.name != "blinn-phong") c.variants.push_back(std::move(v));  // these end at the horizon with a step: no cosine is part of them
  for (int i = -500; i <= 500; ++i) {
    const double e = i * 0.01 * 3.14159265358979 / 180;
    const float nol = float(std::sin(e));
    const shading::Rungs k = plan::rungsOf(Quality{});
    const glm::vec2 dfgV(prefilter::lookUpDfg(k, 0.3, 0.09)), dfgL(prefilter::lookUpDfg(k, double(nol), 0.09)), mean(prefilter::lookUpDfgMean(k, 0.09));
    c.inputs.push_back({vec4(0, 0, 1, 0.09f), vec4(float(std::cos(e)), 0, nol, 0), vec4(-0.9539392f, 0, 0.3f, 0), vec4(0.8f, 0.8f, 0.8f, 0.7f), vec4(dfgV, dfgL), vec4(mean, 0, 0)});
  }
  c.judge = [](Inputs, Outputs out) {
    double step = 0, most = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      most = std::max(most, out[i].x);
      if (i) step = std::max(step, std::abs(out[i].x - out[i - 1].x));
      if (!finite(out[i])) return Finding{std::nan(""), {}};
    }
    return Finding{step / most, {}};
  };
  return c;
}

}  // namespace

std::vector<TextCase> textCases() {
  std::vector<TextCase> all;
  for (int distribution = 0; distribution <= DISTRIBUTION_GGX; ++distribution)
    for (const int geometry : {GEOMETRY_KELEMEN, GEOMETRY_SMITH}) {
      shading::Rungs k = plan::rungsOf(Quality{});
      k.distribution = distribution;
      k.geometry = geometry;
      all.push_back(whiteMetal(k));
    }
  all.push_back(stableLobe());
  all.push_back(occlusionTakesAlpha());
  all.push_back(highlight(false));
  all.push_back(highlight(true));
  all.push_back(lights());
  all.push_back(grazing());
  all.push_back(horizon());
  return all;
}

}  // namespace burnish::stability
