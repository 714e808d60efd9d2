// Bakes into folders: the same bytes whatever the way, and a scene change bakes what it touches.
#include "gpu/gl_fixture.h"
#include "probe/bounce.h"
#include "probe/work.h"
#include "store_scene.h"

using namespace store_test;

namespace {

constexpr int kPointsIn[] = {6, 8};  // of each room: two reflection probes, and four and six points of the lattice
constexpr int kPoints = kPointsIn[0] + kPointsIn[1], kGridPoints = kPoints - 4;

struct Bench {
  std::unique_ptr<Context> context = test::openContext();
  Folder box;
  BakeOptions options = smallBake();

  Result<BakeReport> tryBake(const Scene& scene, const BakeJob& job) {
    Report report;
    return bakeProbes(context->procAddress(), scene, options, job, report);
  }
  BakeReport bake(const Scene& scene, const fs::path& folder, bool resume = false) {
    auto baked = tryBake(scene, {.folder = folder, .resume = resume});
    if (!baked) FAIL(baked.error().message());
    return std::move(*baked);
  }
  Result<BakeReport> shard(const Scene& scene, const fs::path& folder, int shard, int shards, int bounce, bool resume = false) {
    return tryBake(scene, {.folder = folder, .resume = resume, .shard = shard, .shards = shards, .bounce = bounce});
  }
  /// The error of a bake that cannot be.
  std::string refusal(const Scene& scene, const BakeJob& job) {
    const auto baked = tryBake(scene, job);
    REQUIRE_FALSE(baked);
    CHECK_FALSE(baked.error().remedy.empty());
    return baked.error().message();
  }
};

Result<MergeReport> merge(const fs::path& folder) {
  Report report;
  return mergeBounce(folder, report);
}

int captured(const BakeReport& report) {
  int sum = 0;
  for (const BounceReport& b : report.bounces) {
    CHECK(b.captured + b.reused == kPoints);
    sum += b.captured;
  }
  return sum;
}
/// A bounce after one that changed nothing finds all that it needs: its keys are the same.
void checkCaptured(const BakeReport& report, int points) {
  for (std::size_t k = 0; k < report.bounces.size(); ++k) {
    INFO("bounce " << k + 1);
    CHECK(report.bounces[k].captured == (k > 1 && report.bounces[k - 1].change == 0 ? 0 : points));
    CHECK(report.bounces[k].captured + report.bounces[k].reused == kPoints);
  }
}

}  // namespace

TEST_CASE("A bake's folder holds light, and says what was baked", "[probe][store]") {
  Bench bench;
  const Rooms rooms = twoRooms();
  const BakeReport baked = bench.bake(rooms.scene, bench.box.path / "a");
  REQUIRE(baked.bounces.size() == 3);
  checkCaptured(baked, kPoints);
  CHECK(baked.captureMs > 0);
  CHECK(baked.filterMs > 0);
  CHECK(baked.wallMs > 0);
  Report report;
  const auto set = readProbes(bench.box.path / "a", report);
  REQUIRE(set);
  CHECK(report.empty());
  REQUIRE(probe::captureCount(*set) == kPoints);
  for (const ReflectionProbe& p : set->reflections) {
    REQUIRE(p.radiance.levels.size() >= 2);
    CHECK(p.radiance.levels[0].size == 16);
    CHECK(p.irradiance[0][0] > 0);
  }
  // The red room's light is red, the blue one's blue.
  CHECK(set->reflections[0].irradiance[0][0] > set->reflections[0].irradiance[0][2]);
  CHECK(set->reflections[3].irradiance[0][0] < set->reflections[3].irradiance[0][2]);
  const auto inspected = inspectProbes(bench.box.path / "a");
  REQUIRE(inspected);
  CHECK(inspected->wrong.empty());
  CHECK(inspected->bounces.size() == 3);
  CHECK(inspected->joined == 3);
  CHECK(inspected->files.size() == 6);
  CHECK(inspected->options.find("\"size\":16") != std::string::npos);
}

TEST_CASE("Four shards joined are one process, byte for byte", "[probe][store]") {
  Bench bench;
  const Rooms rooms = twoRooms();
  const BakeReport whole = bench.bake(rooms.scene, bench.box.path / "whole");
  const fs::path folder = bench.box.path / "shards";
  for (int bounce = 1; bounce <= 3; ++bounce) {
    int sum = 0;
    for (const int shard : {2, 0, 3, 1}) {
      const auto part = bench.shard(rooms.scene, folder, shard, 4, bounce);
      if (!part) FAIL(part.error().message());
      sum += part->bounces.at(0).captured;
      CHECK_FALSE(fs::exists(folder / "probes.json"));
    }
    const auto joined = merge(folder);
    if (!joined) FAIL(joined.error().message());
    const BounceReport& expected = whole.bounces[std::size_t(bounce - 1)];
    CHECK(sum == expected.captured);
    CHECK(sum == joined->bounce.captured);
    CHECK(joined->bounce.bounce == bounce);
    CHECK(joined->bounce.change == expected.change);
    CHECK(joined->bounce.rest == expected.rest);
    CHECK(joined->finished == (bounce == 3));
  }
  CHECK(contentOf(folder) == contentOf(bench.box.path / "whole"));
  CHECK(merge(folder).error().what.find("finished") != std::string::npos);
}

TEST_CASE("A bake that is resumed without a change captures nothing", "[probe][store]") {
  Bench bench;
  const Rooms rooms = twoRooms();
  bench.bake(rooms.scene, bench.box.path / "a");
  const auto before = contentOf(bench.box.path / "a");
  CHECK(captured(bench.bake(rooms.scene, bench.box.path / "a", true)) == 0);
  CHECK(contentOf(bench.box.path / "a") == before);
  // Names and the order of tables are no light; more bounces take the ones that are there.
  Rooms renamed = twoRooms();
  renamed.scene.materials.edit(renamed.walls[0])->name = "plaster";
  renamed.scene.name = "other";
  CHECK(captured(bench.bake(renamed.scene, bench.box.path / "a", true)) == 0);
  CHECK(contentOf(bench.box.path / "a") == before);
  bench.options.bounces = 4;
  const BakeReport longer = bench.bake(rooms.scene, bench.box.path / "a", true);
  REQUIRE(longer.bounces.size() == 4);
  CHECK(captured(longer) == longer.bounces[3].captured);
}

TEST_CASE("A change in one room bakes that room again and nothing else, as a fresh bake would", "[probe][store]") {
  Bench bench;
  const int room = GENERATE(0, 1);
  const int what = GENERATE(0, 1, 2);
  Rooms rooms = twoRooms();
  bench.bake(rooms.scene, bench.box.path / "a");
  if (what == 0) rooms.scene.lights.edit(rooms.lamps[room])->intensity = 55;
  if (what == 1) rooms.scene.materials.edit(rooms.walls[room])->albedo.y = 0.6f;
  if (what == 2) rooms.scene.nodes.edit(rooms.tables[room])->local[3].z -= 0.5;
  const BakeReport again = bench.bake(rooms.scene, bench.box.path / "a", true);
  REQUIRE(again.bounces.size() == 3);
  INFO("room " << room << ", change " << what);
  checkCaptured(again, kPointsIn[room]);
  bench.bake(rooms.scene, bench.box.path / "b");
  CHECK(contentOf(bench.box.path / "a") == contentOf(bench.box.path / "b"));
}

TEST_CASE("What was killed in its first moment can be gone on with", "[probe][store]") {
  Bench bench;
  const Rooms rooms = twoRooms();
  bench.bake(rooms.scene, bench.box.path / "whole");
  const fs::path folder = bench.box.path / "a";
  fs::create_directories(folder / "work");
  put(folder / "work/.burnish-0123456789abcdef.tmp", "half");
  bench.bake(rooms.scene, folder, true);
  CHECK(contentOf(folder) == contentOf(bench.box.path / "whole"));
}

TEST_CASE("Damaged, cut and missing files of the work folder are baked again", "[probe][store]") {
  Bench bench;
  const Rooms rooms = twoRooms();
  const fs::path folder = bench.box.path / "a";
  bench.bake(rooms.scene, folder);
  const auto before = contentOf(folder);
  int files = 0;
  for (const auto& [name, text] : before) {
    if (!name.starts_with("work/light/")) continue;
    const int kind = files++ % 3;
    if (kind == 0) setByte(folder / name, (std::size_t(files) * 97) % text.size(), char(text[(std::size_t(files) * 97) % text.size()] ^ 4));
    if (kind == 1) put(folder / name, text.substr(0, text.size() / 2));
    if (kind == 2) fs::remove(folder / name);
    if (kind == 0) CHECK(inspectProbes(folder)->wrong.size() > 0);
    CHECK(captured(bench.bake(rooms.scene, folder, true)) == (name.ends_with(".probe") ? 1 : kGridPoints));
    REQUIRE(contentOf(folder) == before);
  }
  CHECK(files >= 10);  // five a bounce
  for (const char* name : {"work/bake.json", "work/bounce_0001.json", "work/bounce_0003.json", "work/places/probes.json", "probes.json"}) {
    setByte(folder / name, 40, '#');
    CHECK(inspectProbes(folder)->wrong.size() == 1);
    CHECK(captured(bench.bake(rooms.scene, folder, true)) == 0);
    REQUIRE(contentOf(folder) == before);
  }
  fs::remove_all(folder / "work");  // removable: the next bake begins anew
  checkCaptured(bench.bake(rooms.scene, folder, true), kPoints);
  CHECK(contentOf(folder) == before);
}

TEST_CASE("Bakes and joins that cannot be are refused with what to do, and change nothing", "[probe][store]") {
  Bench bench;
  const Rooms rooms = twoRooms();
  const fs::path folder = bench.box.path / "a";
  const auto says = [](const std::string& text, const std::string& part) {
    INFO(text);
    CHECK(text.find(part) != std::string::npos);
  };
  Scene empty = rooms.scene;
  empty.probes = {};
  says(bench.refusal(empty, {.folder = folder}), "no places for probes");
  for (const int size : {0, 8, 100, 4096}) {
    bench.options.size = size;
    says(bench.refusal(rooms.scene, {.folder = folder}), "power of two");
  }
  bench.options = smallBake();
  says(bench.refusal(rooms.scene, {.folder = folder, .shard = 4, .shards = 4, .bounce = 1}), "shard < shards");
  says(bench.refusal(rooms.scene, {.folder = folder, .shards = 4}), "one bounce at a time");
  CHECK_FALSE(fs::exists(folder));
  says(merge(folder).error().message(), "holds no bake");

  says(bench.refusal(rooms.scene, {.folder = folder, .shards = 2, .bounce = 2}), "from bounce 1 on");
  REQUIRE(bench.shard(rooms.scene, folder, 0, 2, 1));
  says(bench.refusal(rooms.scene, {.folder = folder, .shards = 2, .bounce = 2}), "bounce 1 is not joined");
  says(merge(folder).error().message(), "not baked by shard 2/2");
  says(bench.refusal(rooms.scene, {.folder = folder}), "not finished");
  Rooms changed = twoRooms();
  changed.scene.lights.edit(changed.lamps[0])->intensity = 1;
  says(bench.refusal(changed.scene, {.folder = folder, .shards = 2, .bounce = 1}), "another scene or of other options");
  REQUIRE(bench.shard(rooms.scene, folder, 1, 2, 1));
  const auto parts = contentOf(folder);
  for (const auto& [name, text] : parts) {
    if (!name.starts_with("work/part_")) continue;
    setByte(folder / name, text.size() / 2, '#');
    says(merge(folder).error().message(), name);
    put(folder / name, text);
  }
  for (const auto& [name, text] : parts) {
    if (!name.starts_with("work/light/")) continue;
    setByte(folder / name, text.size() / 2, char(text[text.size() / 2] ^ 1));
    says(merge(folder).error().message(), "damaged");
    put(folder / name, text);
  }
  CHECK(contentOf(folder) == parts);
  {
    const auto lock = probe::WorkLock::take(folder, probe::Access::Alone);
    REQUIRE(lock);
    says(bench.refusal(rooms.scene, {.folder = folder, .resume = true}), "another bake is writing here");
    says(bench.refusal(rooms.scene, {.folder = folder, .shards = 2, .bounce = 1}), "another bake is writing here");
    says(merge(folder).error().message(), "another bake is writing here");
  }
  REQUIRE(merge(folder));
  says(bench.refusal(rooms.scene, {.folder = folder, .shards = 2, .bounce = 1}), "bounce 1 is joined already");
  says(merge(folder).error().message(), "no shard of bounce 2");
  bench.bake(rooms.scene, folder, true);
  says(bench.refusal(rooms.scene, {.folder = folder}), "holds probes already");
  says(bench.refusal(changed.scene, {.folder = folder, .shards = 2, .bounce = 1}), "another scene");
}

TEST_CASE("Shards of a changed scene take what still holds, and mend what is damaged", "[probe][store]") {
  Bench bench;
  Rooms rooms = twoRooms();
  const fs::path folder = bench.box.path / "a";
  bench.bake(rooms.scene, folder);
  rooms.scene.lights.edit(rooms.lamps[1])->intensity = 55;
  const BakeReport fresh = bench.bake(rooms.scene, bench.box.path / "fresh");
  for (int bounce = 1; bounce <= 3; ++bounce) {
    int sum = 0;
    for (int shard = 0; shard < 2; ++shard) {
      const auto part = bench.shard(rooms.scene, folder, shard, 2, bounce, true);
      if (!part) FAIL(part.error().message());
      sum += part->bounces[0].captured;
    }
    const bool same = bounce > 2 && fresh.bounces[std::size_t(bounce - 2)].change == 0;
    const int lost = bounce == 3 ? kPointsIn[0] - 2 : 0;  // the red room's lattice points, in files that were damaged below
    CHECK(sum == (same ? 0 : kPointsIn[1] + lost));
    const auto joined = merge(folder);
    if (!joined) FAIL(joined.error().message());
    CHECK(joined->bounce.reused == kPoints - sum);
    if (bounce == 2) {  // a file of bounce 1 that bounce 2 does not need any more, and one that bounce 3 needs
      const auto before = contentOf(folder);
      for (const auto& [name, text] : before)
        if (name.starts_with("work/light/") && name.ends_with(".points")) setByte(folder / name, text.size() - 1, char(text.back() ^ 1));
      CHECK(bench.shard(rooms.scene, folder, 0, 1, 3).error().what.find("damaged") != std::string::npos);
      for (int k = 1; k <= 2; ++k) REQUIRE(bench.shard(rooms.scene, folder, 0, 1, k, true));
    }
  }
  CHECK(contentOf(folder) == contentOf(bench.box.path / "fresh"));
}
