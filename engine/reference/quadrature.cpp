#include "reference/quadrature.h"

namespace burnish::reference {

// Newton's iteration on the Legendre polynomial from the usual starting points (Abramowitz and Stegun 25.4.29).
GaussRule::GaussRule(int n) : node(std::size_t(n)), weight(std::size_t(n)) {
  for (int i = 0; i < n; ++i) {
    double x = std::cos(detail::kPi * (i + 0.75) / (n + 0.5)), derivative = 1;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      derivative = n * (x * p - before) / (x * x - 1);
      const double dx = p / derivative;
      x -= dx;
      if (std::abs(dx) < 1e-15) break;
    }
    node[std::size_t(i)] = 0.5 * (1 - x);
    weight[std::size_t(i)] = 1 / ((1 - x * x) * derivative * derivative);
  }
}

}  // namespace burnish::reference
