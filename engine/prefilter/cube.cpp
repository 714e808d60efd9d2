#include "prefilter/cube.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prefilter/parallel.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;

using Rgb = glm::vec3;

Rgb texelOf(const Image& image, int x, int y) {
  const float* p = image.f32() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * std::size_t(image.channels);
  return {p[0], p[1], p[2]};
}

Rgb mixed(Rgb a, Rgb b, float t) { return a + (b - a) * t; }

// Bilinear, wrapped in longitude; the picture's centre column looks along -Z, its first row is the zenith.
Rgb sampleLatLong(const Image& image, const glm::dvec3& direction) {
  const glm::vec3 d(direction);
  const float u = (0.5f + std::atan2(d.x, -d.z) / float(2 * kPi)) * float(image.width) - 0.5f;
  const float v = std::clamp(std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) / float(kPi) * float(image.height) - 0.5f, 0.0f, float(image.height - 1));
  const float left = std::floor(u);
  const int x0 = (int(left) % image.width + image.width) % image.width, x1 = (x0 + 1) % image.width;
  const int y0 = std::min(int(v), image.height - 1), y1 = std::min(y0 + 1, image.height - 1);
  return mixed(mixed(texelOf(image, x0, y0), texelOf(image, x1, y0), u - left), mixed(texelOf(image, x0, y1), texelOf(image, x1, y1), u - left), v - float(y0));
}

const float* texelOf(const CubeLevel& cube, int face, int x, int y) {
  return cube.texels.data() + 3 * (std::size_t(face) * faceTexels(cube.size) + std::size_t(y) * std::size_t(cube.size) + std::size_t(x));
}

/// Calls row(face, y, first value of the row) for all rows of a new cube.
template <class Row>
CubeLevel filled(int size, int threads, const Row& row) {
  CubeLevel cube{size, 0, std::vector<float>(18 * faceTexels(size))};
  forEachPiece(6 * size, threads, [&](int piece) { row(piece / size, piece % size, cube.texels.data() + 3 * std::size_t(piece) * std::size_t(size)); });
  return cube;
}

/// Values that are large enough overflow in a sum of floats: means are taken in double.
void storeMean(const glm::dvec3& sum, double weight, float* out) {
  for (int c = 0; c < 3; ++c) out[c] = float(sum[c] / weight);
}

}  // namespace

glm::dvec3 cubeDirection(int face, double u, double v) {
  switch (face) {
    case 0: return {1, -v, -u};
    case 1: return {-1, -v, u};
    case 2: return {u, 1, v};
    case 3: return {u, -1, -v};
    case 4: return {u, -v, 1};
    default: return {-u, -v, -1};
  }
}

glm::dvec3 texelDirection(int size, int face, int x, int y) { return glm::normalize(cubeDirection(face, (2.0 * x + 1) / size - 1, (2.0 * y + 1) / size - 1)); }

namespace {
double cornerAngle(double u, double v) { return std::atan2(u * v, std::sqrt(u * u + v * v + 1)); }
}  // namespace

double texelSolidAngle(int size, int x, int y) {
  const double u0 = 2.0 * x / size - 1, u1 = 2.0 * (x + 1) / size - 1, v0 = 2.0 * y / size - 1, v1 = 2.0 * (y + 1) / size - 1;
  return cornerAngle(u0, v0) - cornerAngle(u0, v1) - cornerAngle(u1, v0) + cornerAngle(u1, v1);
}

std::vector<double> texelSolidAngles(int size) {
  const std::size_t n = std::size_t(size);
  std::vector<double> corner((n + 1) * (n + 1)), out(n * n);
  for (std::size_t y = 0; y <= n; ++y)
    for (std::size_t x = 0; x <= y; ++x) corner[y * (n + 1) + x] = corner[x * (n + 1) + y] = cornerAngle(2.0 * double(x) / size - 1, 2.0 * double(y) / size - 1);
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) {
      const double* c = corner.data() + y * (n + 1) + x;
      out[y * n + x] = c[0] - c[1] - c[n + 1] + c[n + 2];
    }
  return out;
}

std::string texelName(int size, std::size_t texel) {
  static constexpr const char* kFaces[6] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
  const std::size_t inFace = texel % faceTexels(size);
  return fmt::format("face {}, column {}, row {}", kFaces[texel / faceTexels(size)], inFace % std::size_t(size), inFace / std::size_t(size));
}

CubeLevel cubeFromLatLong(const Image& latLong, int size, int threads) {
  const int n = std::clamp(int(std::ceil(double(latLong.width) / (4.0 * size))), 1, 64);
  return filled(size, threads, [&](int face, int y, float* out) {
    for (int x = 0; x < size; ++x, out += 3) {
      glm::dvec3 sum(0);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) sum += glm::dvec3(sampleLatLong(latLong, cubeDirection(face, (x + (i + 0.5) / n) * 2 / size - 1, (y + (j + 0.5) / n) * 2 / size - 1)));
      storeMean(sum, n * n, out);
    }
  });
}

CubeLevel resized(const CubeLevel& cube, int size, int threads) {
  if (cube.size == size) return {size, 0, cube.texels};
  if (cube.size % size == 0) {
    const int n = cube.size / size;
    const std::vector<double> weight = texelSolidAngles(cube.size);
    return filled(size, threads, [&](int face, int y, float* out) {
      for (int x = 0; x < size; ++x, out += 3) {
        glm::dvec3 sum(0);
        double total = 0;
        for (int j = y * n; j < (y + 1) * n; ++j)
          for (int i = x * n; i < (x + 1) * n; ++i) {
            const double w = weight[std::size_t(j) * std::size_t(cube.size) + std::size_t(i)];
            const float* p = texelOf(cube, face, i, j);
            sum += glm::dvec3(p[0], p[1], p[2]) * w;
            total += w;
          }
        storeMean(sum, total, out);
      }
    });
  }
  const int n = std::max(1, (2 * cube.size + size - 1) / size), last = cube.size - 1;
  return filled(size, threads, [&](int face, int y, float* out) {
    for (int x = 0; x < size; ++x, out += 3) {
      glm::dvec3 sum(0);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const double u = std::clamp((x + (i + 0.5) / n) * cube.size / size - 0.5, 0.0, double(last)), v = std::clamp((y + (j + 0.5) / n) * cube.size / size - 0.5, 0.0, double(last));
          const int x0 = int(u), y0 = int(v), x1 = std::min(x0 + 1, last), y1 = std::min(y0 + 1, last);
          for (int c = 0; c < 3; ++c) {
            const double top = glm::mix(double(texelOf(cube, face, x0, y0)[c]), double(texelOf(cube, face, x1, y0)[c]), u - x0);
            const double bottom = glm::mix(double(texelOf(cube, face, x0, y1)[c]), double(texelOf(cube, face, x1, y1)[c]), u - x0);
            sum[c] += glm::mix(top, bottom, v - y0);
          }
        }
      storeMean(sum, n * n, out);
    }
  });
}

}  // namespace burnish::prefilter
