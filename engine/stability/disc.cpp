#include "stability/disc.h"

namespace burnish::stability {

CubeLevel discCube(int size, const Disc& disc) {
  const double reach = disc.radius + 3.0 / size;
  CubeLevel c{size, 0, {}};
  c.texels.reserve(18 * std::size_t(size) * std::size_t(size));
  for (int f = 0; f < 6; ++f)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        int inside = 0;
        if (glm::length(centreOf(size, f, x, y) - disc.centre) < reach)
          for (int k = 0; k < 4096; ++k) inside += disc.holds(centreOf(size * 64, f, x * 64 + k % 64, y * 64 + k / 64));
        c.texels.insert(c.texels.end(), 3, float(disc.radiance * inside / 4096));
      }
  return c;
}

Image discPicture(int width, const Disc& disc) {
  Image image = makeImage(width, width / 2, 3, PixelType::F32);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto direction = [&](double i, double j) {
        const double longitude = ((x + i) / width - 0.5) * kCircle, polar = (y + j) / image.height * kCircle / 2;
        return glm::dvec3(std::sin(polar) * std::sin(longitude), std::cos(polar), -std::sin(polar) * std::cos(longitude));
      };
      int inside = 0;
      if (glm::length(direction(0.5, 0.5) - disc.centre) < disc.radius + kCircle / width)
        for (int k = 0; k < 256; ++k) inside += disc.holds(direction((k % 16 + 0.5) / 16, (k / 16 + 0.5) / 16));
      for (int c = 0; c < 3; ++c) image.f32()[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3 + std::size_t(c)] = float(disc.radiance * inside / 256);
    }
  return image;
}

}  // namespace burnish::stability
