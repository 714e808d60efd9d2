#include "prefilter/kernels.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

// Vectors without a size that the compiler knows cannot hold the blocks below: those processors take their fixed-size set.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h.
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace burnish::prefilter {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, kParts>;
using Floats = hn::CappedTag<float, 16>;
using Vec = hn::Vec<Doubles>;
constexpr std::size_t kLanes = hn::MaxLanes(Doubles());

// The kernel's polynomial by Horner, of a degree that the compiler knows; u >= 0 is the caller's.
template <int kDegree>
HWY_INLINE Vec evaluate(const KernelPolynomial& k, Vec u) {
  const Doubles d;
  Vec sum = hn::Set(d, k.c[kDegree]);
  HWY_UNROLL(16)
  for (int i = kDegree - 1; i >= 1; --i) sum = hn::MulAdd(sum, u, hn::Set(d, k.c[i]));
  return hn::Mul(sum, u);
}

// Calls f.operator()<degree>() with the next degree of those compiled; coefficients above the polynomial's own are zero.
template <class F>
HWY_INLINE void withDegree(int degree, const F& f) {
  if (degree <= 10)
    f(std::integral_constant<int, 10>());
  else if (degree <= 13)
    f(std::integral_constant<int, 13>());
  else
    f(std::integral_constant<int, KernelPolynomial::kMostDegree>());
}

HWY_INLINE int firstTap(const RingView& ring, float turn) { return ring.taps >= ring.size ? 0 : int(std::ceil(double(turn) * ring.size - 0.5 * ring.taps)); }

template <int kDegree>
HWY_INLINE Vec weightsAt(const RingView& ring, const KernelPolynomial& kernel, int k, int tap, Vec x, Vec y, Vec u0) {
  const Doubles d;
  Vec u = hn::MulAdd(x, hn::LoadU(d, ring.cosine + k), hn::MulAdd(y, hn::LoadU(d, ring.sine + k), u0));
  const Vec w = evaluate<kDegree>(kernel, hn::Max(u, hn::Zero(d)));
  return ring.taps >= ring.size && tap + int(kLanes) > ring.size ? hn::IfThenElseZero(hn::FirstN(d, std::size_t(ring.size - tap)), w) : w;
}

template <int kDegree>
HWY_INLINE void spreadWith(const PointsView& p, const double* values, std::size_t begin, std::size_t end, const RingView& ring, const KernelPolynomial& kernel, double* row, std::size_t stride) {
  const Doubles d;
  double* HWY_RESTRICT base = row + kRingPad;
  const Vec uScale = hn::Set(d, 1 - kernel.scale), zScale = hn::Set(d, kernel.scale * ring.z);
  const bool oneVector = ring.taps <= int(kLanes) && ring.taps < ring.size;
  const double size = ring.size, halfTaps = 0.5 * ring.taps;
  for (std::size_t j = begin; j < end; ++j) {
    const Vec x = hn::Set(d, p.x[j]), y = hn::Set(d, p.y[j]), u0 = hn::MulAdd(hn::Set(d, p.z[j]), zScale, uScale);
    const double* v = values + 4 * j;
    const Vec v0 = hn::Set(d, v[0]), v1 = hn::Set(d, v[1]), v2 = hn::Set(d, v[2]), v3 = hn::Set(d, v[3]);
    const auto add = [&](Vec w, double* q) HWY_ATTR {
      hn::StoreU(hn::MulAdd(w, v0, hn::LoadU(d, q)), d, q);
      q += stride;
      hn::StoreU(hn::MulAdd(w, v1, hn::LoadU(d, q)), d, q);
      q += stride;
      hn::StoreU(hn::MulAdd(w, v2, hn::LoadU(d, q)), d, q);
      q += stride;
      hn::StoreU(hn::MulAdd(w, v3, hn::LoadU(d, q)), d, q);
    };
    if (oneVector) {
      const int k = int(std::ceil(double(p.turn[j]) * size - halfTaps));
      const Vec u = hn::MulAdd(x, hn::LoadU(d, ring.cosine + k), hn::MulAdd(y, hn::LoadU(d, ring.sine + k), u0));
      add(evaluate<kDegree>(kernel, hn::Max(u, hn::Zero(d))), base + k);
      continue;
    }
    const int k0 = firstTap(ring, p.turn[j]);
    for (int t = 0; t < ring.taps; t += int(kLanes)) add(weightsAt<kDegree>(ring, kernel, k0 + t, t, x, y, u0), base + k0 + t);
  }
}

template <int kDegree>
HWY_INLINE void gatherWith(const PointsView& p, std::size_t begin, std::size_t end, const RingView* rings, int firstRing, int lastRing, const KernelPolynomial& kernel, const double* rows, std::size_t stride,
            double* out) {
  const Doubles d;
  for (std::size_t j = begin; j < end; ++j) {
    const Vec x = hn::Set(d, p.x[j]), y = hn::Set(d, p.y[j]);
    Vec s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
    for (int r = firstRing; r < lastRing; ++r) {
      const RingView& ring = rings[r];
      const Vec u0 = hn::Set(d, 1 - kernel.scale + kernel.scale * ring.z * p.z[j]);
      const int k0 = firstTap(ring, p.turn[j]);
      const double* base = rows + std::size_t(r) * 4 * stride + kRingPad + k0;
      for (int t = 0; t < ring.taps; t += int(kLanes)) {
        const Vec w = weightsAt<kDegree>(ring, kernel, k0 + t, t, x, y, u0);
        const double* q = base + t;
        s0 = hn::MulAdd(w, hn::LoadU(d, q), s0);
        s1 = hn::MulAdd(w, hn::LoadU(d, q + stride), s1);
        s2 = hn::MulAdd(w, hn::LoadU(d, q + 2 * stride), s2);
        s3 = hn::MulAdd(w, hn::LoadU(d, q + 3 * stride), s3);
      }
    }
    double* o = out + 4 * j;
    o[0] = hn::GetLane(hn::SumOfLanes(d, s0));
    o[1] = hn::GetLane(hn::SumOfLanes(d, s1));
    o[2] = hn::GetLane(hn::SumOfLanes(d, s2));
    o[3] = hn::GetLane(hn::SumOfLanes(d, s3));
  }
}

void spread(const PointsView& p, const double* values, std::size_t begin, std::size_t end, const RingView& ring, const KernelPolynomial& kernel, double* row, std::size_t stride) {
  const RingView r = ring;
  withDegree(kernel.degree, [&](auto degree) HWY_ATTR { spreadWith<degree>(p, values, begin, end, r, kernel, row, stride); });
}
void gather(const PointsView& p, std::size_t begin, std::size_t end, const RingView* rings, int firstRing, int lastRing, const KernelPolynomial& kernel, const double* rows, std::size_t stride,
            double* out) {
  withDegree(kernel.degree, [&](auto degree) HWY_ATTR { gatherWith<degree>(p, begin, end, rings, firstRing, lastRing, kernel, rows, stride, out); });
}

void row(const double* values, std::size_t columns, const double* weights, const std::int32_t* first, int taps, double* out, std::size_t stride) {
  const Doubles d;
  for (std::size_t j = 0; j < columns; ++j) {
    const Vec v0 = hn::Set(d, values[3 * j]), v1 = hn::Set(d, values[3 * j + 1]), v2 = hn::Set(d, values[3 * j + 2]);
    const double* w = weights + j * std::size_t(taps);
    double* q = out + first[j];
    for (int t = 0; t < taps; t += int(kLanes)) {
      const Vec weight = hn::LoadU(d, w + t);
      hn::StoreU(hn::MulAdd(weight, v0, hn::LoadU(d, q + t)), d, q + t);
      hn::StoreU(hn::MulAdd(weight, v1, hn::LoadU(d, q + stride + t)), d, q + stride + t);
      hn::StoreU(hn::MulAdd(weight, v2, hn::LoadU(d, q + 2 * stride + t)), d, q + 2 * stride + t);
    }
  }
}

// Both transforms go over groups of kLanes rings. What belongs to a group fits eight vectors for even and eight for odd l - m: kLanes rings × kParts parts. Vector k holds parts
// (k % kBlocks) · kLanes and so on of ring k / kBlocks. P_l of the group is stored, then read lane by lane.
constexpr std::size_t kBlocks = kParts / kLanes;

struct Group {
  Vec v0, v1, v2, v3, v4, v5, v6, v7;
};
HWY_INLINE const double* partOf(const double* rings, std::size_t k) { return rings + (k / kBlocks) * 2 * kParts + (k % kBlocks) * kLanes; }
HWY_INLINE double* partOf(double* rings, std::size_t k) { return rings + (k / kBlocks) * 2 * kParts + (k % kBlocks) * kLanes; }

HWY_INLINE Group load(const double* rings) {
  const Doubles d;
  return {hn::LoadU(d, partOf(rings, 0)), hn::LoadU(d, partOf(rings, 1)), hn::LoadU(d, partOf(rings, 2)), hn::LoadU(d, partOf(rings, 3)),
          hn::LoadU(d, partOf(rings, 4)), hn::LoadU(d, partOf(rings, 5)), hn::LoadU(d, partOf(rings, 6)), hn::LoadU(d, partOf(rings, 7))};
}

// coefficient block (k % kBlocks) += P of ring (k / kBlocks) × vector k.
HWY_INLINE void addGroup(const double* P, const Group& g, double* coefficients) {
  const Doubles d;
  const auto p = [&](std::size_t k) HWY_ATTR { return hn::Set(d, P[k / kBlocks]); };
  if constexpr (kBlocks == 1) {
    Vec s = hn::MulAdd(p(0), g.v0, hn::LoadU(d, coefficients)), t = hn::Mul(p(1), g.v1);
    s = hn::MulAdd(p(2), g.v2, s), t = hn::MulAdd(p(3), g.v3, t);
    s = hn::MulAdd(p(4), g.v4, s), t = hn::MulAdd(p(5), g.v5, t);
    s = hn::MulAdd(p(6), g.v6, s), t = hn::MulAdd(p(7), g.v7, t);
    hn::StoreU(hn::Add(s, t), d, coefficients);
  } else if constexpr (kBlocks == 2) {
    Vec s = hn::MulAdd(p(0), g.v0, hn::LoadU(d, coefficients)), t = hn::MulAdd(p(1), g.v1, hn::LoadU(d, coefficients + kLanes));
    s = hn::MulAdd(p(2), g.v2, s), t = hn::MulAdd(p(3), g.v3, t);
    s = hn::MulAdd(p(4), g.v4, s), t = hn::MulAdd(p(5), g.v5, t);
    s = hn::MulAdd(p(6), g.v6, s), t = hn::MulAdd(p(7), g.v7, t);
    hn::StoreU(s, d, coefficients);
    hn::StoreU(t, d, coefficients + kLanes);
  } else {
    const auto add = [&](std::size_t k, Vec v) HWY_ATTR {
      double* c = coefficients + (k % kBlocks) * kLanes;
      hn::StoreU(hn::MulAdd(p(k), v, hn::LoadU(d, c)), d, c);
    };
    add(0, g.v0), add(1, g.v1), add(2, g.v2), add(3, g.v3);
    add(4, g.v4), add(5, g.v5), add(6, g.v6), add(7, g.v7);
  }
}

HWY_INLINE void sumGroup(const double* P, const double* coefficients, Group& g) {
  const Doubles d;
  const auto p = [&](std::size_t k) HWY_ATTR { return hn::Set(d, P[k / kBlocks]); };
  const auto c = [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, coefficients + (k % kBlocks) * kLanes); };
  g.v0 = hn::MulAdd(p(0), c(0), g.v0), g.v1 = hn::MulAdd(p(1), c(1), g.v1);
  g.v2 = hn::MulAdd(p(2), c(2), g.v2), g.v3 = hn::MulAdd(p(3), c(3), g.v3);
  g.v4 = hn::MulAdd(p(4), c(4), g.v4), g.v5 = hn::MulAdd(p(5), c(5), g.v5);
  g.v6 = hn::MulAdd(p(6), c(6), g.v6), g.v7 = hn::MulAdd(p(7), c(7), g.v7);
}

void analysis(const LegendreOrder& order, const double* z, const double* start, std::size_t count, const double* rings, double* coefficients) {
  const Doubles d;
  HWY_ALIGN double P[kLanes];
  for (std::size_t r = 0; r < count; r += kLanes) {
    const Group even = load(rings + r * 2 * kParts), odd = load(rings + r * 2 * kParts + kParts);
    const Vec x = hn::LoadU(d, z + r);
    Vec p = hn::LoadU(d, start + r), before = hn::Zero(d);
    double* c = coefficients;
    for (int l = order.m;; c += kParts) {
      hn::Store(p, d, P);
      if ((l - order.m) % 2)
        addGroup(P, odd, c);
      else
        addGroup(P, even, c);
      if (++l > order.bands) break;
      const Vec next = hn::MulAdd(hn::Mul(hn::Set(d, order.a[l]), x), p, hn::Mul(hn::Set(d, order.b[l]), before));
      before = p;
      p = next;
    }
  }
}

void synthesis(const LegendreOrder& order, const double* z, const double* start, std::size_t count, const double* coefficients, double* rings) {
  const Doubles d;
  HWY_ALIGN double P[kLanes];
  const Vec zero = hn::Zero(d);
  for (std::size_t r = 0; r < count; r += kLanes) {
    Group even{zero, zero, zero, zero, zero, zero, zero, zero}, odd = even;
    const Vec x = hn::LoadU(d, z + r);
    Vec p = hn::LoadU(d, start + r), before = zero;
    const double* c = coefficients;
    for (int l = order.m;; c += kParts) {
      hn::Store(p, d, P);
      if ((l - order.m) % 2)
        sumGroup(P, c, odd);
      else
        sumGroup(P, c, even);
      if (++l > order.bands) break;
      const Vec next = hn::MulAdd(hn::Mul(hn::Set(d, order.a[l]), x), p, hn::Mul(hn::Set(d, order.b[l]), before));
      before = p;
      p = next;
    }
    double* o = rings + r * 2 * kParts;
    const auto put = [&](std::size_t k, Vec e, Vec f) HWY_ATTR {
      hn::StoreU(hn::Add(e, f), d, partOf(o, k));
      hn::StoreU(hn::Sub(e, f), d, partOf(o, k) + kParts);
    };
    put(0, even.v0, odd.v0), put(1, even.v1, odd.v1), put(2, even.v2, odd.v2), put(3, even.v3, odd.v3);
    put(4, even.v4, odd.v4), put(5, even.v5, odd.v5), put(6, even.v6, odd.v6), put(7, even.v7, odd.v7);
  }
}

// The cone's edge on the plane: (a u + b v + c)² = k (u² + v² + 1). For one v, with B = b v + c and D = k - a²: u = (a B ± sqrt(k (B² - D (v² + 1))))/D.
void cone(const FaceCone& f, int firstRow, int count, std::int32_t* first, std::int32_t* last) {
  const Floats d;
  using V = hn::Vec<Floats>;
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  const hn::Rebind<std::int32_t, Floats> di;
  const double D = f.cosine2 - f.u * f.u, texels = f.size / 2.0;
  const V a = hn::Set(d, float(f.u * texels / D)), b = hn::Set(d, float(f.v)), c = hn::Set(d, float(f.w)), k = hn::Set(d, float(f.cosine2 * texels * texels / (D * D))), dd = hn::Set(d, float(D));
  const V middle = hn::Set(d, float(texels - 0.5)), step = hn::Set(d, float(2.0 / f.size)), one = hn::Set(d, 1.0f), margin = hn::Set(d, 0.05f);
  for (std::size_t i = 0; i < std::size_t(count); i += lanes) {
    const V v = hn::MulAdd(hn::Iota(d, float(firstRow + int(i)) + 0.5f), step, hn::Set(d, -1.0f));
    const V B = hn::MulAdd(b, v, c), q = hn::Mul(k, hn::NegMulAdd(dd, hn::MulAdd(v, v, one), hn::Mul(B, B)));
    const V half = hn::Add(hn::Sqrt(hn::Max(q, hn::Zero(d))), margin), centre = hn::MulAdd(a, B, middle);
    const auto low = hn::ConvertTo(di, hn::Ceil(hn::Sub(centre, half))), high = hn::ConvertTo(di, hn::Floor(hn::Add(centre, half)));
    hn::StoreU(low, di, first + i);
    hn::StoreU(high, di, last + i);
  }
}

void nearTexels(const TexelsView& t, const Run* runs, std::size_t count, const double direction[3], const NearLobe& lobe, double sums[4]) {
  const Floats d;
  using V = hn::Vec<Floats>;
  constexpr std::size_t lanes = hn::MaxLanes(Floats());
  const V rx = hn::Set(d, float(direction[0])), ry = hn::Set(d, float(direction[1])), rz = hn::Set(d, float(direction[2]));
  const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f), end = hn::Set(d, lobe.end), slope = hn::Set(d, lobe.slope), scale = hn::Set(d, lobe.scale), zero = hn::Zero(d);
  const V c0 = hn::Set(d, lobe.c[0]), c1 = hn::Set(d, lobe.c[1]), c2 = hn::Set(d, lobe.c[2]), c3 = hn::Set(d, lobe.c[3]), c4 = hn::Set(d, lobe.c[4]), c5 = hn::Set(d, lobe.c[5]), c6 = hn::Set(d, lobe.c[6]);
  V s0 = zero, s1 = zero, s2 = zero, s3 = zero;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t last = std::size_t(runs[n].first) + runs[n].count;
    for (std::size_t i = runs[n].first; i < last; i += lanes) {
      const V dx = hn::Sub(hn::LoadU(d, t.x + i), rx), dy = hn::Sub(hn::LoadU(d, t.y + i), ry), dz = hn::Sub(hn::LoadU(d, t.z + i), rz);
      const V x = hn::Mul(half, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));  // 1 - l·R without cancellation
      V w;
      if (lobe.ggx) {
        const V q = hn::MulAdd(slope, x, one), q2 = hn::Mul(q, q), h = hn::Sub(x, end);
        V sum = c6;
        sum = hn::MulAdd(sum, h, c5), sum = hn::MulAdd(sum, h, c4), sum = hn::MulAdd(sum, h, c3);
        sum = hn::MulAdd(sum, h, c2), sum = hn::MulAdd(sum, h, c1), sum = hn::MulAdd(sum, h, c0);
        V inverse = hn::ApproximateReciprocal(q2);
        inverse = hn::Mul(inverse, hn::NegMulAdd(q2, inverse, two));
        inverse = hn::Mul(inverse, hn::NegMulAdd(q2, inverse, two));
        w = hn::Sub(hn::Mul(hn::Sub(one, x), inverse), sum);
      } else {
        const V y = hn::Mul(scale, x);
        V sum = c6;
        sum = hn::MulAdd(sum, y, c5), sum = hn::MulAdd(sum, y, c4), sum = hn::MulAdd(sum, y, c3);
        sum = hn::MulAdd(sum, y, c2), sum = hn::MulAdd(sum, y, c1), sum = hn::MulAdd(sum, y, c0);
        sum = hn::Mul(sum, sum), sum = hn::Mul(sum, sum), sum = hn::Mul(sum, sum);
        w = hn::Mul(sum, sum);
      }
      auto inside = hn::Lt(x, end);
      if (i + lanes > last) inside = hn::And(inside, hn::FirstN(d, last - i));
      w = hn::IfThenElseZero(inside, w);
      s0 = hn::MulAdd(w, hn::LoadU(d, t.r + i), s0);
      s1 = hn::MulAdd(w, hn::LoadU(d, t.g + i), s1);
      s2 = hn::MulAdd(w, hn::LoadU(d, t.b + i), s2);
      s3 = hn::MulAdd(w, hn::LoadU(d, t.solidAngle + i), s3);
    }
  }
  sums[0] += double(hn::GetLane(hn::SumOfLanes(d, s0)));
  sums[1] += double(hn::GetLane(hn::SumOfLanes(d, s1)));
  sums[2] += double(hn::GetLane(hn::SumOfLanes(d, s2)));
  sums[3] += double(hn::GetLane(hn::SumOfLanes(d, s3)));
}

HWY_INLINE Vec lobeAt(const FullLobe& lobe, Vec x) {
  const Doubles d;
  const Vec one = hn::Set(d, 1.0);
  if (lobe.ggx) {
    const Vec q = hn::MulAdd(hn::Set(d, lobe.slope), x, one);
    return hn::Div(hn::Sub(one, x), hn::Mul(q, q));
  }
  if (lobe.halfPower == 0) return hn::Sub(one, x);
  const Vec e = hn::Mul(hn::Set(d, lobe.halfPower), hn::Log1p(d, hn::Mul(hn::Set(d, -0.5), hn::Min(x, one))));
  return hn::Mul(hn::Exp(d, hn::Max(e, hn::Set(d, -700.0))), hn::Sub(one, x));
}

void all(const TexelsView& t, std::size_t begin, std::size_t end, const double direction[3], const FullLobe& lobe, double sums[4]) {
  const Doubles d;
  const hn::Rebind<float, Doubles> df;
  const auto load = [&](const float* p) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(df, p)); };
  const Vec rx = hn::Set(d, direction[0]), ry = hn::Set(d, direction[1]), rz = hn::Set(d, direction[2]), half = hn::Set(d, 0.5), stop = hn::Set(d, std::min(lobe.end, 1.0)), zero = hn::Zero(d);
  Vec s0 = zero, s1 = zero, s2 = zero, s3 = zero;
  for (std::size_t i = begin; i < end; i += kLanes) {
    const Vec dx = hn::Sub(load(t.x + i), rx), dy = hn::Sub(load(t.y + i), ry), dz = hn::Sub(load(t.z + i), rz);
    const Vec x = hn::Mul(half, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
    auto inside = hn::Lt(x, stop);
    if (i + kLanes > end) inside = hn::And(inside, hn::FirstN(d, end - i));
    if (hn::AllFalse(d, inside)) continue;
    const Vec w = hn::IfThenElseZero(inside, lobeAt(lobe, x));
    s0 = hn::MulAdd(w, load(t.r + i), s0);
    s1 = hn::MulAdd(w, load(t.g + i), s1);
    s2 = hn::MulAdd(w, load(t.b + i), s2);
    s3 = hn::MulAdd(w, load(t.solidAngle + i), s3);
  }
  sums[0] += hn::GetLane(hn::SumOfLanes(d, s0));
  sums[1] += hn::GetLane(hn::SumOfLanes(d, s1));
  sums[2] += hn::GetLane(hn::SumOfLanes(d, s2));
  sums[3] += hn::GetLane(hn::SumOfLanes(d, s3));
}

void bright(const PointsView& p, std::size_t begin, std::size_t end, const double* sources, std::size_t count, const FullLobe& lobe, double* out) {
  const Doubles d;
  const Vec half = hn::Set(d, 0.5), stop = hn::Set(d, std::min(lobe.end, 1.0));
  for (std::size_t i = begin; i < end; i += kLanes) {
    const std::size_t n = std::min(kLanes, end - i);
    const Vec px = hn::LoadU(d, p.x + i), py = hn::LoadU(d, p.y + i), pz = hn::LoadU(d, p.z + i);
    Vec s0 = hn::Zero(d), s1 = s0, s2 = s0;
    for (std::size_t k = 0; k < count; ++k) {
      const double* s = sources + 6 * k;
      const Vec dx = hn::Sub(hn::Set(d, s[0]), px), dy = hn::Sub(hn::Set(d, s[1]), py), dz = hn::Sub(hn::Set(d, s[2]), pz);
      const Vec x = hn::Mul(half, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
      const auto inside = hn::Lt(x, stop);
      if (hn::AllFalse(d, inside)) continue;
      const Vec w = hn::IfThenElseZero(inside, lobeAt(lobe, x));
      s0 = hn::MulAdd(w, hn::Set(d, s[3]), s0);
      s1 = hn::MulAdd(w, hn::Set(d, s[4]), s1);
      s2 = hn::MulAdd(w, hn::Set(d, s[5]), s2);
    }
    HWY_ALIGN double a[3][kLanes];
    hn::Store(s0, d, a[0]);
    hn::Store(s1, d, a[1]);
    hn::Store(s2, d, a[2]);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t c = 0; c < 3; ++c) out[4 * (i + k) + c] += a[c][k];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace burnish::prefilter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish::prefilter {

HWY_EXPORT(spread);
HWY_EXPORT(gather);
HWY_EXPORT(row);
HWY_EXPORT(analysis);
HWY_EXPORT(synthesis);
HWY_EXPORT(cone);
HWY_EXPORT(nearTexels);
HWY_EXPORT(all);
HWY_EXPORT(bright);

void spreadToRing(const PointsView& points, const double* values, std::size_t begin, std::size_t end, const RingView& ring, const KernelPolynomial& kernel, double* row, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(spread)(points, values, begin, end, ring, kernel, row, stride);
}
void gatherFromRings(const PointsView& points, std::size_t begin, std::size_t end, const RingView* rings, int firstRing, int lastRing, const KernelPolynomial& kernel, const double* rows,
                     std::size_t stride, double* out) {
  HWY_DYNAMIC_DISPATCH(gather)(points, begin, end, rings, firstRing, lastRing, kernel, rows, stride, out);
}
void spreadRow(const double* values, std::size_t columns, const double* weights, const std::int32_t* first, int taps, double* out, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(row)(values, columns, weights, first, taps, out, stride);
}
void legendreAnalysis(const LegendreOrder& order, const double* z, const double* start, std::size_t count, const double* rings, double* coefficients) {
  HWY_DYNAMIC_DISPATCH(analysis)(order, z, start, count, rings, coefficients);
}
void legendreSynthesis(const LegendreOrder& order, const double* z, const double* start, std::size_t count, const double* coefficients, double* rings) {
  HWY_DYNAMIC_DISPATCH(synthesis)(order, z, start, count, coefficients, rings);
}
void coneRows(const FaceCone& f, int firstRow, int count, std::int32_t* first, std::int32_t* last) { HWY_DYNAMIC_DISPATCH(cone)(f, firstRow, count, first, last); }
void sumNear(const TexelsView& texels, const Run* runs, std::size_t count, const double direction[3], const NearLobe& lobe, double sums[4]) {
  HWY_DYNAMIC_DISPATCH(nearTexels)(texels, runs, count, direction, lobe, sums);
}
void sumTexels(const TexelsView& texels, std::size_t begin, std::size_t end, const double direction[3], const FullLobe& lobe, double sums[4]) {
  HWY_DYNAMIC_DISPATCH(all)(texels, begin, end, direction, lobe, sums);
}
void sumBright(const PointsView& points, std::size_t begin, std::size_t end, const double* sources, std::size_t count, const FullLobe& lobe, double* out) {
  HWY_DYNAMIC_DISPATCH(bright)(points, begin, end, sources, count, lobe, out);
}

}  // namespace burnish::prefilter
#endif  // HWY_ONCE
