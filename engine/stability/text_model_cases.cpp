// The hard cases of the shading text whose truth is a closed form: Fresnel's equations, the lobes' widths, the G-buffer's codes, tone curves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "plan/rungs.h"
#include "stability/case_text.h"
#include "stability/text_words.h"

namespace burnish::stability {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;

// Fresnel's equations for unpolarized light from air onto an index eta - i k.
double reflectance(Complex index, double cosine) {
  const Complex refracted = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
  const Complex s = (cosine - index * refracted) / (cosine + index * refracted), p = (index * cosine - refracted) / (index * cosine + refracted);
  return (std::norm(s) + std::norm(p)) / 2;
}

TextCase fresnel() {
  TextCase c{"H13", "Schlick's equation and Fresnel's for dielectrics and conductors against their closed forms: absolute error", 1e-5, {}, {}, {}};
  for (const float f0 : {0.0196f, 0.04f, 0.0817f, 0.1724f, 0.5f, 0.9f})
    for (const auto& [eta, k] : {std::pair(0.2f, 3.4f), std::pair(1.4f, 7.5f), std::pair(2.9f, 3.1f)})
      for (int i = 0; i <= 200; ++i) c.inputs.push_back({vec4(f0, float(i) / 200, eta, k)});
  c.variants.push_back({{},
                        "vec4(F_schlick(vec3(a.x), a.y).x, F_dielectric(a.x, a.y), F_conductor(a.z, a.w, a.y), 0.0)",
                        [](const ShaderCase& in) {
                          const dvec4 a(in[0]);
                          return dvec4(f64::F_schlick(dvec3(a.x), a.y).x, f64::F_dielectric(a.x, a.y), f64::F_conductor(a.z, a.w, a.y), 0);
                        },
                        [](const ShaderCase& in) {
                          const vec4& a = in[0];
                          return vec4(f32::F_schlick(vec3(a.x), a.y).x, f32::F_dielectric(a.x, a.y), f32::F_conductor(a.z, a.w, a.y), 0);
                        }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec4 a(in[i][0]);
      const double root = std::sqrt(a.x);
      worst.worse(std::abs(out[i].x - (a.x + (1 - a.x) * std::pow(1 - a.y, 5))), fmt::format("schlick, F0 {:.4f}, cosine {:.3f}", a.x, a.y));
      worst.worse(std::abs(out[i].y - reflectance((1 + root) / (1 - root), a.y)), fmt::format("dielectric, F0 {:.4f}, cosine {:.3f}", a.x, a.y));
      worst.worse(std::abs(out[i].z - reflectance(Complex(a.z, -a.w), a.y)), fmt::format("conductor, {:.1f} and {:.1f} i, cosine {:.3f}", a.z, a.w, a.y));
    }
    return worst;
  };
  return c;
}

// Light and eye in one direction, the normal turned away from it by an angle: D(angle)/4 · cosine for a mirror of F0 1 under Kelemen's term. Peak 1/(4 pi alpha²) for every distribution.
TextCase widths() {
  TextCase c{"H15", "the lobe's peak and width take alpha = roughness squared, every distribution: relative error against the closed form", 2e-3, {}, {}, {}};
  std::vector<int> distributions;
  for (int d = 0; d <= DISTRIBUTION_GGX; ++d) {
    shading::Rungs k = plan::rungsOf(Quality{});
    k.distribution = d;
    k.geometry = GEOMETRY_KELEMEN;
    TextVariant v = shadeVariant(nameOf(k), k);
    v.glsl = "vec4(shadeCase(vec4(a.xyz, alphaFromRoughness(a.w)), b, c, d, e, f.xy, " + glslOf(k) + ").x, " + fmt::format("{}.0", d) + ", 0.0, 0.0)";
    v.inDouble = [plain = v.inDouble, d](ShaderCase in) {
      in[0].w = float(f64::alphaFromRoughness(double(in[0].w)));
      return dvec4(plain(in).x, d, 0, 0);
    };
    v.inFloat = [plain = v.inFloat, d](ShaderCase in) {
      in[0].w = f32::alphaFromRoughness(in[0].w);
      return vec4(plain(in).x, float(d), 0, 0);
    };
    c.variants.push_back(std::move(v));
  }
  const dvec3 l = glm::normalize(dvec3(0.3, -0.5, 0.8)), side = glm::normalize(glm::cross(l, dvec3(0, 1, 0)));
  for (const double r : {0.05, 0.1, 0.2, 0.4, 0.7, 1.0})
    for (const double share : {0.0, 0.5, 1.0}) {  // of alpha, radians
      const double angle = share * r * r;
      c.inputs.push_back({vec4(vec3(l * std::cos(angle) + side * std::sin(angle)), float(r)), vec4(vec3(l), 0), vec4(vec3(l), 0), vec4(1), vec4(0), vec4(float(angle), 0, 0, 0)});
    }
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double r = double(in[i][0].w), alpha2 = std::pow(r, 4), angle = double(in[i][5].x), c2 = std::pow(std::cos(angle), 2), tan2 = 1 / c2 - 1;
      const int d = int(std::lround(out[i].y));
      const double lobe = d == DISTRIBUTION_BLINN_PHONG ? std::pow(c2, 1 / alpha2 - 1) / (kPi * alpha2)
                          : d == DISTRIBUTION_BECKMANN  ? std::exp(-tan2 / alpha2) / (kPi * alpha2 * c2 * c2)
                                                        : alpha2 / (kPi * std::pow(c2 * (alpha2 - 1) + 1, 2));
      worst.worse(std::abs(out[i].x / (lobe / 4 * std::cos(angle)) - 1), fmt::format("roughness {:g}, {:.3f} radians off", r, angle));
    }
    return worst;
  };
  return c;
}

// What bytes of the G-buffer make of a surface, over half a step of each code.
TextCase storedNormals() {
  TextCase c{"H24", "normals through the G-buffer: largest angle, degrees", 0.0589 * 1.02, {}, {}, {}};
  std::mt19937 random(24);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 20'000; ++i) c.inputs.push_back({vec4(glm::normalize(vec3(normal(random), normal(random), normal(random))), 0)});
  for (const vec3 axis : {vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1)}) c.inputs.push_back({vec4(axis, 0)});
  c.variants.push_back({{},
                        "vec4(unpackNormal(floor(packNormal(a.xyz) * 255.0 + 0.5) / 255.0), 0.0)",
                        [](const ShaderCase& in) { return dvec4(f64::unpackNormal(glm::floor(f64::packNormal(exactly(in[0])) * 255.0 + 0.5) / 255.0), 0); },
                        [](const ShaderCase& in) { return vec4(f32::unpackNormal(glm::floor(f32::packNormal(of(in[0])) * 255.0f + 0.5f) / 255.0f), 0); }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 n = unitOf(in[i][0]), stored(out[i]);
      worst.worse(glm::degrees(std::atan2(glm::length(glm::cross(n, stored)), glm::dot(n, stored))), fmt::format("({:.3f}, {:.3f}, {:.3f})", n.x, n.y, n.z));
    }
    return worst;
  };
  return c;
}
TextCase storedNumbers() {
  // alpha: half of 1/255 of 11.29 octaves, 1.55 %. Albedo: the square of a root that is off by half a step, 1/255 and a little.
  TextCase c{"H24", "alpha and albedo through the G-buffer: error over what half a step of their codes makes", 1.02, {}, {}, {}};
  for (int i = 0; i <= 4000; ++i) c.inputs.push_back({vec4(float(std::pow(2500.0, i / 4000.0 - 1)), float(i) / 4000, 0, 0)});
  c.variants.push_back({{},
                        "vec4(decodeAlpha(floor(encodeAlpha(a.x) * 255.0 + 0.5) / 255.0), decodeAlbedo(floor(encodeAlbedo(vec3(a.y)) * 255.0 + 0.5) / 255.0).x, 0.0, 0.0)",
                        [](const ShaderCase& in) {
                          const dvec4 a(in[0]);
                          return dvec4(f64::decodeAlpha(std::floor(f64::encodeAlpha(a.x) * 255 + 0.5) / 255), f64::decodeAlbedo(glm::floor(f64::encodeAlbedo(dvec3(a.y)) * 255.0 + 0.5) / 255.0).x, 0, 0);
                        },
                        [](const ShaderCase& in) {
                          const vec4& a = in[0];
                          return vec4(f32::decodeAlpha(std::floor(f32::encodeAlpha(a.x) * 255 + 0.5f) / 255), f32::decodeAlbedo(glm::floor(f32::encodeAlbedo(vec3(a.y)) * 255.0f + 0.5f) / 255.0f).x, 0, 0);
                        }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    const double half = 0.5 / 255, octave = std::exp2(half * std::log2(2500.0)) - 1;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double alpha = double(in[i][0].x), albedo = double(in[i][0].y);
      worst.worse(std::abs(out[i].x / alpha - 1) / octave, fmt::format("alpha {:.4g}", alpha));
      worst.worse(std::abs(out[i].y - albedo) / (2 * half * std::sqrt(albedo) + half * half), fmt::format("albedo {:.4g}", albedo));
    }
    return worst;
  };
  return c;
}

// H18: zero normals, denormal ones, lengths past a float's square.
TextCase hardNormals() {
  TextCase c{"H18", "zero, denormal and huge normals through the G-buffer's code: vectors that are not finite, not unit, or turned by over 0.06 degrees", 0, {}, {}, {}};
  const vec3 directions[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0.6f, -0.8f, 0}, {-0.48f, 0.6f, -0.64f}};
  for (const float length : {0.0f, 1e-45f, 1e-38f, 1e-20f, 1e-6f, 1.0f, 1e6f, 1e18f, 1e37f})
    for (const vec3& d : directions) c.inputs.push_back({vec4(d * length, 0)});
  c.variants.push_back({{},
                        "vec4(unpackNormal(floor(packNormal(a.xyz) * 255.0 + 0.5) / 255.0), 0.0)",
                        [](const ShaderCase& in) { return dvec4(f64::unpackNormal(glm::floor(f64::packNormal(exactly(in[0])) * 255.0 + 0.5) / 255.0), 0); },
                        [](const ShaderCase& in) { return vec4(f32::unpackNormal(glm::floor(f32::packNormal(of(in[0])) * 255.0f + 0.5f) / 255.0f), 0); }});
  c.judge = [](Inputs in, Outputs out) {
    Finding bad;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 n = exactly(in[i][0]), stored(out[i]);
      const double length = glm::length(n);
      // Shorter than the guard is no direction.
      const bool turned = length > 1e-29 && length < 1e38 && glm::length(glm::cross(n / length, stored)) > std::sin(glm::radians(0.0601));
      if ((!finite(out[i]) || std::abs(glm::length(stored) - 1) > 1e-5 || turned) && bad.value++ == 0) bad.where = fmt::format("({:g}, {:g}, {:g})", n.x, n.y, n.z);
    }
    return bad;
  };
  return c;
}

// H16: tone curves up to the largest float.
TextCase toneCurves() {
  TextCase c{"H16", "tone curves of radiance from 0 to 3e38: values that are not finite or leave 0 to 1", 0, {}, {}, {}};
  const float values[] = {0, 1e-38f, 1e-10f, 0.08f, 0.76f, 1, 65504, 1e5f, 1e9f, 1e18f, 3e38f};
  for (const float r : values)
    for (const float g : values)
      for (const float b : {0.0f, 0.5f, 65504.0f, 3e38f}) c.inputs.push_back({vec4(r, g, b, 0)});
  const auto add = [&](const char* name, auto inDouble, auto inFloat) {
    c.variants.push_back({name, fmt::format("vec4(tonemap{}(a.xyz), 0.0)", name), [inDouble](const ShaderCase& in) { return dvec4(inDouble(exactly(in[0])), 0); },
                          [inFloat](const ShaderCase& in) { return vec4(inFloat(of(in[0])), 0); }});
  };
  add("None", f64::tonemapNone, f32::tonemapNone);
  add("Neutral", f64::tonemapNeutral, f32::tonemapNeutral);
  add("Agx", f64::tonemapAgx, f32::tonemapAgx);
  add("Aces", f64::tonemapAces, f32::tonemapAces);
  c.judge = [](Inputs in, Outputs out) {
    Finding bad;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const bool good = finite(out[i]) && std::min({out[i].x, out[i].y, out[i].z}) >= 0 && std::max({out[i].x, out[i].y, out[i].z}) <= 1;
      if (!good && bad.value++ == 0) bad.where = fmt::format("({:g}, {:g}, {:g})", in[i][0].x, in[i][0].y, in[i][0].z);
    }
    return bad;
  };
  return c;
}

// H20: what specular antialiasing does to alpha.
TextCase filteredWidths() {
  TextCase c{"H20", "specular antialiasing: alpha by the variance of the normal within a pixel, against the closed form", 1e-5, {}, {}, {}};
  for (const float alpha : {0.0f, 4e-4f, 0.01f, 0.09f, 0.5f, 1.0f})
    for (const float turn : {0.0f, 1e-4f, 0.01f, 0.1f, 0.5f, 2.0f, 1e6f}) c.inputs.push_back({vec4(alpha, 0, 0, 0), vec4(turn, 0, 0, 0), vec4(0, turn * 0.5f, 0, 0)});
  c.variants.push_back({{},
                        "vec4(filteredAlpha(a.x, b.xyz, c.xyz))",
                        [](const ShaderCase& in) { return dvec4(f64::filteredAlpha(double(in[0].x), exactly(in[1]), exactly(in[2]))); },
                        [](const ShaderCase& in) { return vec4(f32::filteredAlpha(in[0].x, of(in[1]), of(in[2]))); }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const double alpha = double(in[i][0].x), turned = (std::pow(double(in[i][1].x), 2) + std::pow(double(in[i][2].y), 2)) / (2 * kPi);
      worst.worse(std::abs(out[i].x - std::sqrt(std::min(alpha * alpha + std::min(turned, 0.18), 1.0))), fmt::format("alpha {:g}, turned by {:g}", alpha, in[i][1].x));
    }
    return worst;
  };
  return c;
}

// H25: Snell's law and what crosses, total reflection included; not within 1e-3 of the critical angle, where the slope has no end.
TextCase refraction() {
  TextCase c{"H25", "refraction, indices 0.4 to 2.4: direction and transmittance against Snell and Fresnel, absolute error", 2e-5, {}, {}, {}};
  for (const float eta : {1 / 2.4f, 1 / 1.5f, 0.75f, 1.0f, 1.33f, 1.5f, 2.4f})
    for (int i = 1; i <= 300; ++i) {
      const double cosine = i / 300.0, sine2 = (1 - cosine * cosine) / (double(eta) * double(eta));
      if (std::abs(1 - sine2) < 1e-3) continue;
      c.inputs.push_back({vec4(vec3(dvec3(std::sqrt(1 - cosine * cosine), 0, cosine)), eta)});
    }
  c.variants.push_back({{}, "refractCase(a.xyz, vec3(0.0, 0.0, 1.0), a.w)", [](const ShaderCase& in) { return f64::refractCase(unitOf(in[0]), {0, 0, 1}, double(in[0].w)); },
                        [](const ShaderCase& in) { return f32::refractCase(of(in[0]), {0, 0, 1}, in[0].w); }});
  for (ShaderCase& in : c.inputs) in[1].x = in[0].w;
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const dvec3 v = glm::normalize(exactly(in[i][0]));
      const double eta = double(in[i][1].x), sine = v.x / eta;
      const dvec3 truth = sine >= 1 ? dvec3(-v.x, 0, v.z) : dvec3(-sine, 0, -std::sqrt(1 - sine * sine));
      const double crosses = sine >= 1 ? 0 : 1 - reflectance(eta, v.z);
      worst.worse(std::max(glm::length(dvec3(out[i]) - truth), std::abs(out[i].w - crosses)), fmt::format("index {:.3f}, cosine {:.3f}", eta, v.z));
    }
    return worst;
  };
  return c;
}

// H27: the level of a roughness is the roughness of the level.
TextCase levels() {
  TextCase c{"H27", "roughness to level of a cube and back: error, levels", 1e-5, {}, {}, {}};
  for (int last = 1; last <= 8; ++last)
    for (int k = 0; k <= 4 * last; ++k) c.inputs.push_back({vec4(float(k) / 4, float(last), 0, 0)});
  c.variants.push_back({{}, "vec4(environmentLevel(environmentRoughness(a.x, a.y), a.y))",
                        [](const ShaderCase& in) { return dvec4(f64::environmentLevel(f64::environmentRoughness(double(in[0].x), double(in[0].y)), double(in[0].y))); },
                        [](const ShaderCase& in) { return vec4(f32::environmentLevel(f32::environmentRoughness(in[0].x, in[0].y), in[0].y)); }});
  c.judge = [](Inputs in, Outputs out) {
    Finding worst;
    for (std::size_t i = 0; i < in.size(); ++i) worst.worse(std::abs(out[i].x - double(in[i][0].x)), fmt::format("level {:g} of {:g}", in[i][0].x, in[i][0].y));
    return worst;
  };
  return c;
}

}  // namespace

std::vector<TextCase> modelTextCases() {
  std::vector<TextCase> all;
  all.push_back(fresnel());
  all.push_back(widths());
  all.push_back(toneCurves());
  all.push_back(hardNormals());
  all.push_back(filteredWidths());
  all.push_back(storedNormals());
  all.push_back(storedNumbers());
  all.push_back(refraction());
  all.push_back(levels());
  return all;
}

}  // namespace burnish::stability
