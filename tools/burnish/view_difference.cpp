#include "view_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cli::viewer {
namespace {

constexpr int kColors = 256;

glm::dvec3 linearOfOklab(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const glm::dvec3 root(lightness + 0.3963377774 * a + 0.2158037573 * b, lightness - 0.1055613458 * a - 0.0638541728 * b, lightness - 0.0894841775 * a - 1.2914855480 * b);
  const glm::dvec3 lms = root * root * root;
  return {4.0767416621 * lms.x - 3.3077115913 * lms.y + 0.2309699292 * lms.z, -1.2684380046 * lms.x + 2.6097574011 * lms.y - 0.3413193965 * lms.z,
          -0.0041960863 * lms.x - 0.7034186147 * lms.y + 1.7076147010 * lms.z};
}

double encoded(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

bool inGamut(glm::dvec3 c) { return std::min({c.x, c.y, c.z}) >= -1e-6 && std::max({c.x, c.y, c.z}) <= 1 + 1e-6; }

/// The colours, reckoned once a map.
std::array<glm::u8vec3, kColors> ramp() {
  std::array<glm::u8vec3, kColors> colors;
  for (int i = 0; i < kColors; ++i) colors[std::size_t(i)] = glm::u8vec3(glm::round(heatColor(double(i) / (kColors - 1)) * 255.0));
  return colors;
}

/// The smallest of 1, 2, 5 times a power of ten that is not below.
double roundUp(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= value * (1 - 1e-12)) return step * power;
  return 10 * power;
}

double scaleFor(std::vector<float> values) {
  if (values.empty()) return 0.01;
  const auto at = std::ptrdiff_t(double(values.size() - 1) * 0.999);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return roundUp(std::clamp(double(values[std::size_t(at)]), 1e-4, 1e3));
}

}  // namespace

glm::dvec3 heatColor(double t) {
  t = std::clamp(t, 0.0, 1.0);
  const double lightness = 0.2 + 0.77 * t, hue = (-75 + 180 * t) * M_PI / 180;
  // As colourful as the display can show at this lightness, up to a limit; the ends are grey.
  double chroma = 0.2 * std::min({1.0, 0.3 + 4 * t, 5 * (1 - t)});
  while (chroma > 1e-3 && !inGamut(linearOfOklab(lightness, chroma, hue))) chroma *= 0.97;
  const glm::dvec3 color = glm::clamp(linearOfOklab(lightness, chroma, hue), glm::dvec3(0), glm::dvec3(1));
  return {encoded(color.x), encoded(color.y), encoded(color.z)};
}

Difference differenceOf(const burnish::Image& a, const burnish::Image& b, double white, double scale, double threshold) {
  Difference out;
  const std::size_t count = std::min(a.pixelCount(), b.pixelCount());
  std::vector<float> values(count), counted;
  counted.reserve(count);
  double squares = 0, reference = 0, sumA = 0, sumB = 0;
  long long over = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const float *p = a.f32() + 4 * i, *q = b.f32() + 4 * i;
    float d = 0;
    bool finite = true;
    for (int c = 0; c < 3; ++c) finite = finite && std::isfinite(p[c]) && std::isfinite(q[c]);
    if (!finite) {
      values[i] = -1;
      ++out.skipped;
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const double gap = double(q[c]) - double(p[c]);
      d = std::max(d, float(std::abs(gap) / white));
      squares += gap * gap;
      reference += double(p[c]) * double(p[c]);
      sumA += double(p[c]);
      sumB += double(q[c]);
    }
    values[i] = d;
    counted.push_back(d);
    over += double(d) > threshold ? 1 : 0;
    out.largest = std::max(out.largest, double(d));
  }
  out.rms = reference > 0 ? std::sqrt(squares / reference) : 0;
  out.energy = sumA > 0 ? sumB / sumA - 1 : 0;
  out.over = counted.empty() ? 0 : double(over) / double(counted.size());
  out.scale = scale > 0 ? scale : scaleFor(std::move(counted));

  const auto colors = ramp();
  out.heat = burnish::makeImage(a.width, a.height, 4, burnish::PixelType::U8);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = double(values[i]) / out.scale * (kColors - 1);
    const glm::u8vec3 color = values[i] < 0 ? glm::u8vec3(255, 0, 255) : values[i] == 0 ? glm::u8vec3(0) : colors[std::size_t(std::clamp(std::lround(t), 0L, long(kColors - 1)))];
    for (int c = 0; c < 3; ++c) out.heat.u8()[4 * i + std::size_t(c)] = color[c];
    out.heat.u8()[4 * i + 3] = 255;
  }
  return out;
}

}  // namespace cli::viewer
