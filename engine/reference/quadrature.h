// Integrals over directions in double: what the directional albedo of a lobe, its reciprocity's counterpart and the DFG tables are made of.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::reference {

/// Nodes and weights of Gauss and Legendre on [0, 1]. n >= 1.
struct GaussRule {
  std::vector<double> node, weight;
  explicit GaussRule(int n);
};

/// Unit vector in the xz plane at cosine `nov` from +z (the normal).
inline glm::dvec3 directionAt(double nov) { return {std::sqrt(std::max(1 - nov * nov, 0.0)), 0, nov}; }

/// Nodes in polar angle (for each of up to three pieces) and in azimuth.
struct Resolution {
  int polar = 48, azimuth = 48;
};
/// The rules of a resolution; worth keeping where many integrals are taken.
struct Rules {
  GaussRule polar, azimuth;
  Rules(const Resolution& r = {}) : polar(r.polar), azimuth(r.azimuth) {}
  Rules(int polarNodes, int azimuthNodes) : polar(polarNodes), azimuth(azimuthNodes) {}
};

/// ∫ f(l) dl over the upper hemisphere for a viewer at directionAt(nov), with the nodes where half vectors of a lobe of width alpha lie. f: symmetric about the xz plane,
/// a double or a vector; exact at the horizon, where each ring of half vectors is cut. nov in (0, 1], alpha in (0, 1]. T(0) must be zero.
template <class T, class F>
T integrateHalf(double nov, double alpha, F&& f, const Rules& rules = Resolution{});

/// The nodes of integrateHalf: visit(l, weight) for each, on one side of the xz plane, weights for both.
template <class Visit>
void visitHalf(double nov, double alpha, const Rules& rules, Visit&& visit);

/// The same with the nodes around the mirrored direction (Phong's lobes), of half-width `alpha` as integrateHalf's.
template <class T, class F>
T integrateMirror(double nov, double alpha, F&& f, const Rules& rules = Resolution{});

/// ∫ f(l) dl over the upper hemisphere for smooth f (diffuse, distributions that fill it). Nodes uniform in cos² and azimuth.
template <class T, class F>
T integrateCosine(F&& f, const Rules& rules = Resolution{});

/// 2 ∫ f(c) c dc over [0, 1]: the mean of a function of the cosine over the hemisphere, with nodes that are dense toward grazing.
template <class T, class F>
T hemisphereMean(F&& f, int nodes = 48);

}  // namespace burnish::reference

#include "reference/quadrature.inl"
