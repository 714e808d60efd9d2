#include "stability/text_variants.h"

#include <fmt/format.h>

#include "plan/rungs.h"
#include "prefilter/dfg.h"

namespace burnish::stability {

namespace f32 = shading::f32;
namespace f64 = shading::f64;

TextVariant shadeVariant(std::string name, const shading::Rungs& k) {
  TextVariant v;
  v.name = std::move(name);
  v.glsl = "shadeCase(a, b, c, d, e, f.xy, " + glslOf(k) + ")";
  v.inDouble = [k](const ShaderCase& c) {
    f64::Surface m = f64::makeSurface(unitOf(c[0]), unitOf(c[2]), glm::dvec3(c[3]), double(c[3].w), double(c[0].w));
    m.dfg = glm::dvec2(c[4]);
    m.dfgMean = glm::dvec2(c[5]);
    return glm::dvec4(f64::shadeDirection(m, unitOf(c[1]), {double(c[4].z), double(c[4].w)}, k), 0);
  };
  v.inFloat = [k](const ShaderCase& c) {
    f32::Surface m = f32::makeSurface(glm::vec3(c[0]), glm::vec3(c[2]), glm::vec3(c[3]), c[3].w, c[0].w);
    m.dfg = glm::vec2(c[4]);
    m.dfgMean = glm::vec2(c[5]);
    return glm::vec4(f32::shadeDirection(m, glm::vec3(c[1]), {c[4].z, c[4].w}, k), 0);
  };
  return v;
}

std::string nameOf(const shading::Rungs& k) {
  const auto rung = [](std::size_t term, int i) { return std::string(terms()[term].rungs[std::size_t(i)].name); };
  if (k.specular != SPECULAR_MICROFACET) return rung(0, k.specular);
  return fmt::format("{}, {}", rung(1, k.distribution), rung(2, k.geometry));
}

std::vector<TextVariant> everyShadeVariant() {
  std::vector<TextVariant> all;
  const shading::Rungs usual = plan::rungsOf(Quality{});
  const auto add = [&](std::string name, int shading::Rungs::*member, int value) {
    shading::Rungs k = usual;
    k.*member = value;
    all.push_back(shadeVariant(std::move(name), k));
  };
  for (int i = 0; i < prefilter::kDfgTables; ++i) {
    const shading::Rungs k = prefilter::dfgRungs(i);
    all.push_back(shadeVariant(nameOf(k), k));
  }
  const auto each = [&](std::string_view term, int shading::Rungs::*member) {
    for (const Term& t : terms())
      if (t.name == term)
        for (std::size_t r = 0; r < t.rungs.size(); ++r) add(fmt::format("{}={}", term, t.rungs[r].name), member, int(r));
  };
  each("lobe", &shading::Rungs::lobe);
  each("fresnel", &shading::Rungs::fresnel);
  each("diffuse", &shading::Rungs::diffuse);
  each("compensation", &shading::Rungs::compensation);
  return all;
}

}  // namespace burnish::stability
