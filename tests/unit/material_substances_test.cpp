// The library of named substances: order, look-up, nearest names.
#include <burnish/material.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "material/library.h"

using namespace burnish;

TEST_CASE("Substances are sorted, sourced and plausible", "[material]") {
  const auto all = substances();
  REQUIRE(all.size() >= 60);
  CHECK(std::is_sorted(all.begin(), all.end(), [](const Substance& a, const Substance& b) { return a.name < b.name; }));
  for (const Substance& s : all) {
    INFO(s.name);
    CHECK(s.source.size() > 6);
    CHECK(findSubstance(s.name) == &s);
    for (int c = 0; c < 3; ++c) {
      CHECK(s.f0[c] > (s.conductor ? 0.3f : 0.015f));
      CHECK(s.f0[c] <= (s.conductor ? 1.0f : 0.25f));
    }
    CHECK((s.ior == 0) == s.conductor);
    for (int c = 0; c < 3; ++c) CHECK((s.eta[c] > 0 && s.k[c] > 0) == s.conductor);
    if (!s.conductor) {
      CHECK(s.f0.x == Approx(f0FromIor(s.ior)));
      // A named dielectric survives the 8-bit code: 0.0036 is half a step where steps are widest (F0 0.25).
      const float byte = std::round(encodeDielectric(s.f0.x) * 255);
      CHECK(decodeSubstance(byte / 255, glm::vec3(0)).f0.x == Approx(std::max(s.f0.x, 0.0196f)).margin(0.0018));
    }
  }
}

TEST_CASE("Substances are found whatever the spelling", "[material]") {
  REQUIRE(findSubstance("Cubic-Zirconia"));
  CHECK(findSubstance("cubic_zirconia") == findSubstance("CUBIC ZIRCONIA"));
  CHECK(findSubstance("aluminum") == findSubstance("aluminium"));
  CHECK(findSubstance("unobtainium") == nullptr);
  CHECK(findSubstance("") == nullptr);
  CHECK(findSubstance("water")->ior == Approx(1.333f));
  CHECK(findSubstance("ruby")->ior == Approx(1.77f));
  CHECK(findSubstance("diamond")->ior == Approx(2.417f));
}

TEST_CASE("The nearest substance of a misspelt name", "[material]") {
  CHECK(material::nearestSubstance("golt") == "gold");
  CHECK(material::nearestSubstance("GOLD_") == "gold");
  CHECK(material::nearestSubstance("stainles-steel") == "stainless steel");
  CHECK(material::nearestSubstance("aluminim") == "aluminium");
  CHECK(material::nearestSubstance("unobtainium").empty());
  CHECK(material::nearestSubstance(std::string(1000000, 'g')).empty());
}
