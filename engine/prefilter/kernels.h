// The inner loops of the filter, compiled for each instruction set that the compiler knows and chosen when the program runs (Highway).
#pragma once
#include <cstddef>
#include <cstdint>

namespace burnish::prefilter {

/// Room before and after a ring's values for taps that run over its ends, and for whole vectors.
inline constexpr int kRingPad = 64;
/// Values of the four channels r, g, b, a and their imaginary parts, side by side.
inline constexpr int kParts = 8;
/// Rings come in groups, filled up with empty ones.
inline constexpr int kRingGroup = 8;

/// A compact zonal kernel: the polynomial of u = 1 - scale (1 - cosine) where u > 0, without a constant term.
struct KernelPolynomial {
  static constexpr int kMostDegree = 16;
  double scale = 0;
  int degree = 0;
  double c[kMostDegree + 1] = {};
};

/// One ring of a grid. cosine[k], sine[k]: scale · sin θ · (cos, sin) of azimuth 2 π k/size for k from -kRingPad to size + kRingPad.
struct RingView {
  const double* cosine = nullptr;
  const double* sine = nullptr;
  double z = 0;  ///< cos θ
  int size = 0;
  int taps = 0;  ///< values within reach of a point, at most; size: all of them
};

/// Points on the sphere, (x, y, z) with the rings' axis along z; kRingGroup more of each may be read.
struct PointsView {
  const double* x = nullptr;
  const double* y = nullptr;
  const double* z = nullptr;
  const float* turn = nullptr;  ///< azimuth in [0, 1)
};

/// Adds four values of each point in [begin, end), times the kernel, to the values of a ring: row[c · stride + k]. Rows start at k = -kRingPad; what runs over the ends is not folded back.
void spreadToRing(const PointsView& points, const double* values, std::size_t begin, std::size_t end, const RingView& ring, const KernelPolynomial& kernel, double* row, std::size_t stride);

/// The transpose: sums of the values of rings [firstRing, lastRing) times the kernel for each point in [begin, end), four a point. rows: ring r from r · 4 · stride on, ends filled in.
void gatherFromRings(const PointsView& points, std::size_t begin, std::size_t end, const RingView* rings, int firstRing, int lastRing, const KernelPolynomial& kernel, const double* rows,
                     std::size_t stride, double* out);

/// Adds three values of each column of a row, times its taps' weights, to three ring buffers: out[c · stride + first[column] + tap]. `taps`: a multiple of 8.
void spreadRow(const double* values, std::size_t columns, const double* weights, const std::int32_t* first, int taps, double* out, std::size_t stride);

/// Normalized associated Legendre functions of one order m on pairs of rings at z and -z: start[r] = P_mm(z_r), P_l = a_l z P_(l-1) + b_l P_(l-2), l to bands. a, b: by l.
struct LegendreOrder {
  int m = 0, bands = 0;
  const double* a = nullptr;
  const double* b = nullptr;
};
/// coefficients[(l - m) · kParts + part] += Σ over `count` (a multiple of kRingGroup) pairs of P_l(z) rings[r · 2 kParts + ...]: even l - m with the first kParts (the sum of both rings), odd
/// ones with the others (the difference).
void legendreAnalysis(const LegendreOrder& order, const double* z, const double* start, std::size_t count, const double* rings, double* coefficients);
/// rings[r · 2 kParts + ...] = Σ P_l(z) coefficients at z, then at -z.
void legendreSynthesis(const LegendreOrder& order, const double* z, const double* start, std::size_t count, const double* coefficients, double* rings);

/// Texels of a source, one array each: directions, radiance less its mean times solid angle, and solid angle. 16 more of each may be read.
struct TexelsView {
  const float *x = nullptr, *y = nullptr, *z = nullptr, *r = nullptr, *g = nullptr, *b = nullptr, *solidAngle = nullptr;
};
struct Run {
  std::uint32_t first = 0, count = 0;
};
/// A plane in front of the origin with texels on it: a direction has the components (u, v, w), w across the plane; the plane is at w = 1 and has size² texels over [-1, 1]².
struct FaceCone {
  double u = 0, v = 0, w = 0;
  double cosine2 = 1;  ///< of the cone's half angle, squared
  int size = 0;
};
/// For `count` rows from `firstRow` on: the first and last texels whose centres may be in the cone about the direction, rounded outwards, not clamped; last < first where there are none. Both arrays
/// have room for 16 more. cosine2 > u².
void coneRows(const FaceCone& cone, int firstRow, int count, std::int32_t* first, std::int32_t* last);

/// What is summed directly at x = |l - R|²/2 < end. Blinn-Phong's lobe: the polynomial c of scale · x to the power 16; scale, a power of two, keeps c of the narrowest lobes within floats. GGX's (1 - x)/(1 + slope x)² less the polynomial c of x - end.
struct NearLobe {
  bool ggx = false;
  float slope = 0, end = 0, scale = 1;
  float c[7] = {};
};
/// sums[0..3] += Σ of lobe × (r, g, b, solid angle) over the runs.
void sumNear(const TexelsView& texels, const Run* runs, std::size_t count, const double direction[3], const NearLobe& lobe, double sums[4]);

/// A whole lobe in double.
struct FullLobe {
  bool ggx = false;
  double halfPower = 0, slope = 0, end = 1;  ///< x from `end` on: nothing
};
/// sums[0..3] += Σ of the whole lobe × (r, g, b, solid angle) over texels [begin, end), in double.
void sumTexels(const TexelsView& texels, std::size_t begin, std::size_t end, const double direction[3], const FullLobe& lobe, double sums[4]);
/// out[4 i + c] += Σ over `count` point sources {x, y, z, r, g, b} of lobe × (r, g, b) for points [begin, end).
void sumBright(const PointsView& points, std::size_t begin, std::size_t end, const double* sources, std::size_t count, const FullLobe& lobe, double* out);

}  // namespace burnish::prefilter
