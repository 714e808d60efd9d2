// Irradiance in spherical harmonics up to band 2 (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps": eq. 3 for the basis, eq. 8 for A_l / π = 1, 2/3,
// 1/4), from texels as point samples weighted by their exact solid angles, in double.
#include <burnish/image.h>

#include <cmath>

namespace burnish {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Squares of the basis' constants times A_l / π, so that irradiance / π is Σ coefficient · polynomial.
constexpr double kBand1 = 3 / (4 * kPi) * 2 / 3, kCross = 15 / (4 * kPi) / 4, kZonal = 5 / (16 * kPi) / 4, kSquares = 15 / (16 * kPi) / 4;
constexpr double kScale[9] = {1 / (4 * kPi), kBand1, kBand1, kBand1, kCross, kCross, kZonal, kCross, kSquares};

/// Sums of texels against the basis' polynomials. All solid angles together must be 4π; what rounding leaves is divided out, so that a constant stays one.
class Projection {
 public:
  void add(double x, double y, double z, double angle, const float* rgb) {
    const double basis[9] = {1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y};
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t c = 0; c < 3; ++c) sum_[i][c] += static_cast<double>(rgb[c]) * basis[i] * angle;
    sphere_ += angle;
  }
  [[nodiscard]] IrradianceSh result() const {
    IrradianceSh out = sum_;
    for (std::size_t i = 0; i < 9; ++i)
      for (double& c : out[i]) c *= kScale[i] * 4 * kPi / sphere_;
    return out;
  }

 private:
  IrradianceSh sum_{};
  double sphere_ = 0;
};

/// Solid angle of the part of a face between its centre and (u, v).
double cornerAngle(double u, double v) { return std::atan2(u * v, std::sqrt(u * u + v * v + 1)); }

}  // namespace

Result<IrradianceSh> irradianceSh(const CubeLevel& source) {
  const int n = source.size;
  if (n < 1 || source.texels.size() != std::size_t(n) * std::size_t(n) * 18) return fail("irradianceSh", "the source lacks texels", "read it again");
  Projection projection;
  const float* rgb = source.texels.data();
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x, rgb += 3) {
        const double u0 = 2.0 * x / n - 1, u1 = 2.0 * (x + 1) / n - 1, v0 = 2.0 * y / n - 1, v1 = 2.0 * (y + 1) / n - 1, u = (u0 + u1) / 2, v = (v0 + v1) / 2;
        const double angle = cornerAngle(u0, v0) - cornerAngle(u0, v1) - cornerAngle(u1, v0) + cornerAngle(u1, v1), s = 1 / std::sqrt(u * u + v * v + 1);
        switch (face) {  // OpenGL 4.5 specification, table 8.19
          case 0: projection.add(s, -v * s, -u * s, angle, rgb); break;
          case 1: projection.add(-s, -v * s, u * s, angle, rgb); break;
          case 2: projection.add(u * s, s, v * s, angle, rgb); break;
          case 3: projection.add(u * s, -s, -v * s, angle, rgb); break;
          case 4: projection.add(u * s, -v * s, s, angle, rgb); break;
          default: projection.add(-u * s, -v * s, -s, angle, rgb);
        }
      }
  return projection.result();
}

Result<IrradianceSh> irradianceSh(const Image& latLong) {
  if (latLong.type != PixelType::F32 || latLong.channels < 3 || latLong.width < 1 || latLong.height < 1 || latLong.data.size() != latLong.byteSize())
    return fail("irradianceSh", "the source is no float picture of three or four channels", "convert it first");
  Projection projection;
  const double w = latLong.width, h = latLong.height;
  std::vector<double> sine, cosine;  // of the angle from -Z toward +X
  for (int x = 0; x < latLong.width; ++x) {
    const double a = ((x + 0.5) / w - 0.5) * 2 * kPi;
    sine.push_back(std::sin(a)), cosine.push_back(std::cos(a));
  }
  const float* rgb = latLong.f32();
  for (int y = 0; y < latLong.height; ++y) {
    const double theta = (y + 0.5) / h * kPi, sinTheta = std::sin(theta), cosTheta = std::cos(theta);
    const double angle = (std::cos(y / h * kPi) - std::cos((y + 1) / h * kPi)) * 2 * kPi / w;
    for (std::size_t x = 0; x < sine.size(); ++x, rgb += latLong.channels) projection.add(sinTheta * sine[x], cosTheta, -sinTheta * cosine[x], angle, rgb);
  }
  return projection.result();
}

}  // namespace burnish
