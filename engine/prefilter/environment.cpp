#include "prefilter/environment.h"

#include <algorithm>
#include <cmath>

#include "reference/shading.h"

namespace burnish::prefilter {
namespace {

constexpr float kPi = 3.14159265358979f;

glm::vec3 texel(const Image& image, int x, int y) {
  const float* p = image.f32() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * std::size_t(image.channels);
  return {p[0], p[1], p[2]};
}

// Bilinear, wrapped in longitude; the picture's centre column looks along -Z, its first row is the zenith.
glm::vec3 sampleLatLong(const Image& image, glm::vec3 direction) {
  const glm::vec3 d = glm::normalize(direction);
  const float u = (0.5f + std::atan2(d.x, -d.z) / (2 * kPi)) * float(image.width) - 0.5f;
  const float v = std::clamp(std::acos(std::clamp(d.y, -1.0f, 1.0f)) / kPi * float(image.height) - 0.5f, 0.0f, float(image.height - 1));
  const float fu = std::floor(u);
  const int x0 = (int(fu) % image.width + image.width) % image.width, x1 = (x0 + 1) % image.width;
  const int y0 = std::min(int(v), image.height - 1), y1 = std::min(y0 + 1, image.height - 1);
  const float tx = u - fu, ty = v - float(y0);
  return glm::mix(glm::mix(texel(image, x0, y0), texel(image, x1, y0), tx), glm::mix(texel(image, x0, y1), texel(image, x1, y1), tx), ty);
}

// Each texel is the mean of n × n samples, n such that no texel of the picture is stepped over.
Cube cubeFromLatLong(const Image& image, int size) {
  Cube cube{size, std::vector<glm::vec3>(std::size_t(6 * size * size))};
  const int n = std::clamp(int(std::ceil(float(image.width) / (4.0f * float(size)))), 1, 16);
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        glm::vec3 sum(0);
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i)
            sum += sampleLatLong(image, cubeDirection(face, (float(x) + (float(i) + 0.5f) / float(n)) * 2 / float(size) - 1, (float(y) + (float(j) + 0.5f) / float(n)) * 2 / float(size) - 1));
        cube.at(face, x, y) = sum / float(n * n);
      }
  return cube;
}

// Halves a cube; texels weigh their solid angles.
Cube halved(const Cube& in) {
  Cube out{in.size / 2, std::vector<glm::vec3>(std::size_t(6 * in.size * in.size / 4))};
  std::vector<float> weight(std::size_t(in.size * in.size));
  for (int y = 0; y < in.size; ++y)
    for (int x = 0; x < in.size; ++x) weight[std::size_t(y * in.size + x)] = float(texelSolidAngle(in.size, x, y));
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < out.size; ++y)
      for (int x = 0; x < out.size; ++x) {
        glm::vec3 sum(0);
        float total = 0;
        for (int k = 0; k < 4; ++k) {
          const int sx = 2 * x + (k & 1), sy = 2 * y + (k >> 1);
          const float w = weight[std::size_t(sy * in.size + sx)];
          sum += in.at(face, sx, sy) * w;
          total += w;
        }
        out.at(face, x, y) = sum / total;
      }
  return out;
}

// The source of a convolution: directions, radiance × solid angle, and blocks of texels with bounding cones, so that a narrow lobe skips most of the sphere.
struct Source {
  struct Block {
    glm::vec3 axis;
    float cosRadius, sinRadius;
    std::uint32_t first, count;
  };
  std::vector<glm::vec4> direction;  // w: solid angle
  std::vector<glm::vec3> radiance;
  std::vector<Block> blocks;
};

Source sourceOf(const Cube& cube) {
  Source s;
  const int step = std::min(16, cube.size);
  for (int face = 0; face < 6; ++face)
    for (int by = 0; by < cube.size; by += step)
      for (int bx = 0; bx < cube.size; bx += step) {
        Source::Block block{{}, 1, 0, std::uint32_t(s.direction.size()), std::uint32_t(step * step)};
        const float half = float(cube.size) * 0.5f;
        block.axis = glm::normalize(cubeDirection(face, (float(bx) + float(step) * 0.5f) / half - 1, (float(by) + float(step) * 0.5f) / half - 1));
        for (int y = by; y < by + step; ++y)
          for (int x = bx; x < bx + step; ++x) {
            const glm::vec3 d = glm::normalize(cubeDirection(face, (float(x) + 0.5f) / half - 1, (float(y) + 0.5f) / half - 1));
            block.cosRadius = std::min(block.cosRadius, glm::dot(d, block.axis));
            s.direction.emplace_back(d, float(texelSolidAngle(cube.size, x, y)));
            s.radiance.push_back(cube.at(face, x, y));
          }
        block.sinRadius = std::sqrt(std::max(1 - block.cosRadius * block.cosRadius, 0.0f));
        s.blocks.push_back(block);
      }
  return s;
}

// The half-vector lobe at n = v = R: w = ((1 + l·R)/2)^(p/2) max(l·R, 0) (docs/shading.md, section 5), tabulated over l·R down to where it is under 1e-5.
class LobeTable {
 public:
  explicit LobeTable(double alpha) {
    const double p = shading::f64::powerFromAlpha(alpha);
    cosEnd_ = float(std::max(0.0, p > 0.02 ? 2 * std::pow(1e-5, 2 / p) - 1 : 0.0));
    scale_ = float(kSteps) / (1 - cosEnd_);
    for (int i = 0; i <= kSteps + 1; ++i) {
      const double c = std::max(1 - (1 - double(cosEnd_)) * i / kSteps, 0.0);
      value_[std::size_t(i)] = float(std::pow((1 + c) / 2, p / 2) * c);
    }
  }
  [[nodiscard]] float cosEnd() const { return cosEnd_; }
  [[nodiscard]] float operator()(float c) const {
    const float t = std::max((1 - c) * scale_, 0.0f);
    const int i = std::min(int(t), kSteps);
    return value_[std::size_t(i)] + (value_[std::size_t(i) + 1] - value_[std::size_t(i)]) * (t - float(i));
  }

 private:
  static constexpr int kSteps = 4096;
  std::array<float, kSteps + 2> value_{};
  float cosEnd_ = 0, scale_ = 1;
};

glm::vec3 convolveAt(const Source& source, const LobeTable& lobe, glm::vec3 r) {
  const float cosEnd = lobe.cosEnd(), sinEnd = std::sqrt(1 - cosEnd * cosEnd);
  glm::vec3 sum(0);
  float total = 0;
  for (const Source::Block& b : source.blocks) {
    // Outside when the angle to the block's axis is over lobe end + block radius (both under 90 degrees).
    if (glm::dot(b.axis, r) < cosEnd * b.cosRadius - sinEnd * b.sinRadius) continue;
    for (std::uint32_t i = b.first; i < b.first + b.count; ++i) {
      const glm::vec4& d = source.direction[i];
      const float c = d.x * r.x + d.y * r.y + d.z * r.z;
      if (c <= cosEnd) continue;
      const float w = lobe(c) * d.w;
      sum += source.radiance[i] * w;
      total += w;
    }
  }
  return total > 0 ? sum / total : glm::vec3(0);
}

Cube convolved(const Cube& in, int size, double roughness) {
  Cube out{size, std::vector<glm::vec3>(std::size_t(6 * size * size))};
  const Source source = sourceOf(in);
  const LobeTable lobe(roughness * roughness);
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        out.at(face, x, y) = convolveAt(source, lobe, glm::normalize(cubeDirection(face, (float(x) + 0.5f) * 2 / float(size) - 1, (float(y) + 0.5f) * 2 / float(size) - 1)));
  return out;
}

// Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps": eq. 3 (basis), eq. 8 (A_l / pi = 1, 2/3, 1/4).
std::array<glm::vec3, 9> irradianceOf(const Cube& cube) {
  std::array<glm::dvec3, 9> sum{};
  double sphere = 0;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < cube.size; ++y)
      for (int x = 0; x < cube.size; ++x) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(cubeDirection(face, (float(x) + 0.5f) * 2 / float(cube.size) - 1, (float(y) + 0.5f) * 2 / float(cube.size) - 1)));
        const double w = texelSolidAngle(cube.size, x, y);
        const double basis[9] = {1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
        for (int i = 0; i < 9; ++i) sum[std::size_t(i)] += glm::dvec3(cube.at(face, x, y)) * (w * basis[i]);
        sphere += w;
      }
  constexpr double kY[9] = {0.282094792, 0.488602512, 0.488602512, 0.488602512, 1.092548431, 1.092548431, 0.315391565, 1.092548431, 0.546274215};
  constexpr double kA[9] = {1, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
  std::array<glm::vec3, 9> c{};
  for (std::size_t i = 0; i < 9; ++i) c[i] = glm::vec3(sum[i] * (kY[i] * kY[i] * kA[i] * 4 * 3.14159265358979 / sphere));
  return c;
}

}  // namespace

glm::vec3 cubeDirection(int face, float u, float v) {
  switch (face) {
    case 0: return {1, -v, -u};
    case 1: return {-1, -v, u};
    case 2: return {u, 1, v};
    case 3: return {u, -1, -v};
    case 4: return {u, -v, 1};
    default: return {-u, -v, -1};
  }
}

double texelSolidAngle(int size, int x, int y) {
  const auto corner = [](double u, double v) { return std::atan2(u * v, std::sqrt(u * u + v * v + 1)); };
  const double u0 = 2.0 * x / size - 1, u1 = 2.0 * (x + 1) / size - 1, v0 = 2.0 * y / size - 1, v1 = 2.0 * (y + 1) / size - 1;
  return corner(u0, v0) - corner(u0, v1) - corner(u1, v0) + corner(u1, v1);
}

EnvironmentLight prefilterEnvironment(const Image& latLong, int baseSize) {
  EnvironmentLight light;
  std::vector<Cube> plain;
  plain.push_back(cubeFromLatLong(latLong, baseSize));
  while (plain.back().size > 8) plain.push_back(halved(plain.back()));
  const int last = int(plain.size()) - 1;
  light.levels.push_back(plain[0]);
  for (int k = 1; k <= last; ++k) {
    const double r = shading::f64::environmentRoughness(k, last);
    const int size = plain[std::size_t(k)].size;
    // The two broadest lobes are cheap: summed over a finer source. The others over texels of their own size, 2.6 and more to the lobe's half-width.
    light.levels.push_back(convolved(plain[std::size_t(k >= last - 1 ? k - 1 : k)], size, r));
  }
  const Cube& fine = plain[std::size_t(std::max(0, last - 3))];
  light.irradiance = irradianceOf(fine);
  light.meanLuminance = glm::dot(light.irradiance[0], glm::vec3(0.2126f, 0.7152f, 0.0722f));
  return light;
}

}  // namespace burnish::prefilter
