// Gauss-Legendre nodes and coefficients of functions of an angle.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace burnish::prefilter {

struct GaussNodes {
  std::vector<double> x, weight;  ///< on [-1, 1], x falling
};
/// Exact for polynomials up to degree 2 n - 1; n >= 1.
GaussNodes gaussNodes(int n);

/// b_l = 2 π ∫ f(x) P_l(1 - x) dx for l = 0 to bands, x = 1 - cosine from 0 to `end`: what a zonal function multiplies the coefficients of band l by (Funk and Hecke). `width` is the
/// angle (radians) over which f turns at x = 0; where f has kinks inside, they are named in `breaks`, rising.
std::vector<double> zonalCoefficients(const std::function<double(double)>& f, double end, double width, int bands, std::span<const double> breaks = {});

}  // namespace burnish::prefilter
