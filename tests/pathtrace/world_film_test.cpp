// The film and its state: pictures that depend on nothing but scene and options, and a noise that is what it says.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "pathtrace/film.h"
#include "world_scenes.h"

using namespace burnish;
using namespace burnish::test;
namespace fs = std::filesystem;

namespace {

/// A floor and a wall under a lamp and a dim sky.
Scene corner() {
  Scene scene;
  Material floor, wall, lamp;
  floor.albedo = {0.8f, 0.6f, 0.4f};
  floor.roughness = 0.4f;
  wall.albedo = {0.3f, 0.5f, 0.7f};
  lamp.emission = {40, 30, 20};
  lamp.twoSided = true;
  add(scene, panel(2), floor);
  glm::dmat4 upright(1);
  upright[1] = glm::dvec4(0, 0, 1, 0), upright[2] = glm::dvec4(0, -1, 0, 0), upright[3] = glm::dvec4(0, 2, 1, 1);
  add(scene, panel(2), wall, upright);
  add(scene, panel(0.3f), lamp, moved({0.5, 0.5, 1.5}));
  scene.environment.color = {0.5f, 0.6f, 0.8f};
  return scene;
}
const View kView = lookAt({0, -4, 3}, {0, 0, 0.5}, {0, 0, 1});

ReferencePicture trace(const Scene& scene, const ReferenceOptions& options, Report* said = nullptr) {
  Report report;
  auto made = traceReference(scene, kView, {}, options, said ? *said : report);
  if (!made) FAIL(made.error().message());
  return std::move(*made);
}
bool same(const ReferencePicture& a, const ReferencePicture& b) {
  return a.radiance.data == b.radiance.data && a.direct.data == b.direct.data && a.albedo.data == b.albedo.data && a.normal.data == b.normal.data && a.variance.data == b.variance.data &&
         a.samples == b.samples && a.error == b.error;
}
struct File {
  fs::path path = fs::temp_directory_path() / ("burnish_film_" + std::to_string(::getpid()));
  File() { fs::remove(path); }
  ~File() { fs::remove(path); }
};
ReferenceOptions options(int samples, std::uint64_t seed = 1) {
  ReferenceOptions o;
  o.size = {36, 24};
  o.samples = samples;
  o.seed = seed;
  o.threads = 1;
  return o;
}

}  // namespace

TEST_CASE("film: the number of threads changes nothing", "[film]") {
  const Scene scene = corner();
  ReferenceOptions o = options(12);
  const ReferencePicture one = trace(scene, o);
  for (const int threads : {2, 5}) {
    o.threads = threads;
    CHECK(same(one, trace(scene, o)));
  }
}

TEST_CASE("film: interrupted and taken up again it is the picture that it would have been", "[film]") {
  const Scene scene = corner();
  const ReferencePicture whole = trace(scene, options(44));
  for (const int after : {1, 5, 8, 16, 43}) {
    CAPTURE(after);
    File file;
    ReferenceOptions o = options(44);
    o.state = file.path;
    o.progress = [&](const ReferenceProgress& p) { return p.samples < after; };
    const ReferencePicture part = trace(scene, o);
    REQUIRE(part.samples >= after);
    CHECK(fs::exists(file.path));
    o.progress = {};
    CHECK(same(whole, trace(scene, o)));
    // A state can be taken further than was asked for at first.
    o.samples = 50;
    CHECK(same(trace(scene, options(50)), trace(scene, o)));
  }
}

TEST_CASE("film: a state of something else, or a damaged one, is one error", "[film]") {
  const Scene scene = corner();
  File file;
  ReferenceOptions o = options(4);
  o.state = file.path;
  trace(scene, o);
  const auto refused = [&](const Scene& s, const ReferenceOptions& with) {
    Report report;
    const auto made = traceReference(s, kView, {}, with, report);
    return !made && made.error().place == file.path.string();
  };
  ReferenceOptions other = o;
  other.seed = 2;
  CHECK(refused(scene, other));
  other = o, other.bounces = 3;
  CHECK(refused(scene, other));
  other = o, other.size.x = 37;
  CHECK(refused(scene, other));
  other = o, other.pixelArea = false;
  CHECK(refused(scene, other));
  Scene brighter = corner();
  brighter.environment.color.r *= 2;
  CHECK(refused(brighter, o));
  Report report;
  Quality phong;
  phong.specular = Specular::Phong;
  CHECK_FALSE(traceReference(scene, kView, phong, o, report));
  CHECK_FALSE(refused(scene, o));

  std::ifstream in(file.path, std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(in)), {});
  const auto put = [&](const std::string& bytes) { std::ofstream(file.path, std::ios::binary) << bytes; };
  for (const std::size_t length : {std::size_t(0), std::size_t(10), std::size_t(60), good.size() - 1}) {
    put(good.substr(0, length));
    CHECK(refused(scene, o));
  }
  for (const std::size_t at : {std::size_t(3), std::size_t(20), good.size() / 2, good.size() - 3}) {
    std::string bytes = good;
    bytes[at] = char(bytes[at] ^ 4);
    put(bytes);
    CHECK(refused(scene, o));
  }
}

TEST_CASE("film: seeds agree within the noise that they state", "[film]") {
  const Scene scene = corner();
  constexpr int kSeeds = 12, kSamples = 64;
  std::vector<ReferencePicture> pictures;
  for (int seed = 0; seed < kSeeds; ++seed) pictures.push_back(trace(scene, options(kSamples, std::uint64_t(seed) * 1000 + 1)));
  // What the seeds' pictures scatter, pixel by pixel, against what each says of itself.
  const std::size_t count = pictures[0].radiance.pixelCount() * 3;
  double scatter = 0, stated = 0, light = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0, squares = 0;
    for (const ReferencePicture& p : pictures) {
      const double v = p.radiance.f32()[i];
      sum += v, squares += v * v;
      stated += double(p.variance.f32()[i]) / kSeeds;
    }
    scatter += (squares - sum * sum / kSeeds) / (kSeeds - 1);
    light += sum * sum / kSeeds / kSeeds;
  }
  // Twelve seeds know a variance to sqrt(2/11) in one pixel; the brightest few dozen pixels, at the lamp's edge, hold most of it.
  CHECK(scatter / stated == Approx(1).margin(0.25));
  for (const ReferencePicture& p : pictures) CHECK(p.error == Approx(std::sqrt(stated / light)).epsilon(0.35));
}

TEST_CASE("film: untilError ends the work, early and not before", "[film]") {
  const Scene scene = corner();
  ReferenceOptions o = options(1000);
  o.untilError = 0.05;
  const ReferencePicture p = trace(scene, o);
  CHECK(p.error < 0.05);
  CHECK(p.samples % 8 == 0);
  CHECK(p.samples >= 16);
  CHECK(p.samples < 1000);
  CHECK(trace(scene, options(p.samples - 8)).error >= 0.05);
}

TEST_CASE("film: options out of range are errors", "[film]") {
  const Scene scene = corner();
  Report report;
  for (const auto& [size, samples] : {std::pair{glm::ivec2(0, 4), 1}, std::pair{glm::ivec2(20000, 4), 1}, std::pair{glm::ivec2(16384, 16384), 1}, std::pair{glm::ivec2(4, 4), 0}, std::pair{glm::ivec2(4, 4), 1'000'001}}) {
    ReferenceOptions o;
    o.size = size;
    o.samples = samples;
    CHECK_FALSE(traceReference(scene, kView, {}, o, report));
  }
}

TEST_CASE("film: samples that are not finite do not count", "[film]") {
  pathtrace::Pixel with, without;
  std::uint32_t n = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    pathtrace::FilmSample s;
    s.radiance = glm::dvec3(i % 7, 1, 2);
    CHECK(with.add(i, s));
  }
  for (std::uint32_t i = 0; i < 40; ++i) {
    pathtrace::FilmSample s;
    s.radiance = glm::dvec3(i % 7, 1, 2);
    if (i % 5 == 2) s.radiance.y = std::numeric_limits<double>::quiet_NaN();
    if (i % 5 == 3) s.features.normal.x = std::numeric_limits<float>::infinity();
    n += without.add(i, s);
  }
  CHECK(n == 24);
  CHECK(without.whole + without.open == 24);
  CHECK(without.radiance().y == 1);
  CHECK(std::isfinite(without.radiance().x));
  CHECK(std::isfinite(without.variance(40).x));
}

TEST_CASE("film: the variance of independent samples is estimated without bias", "[film]") {
  // Numbers of variance 1/12: the mean of n has 1/(12 n). A plain generator, so that groups gain nothing by being spread.
  for (const int samples : {6, 8, 16, 64, 100}) {
    double sum = 0;
    const int pixels = 4000;
    std::uint64_t state = 7;
    for (int p = 0; p < pixels; ++p) {
      pathtrace::Pixel pixel;
      for (int i = 0; i < samples; ++i) {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        pathtrace::FilmSample s;
        s.radiance = glm::dvec3(double(state >> 11) * 0x1p-53);
        pixel.add(std::uint32_t(i), s);
      }
      sum += pixel.variance(samples).x;
    }
    // Of 4000 pixels with one degree of freedom (16 samples: two groups) the mean is known to sqrt(2/4000) = 2.2 %.
    const double bound = samples == 100 ? 0.12 : 0.08;  // 100: the open group of four has no part in the spread
    CHECK(sum / pixels == Approx(1.0 / 12 / samples).epsilon(bound));
  }
}
