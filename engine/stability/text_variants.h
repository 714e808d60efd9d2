// Cases of the shading text: one expression as C++ in double, in float, and as GLSL.
#pragma once
#include "stability/cases.h"

namespace burnish::stability {

/// A unit vector of a case as double: normalized again, since float rounded it.
inline glm::dvec3 unitOf(const glm::vec4& v) { return glm::normalize(glm::dvec3(v)); }

/// shadeCase of the rungs over the inputs a = n, alpha; b = l; c = v; d = albedo, substance; e = dfg at v and at l; f = mean dfg.
TextVariant shadeVariant(std::string name, const shading::Rungs& rungs);
/// Every specular rung that is a lobe of its own, then the default lobe with every Fresnel, diffuse and compensation rung.
std::vector<TextVariant> everyShadeVariant();
/// "ggx, smith" or "ward".
std::string nameOf(const shading::Rungs& rungs);

}  // namespace burnish::stability
