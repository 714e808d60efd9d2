// Bodies of quadrature.h's templates.
#pragma once

namespace burnish::reference {

namespace detail {

inline constexpr double kPi = 3.14159265358979323846;

/// A part of the circle of rings: tan² of the polar angle = alpha² u/(1 - u) over [from, to] in u.
struct Piece {
  double from, to;
};

// The endpoints of a piece are where rings begin or end to be cut, with square-root behaviour: u = from + (to - from)(1 - cos πt)/2 takes it away.
template <class G>
void eachNode(const Piece& piece, const GaussRule& rule, G&& g) {
  const double span = piece.to - piece.from;
  if (!(span > 0)) return;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double t = rule.node[i], u = piece.from + span * 0.5 * (1 - std::cos(kPi * t));
    g(u, rule.weight[i] * span * 0.5 * kPi * std::sin(kPi * t));
  }
}

/// Polar angle of u: cosine, sine and sin θ dθ/du.
struct Polar {
  double cosine, sine, jacobian;
};
inline Polar polarOf(double u, double alpha2) {
  const double d = 1 - u + alpha2 * u, c = std::sqrt((1 - u) / d);
  return {c, std::sqrt(alpha2 * u / d), alpha2 / (2 * std::max(c, 1e-150) * d * d)};
}
inline double uOf(double theta, double alpha2) {
  if (theta <= 0) return 0;
  const double t = std::tan(std::min(theta, 0.5 * kPi)), t2 = t * t;
  return t2 > 1e30 || t < 0 ? 1 : t2 / (alpha2 + t2);
}

}  // namespace detail

template <class Visit>
void visitHalf(double nov, double alpha, const Rules& rules, Visit&& visit) {
  using detail::kPi;
  const auto& [polar, azimuth] = rules;
  const glm::dvec3 v = directionAt(nov);
  const double alpha2 = alpha * alpha, thetaV = std::acos(std::min(nov, 1.0));
  // l is above the horizon for whole rings up to 45° - θv/2, for none past 45° + θv/2.
  const double first = detail::uOf(kPi / 4 - thetaV / 2, alpha2), last = detail::uOf(kPi / 4 + thetaV / 2, alpha2);
  for (const detail::Piece& piece : {detail::Piece{0, first}, detail::Piece{first, last}})
    detail::eachNode(piece, polar, [&](double u, double du) {
      const auto [c, s, jacobian] = detail::polarOf(u, alpha2);
      // n·l = 2 (v·h)(n·h) - n·v > 0 where cos φ > (nov/(2 c) - nov c)/(sin θv s).
      const double limit = (nov / (2 * c) - nov * c) / std::max(v.x * s, 1e-300);
      if (limit >= 1) return;
      const double end = limit <= -1 ? kPi : std::acos(limit);
      for (std::size_t j = 0; j < azimuth.node.size(); ++j) {
        // Nodes crowd toward the horizon, where 1/(v·h) varies fastest.
        const double t = azimuth.node[j], phi = end * (1 - t * t);
        const glm::dvec3 h(s * std::cos(phi), s * std::sin(phi), c);
        const double voh = glm::dot(v, h);
        const glm::dvec3 l = h * (2 * voh) - v;
        if (voh > 0 && l.z > 0) visit(l, azimuth.weight[j] * 2 * t * 4 * voh * 2 * end * jacobian * du);
      }
    });
}

template <class T, class F>
T integrateHalf(double nov, double alpha, F&& f, const Rules& rules) {
  T sum(0);
  visitHalf(nov, alpha, rules, [&](const glm::dvec3& l, double weight) { sum += f(l) * weight; });
  return sum;
}

template <class T, class F>
T integrateMirror(double nov, double alpha, F&& f, const Rules& rules) {
  using detail::kPi;
  const auto& [polar, azimuth] = rules;
  const glm::dvec3 r(-directionAt(nov).x, 0, nov), side(0, 1, 0), up = glm::cross(side, r) * -1.0;  // up: in the plane, away from the horizon (up.z >= 0)
  const double width2 = 4 * alpha * alpha, theta = std::acos(std::min(nov, 1.0));
  const glm::dvec3 across = up.z < 0 ? -up : up;
  T sum(0);
  // In half angles, so that the mapping reaches directions behind: tan²(ϑ/2) = width²/4 u/(1 - u). Pieces end where the horizon begins to cut and where r·l changes sign.
  const double alpha2 = width2 / 4, first = detail::uOf((kPi / 2 - theta) / 2, alpha2), middle = detail::uOf(kPi / 4, alpha2), last = detail::uOf((kPi / 2 + theta) / 2, alpha2);
  for (const detail::Piece& piece : {detail::Piece{0, first}, detail::Piece{first, middle}, detail::Piece{middle, last}})
    detail::eachNode(piece, polar, [&](double u, double du) {
      const auto half = detail::polarOf(u, alpha2);
      const double c = 2 * half.cosine * half.cosine - 1, s = 2 * half.cosine * half.sine;
      // sin ϑ dϑ = 4 sin cos (half) d(half): 4 cos(half) times the half's jacobian.
      const double jacobian = 4 * half.cosine * half.jacobian;
      const double limit = -nov * c / std::max(across.z * s, 1e-300);
      if (limit >= 1) return;
      const double end = limit <= -1 ? kPi : std::acos(limit);
      T ring(0);
      for (std::size_t j = 0; j < azimuth.node.size(); ++j) {
        const double t = azimuth.node[j], phi = end * (1 - t * t);
        const glm::dvec3 l = r * c + (across * std::cos(phi) + side * std::sin(phi)) * s;
        if (l.z > 0) ring += f(l) * (azimuth.weight[j] * 2 * t);
      }
      sum += ring * (2 * end * jacobian * du);
    });
  return sum;
}

template <class T, class F>
T integrateCosine(F&& f, const Rules& rules) {
  using detail::kPi;
  const auto& [polar, azimuth] = rules;
  T sum(0);
  for (std::size_t i = 0; i < polar.node.size(); ++i) {
    const double c = polar.node[i], s = std::sqrt(1 - c * c);
    T ring(0);
    for (std::size_t j = 0; j < azimuth.node.size(); ++j) {
      const double phi = kPi * azimuth.node[j];
      ring += f(glm::dvec3(s * std::cos(phi), s * std::sin(phi), c)) * azimuth.weight[j];
    }
    sum += ring * (2 * kPi * polar.weight[i]);
  }
  return sum;
}

template <class T, class F>
T hemisphereMean(F&& f, int nodes) {
  const GaussRule rule(nodes);
  T sum(0);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double t = rule.node[i], c = t * t * t;  // dense toward grazing
    sum += f(c) * (rule.weight[i] * 2 * c * 3 * t * t);
  }
  return sum;
}

}  // namespace burnish::reference
