// Folders of probes: what is written comes back, and old ones stay until new ones are complete.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>

#include "core/hash.h"
#include "image/cube_file.h"
#include "probe/work.h"
#include "store_fixture.h"

using namespace store_test;

namespace {

Result<void> write(const fs::path& folder, const ProbeSet& set) {
  Report report;
  return writeProbes(folder, set, report);
}
ProbeSet read(const fs::path& folder) {
  Report report;
  auto set = readProbes(folder, report);
  if (!set) FAIL(set.error().message());
  CHECK(report.empty());
  return std::move(*set);
}

void checkSamePlace(const ReflectionProbe& a, const ReflectionProbe& b) {
  CHECK(a.name == b.name);
  CHECK(a.center == b.center);
  CHECK(a.axes == b.axes);
  CHECK(a.halfSize == b.halfSize);
  CHECK(a.capture == b.capture);
  CHECK(a.fade == b.fade);
  CHECK(a.margin == b.margin);
  CHECK(a.irradiance == b.irradiance);
}

/// Largest error of values that are at least 2^-28 of the largest, over the value: a half float with all its digits rounds by 2^-11 at most.
double worstError(const Cubemap& stored, const Cubemap& asked) {
  float most = 0;
  for (const CubeLevel& level : asked.levels)
    for (const float v : level.texels) most = std::max(most, v);
  double worst = 0;
  for (std::size_t k = 0; k < asked.levels.size(); ++k)
    for (std::size_t i = 0; i < asked.levels[k].texels.size(); ++i) {
      const double v = asked.levels[k].texels[i];
      if (v >= std::ldexp(double(most), -28)) worst = std::max(worst, std::abs(double(stored.levels[k].texels[i]) - v) / v);
    }
  return worst;
}

}  // namespace

TEST_CASE("What a folder of probes was given comes back, and writing that gives the same bytes", "[probe][store]") {
  const Folder box;
  const ProbeSet set = sampleSet();
  REQUIRE(write(box.path / "a", set));
  const ProbeSet back = read(box.path / "a");
  REQUIRE(back.reflections.size() == set.reflections.size());
  for (std::size_t i = 0; i < set.reflections.size(); ++i) checkSamePlace(back.reflections[i], set.reflections[i]);
  CHECK(back.reflections[2].radiance.levels.empty());
  for (std::size_t i = 0; i < 2; ++i) {
    const Cubemap &stored = back.reflections[i].radiance, &asked = set.reflections[i].radiance;
    REQUIRE(stored.levels.size() == 2);
    CHECK(stored.lobe == ReflectionLobe::Ggx);
    CHECK(stored.levels[1].roughness == asked.levels[1].roughness);
    CHECK(worstError(stored, asked) <= std::ldexp(1.0, -11));
    CHECK(worstError(stored, asked) > std::ldexp(1.0, -13));  // they are halves
  }
  REQUIRE(back.grid);
  const AmbientGrid &g = *back.grid, &asked = *set.grid;
  CHECK(g.name == asked.name);
  CHECK(g.origin == asked.origin);
  CHECK(g.axes == asked.axes);
  CHECK(g.spacing == asked.spacing);
  CHECK(g.counts == asked.counts);
  CHECK(g.margin == asked.margin);
  REQUIRE(g.points.size() == asked.points.size());
  for (std::size_t i = 0; i < g.points.size(); ++i) {
    CHECK(g.points[i].valid == asked.points[i].valid);
    CHECK(g.points[i].irradiance == asked.points[i].irradiance);
    CHECK(g.points[i].distances == asked.points[i].distances);
  }
  REQUIRE(write(box.path / "b", back));
  CHECK(contentOf(box.path / "a") == contentOf(box.path / "b"));
}

TEST_CASE("Scales of half floats stay when what they made is written again", "[probe][store]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-100, 127);
  for (int i = 0; i < 2000; ++i) {
    Cubemap cube = radianceOf(1, 1, 1e-3, 1, random);
    // Every tenth rounds up to the next power of two, where a scale may jump.
    const float most = i % 10 ? std::exp2(float(exponent(random))) : std::nextafter(std::exp2(std::floor(float(exponent(random)))), 0.0f);
    for (float& v : cube.levels[0].texels) v *= most;
    const double scale = image::halfScale(cube);
    INFO("most " << most << ", scale " << scale);
    const auto bytes = image::encodeKtx2(cube, PixelType::F16, scale);
    const auto back = image::decodeKtx2(bytes, "cube", {});
    REQUIRE(back);
    CHECK(back->scale == scale);
    CHECK(std::abs(back->cube.levels[0].texels[0] / double(cube.levels[0].texels[0]) - 1) <= std::ldexp(1.0, -11));
    REQUIRE(image::halfScale(back->cube) == scale);
    REQUIRE(image::encodeKtx2(back->cube, PixelType::F16, scale) == bytes);
  }
}

TEST_CASE("Files of a folder are named and checked by XXH3-128, as others compute it", "[probe][store]") {
  CHECK(core::hashOf({}).hex() == "99aa06d3014798d86001c324468d497f");  // the empty input's, of the algorithm's own test vectors
  CHECK(core::parseHash("99aa06d3014798d86001c324468d497f") == core::hashOf({}));
  CHECK_FALSE(core::parseHash("99AA06d3014798d86001c324468d497f"));
  CHECK_FALSE(core::parseHash("99aa"));
  const Folder box;
  REQUIRE(write(box.path / "a", sampleSet()));
  int cubes = 0, pictures = 0;
  for (const auto& [name, text] : contentOf(box.path / "a")) {
    if (name == "probes.json") continue;
    const std::string hash = core::hashOf(std::as_bytes(std::span(text))).hex();
    CHECK(name.ends_with(fmt::format(".{}.ktx2", hash.substr(0, 16))));
    CHECK(textOf(box.path / "a/probes.json").find(hash) != std::string::npos);
    (name.starts_with("reflection_") ? cubes : pictures) += 1;
  }
  CHECK(cubes == 2);
  CHECK(pictures == 2);
}

TEST_CASE("A probe's file alone is a cubemap with true radiance", "[probe][store]") {
  const Folder box;
  const ProbeSet set = sampleSet();
  REQUIRE(write(box.path / "a", set));
  for (const auto& [name, text] : contentOf(box.path / "a")) {
    if (!name.starts_with("reflection_0000")) continue;
    Report report;
    const auto cube = readCubemap(box.path / "a" / name, report);
    REQUIRE(cube);
    CHECK(report.empty());
    CHECK(worstError(*cube, set.reflections[0].radiance) <= std::ldexp(1.0, -11));
    return;
  }
  FAIL("no file of the first probe");
}

TEST_CASE("Places without light, and nothing at all, can be stored", "[probe][store]") {
  const Folder box;
  ProbeSet set = sampleSet();
  for (ReflectionProbe& p : set.reflections) p.radiance = {};
  set.grid->points.clear();
  REQUIRE(write(box.path / "places", set));
  CHECK(contentOf(box.path / "places").size() == 1);
  const ProbeSet places = read(box.path / "places");
  CHECK(places.reflections.size() == 3);
  REQUIRE(places.grid);
  CHECK(places.grid->points.empty());
  CHECK(places.grid->counts == set.grid->counts);
  REQUIRE(write(box.path / "nothing", {}));
  CHECK(read(box.path / "nothing").reflections.empty());
  CHECK_FALSE(read(box.path / "nothing").grid);
  set = sampleSet();
  for (AmbientGrid::Point& p : set.grid->points) p.distances.clear();
  REQUIRE(write(box.path / "blind", set));
  CHECK(read(box.path / "blind").grid->points[0].distances.empty());
}

TEST_CASE("What no folder can hold is refused with its place, and nothing is made", "[probe][store]") {
  const Folder box;
  const double nan = std::nan("");
  const std::vector<std::pair<std::string, std::function<void(ProbeSet&)>>> faults = {
      {"centre", [&](ProbeSet& s) { s.reflections[1].center.y = nan; }},
      {"half size", [&](ProbeSet& s) { s.reflections[1].halfSize.x = -1; }},
      {"axes", [&](ProbeSet& s) { s.reflections[1].axes[0] *= 1.01; }},
      {"irradiance", [&](ProbeSet& s) { s.reflections[1].irradiance[4][1] = INFINITY; }},
      {"level 1", [&](ProbeSet& s) { s.reflections[1].radiance.levels[1].texels[5] = -1; }},
      {"level 0", [&](ProbeSet& s) { s.reflections[1].radiance.levels[0].texels.pop_back(); }},
      {"another lobe", [&](ProbeSet& s) { s.reflections[1].radiance.lobe = ReflectionLobe::BlinnPhong; }},
      {"spacing", [&](ProbeSet& s) { s.grid->spacing.z = 0; }},
      {"along an axis", [&](ProbeSet& s) { s.grid->counts.x = 0; }},
      {"points", [&](ProbeSet& s) { s.grid->points.pop_back(); }},
      {"distances", [&](ProbeSet& s) { s.grid->points[0].distances.pop_back(); }},
      {"distance", [&](ProbeSet& s) { s.grid->points[0].distances[3].y = -1; }},
      {"irradiance", [&](ProbeSet& s) { s.grid->points[0].irradiance[8].z = NAN; }},
  };
  for (const auto& [says, spoil] : faults) {
    ProbeSet set = sampleSet();
    spoil(set);
    const auto written = write(box.path / "a", set);
    REQUIRE_FALSE(written);
    INFO(written.error().message());
    CHECK(written.error().message().find(says) != std::string::npos);
    CHECK(written.error().place.find((box.path / "a").string()) == 0);
    CHECK_FALSE(written.error().remedy.empty());
    CHECK_FALSE(fs::exists(box.path / "a"));
  }
  for (const auto& [folder, says] : std::vector<std::pair<fs::path, std::string>>{{box.path / "no/such", "around it"}, {"", "name a folder"}, {"/proc/no", "cannot be made"}}) {
    const auto written = write(folder, sampleSet());
    REQUIRE_FALSE(written);
    INFO(written.error().message());
    CHECK((written.error().message().find(says) != std::string::npos || folder.native().starts_with("/proc")));
  }
  fs::create_directory(box.path / "mine");
  put(box.path / "mine/thesis.txt", "x");
  CHECK(write(box.path / "mine", sampleSet()).error().message().find("other things") != std::string::npos);
  CHECK(write(box.path / "mine/thesis.txt", sampleSet()).error().message().find("no folder") != std::string::npos);
}

TEST_CASE("A new set takes an old one's place, whose files go; what is not ours stays", "[probe][store]") {
  const Folder box;
  REQUIRE(write(box.path / "a", sampleSet()));
  put(box.path / "a/notes.txt", "mine");
  put(box.path / "a/lightmap.ktx2", "mine");
  ProbeSet other = sampleSet();
  other.reflections.resize(1);
  other.reflections[0].radiance.levels[0].texels[7] = 3;
  REQUIRE(write(box.path / "a", other));
  CHECK(read(box.path / "a").reflections.size() == 1);
  REQUIRE(write(box.path / "b", other));
  auto a = contentOf(box.path / "a");
  CHECK(a.erase("notes.txt") + a.erase("lightmap.ktx2") == 2);
  CHECK(a == contentOf(box.path / "b"));
}

TEST_CASE("A file size limit, a folder that may not be written and a bake at work leave the old set", "[probe][store]") {
  const Folder box;
  const fs::path folder = box.path / "a";
  const ProbeSet small = sampleSet(), large = sampleSet(64);
  REQUIRE(write(folder, small));
  const auto before = contentOf(folder);
  const auto limited = [&](const fs::path& target, rlim_t most) {
    return inChild([&] {
      const struct rlimit limit { most, most };
      if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
      const auto written = write(target, large);
      return written ? 2 : written.error().remedy.find("file size limit") == std::string::npos ? 3 : 0;
    });
  };
  for (const rlim_t most : {1000, 20000, 200000}) {
    CHECK(limited(folder, most) == 0);
    CHECK(contentOf(folder) == before);
    CHECK(limited(box.path / "new", most) == 0);
    CHECK_FALSE(fs::exists(box.path / "new"));
  }
  fs::permissions(box.path, fs::perms(0755));
  fs::permissions(folder, fs::perms(0555));
  CHECK(inChild([&] {
          if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) return 1;
          const auto written = write(folder, large);
          return written ? 2 : written.error().remedy.find("permissions") == std::string::npos ? 3 : write(box.path / "new", large) ? 4 : 0;
        }) == 0);
  fs::permissions(folder, fs::perms(0755));
  CHECK(contentOf(folder) == before);
  {
    const auto lock = probe::WorkLock::take(folder, probe::Access::Alone);
    REQUIRE(lock);
    const auto written = write(folder, large);
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find("another bake") != std::string::npos);
  }
  auto after = contentOf(folder);
  CHECK(after.erase("work/lock") + after.erase("work/state_lock") == 2);
  CHECK(after == before);
  CHECK(write(folder, large));
}

TEST_CASE("SIGKILL at any moment leaves the old or the new set, whole", "[probe][store]") {
  const Folder box;
  const fs::path folder = box.path / "a";
  ProbeSet sets[2] = {sampleSet(16), sampleSet(16)};
  sets[1].reflections[0].radiance.levels[0].texels[0] *= 2;
  sets[1].reflections[2].name = "other";
  REQUIRE(write(folder, sets[0]));
  std::mt19937 random(3);
  const int kills = std::getenv("BURNISH_LONG") ? 1000 : 40;
  int seen[2] = {};
  for (int i = 0; i < kills; ++i) {
    const pid_t pid = ::fork();
    if (pid == 0)
      for (int k = 0;; ++k) (void)write(folder, sets[(k + i) % 2]);
    ::usleep(1000 + useconds_t(random() % 60000));
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    Report report;
    const auto set = readProbes(folder, report);
    if (!set) FAIL(set.error().message());
    const bool second = set->reflections[2].name == "other";
    ++seen[second];
    const double found = set->reflections[0].radiance.levels[0].texels[0], asked = sets[second].reflections[0].radiance.levels[0].texels[0];
    REQUIRE(std::abs(found / asked - 1) <= std::ldexp(1.0, -11));
  }
  CHECK(seen[0] > 0);
  CHECK(seen[1] > 0);
  // The next write takes away what a kill left.
  REQUIRE(write(folder, sets[0]));
  REQUIRE(write(box.path / "b", sets[0]));
  CHECK(contentOf(folder) == contentOf(box.path / "b"));
}
