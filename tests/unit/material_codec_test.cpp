// The substance codec: docs/shading.md, section 1.
#include <catch2/catch.hpp>
#include <cmath>

#include "material/codec.h"
#include "material/merge.h"
#include "reference/shading.h"

using namespace burnish;

TEST_CASE("The codec inverts exactly on its range", "[material]") {
  for (int i = 0; i <= 1000; ++i) {
    const float f0 = 0.0196f + (0.25f - 0.0196f) * float(i) / 1000;
    const DecodedSubstance d = decodeSubstance(encodeDielectric(f0), glm::vec3(0.3f));
    CHECK(d.f0.x == Approx(f0).margin(2e-7));
    CHECK(d.diffuse.x == 0.3f);
  }
  for (int i = 10; i <= 1000; ++i) {
    const float m = float(i) / 1000;
    const DecodedSubstance d = decodeSubstance(encodeMetalness(m), glm::vec3(0.8f, 0.5f, 0.2f));
    CHECK(d.f0.y == Approx(0.0196f * (1 - m) + 0.5f * m).margin(2e-7));
    CHECK(d.diffuse.z == Approx(0.2f * (1 - m)).margin(2e-7));
  }
}

TEST_CASE("Named points of the codec", "[material]") {
  CHECK(encodeDielectric(0.04f) * 255 == Approx(85));  // glass and plastic: code 85 exactly
  CHECK(encodeDielectric(0.25f) == Approx(0).margin(1e-6));
  CHECK(encodeDielectric(0.0196f) == Approx(0.4f));
  CHECK(encodeDielectric(0.01f) == Approx(0.4f));  // clamped
  CHECK(encodeDielectric(0.9f) == Approx(0).margin(1e-6));
  CHECK(encodeDielectric(NAN) == Approx(0.4f));
  CHECK(encodeMetalness(0) == Approx(1.0f / 3));
  CHECK(encodeMetalness(1) == 1);
  CHECK(encodeMetalness(7) == 1);
  CHECK(encodeMetalness(NAN) == Approx(1.0f / 3));
  CHECK(std::isfinite(decodeSubstance(NAN, glm::vec3(0.5f)).f0.x));
}

TEST_CASE("Eight bits hold every code, and the table is the decoder", "[material]") {
  for (int byte = 0; byte < 256; ++byte) {
    const float s = float(byte) / 255;
    const glm::vec3 albedo(0.9f, 0.4f, 0.05f);
    const DecodedSubstance d = decodeSubstance(s, albedo);
    const material::Reflectance r = material::decode({albedo, std::uint8_t(byte)});
    for (int c = 0; c < 3; ++c) {
      CHECK(r.f0[c] == Approx(d.f0[c]).margin(1e-6));
      CHECK(r.diffuse[c] == Approx(d.diffuse[c]).margin(1e-6));
    }
    // Encoding what was decoded gives the same byte.
    if (byte <= 102) CHECK(std::lround(encodeDielectric(d.f0.x) * 255) == byte);
    const material::CodedTexel back = byte <= 102 ? material::projectDielectric(r) : material::projectConductor(r);
    CHECK(int(back.code) == byte);
    for (int c = 0; c < 3; ++c) CHECK(back.albedo[c] == Approx(albedo[c]).margin(2e-4));
  }
}

TEST_CASE("The engine's codec is the shader's", "[material]") {
  for (int i = 0; i <= 510; ++i) {
    const float s = float(i) / 510;
    const glm::vec3 albedo(0.7f, 0.3f, 0.1f);
    const DecodedSubstance d = decodeSubstance(s, albedo);
    const glm::dvec3 f0 = shading::f64::substanceF0(s, glm::dvec3(albedo)),
                     diffuse = shading::f64::substanceDiffuse(s, glm::dvec3(albedo));
    for (int c = 0; c < 3; ++c) {
      CHECK(double(d.f0[c]) == Approx(f0[c]).margin(1e-6));
      CHECK(double(d.diffuse[c]) == Approx(diffuse[c]).margin(1e-6));
    }
  }
}

namespace {
/// F0 + diffuse along a bilinear edge from paint (code 1/3) to metal (code 1), both of grey albedo, over the true
/// blend.
struct Edge {
  double highest = 0, lowest = 2, mean = 0;
};
template <class Decode>
Edge edge(double paint, double metal, Decode&& sum) {
  constexpr int kSteps = 1000;
  Edge e;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = double(i) / kSteps, albedo = paint * (1 - t) + metal * t;
    const double truth = (1 - t) * (paint + 0.04) + t * metal;
    const double ratio = sum(t, albedo) / truth;
    e.highest = std::max(e.highest, ratio);
    e.lowest = std::min(e.lowest, ratio);
    e.mean += ratio / (kSteps + 1);
  }
  return e;
}
double ours(double t, double albedo) {
  const float s = float((1.0 / 3) * (1 - t) + t);
  const DecodedSubstance d = decodeSubstance(s, glm::vec3(float(albedo)));
  return double(d.f0.x) + double(d.diffuse.x);
}
}  // namespace

TEST_CASE("A filtered edge between paint and metal never glows and darkens by 12.5 % at most", "[material]") {
  double lowest = 2, means = 0;
  int count = 0;
  for (double paint = 0.05; paint <= 0.5001; paint += 0.025)
    for (double metal = 0.5; metal <= 1.0001; metal += 0.05) {
      const Edge e = edge(paint, metal, ours);
      CHECK(e.highest <= 1 + 1e-6);
      lowest = std::min(lowest, e.lowest);
      means += 1 - e.mean;
      ++count;
    }
  CHECK(lowest >= 1 - 0.1255);
  CHECK(lowest <= 1 - 0.12);  // reached by the darkest paint on the darkest metal
  CHECK(means / count == Approx(0.03).margin(0.02));
}

TEST_CASE("A code that rises from 0 would glow on the same edge", "[material]") {
  // Dielectrics from F0 0 at s = 0 to gems (0.21) at 0.4: between plastic and metal the filter meets the gems.
  const double plastic = 0.4 * std::sqrt(0.04 / 0.21);
  const auto rising = [plastic](double t, double albedo) {
    const double s = plastic * (1 - t) + t, m = std::max(s - 0.4, 0.0) / 0.6, root = std::min(s / 0.4, 1.0);
    return 0.21 * root * root * (1 - m) + albedo * m + albedo * (1 - m);
  };
  double least = 9, most = 0;
  for (double paint = 0.05; paint <= 0.5001; paint += 0.05) {
    const double glow = edge(paint, 0.5, rising).highest - 1;
    least = std::min(least, glow);
    most = std::max(most, glow);
  }
  CHECK(least == Approx(0.33).margin(0.03));
  CHECK(most == Approx(0.92).margin(0.03));
}

TEST_CASE("glTF's partly metallic materials err in F0 by 0.0202 at most", "[material]") {
  float worst = 0, worstDiffuse = 0;
  for (int i = 0; i <= 4000; ++i) {
    const float m = float(i) / 4000;
    const material::ConversionError stated = material::metalnessError(m);
    for (const float base : {0.0f, 0.02f, 0.5f, 1.0f}) {
      const DecodedSubstance d = decodeSubstance(encodeMetalness(m), glm::vec3(base));
      const float f0 = std::abs(d.f0.x - (0.04f * (1 - m) + base * m)),
                  diffuse = std::abs(d.diffuse.x - base * (1 - m));
      CHECK(f0 <= stated.f0 + 1e-6f);
      CHECK(diffuse <= stated.diffuse + 1e-6f);
      worst = std::max(worst, f0);
      worstDiffuse = std::max(worstDiffuse, diffuse);
    }
  }
  CHECK(worst <= 0.0202f);
  CHECK(worst > 0.0195f);
  CHECK(worstDiffuse <= 0.01f);
}

TEST_CASE("A projection keeps F0 + diffuse", "[material]") {
  // Half gold, half blue paint: no texel shows it exactly, but none of its light is lost.
  const glm::vec3 gold(1, 0.73f, 0.36f), blue(0.05f, 0.1f, 0.5f);
  for (float t = 0.02f; t < 1; t += 0.02f) {
    const material::Reflectance mixed{t * gold + (1 - t) * 0.04f, (1 - t) * blue};
    const material::CodedTexel texel = material::projectConductor(mixed);
    const material::Reflectance shown = material::decode(texel);
    for (int c = 0; c < 3; ++c) {
      CHECK(
          shown.f0[c] + shown.diffuse[c] ==
          Approx(std::min(mixed.f0[c] + mixed.diffuse[c], 1.0f + material::codeTable()[texel.code].base)).margin(1e-5));
      CHECK(shown.f0[c] >= 0);
      CHECK(shown.diffuse[c] >= 0);
    }
  }
}
