#include "material/resample.h"

#include <algorithm>

namespace burnish::material {

std::vector<HalvingTap> halvingTaps(int n) {
  const int out = std::max(1, n / 2);
  std::vector<HalvingTap> taps(out);
  if (n == 1) return taps;
  for (int i = 0; i < out; ++i) {
    // In units of 1/out input samples: output i covers [i n, (i + 1) n), sample j covers [j out, (j + 1) out).
    const long long begin = 1LL * i * n, end = begin + n;
    HalvingTap& t = taps[i];
    t.first = int(begin / out);
    t.count = 0;
    for (int j = t.first; 1LL * j * out < end && t.count < 3; ++j) {
      const long long covered = std::min(end, (j + 1LL) * out) - std::max(begin, 1LL * j * out);
      t.weight[t.count++] = float(double(covered) / n);
    }
  }
  return taps;
}

}  // namespace burnish::material
