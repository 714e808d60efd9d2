#include "prefilter/harmonics.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "prefilter/parallel.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Complex = std::complex<double>;

/// log of the normalized P_mm over sin^m, without the sign: 1/sqrt(4 π) Π sqrt((2k + 1)/(2k)).
std::vector<double> logarithmsOfStart(int bands) {
  std::vector<double> log(std::size_t(bands) + 1);
  log[0] = -0.5 * std::log(4 * kPi);
  for (int m = 1; m <= bands; ++m) log[std::size_t(m)] = log[std::size_t(m) - 1] + 0.5 * std::log1p(0.5 / m);
  return log;
}

/// The recurrence of one order and its start on all pairs from `first` on: where m is far over l sin θ for all l, P_lm is nothing.
struct Order {
  std::vector<double> a, b, start;
  std::size_t first = 0;
  Order(int m, int bands, double logStart, const RingSpectra& rings) : a(std::size_t(bands) + 1), b(a.size()), start(rings.pairs, 0.0) {
    double before = 0;
    for (int l = m + 1; l <= bands; ++l) {
      const double l2 = double(l) * l, m2 = double(m) * m, now = std::sqrt((4 * l2 - 1) / (l2 - m2));
      a[std::size_t(l)] = now;
      b[std::size_t(l)] = l == m + 1 ? 0 : -now / before;
      before = now;
    }
    while (first < rings.pairs && m > bands * rings.sine[first + kRingGroup - 1] + 12 + 0.02 * bands) first += kRingGroup;
    for (std::size_t r = first; r < rings.pairs; ++r)
      if (rings.sine[r] > 0) start[r] = std::exp(logStart + m * std::log(rings.sine[r]));
    if (m == 0) std::fill(start.begin(), start.end(), std::exp(logStart));
  }
};

}  // namespace

RingSpectra::RingSpectra(std::vector<double> zs, int bandCount) : bands(bandCount), z(std::move(zs)) {
  pairs = (z.size() + kRingGroup - 1) / kRingGroup * kRingGroup;
  z.resize(pairs, 0.0);
  for (const double c : z) sine.push_back(std::sqrt((1 - c) * (1 + c)));
  values.assign(std::size_t(bands + 1) * pairs * 2 * kParts, 0.0);
}

void analyseSpectra(const RingSpectra& spectra, int threads, Harmonics& out) {
  const std::vector<double> log = logarithmsOfStart(out.bands);
  forEachPiece(out.bands + 1, threads, [&](int m) {
    const Order o(m, out.bands, log[std::size_t(m)], spectra);
    legendreAnalysis({m, out.bands, o.a.data(), o.b.data()}, spectra.z.data() + o.first, o.start.data() + o.first, spectra.pairs - o.first, spectra.at(m, o.first), out.at(m, m));
  });
}

void synthesiseSpectra(const Harmonics& harmonics, const std::vector<double>& factor, int threads, RingSpectra& spectra) {
  const std::vector<double> log = logarithmsOfStart(spectra.bands);
  forEachPiece(spectra.bands + 1, threads, [&](int m) {
    const Order o(m, spectra.bands, log[std::size_t(m)], spectra);
    std::vector<double> scaled(std::size_t(spectra.bands + 1 - m) * kParts);
    for (int l = m; l <= spectra.bands; ++l)
      for (int c = 0; c < kParts; ++c) scaled[std::size_t((l - m) * kParts + c)] = harmonics.at(l, m)[c] * factor[std::size_t(l)];
    legendreSynthesis({m, spectra.bands, o.a.data(), o.b.data()}, spectra.z.data() + o.first, o.start.data() + o.first, spectra.pairs - o.first, scaled.data(), spectra.at(m, o.first));
  });
}

namespace {

RingSpectra spectraOf(const RingGrid& grid) { return {std::vector<double>(grid.z.begin(), grid.z.begin() + grid.count() / 2), grid.bands}; }

/// Two real rows at once as one complex row: Z_m = A_m + i B_m.
void splitPair(const std::vector<Complex>& z, int size, int m, double scale, double* out) {
  const Complex p = z[std::size_t(m)], q = std::conj(z[std::size_t(m ? size - m : 0)]);
  const Complex a = (p + q) * (0.5 * scale), b = (p - q) * Complex(0, -0.5 * scale);
  out[0] = a.real();
  out[1] = a.imag();
  out[2] = b.real();
  out[3] = b.imag();
}

/// Azimuthal coefficients of one ring after points were spread to it.
void ringSpectrum(const RingGrid& grid, int r, double* row, std::vector<Complex>& in, std::vector<Complex>& z, std::vector<double>& out) {
  const RingView& ring = grid.rings[std::size_t(r)];
  const int last = grid.lastOrder(r);
  out.assign(std::size_t(last + 1) * kParts, 0.0);
  for (std::size_t half = 0; half < 2; ++half) {
    double* a = row + 2 * half * grid.stride + kRingPad;
    double* b = a + grid.stride;
    const auto at = [&](int k) { return ((k % ring.size) + ring.size) % ring.size; };
    for (int k = 1; k <= kRingPad; ++k)
      for (double* c : {a, b}) c[at(-k)] += c[-k];
    for (int k = ring.size; k < ring.size + kRingPad; ++k)
      for (double* c : {a, b}) c[at(k)] += c[k];
    for (int k = 0; k < ring.size; ++k) in[std::size_t(k)] = {a[k], b[k]};
    grid.fft.at(ring.size).transform(in.data(), z.data());
    for (int m = 0; m <= last; ++m) splitPair(z, ring.size, m, grid.weight[std::size_t(r)], out.data() + std::size_t(m) * kParts + 4 * half);
  }
}

}  // namespace

void analysePoints(const SortedPoints& points, const RingGrid& grid, int threads, Harmonics& out) {
  RingSpectra spectra = spectraOf(grid);
  const int bins = points.bins();
  forEachPiece(grid.count() / 2, threads, [&](int pair) {
    std::vector<double> row(4 * grid.stride);
    std::vector<Complex> in(grid.stride), z(grid.stride);
    std::vector<double> spectrum[2];
    for (int side = 0; side < 2; ++side) {
      const int r = side ? grid.count() - 1 - pair : pair;
      const double bin = bins / kPi, angle = grid.polar[std::size_t(r)], slack = 1e-3;
      const int low = std::clamp(int(std::floor((angle - grid.reach) * bin - slack)), 0, bins - 1), high = std::clamp(int(std::floor((angle + grid.reach) * bin + slack)), 0, bins - 1);
      std::fill(row.begin(), row.end(), 0.0);
      spreadToRing(points.view(), points.values.data(), points.firstOfBin[std::size_t(low)], points.firstOfBin[std::size_t(high) + 1], grid.rings[std::size_t(r)], grid.kernel, row.data(),
                   grid.stride);
      ringSpectrum(grid, r, row.data(), in, z, spectrum[side]);
    }
    for (int m = 0; m <= grid.lastOrder(pair); ++m)
      for (int c = 0; c < kParts; ++c) {
        const double north = spectrum[0][std::size_t(m * kParts + c)], south = spectrum[1][std::size_t(m * kParts + c)];
        spectra.at(m, std::size_t(pair))[c] = north + south;
        spectra.at(m, std::size_t(pair))[kParts + c] = north - south;
      }
  });
  analyseSpectra(spectra, threads, out);
  forEachPiece(out.bands + 1, threads, [&](int m) {
    for (int l = m; l <= out.bands; ++l)
      for (int c = 0; c < kParts; ++c) out.at(l, m)[c] /= grid.kernelBands[std::size_t(l)];
  });
}

void evaluateAtPoints(const Harmonics& harmonics, const std::vector<double>& factor, const RingGrid& grid, const SortedPoints& points, int threads, std::vector<double>& out) {
  std::vector<double> scaled(std::size_t(grid.bands) + 1);
  for (std::size_t l = 0; l < scaled.size(); ++l) scaled[l] = factor[l] / grid.kernelBands[l];
  RingSpectra spectra = spectraOf(grid);
  synthesiseSpectra(harmonics, scaled, threads, spectra);
  Buffer<double> rows(std::size_t(grid.count()) * 4 * grid.stride);
  forEachPiece(grid.count(), threads, [&](int r) {
    const RingView& ring = grid.rings[std::size_t(r)];
    const int n = ring.size, last = grid.lastOrder(r), side = r >= grid.count() / 2;
    const std::size_t pair = std::size_t(side ? grid.count() - 1 - r : r);
    const double weight = grid.weight[std::size_t(r)];
    std::vector<Complex> in(grid.stride), z(grid.stride);
    for (std::size_t half = 0; half < 2; ++half) {
      std::fill(in.begin(), in.end(), Complex());
      // Placed backwards: the forward transform then sums up e^(+i m φ).
      for (int m = 0; m <= last; ++m) {
        const double* f = spectra.at(m, pair) + side * kParts + 4 * half;
        if (m == 0)
          in[0] = {f[0] * weight, f[2] * weight};
        else {
          in[std::size_t(n - m)] = Complex(f[0] - f[3], f[1] + f[2]) * weight;  // A + i B
          in[std::size_t(m)] = Complex(f[0] + f[3], f[2] - f[1]) * weight;      // conj(A) + i conj(B)
        }
      }
      grid.fft.at(n).transform(in.data(), z.data());
      double* a = rows.data() + (std::size_t(r) * 4 + 2 * half) * grid.stride + kRingPad;
      double* b = a + grid.stride;
      for (int k = 0; k < n; ++k) a[k] = z[std::size_t(k)].real(), b[k] = z[std::size_t(k)].imag();
      for (double* c : {a, b}) {
        for (int k = 0; k < kRingPad; ++k) c[n + k] = c[k % n];
        for (int k = 1; k <= kRingPad; ++k) c[-k] = c[((-k % n) + n) % n];
      }
    }
  });
  out.assign(points.count() * 4, 0.0);
  const int bins = points.bins();
  forEachPiece(bins, threads, [&](int bin) {
    const double low = kPi * (bin - 1e-3) / bins - grid.reach, high = kPi * (bin + 1 + 1e-3) / bins + grid.reach;
    const int first = int(std::lower_bound(grid.polar.begin(), grid.polar.end(), low) - grid.polar.begin()), last = int(std::upper_bound(grid.polar.begin(), grid.polar.end(), high) - grid.polar.begin());
    gatherFromRings(points.view(), points.firstOfBin[std::size_t(bin)], points.firstOfBin[std::size_t(bin) + 1], grid.rings.data(), first, last, grid.kernel, rows.data(), grid.stride, out.data());
  });
}

void evaluateExactly(const Harmonics& harmonics, const std::vector<double>& factor, const SortedPoints& points, int threads, std::vector<double>& out) {
  std::vector<double> z;
  for (std::size_t i = 0; i < points.count(); ++i) z.push_back(std::abs(points.z[i]));
  std::sort(z.begin(), z.end(), std::greater<>());
  z.erase(std::unique(z.begin(), z.end(), [](double a, double b) { return a - b < 1e-13; }), z.end());
  const std::vector<double> circles = z;
  RingSpectra spectra(std::move(z), int(factor.size()) - 1);
  synthesiseSpectra(harmonics, factor, threads, spectra);
  out.assign(points.count() * 4, 0.0);
  constexpr std::size_t kPiece = 64;
  forEachPiece(int((points.count() + kPiece - 1) / kPiece), threads, [&](int piece) {
    for (std::size_t i = std::size_t(piece) * kPiece; i < std::min(points.count(), (std::size_t(piece) + 1) * kPiece); ++i) {
      // The circle that stands for |z|: the first of the run of equal ones.
      const double height = std::abs(points.z[i]);
      std::size_t pair = std::size_t(std::partition_point(circles.begin(), circles.end(), [&](double c) { return c > height + 1e-13; }) - circles.begin());
      pair = std::min(pair, circles.size() - 1);
      const std::size_t side = points.z[i] < 0 ? kParts : 0;
      const double length = std::hypot(points.x[i], points.y[i]);
      const Complex turn = length > 0 ? Complex(points.x[i] / length, points.y[i] / length) : Complex(1, 0);
      Complex power = 0.5;
      for (int m = 0; m <= spectra.bands; ++m, power *= turn) {
        const double* f = spectra.at(m, pair) + side;
        for (std::size_t c = 0; c < 4; ++c) out[4 * i + c] += 2 * (f[2 * c] * power.real() - f[2 * c + 1] * power.imag());
        if (m == 0) power = 1;
      }
    }
  });
}

}  // namespace burnish::prefilter
