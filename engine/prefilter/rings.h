// A grid of rings on the sphere: points are spread to it and values gathered from it with a compact zonal kernel. Because the kernel is zonal, it multiplies spherical-harmonic band l by a
// number of its own (Funk and Hecke), which is divided out again: a non-uniform transform on the sphere without faces, seams or poles.
#pragma once
#include <kissfft/kissfft.hh>
#include <map>
#include <memory>
#include <vector>

#include "prefilter/kernels.h"

namespace burnish::prefilter {

/// How wide the kernel is and how fine the grid, for an error.
struct GridChoice {
  double width = 7;         ///< rings within the kernel's reach
  double oversampling = 1.75;  ///< rings over bands + 1
  int degree = 13;          ///< of the kernel's polynomial
  bool operator==(const GridChoice&) const = default;
};
GridChoice gridChoice(double error);

/// Immutable once made.
struct RingGrid {
  int bands = 0;
  GridChoice choice;
  KernelPolynomial kernel;
  double reach = 0;                  ///< of the kernel, radians
  std::vector<double> kernelBands;   ///< what the kernel multiplies band l by
  std::vector<double> polar, z, sine;  ///< of each ring, from z = 1 down
  std::vector<double> weight;        ///< solid angle of one of the ring's values
  std::vector<RingView> rings;       ///< Gauss-Legendre in z; even in number, rings r and size - 1 - r mirror each other
  std::size_t stride = 0;            ///< length of a ring's buffer: the longest ring and pads
  std::map<int, kissfft<double>> fft;  ///< by ring size
  std::vector<double> table;         ///< what rings point into
  [[nodiscard]] int count() const { return int(rings.size()); }
  /// Orders that ring r can tell apart and that the bands reach.
  [[nodiscard]] int lastOrder(int r) const;
};

/// The grid for bands 0 to `bands` (at least 8). The last few are kept, up to some megabytes; safe to call from several threads. *made: ms of CPU spent on a new one, added.
std::shared_ptr<const RingGrid> ringGrid(int bands, const GridChoice& choice, double* made = nullptr);

/// The kernel along a circle, for points and values on the same ring: weights by distance in values, |distance| < width/2; and its Fourier transform at m of `size` values.
class CircleKernel {
 public:
  explicit CircleKernel(double width);
  [[nodiscard]] double operator()(double distance) const;
  [[nodiscard]] double transform(double m, double size) const;

 private:
  double width_, beta_, norm_;
};

/// The next even number with no prime factors but 2, 3 and 5.
int smoothSize(int atLeast);

}  // namespace burnish::prefilter
