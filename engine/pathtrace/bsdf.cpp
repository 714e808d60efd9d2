#include "pathtrace/bsdf.h"

#include <algorithm>
#include <cmath>

#include "pathtrace/glass.h"

namespace burnish::pathtrace {

namespace f32 = shading::f32;
using glm::vec2;
using glm::vec3;

namespace {

constexpr float kPi = 3.14159265f;

/// GGX with Smith's masking is drawn by what the eye sees; with another geometry term that would not bound its weights toward grazing, all facets would (their weights are at most 2).
bool drawnVisible(const shading::Rungs& k) {
  if (k.specular == SPECULAR_GGX_SMITH) return true;
  return k.specular == SPECULAR_MICROFACET && k.distribution == DISTRIBUTION_GGX && (k.geometry == GEOMETRY_SMITH || k.geometry == GEOMETRY_SCHLICK_SMITH);
}

}  // namespace

Bsdf::Bsdf(const SurfacePoint& point, const vec3& toEye, const shading::Rungs& rungs, const LobeTable& table)
    : m_(f32::makeSurface(point.normal, toEye, point.albedo, point.substance, point.alpha)), rungs_(rungs), table_(&table), frame_(vec3(0), vec3(0), m_.n), geometric_(point.geometric) {
  rungs_.lobe = LOBE_STABLE;
  rungs_.anisotropic = rungs.anisotropic == 1 && point.brushed && hasTwoWidths(rungs) ? 1 : 0;
  rungs_.roughDiffuse = rungs.roughDiffuse == 1 && point.sigma > 0 ? 1 : 0;
  m_.eta = point.eta;
  m_.k = point.k;
  m_.sigma = point.sigma;
  if (rungs_.anisotropic == 1) f32::setWidth(m_, point.tangent, point.alphaX);
  twoWidths_ = m_.alphaX != m_.alphaY;
  if (!twoWidths_) rungs_.anisotropic = 0;
  if (point.passage == Passage::Blend) m_.diffuse *= point.pigment;
  if (isGlass(point.passage)) makeGlass(point);
  family_ = lobeFamily(rungs_);
  visible_ = drawnVisible(rungs_);
  coupled_ = needsAlbedoTable(rungs_);
  tilted_ = glm::dot(m_.n, geometric_) < 1 - 1e-6f;
  row_ = table.row(m_.alpha);
  m_.dfg = table.at(row_, m_.nov);
  if (coupled_) m_.dfgMean = table.mean(row_);
  if (twoWidths_) frame_ = Frame(m_.t, m_.b, m_.n);
  else frame_ = Frame(family_ == LOBE_FAMILY_PHONG ? glm::normalize(2 * m_.nov * m_.n - m_.v) : m_.n);
  if (visible_) alphaEye_ = twoWidths_ ? f32::alphaToward(glm::dot(m_.v, m_.t), glm::dot(m_.v, m_.b), m_.alphaX, m_.alphaY) : m_.alpha;
  weigh();
}

void Bsdf::makeGlass(const SurfacePoint& point) {
  const float solid = 1 - f32::substanceMetalness(point.substance), eta = indexOf(point), f0 = f32::f0FromIndex(eta);
  m_.f0 += vec3((f0 - m_.dielectric) * solid);
  m_.dielectric = f0;
  m_.eta = vec3(0);
  rungs_.fresnel = FRESNEL_DIELECTRIC;
  through_ = m_.diffuse * point.transmission;
  m_.diffuse -= through_;
  pane_ = point.passage != Passage::Body || point.open;
  if (pane_) back_ = through_ * slabLeft(point, m_.nov);
}

// Shares of the lobe and of what is diffuse (or scattered more than once), by what they reflect.
void Bsdf::weigh() {
  const vec3 lobe(f32::lobeAlbedo(m_.f0.x, m_.dfg, rungs_.fresnel), f32::lobeAlbedo(m_.f0.y, m_.dfg, rungs_.fresnel), f32::lobeAlbedo(m_.f0.z, m_.dfg, rungs_.fresnel));
  lobeAlbedo_ = std::max(luminance(lobe), 0.0f);
  diffuseAlbedo_ = luminance(m_.diffuse) * std::max(1 - f32::lobeAlbedo(m_.dielectric, m_.dfg, rungs_.fresnel), 0.0f);
  const float again = rungs_.compensation == COMPENSATION_MULTIPLE_SCATTERING ? f32::scatteredShare(luminance(m_.f0), m_.dfgMean, rungs_.fresnel) * f32::lobeLoss(m_.dfg) : 0;
  const float smooth = diffuseAlbedo_ + again, sum = lobeAlbedo_ + smooth;
  diffuseAlbedo_ = smooth;
  if (!(sum > 0)) return;
  // A lobe of any width may be met by chance where lights are small and bright, and the cosine covers what a lobe's tails leave out.
  const float share = lobeAlbedo_ / sum;
  lobeShare_ = std::clamp(share, std::min(10 * share, 0.1f), m_.alpha < 0.01f && smooth <= 0 ? 0.99f : 0.95f);
}

vec3 Bsdf::value(const vec3& l, const f32::Angles& a) const {
  if (!(a.nol > 0)) return vec3(0);
  vec3 diffuse, specular;
  f32::shadeParts(m_, l, coupled_ ? table_->at(row_, a.nol) : vec2(0), rungs_, diffuse, specular);
  if (pane_) specular *= 1.0f + paneBack(f32::F_dielectric(m_.dielectric, a.loh), back_);
  const vec3 sum = diffuse + specular;
  return std::isfinite(sum.x + sum.y + sum.z) ? sum : vec3(0);
}

float Bsdf::densityAt(const f32::Angles& a) const {
  const float cosine = (1 - lobeShare_) * f32::cosineDensity(a.nol);
  if (lobeShare_ <= 0) return cosine;
  float lobe = 0;
  if (family_ == LOBE_FAMILY_PHONG) {
    const float q = f32::phongFromBlinnPhong(m_.power), difference = a.nol - m_.nov;
    lobe = (q + 1) / (2 * kPi) * f32::lobePhong(glm::dot(a.t, a.t) + difference * difference, q);
  } else if (a.nol + m_.nov > 0) {
    const float inverse = std::sqrt(a.inverse);
    const vec3 h(glm::dot(a.t, m_.t) * inverse, glm::dot(a.t, m_.b) * inverse, 0);
    // D (n·h)/(4 l·h), or of the facets that the eye sees D G1/(4 n·v).
    if (visible_) {
      const float alpha = twoWidths_ ? f32::alphaAlong(h.x, h.y, m_.alphaX, m_.alphaY) : m_.alpha, scale = twoWidths_ ? f32::twoWidthsScale(alpha, m_.alphaX, m_.alphaY) : 1;
      lobe = f32::D_ggx(a.sin2, alpha) * scale * 0.25f * visibleGgxShare(m_.nov, alphaEye_);
    } else {
      lobe = (twoWidths_ ? f32::twoWidthsDensity(h, m_.alphaX, m_.alphaY, family_) : f32::lobeDensity(a.sin2, m_.alpha, family_)) * 0.25f / a.loh;
    }
  }
  return cosine + lobeShare_ * lobe;
}

float Bsdf::density(const vec3& toLight) const { return densityAt(f32::anglesOf(m_, toLight)); }

vec3 Bsdf::alone(const vec3& toLight) const { return value(toLight, f32::anglesOf(m_, toLight)); }

Reflected Bsdf::reflected(const vec3& toLight) const {
  const float above = glm::dot(toLight, geometric_);
  if (!(above > 0)) return {};
  const f32::Angles a = f32::anglesOf(m_, toLight);
  Reflected sum{value(toLight, a), densityAt(a)};
  if (!tilted_) return sum;
  const vec3 mirrored = toLight - 2 * above * geometric_;
  const f32::Angles b = f32::anglesOf(m_, mirrored);
  sum.value += value(mirrored, b);
  sum.density += densityAt(b);
  return sum;
}

vec3 Bsdf::halfVector(const vec2& place) const {
  const vec3 h = visible_     ? visibleGgx(frame_.toLocal(m_.v), twoWidths_ ? m_.alphaX : m_.alpha, twoWidths_ ? m_.alphaY : m_.alpha, place)
                 : twoWidths_ ? f32::sampleTwoWidths(place.x, place.y, m_.alphaX, m_.alphaY, family_)
                              : f32::sampleLobe(place.x, place.y, m_.alpha, family_);
  return frame_.toWorld(h);
}

bool Bsdf::sample(float pick, const vec2& place, vec3& toLight) const {
  if (pick >= lobeShare_) {
    toLight = Frame(m_.n).toWorld(f32::sampleCosine(place.x, place.y));
  } else {
    const vec3 h = halfVector(place);
    toLight = h;
    if (family_ != LOBE_FAMILY_PHONG) {
      const float voh = glm::dot(m_.v, h);
      if (!(voh > 0)) return false;
      toLight = 2 * voh * h - m_.v;
    }
    toLight = glm::normalize(toLight);
  }
  const float above = glm::dot(toLight, geometric_);
  if (above > 0) return true;
  if (!tilted_) return false;
  toLight -= 2 * above * geometric_;
  return above < 0;
}

float Bsdf::guess(const vec3& toLight) const {
  const f32::Angles a = f32::anglesOf(m_, toLight);
  if (!(a.nol > 0)) return 0;
  // GGX's long tails cover every lobe here, within what a choice among lights asks for.
  const float lobe = f32::D_ggx(a.sin2, m_.alpha) * a.inverse;
  return a.nol * (diffuseAlbedo_ / kPi + lobeAlbedo_ * lobe + 1e-4f);
}

vec3 Bsdf::facet(Sampler& sampler) const {
  if (visible_) return halfVector(sampler.next2());
  const int family = family_ == LOBE_FAMILY_PHONG ? LOBE_FAMILY_BLINN_PHONG : family_;
  const Frame frame = twoWidths_ ? frame_ : Frame(m_.n);
  const float sine = std::sqrt(std::max(1 - m_.nov * m_.nov, 0.0f)), most = m_.nov + 3 * sine * std::max(m_.alphaX, m_.alphaY);
  for (int i = 0; i < 16; ++i) {
    const vec2 u = sampler.next2();
    const vec3 h = frame.toWorld(twoWidths_ ? f32::sampleTwoWidths(u.x, u.y, m_.alphaX, m_.alphaY, family) : f32::sampleLobe(u.x, u.y, m_.alpha, family));
    // What is seen of a facet goes as v·h/n·h.
    const float noh = glm::dot(m_.n, h);
    if (noh > 0 && sampler.next() * most * noh < glm::dot(m_.v, h)) return h;
  }
  return m_.n;
}

}  // namespace burnish::pathtrace
