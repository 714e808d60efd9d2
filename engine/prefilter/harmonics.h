// Spherical-harmonic coefficients of four channels, and the transforms from and to rings.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "prefilter/kernels.h"
#include "prefilter/rings.h"

namespace burnish::prefilter {

/// Complex coefficients a_lm, m >= 0, of four real channels: kParts doubles (re, im of each channel) an (l, m). a_lm = Σ f Y_lm* with orthonormal Y_lm, the Condon-Shortley phase left out.
struct Harmonics {
  explicit Harmonics(int bandCount) : bands(bandCount), values(index(bands + 1, bands + 1) * kParts, 0.0) {}
  int bands;
  std::vector<double> values;
  [[nodiscard]] std::size_t index(int l, int m) const { return std::size_t(m) * std::size_t(bands + 1) - std::size_t(m) * std::size_t(m - 1) / 2 + std::size_t(l - m); }
  [[nodiscard]] double* at(int l, int m) { return values.data() + index(l, m) * kParts; }
  [[nodiscard]] const double* at(int l, int m) const { return values.data() + index(l, m) * kParts; }
};

/// Azimuthal coefficients F_m of pairs of rings at z and -z, both kParts: 2 kParts doubles a pair and order. Pairs go from the poles to the equator; up to a multiple of kRingGroup of them.
struct RingSpectra {
  RingSpectra(std::vector<double> z, int bands);  ///< z >= 0, falling
  int bands;
  std::size_t pairs = 0;       ///< filled up
  std::vector<double> z, sine;  ///< of each pair
  std::vector<double> values;
  [[nodiscard]] double* at(int m, std::size_t pair) { return values.data() + (std::size_t(m) * pairs + pair) * 2 * kParts; }
  [[nodiscard]] const double* at(int m, std::size_t pair) const { return values.data() + (std::size_t(m) * pairs + pair) * 2 * kParts; }
};

/// Σ over rings, into `out` (its bands at most those of the spectra). What spectra hold are F(z) + F(-z) and F(z) - F(-z).
void analyseSpectra(const RingSpectra& spectra, int threads, Harmonics& out);
/// F(z) and F(-z) of a_lm · factor[l]; bands: those of the spectra, at most those of the harmonics.
void synthesiseSpectra(const Harmonics& harmonics, const std::vector<double>& factor, int threads, RingSpectra& spectra);

/// Leaves new elements as they are: large arrays that are filled right after.
template <class T>
struct LeaveAlone : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = LeaveAlone<U>;
  };
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }
};
template <class T>
using Buffer = std::vector<T, LeaveAlone<T>>;

/// Points sorted by polar angle into bins of equal height, for a grid.
struct SortedPoints {
  Buffer<double> x, y, z;
  Buffer<float> turn;
  Buffer<std::uint32_t> order;           ///< where each comes from; empty where nobody asks
  Buffer<double> values;                  ///< four a point; empty for points to be evaluated
  std::vector<std::uint32_t> firstOfBin;  ///< bins + 1
  [[nodiscard]] int bins() const { return int(firstOfBin.size()) - 1; }
  [[nodiscard]] std::size_t count() const { return x.size() - kRingGroup; }
  [[nodiscard]] PointsView view() const { return {x.data(), y.data(), z.data(), turn.data()}; }
};

/// Σ over points of values · Y_lm*, by spreading to the grid's rings. The grid has as many bands as `out`.
void analysePoints(const SortedPoints& points, const RingGrid& grid, int threads, Harmonics& out);
/// Σ a_lm factor[l] Y_lm at points: four values each, in their sorted order.
void evaluateAtPoints(const Harmonics& harmonics, const std::vector<double>& factor, const RingGrid& grid, const SortedPoints& points, int threads, std::vector<double>& out);
/// The same without a grid, exact; for few points.
void evaluateExactly(const Harmonics& harmonics, const std::vector<double>& factor, const SortedPoints& points, int threads, std::vector<double>& out);

}  // namespace burnish::prefilter
