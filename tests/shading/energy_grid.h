// The grid over which energy is measured, and the lobes that do not keep it.
#pragma once
#include <cstdlib>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "test_rungs.h"

namespace burnish::test {

inline const bool kLong = std::getenv("BURNISH_LONG") != nullptr;
inline const std::vector<double> kRoughness{0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
inline const std::vector<double> kCosines{0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 1.0};
inline const std::vector<double> kSubstances{0, 0.1, 0.2, 1.0 / 3, 0.4, 0.45, 0.5, 0.55, 0.6, 0.7, 0.85, 1};

/// Largest directional albedo that is stated, as a range: more, and less, fails.
struct Excess {
  double low, high;
};
/// Lobes that reflect more than they get with F = 1, over the grid above.
inline const std::map<std::string, Excess> kBright{
    {"phong", {6.27, 6.29}},                         // no normalization: 2 pi at alpha = 1
    {"blinn-phong", {6.27, 6.29}},                   // likewise
    {"normalized-blinn-phong", {1.071, 1.0755}},     // (p + 8)/8pi: 7.5 % at p = 8.8
    {"blinn-phong, void, plus-8", {1.071, 1.0755}},  // the same
    {"blinn-phong, void, linear-fit-8", {1.07, 1.075}},
    {"blinn-phong, void, none", {3.13, 3.15}},  // pi at p = 0
    {"blinn-phong, smith",
     {1.67, 1.69}},  // masking of Gaussian slopes under (p + 2)/2pi (n·h)^p, which is not Gaussian on rough surfaces
};
/// The same under 0.6 degrees of grazing, at n·v 1e-4 to 5e-3.
inline const std::map<std::string, Excess> kBrightGrazing{
    {"ward", {6.5, 6.75}},
    {"ward-anisotropic", {6.5, 6.75}},  // over sqrt(n·l n·v): grows as 1/sqrt(n·v)
    {"blinn-phong, smith", {1.75, 1.78}},
};

inline bool claims(const shading::Rungs& k) { return kBright.find(nameOf(k)) == kBright.end(); }

struct Worst {
  double value = 0, roughness = 0, cosine = 0, substance = 0;
  void note(double v, double r, double c, double s = 1) {
    if (!(v <= value)) value = v, roughness = r, cosine = c, substance = s;
  }
};
inline std::ostream& operator<<(std::ostream& out, const Worst& w) {
  return out << w.value << " (r " << w.roughness << ", n·v " << w.cosine << ", substance " << w.substance << ")";
}

}  // namespace burnish::test
