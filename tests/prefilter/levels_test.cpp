// Filtered levels against the double sum over all texels (docs/prefilter.md).
#include <catch2/catch.hpp>
#include <cstdio>

#include "oracle.h"
#include "prefilter/cube.h"
#include "prefilter/filter.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

namespace {

PrefilterOptions optionsOf(ReflectionLobe lobe, int size, int levels, double error = 1e-4) {
  PrefilterOptions o;
  o.lobe = lobe;
  o.size = size;
  o.levels = levels;
  o.error = error;
  o.threads = 1;
  return o;
}

dvec3 smooth(const dvec3& d) { return {1.5 + std::sin(2 * d.x + d.y), 1 + d.z * d.y, std::exp(d.y)}; }

/// What the lobe makes of bands 1 and 2 over what it makes of band 0 (Funk and Hecke), by midpoints.
std::array<double, 2> bandShares(ReflectionLobe lobe, double roughness) {
  double sums[3] = {};
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {  // x = t², so that narrow lobes are resolved
    const double t = (i + 0.5) / kSteps, w = weightOf(lobe, roughness, t * t) * t, c = 1 - t * t;
    sums[0] += w;
    sums[1] += w * c;
    sums[2] += w * (1.5 * c * c - 0.5);
  }
  return {sums[1] / sums[0], sums[2] / sums[0]};
}

/// All levels of a map within the bounds of a filter at 1e-4.
void judge(const std::string& map, const CubeLevel& source, int size, int levels, int samples, const dvec3& interest) {
  const Points points = pointsOf(source);
  for (const ReflectionLobe lobe : kLobes) {
    const Cubemap cube = prefilterCubemap(source, optionsOf(lobe, size, levels)).value();
    REQUIRE(int(cube.levels.size()) == levels);
    std::string levelErrors;
    for (std::size_t k = 1; k < cube.levels.size(); ++k) {
      const LevelError e = errorOf(cube.levels[k], points, lobe, samples, interest);
      INFO(map << ", " << lobeName(lobe) << ", level " << k << " of " << cube.levels[k].size << "²: rms " << e.rms << ", worst " << e.worst << ", along edges " << e.edge);
      CHECK(e.rms < 1e-4);
      CHECK(e.worst < 1e-3);
      char text[48];
      std::snprintf(text, sizeof text, " %.1e/%.1e", e.rms, e.worst);
      levelErrors += text;
    }
    CHECK(cube.levels.back().size == size >> (levels - 1));
    WARN(map << ", " << lobeName(lobe) << ", " << levels << " levels from " << size << "², rms/worst texel:" << levelErrors);
  }
}

}  // namespace

TEST_CASE("solid angles are Girard's, and cover the sphere") {
  for (const int size : {1, 3, 16}) {
    const std::vector<double> angles = prefilter::texelSolidAngles(size);
    double sum = 0, worst = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const double a = angles[std::size_t(y * size + x)];
        sum += 6 * a;
        worst = std::max(worst, std::abs(a / girard(size, (x + y) % 6, x, y) - 1));
      }
    CHECK(sum == Approx(2 * kCircle).epsilon(1e-13));
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("constant in, constant out, at every level") {
  for (const ReflectionLobe lobe : kLobes) {
    const dvec3 value(0.3, 7, 4e4);
    const Cubemap cube = prefilterCubemap(cubeOf(64, [&](const dvec3&) { return value; }), optionsOf(lobe, 64, 7)).value();
    REQUIRE(cube.levels.size() == 7);
    CHECK(cube.levels.back().texels.size() == 18);
    double worst = 0;
    for (const CubeLevel& l : cube.levels)
      for (std::size_t i = 0; i < l.texels.size(); ++i) worst = std::max(worst, std::abs(double(l.texels[i]) / value[int(i % 3)] - 1));
    CHECK(worst < 1e-6);
  }
}

TEST_CASE("levels of a smooth map, to 1²") { judge("smooth", cubeOf(64, smooth), 64, 7, 40, {0, 0, 1}); }

TEST_CASE("levels of noise, to 1²") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  judge("noise", cubeOf(64, [&](const dvec3&) { return dvec3(uniform(random), uniform(random), uniform(random)); }), 64, 7, 40, {0, 0, 1});
}

TEST_CASE("levels of a small sun, to 1²") {
  const std::pair<const char*, dvec3> suns[] = {{"sun on a face's centre", {0, 0, 1}}, {"sun next to an edge", {1, 0.3, 0.97}}, {"sun on a corner", {1, 1, 1}}};
  for (const auto& [name, at] : suns) judge(name, sunCube(128, at), 128, 8, 30, glm::normalize(at));
}

// Bright areas of more texels than are summed one by one, next to the dark.
TEST_CASE("levels of large lights in a dark room") {
  judge("lights", cubeOf(128, [](const dvec3& d) { return dvec3(glm::dot(d, glm::normalize(dvec3(1, 1, 0.2))) > 0.97 || std::abs(d.x - 0.3) + std::abs(d.y + 0.2) < 0.05 ? 300 : 0.3 + 0.1 * d.y); }), 128, 5, 30,
        glm::normalize(dvec3(1, 1, 0.2)));
}

TEST_CASE("a source and faces of sizes of their own") { judge("noise-free 37²", cubeOf(37, smooth), 32, 4, 40, {1, 0, 0}); }

TEST_CASE("lat-long pictures: the sum is over the picture's own texels") {
  for (const auto& [width, height] : {std::pair(128, 64), std::pair(37, 19)}) {
    Image image = makeImage(width, height, 4, PixelType::F32);
    std::mt19937 random(4);
    for (std::size_t i = 0; i < image.pixelCount() * 4; ++i) image.f32()[i] = float(random() % 1000) / 500;
    image.f32()[4 * (std::size_t(height / 3) * std::size_t(width) + 5)] = 3e4f;
    const Points points = pointsOf(image);
    for (const ReflectionLobe lobe : kLobes) {
      const Cubemap cube = prefilterCubemap(image, optionsOf(lobe, 32, 6)).value();
      for (std::size_t k = 1; k < cube.levels.size(); ++k) {
        const LevelError e = errorOf(cube.levels[k], points, lobe, 60, points.direction[std::size_t(height / 3) * std::size_t(width) + 5]);
        INFO(width << " × " << height << ", " << lobeName(lobe) << ", level " << k << ": rms " << e.rms << ", worst " << e.worst);
        CHECK(e.rms < 1e-4);
        CHECK(e.worst < 1e-3);
      }
    }
  }
}

TEST_CASE("any list of roughness: 1/255 is the nearest texels, 1 the broadest lobe (H8)") {
  std::mt19937 random(2);
  const CubeLevel source = cubeOf(32, [&](const dvec3&) { return dvec3(double(random() % 100), 1, 2); });
  const Points points = pointsOf(source);
  for (const ReflectionLobe lobe : kLobes) {
    prefilter::FilterOptions o;
    o.lobe = lobe;
    const auto from = prefilter::makeSource(source, 1);
    const prefilter::LevelSpec specs[] = {{32, 1 / 255.0}, {16, 1 / 255.0}, {32, 0.03}, {16, 0.05}, {16, 0.1}, {5, 1}};
    const std::vector<CubeLevel> levels = prefilter::filterLevels(*from, specs, o);
    double worst = 0;
    for (std::size_t i = 0; i < source.texels.size(); ++i)
      if (const double off = std::abs(double(levels[0].texels[i]) - double(source.texels[i])); !(off <= worst)) worst = off;  // what is no number stays
    CHECK(worst < (lobe == ReflectionLobe::Ggx ? 1e-3 : 1e-5));  // GGX's tail reaches the neighbours
    // Between texels: what the nearest hold.
    for (const float v : levels[1].texels) REQUIRE((std::isfinite(v) && v >= 0 && v <= 99.001f));
    WARN(lobeName(lobe) << " at roughness 1/255: off the source by " << worst << " of 99");
    for (std::size_t k = 2; k < levels.size(); ++k) {
      const LevelError e = errorOf(levels[k], points, lobe, 60, {0, 1, 0});
      INFO(lobeName(lobe) << ", roughness " << levels[k].roughness << ": rms " << e.rms << ", worst " << e.worst);
      CHECK(e.rms < 1e-4);
      CHECK(e.worst < 1e-3);
    }
  }
  // Level 0 is the source, bit by bit.
  CHECK(prefilterCubemap(source, optionsOf(ReflectionLobe::BlinnPhong, 32, 2)).value().levels[0].texels == source.texels);
}

TEST_CASE("no seams: the step across each of the 12 edges is the step inside (H7)") {
  // Rows of texels bend where they cross an edge, the more the farther from its middle, and so the steps of a perfect level differ. Along whole edges the ratio of the steps is held to that of
  // the true light at the same texels; in an edge's middle, where rows are straight, the ratio of the steps over their angles is held to 1.
  // Harmonics of bands 0, 1 and 2, so that what a level must hold is known: each band times its share of the lobe.
  const dvec3 along = glm::normalize(dvec3(0.9, 0.2, -0.45));  // across every edge
  const auto band1 = [&](const dvec3& d) { return glm::dot(d, along); };
  const auto band2 = [](const dvec3& d) { return 0.05 * (d.x * d.y - d.y * d.z) + 0.02 * (3 * d.z * d.z - 1); };
  const CubeLevel source = cubeOf(128, [&](const dvec3& d) { return dvec3(2 + band1(d) + band2(d)); });
  for (const ReflectionLobe lobe : kLobes) {
    const Cubemap cube = prefilterCubemap(source, optionsOf(lobe, 128, 0)).value();
    REQUIRE(cube.levels.size() == 5);
    for (std::size_t k = 0; k < cube.levels.size(); ++k) {
      const CubeLevel& level = cube.levels[k];
      const int n = level.size;
      const std::array<double, 2> share = level.roughness > 0 ? bandShares(lobe, level.roughness) : std::array<double, 2>{1, 1};
      const auto truthAt = [&](const Texel& t) {
        const dvec3 d = centreOf(n, t.face, t.x, t.y);
        return 2 + share[0] * band1(d) + share[1] * band2(d);
      };
      const auto valueAt = [&](const Texel& t) { return double(level.texels[3 * t.index(n)]); };
      int edges = 0;
      double worst = 0, worstRaw = 0, worstGradient = 0;
      for (int face = 0; face < 6; ++face)
        for (int side = 0; side < 4; ++side) {
          double across[3] = {}, inside[3] = {};  // sums along the edge of steps and true steps; in its middle, of steps over angles
          int other = -1;
          for (int j = 0; j < n; ++j) {
            const int end = side % 2 ? n - 1 : 0, next = side % 2 ? n - 2 : 1, beyond = side % 2 ? n : -1;
            const Texel a = side < 2 ? Texel{face, end, j} : Texel{face, j, end}, in = side < 2 ? Texel{face, next, j} : Texel{face, j, next};
            const Texel b = side < 2 ? acrossEdge(n, face, beyond, j) : acrossEdge(n, face, j, beyond);
            // One texel further on the other face: across its edge comes `a` again.
            Texel on = b;
            if (acrossEdge(n, b.face, b.x == 0 ? -1 : n, b.y).index(n) == a.index(n)) on.x += b.x == 0 ? 1 : -1;
            else on.y += b.y == 0 ? 1 : -1;
            REQUIRE(b.face != face);
            REQUIRE((other == -1 || other == b.face));
            other = b.face;
            const auto add = [&](double (&sums)[3], const Texel& p, const Texel& q, double weight) {
              const double step = std::abs(valueAt(p) - valueAt(q)) * weight;
              sums[0] += step;
              sums[1] += std::abs(truthAt(p) - truthAt(q)) * weight;
              if (j == n / 2 || j == n / 2 - 1) sums[2] += step / glm::length(centreOf(n, p.face, p.x, p.y) - centreOf(n, q.face, q.x, q.y));
            };
            add(across, a, b, 1);
            add(inside, a, in, 0.5);
            add(inside, b, on, 0.5);
          }
          edges += face < other;
          const double ratio = across[0] / inside[0], truth = across[1] / inside[1], gradient = across[2] / inside[2];
          INFO(lobeName(lobe) << ", level " << k << " (" << n << "²), faces " << face << " and " << other << ": steps across over steps inside " << ratio << ", of the true light " << truth << ", in the middle over angles " << gradient);
          CHECK(ratio / truth == Approx(1).margin(0.02));
          if (n >= 16) CHECK(gradient == Approx(1).margin(0.02));
          worst = std::max(worst, std::abs(ratio / truth - 1));
          worstRaw = std::max(worstRaw, std::abs(ratio - 1));
          worstGradient = std::max(worstGradient, std::abs(gradient - 1));
        }
      CHECK(edges == 12);
      WARN(lobeName(lobe) << ", level " << k << " (" << n << "²): steps across over steps inside, off the true ratio by at most " << worst << "; off 1 by " << worstRaw << ", as gradients in the middles by " << worstGradient);
    }
  }
}

TEST_CASE("nothing below zero before the clamp") {
  std::mt19937 random(8);
  const CubeLevel dark = cubeOf(64, [&](const dvec3& d) { return dvec3(d.y > 0.2 ? 1 : 0, random() % 50 == 0 ? 40 : 0, d.x > 0.9 ? 1000 : 0); });
  const auto from = prefilter::makeSource(dark, 1);
  for (const ReflectionLobe lobe : kLobes) {
    prefilter::FilterOptions o;
    o.lobe = lobe;
    o.clamp = false;
    const prefilter::LevelSpec specs[] = {{64, 0.1}, {32, 0.2}, {32, 0.3}, {16, 0.45}, {16, 0.7}, {8, 1}};
    for (const CubeLevel& l : prefilter::filterLevels(*from, specs, o)) {
      double lowest[3] = {}, mean[3] = {};
      for (std::size_t i = 0; i < l.texels.size(); ++i) {
        lowest[i % 3] = std::min(lowest[i % 3], double(l.texels[i]));
        mean[i % 3] += 3 * double(l.texels[i]) / double(l.texels.size());
      }
      for (int c = 0; c < 3; ++c) {
        INFO(lobeName(lobe) << ", roughness " << l.roughness << ", channel " << c << ": least " << lowest[c] / mean[c] << " of the mean");
        CHECK(lowest[c] >= -1e-6 * mean[c]);
      }
    }
  }
}

TEST_CASE("the same bytes from 1, 2 and 8 threads") {
  const CubeLevel source = sunCube(64, {1, 0.3, 0.97});
  for (const ReflectionLobe lobe : kLobes) {
    PrefilterOptions o = optionsOf(lobe, 64, 7);
    const Cubemap one = prefilterCubemap(source, o).value();
    for (const int threads : {2, 8}) {
      o.threads = threads;
      const Cubemap many = prefilterCubemap(source, o).value();
      for (std::size_t k = 0; k < one.levels.size(); ++k) CHECK(one.levels[k].texels == many.levels[k].texels);
    }
  }
}

TEST_CASE("the error falls as asked") {
  std::mt19937 random(5);
  const CubeLevel source = cubeOf(64, [&](const dvec3& d) { return dvec3(random() % 100 < 3 ? 30 : 0.5 + 0.4 * d.y, 1, d.x > 0.5 ? 5 : 0.2); });
  const Points points = pointsOf(source);
  for (const ReflectionLobe lobe : kLobes)
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
      const Cubemap cube = prefilterCubemap(source, optionsOf(lobe, 64, 6, error)).value();
      for (std::size_t k = 1; k < cube.levels.size(); ++k) {
        const LevelError e = errorOf(cube.levels[k], points, lobe, 12, {0, 0, 1});
        INFO(lobeName(lobe) << ", " << error << " asked, level " << k << ": rms " << e.rms << ", worst " << e.worst);
        CHECK(e.rms < std::max(error, 4e-7));  // levels are floats, and so are sums over texels nearby
      }
    }
}

TEST_CASE("single texels from 1e5 to 1e30 keep their energy and leave the sky alone (H9)") {
  for (const double value : {1e5, 65504.0, 1e30}) {
    CubeLevel source = cubeOf(64, [](const dvec3&) { return dvec3(1); });
    const std::size_t texel = 4 * 4096 + 20 * 64 + 33;
    for (std::size_t c = 0; c < 3; ++c) source.texels[3 * texel + c] = float(value);
    const Points points = pointsOf(source);
    for (const ReflectionLobe lobe : kLobes) {
      const Cubemap cube = prefilterCubemap(source, optionsOf(lobe, 64, 7)).value();
      for (std::size_t k = 1; k < cube.levels.size(); ++k) {
        const LevelError e = errorOf(cube.levels[k], points, lobe, 24, points.direction[texel]);
        INFO(value << ", " << lobeName(lobe) << ", level " << k << ": rms " << e.rms << ", worst " << e.worst);
        CHECK(e.rms < 1e-4);
        CHECK(e.worst < 1e-3);
        for (const float v : cube.levels[k].texels) REQUIRE((std::isfinite(v) && v >= 0));
      }
      // A finer level still holds the light of the texel.
      double in = 0, out = 0;
      for (std::size_t i = 0; i < points.light.size(); ++i) in += points.light[i].x * points.solidAngle[i];
      const Points filtered = pointsOf(cube.levels[2]);
      for (std::size_t i = 0; i < filtered.light.size(); ++i) out += filtered.light[i].x * filtered.solidAngle[i];
      CHECK(out / in == Approx(1).margin(0.05));
    }
  }
}

TEST_CASE("what cannot be filtered is said") {
  const CubeLevel good = cubeOf(16, [](const dvec3&) { return dvec3(1); });
  const auto message = [](const auto& result) { return result ? std::string() : result.error().message(); };
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f}) {
    CubeLevel c = good;
    c.texels[3 * (2 * 256 + 5 * 16 + 7) + 1] = bad;
    const std::string text = message(prefilterCubemap(c));
    INFO(text);
    CHECK(text.find("face +Y, column 7, row 5") != std::string::npos);
    CHECK(text.find(bad < 0 && std::isfinite(bad) ? "negative" : "not finite") != std::string::npos);
    Image image = makeImage(8, 4, 3, PixelType::F32);
    image.f32()[3 * (2 * 8 + 6)] = bad;
    CHECK(message(prefilterCubemap(image)).find("column 6, row 2") != std::string::npos);
  }
  PrefilterOptions o;
  for (const int size : {0, 8, 24, 100, 1 << 20}) {
    o.size = size;
    CHECK(!prefilterCubemap(good, o));
  }
  o.size = 64;
  for (const int levels : {-1, 8}) {
    o.levels = levels;
    CHECK(!prefilterCubemap(good, o));
  }
  o.levels = 0;
  for (const double error : {0.0, 1.0, -1e-4, std::nan("")}) {
    o.error = error;
    CHECK(!prefilterCubemap(good, o));
  }
  CubeLevel wrong = good;
  wrong.texels.pop_back();
  CHECK(!prefilterCubemap(wrong));
  CHECK(!prefilterCubemap(CubeLevel{}));
  CHECK(!prefilterCubemap(makeImage(8, 4, 3, PixelType::F16)));
  CHECK(!prefilterCubemap(makeImage(8, 4, 2, PixelType::F32)));
  CHECK(!prefilterCubemap(makeImage(0, 0, 3, PixelType::F32)));
}

TEST_CASE("the report says what was done") {
  PrefilterReport report;
  std::vector<double> shares;
  PrefilterOptions o = optionsOf(ReflectionLobe::BlinnPhong, 64, 0);
  o.progress = [&](double share) { shares.push_back(share); };
  const Cubemap cube = prefilterCubemap(cubeOf(32, smooth), o, &report).value();
  CHECK(cube.lobe == ReflectionLobe::BlinnPhong);
  REQUIRE(report.levels.size() == 4);  // 64, 32, 16, 8
  REQUIRE(cube.levels.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(report.levels[k].size == cube.levels[k].size);
    CHECK(report.levels[k].roughness == cube.levels[k].roughness);
    CHECK((k == 0 || report.levels[k].bands > 0 || report.levels[k].samples > 0));
  }
  CHECK(cube.levels[3].roughness == Approx(1));
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() == 0);
  CHECK(shares.back() == Approx(1));
}
