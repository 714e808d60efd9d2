// Thousands of frames of a scene that keeps changing: memory stays what it is, and nothing is left when the renderer goes.
#include <catch2/catch.hpp>

#include <algorithm>
#include <deque>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "zero_cost/account.h"

using namespace burnish;
using namespace burnish::test;

namespace {

/// Frames after which the scene, the settings and the target's size are what they were.
constexpr int kPeriod = 100;
/// Frames after which what is made once (programs, the driver's code for them, streams at their largest) is there.
constexpr int kWarm = 200;
/// Memory goes up and down within a period: the least over so many frames is compared, which a leak raises as it does the most.
constexpr int kWindow = 4 * kPeriod;
/// Blocks from here on are the driver's (its scenes and textures, of 4 MiB and more): of the same frame it holds three of them now and not another time, as its threads go.
constexpr std::int64_t kLarge = 1 << 20;
/// What those come to, twice over.
constexpr double kDriversBlocks = 24 << 20;

/// Bytes of this process.
struct Memory {
  std::int64_t resident = std::numeric_limits<std::int64_t>::max();  ///< In memory, without what the allocator keeps though nothing uses it.
  std::int64_t small = std::numeric_limits<std::int64_t>::max();     ///< In use in blocks under kLarge; the same as `resident` where the allocator does not say.

  static Memory now() {
    Memory m;
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    std::ifstream in("/proc/self/statm");
    std::int64_t size = 0;
    in >> size >> m.resident;
    m.resident *= sysconf(_SC_PAGESIZE);
#ifdef __GLIBC__
    m.small = std::int64_t(mallinfo2().uordblks);
#else
    m.small = m.resident;
#endif
    return m;
  }
  void least(const Memory& m) { resident = std::min(resident, m.resident), small = std::min(small, m.small); }
};

/// What changes from frame to frame.
struct Life {
  Subject subject = stand();
  std::deque<Id<Instance>> bodies;
  std::deque<Id<Light>> lamps;
  Id<Light> moving, sun;
  Id<Instance> ball;

  Life() {
    Scene& s = subject.scene;
    s.lights.each([&](Id<Light> id, const Light&) { sun = id; });
    ball = s.instances.at(1);
    moving = addLight(s, light(LightKind::Point, {1, 0.8f, 0.6f}, 10, 5), {1, 1, 1});
    s.lights.edit(moving)->castsShadow = true;
  }

  /// A new body with a mesh, a material and (some) a texture of its own.
  void addBody(int frame) {
    Material m;
    m.albedo = {0.3f + 0.1f * float(frame % 5), 0.5f, 0.4f};
    if (frame % 2 == 0) m.emission = vec3(0.5f);
    if (frame % 3 == 0) m.blend = true, m.opacity = 0.6f;
    if (frame % 5 == 0) m.transmission = 1, m.thickness = 0.3f, m.ior = 1.4f;
    m.mapC = subject.scene.textures.add(painted(frame));
    const double x = -1.5 + 0.5 * (frame % 7);
    bodies.push_back(place(subject.scene, sphere(0.3f, 8, 16), m, translation({x, 0.1 * (frame % 3), 1})));
    lamps.push_back(addLight(subject.scene, light(frame % 4 == 0 ? LightKind::Spot : LightKind::Point, {0.5f, 0.7f, 1}, 5, 3), {x, 1, 1.5}, {0, -1, -0.2}));
  }
  void removeBody() {
    Scene& s = subject.scene;
    const Instance gone = *s.instances.get(bodies.front());
    s.instances.remove(bodies.front());
    s.textures.remove(s.materials.get(gone.material)->mapC);
    s.meshes.remove(gone.mesh);
    s.materials.remove(gone.material);
    s.nodes.remove(gone.node);
    const Id<Node> node = s.lights.get(lamps.front())->node;
    s.lights.remove(lamps.front());
    s.nodes.remove(node);
    bodies.pop_front();
    lamps.pop_front();
  }
  /// Everything follows from frame % kPeriod, so that a period ends where it began.
  void step(int frame) {
    const int at = frame % kPeriod;
    Quality& q = subject.quality;
    subject.scene.nodes.edit(subject.scene.lights.get(moving)->node)->local = translation({std::sin(at * 0.1) * 2, 1, 1});
    // Shadows that move with their lights, with what stands in them, and not at all.
    Scene& s = subject.scene;
    s.lights.edit(sun)->castsShadow = at >= 10 && at < 70;
    if (at < 30) s.nodes.edit(s.lights.get(sun)->node)->local = glm::rotate(glm::dmat4(1), -1.0 + 0.01 * at, dvec3(1, 0, 0));
    if (at >= 40) s.nodes.edit(s.instances.get(ball)->node)->local = translation({-0.4 + 0.3 * std::sin(at * 0.2), 0, 0});
    s.fog.density = at >= 25 && at < 45 ? 0.05f : 0.0f;
    if (at % 5 == 0) addBody(at);
    while (bodies.size() > (at < kPeriod - 1 ? 4u : 0u)) removeBody();
    if (at % 10 == 0) subject.scene.environment.scale = at % 20 == 0 ? 1.0f : 0.0f, subject.scene.environment.color = {0.4f, 0.5f, 0.7f};
    if (at == 50) ++subject.scene.environment.revision;
    q.bloom = at >= 20 && at < 40 ? Bloom::Scatter : Bloom::None;
    q.antialiasing = at >= 30 && at < 60 ? Antialiasing::Edge : at >= 65 && at < 90 ? Antialiasing::Temporal : Antialiasing::None;
    q.occlusion = at >= 50 && at < 80 ? Occlusion::Screen4 : Occlusion::Baked;
    q.path = at >= 80 && at < 85 ? Path::Forward : Path::Deferred;
    if (at >= 60 && at < 75)
      q.exposureEv.reset();
    else
      q.exposureEv = 2.0f;
    constexpr glm::ivec2 kSizes[] = {{64, 36}, {80, 45}, {48, 64}, {33, 17}};
    subject.size = kSizes[at / 25];
  }

 private:
  static Texture painted(int frame) {
    Texture t;
    t.kind = MapKind::Occlusion;
    t.image = makeImage(8, 8, 2, PixelType::U8);
    for (std::size_t i = 0; i < t.image.byteSize(); ++i) t.image.u8()[i] = std::uint8_t(128 + (int(i) * 7 + frame) % 128);
    return t;
  }
};

}  // namespace

TEST_CASE("zero cost: thousands of frames of a changing scene take no more memory, and nothing is left at the end", "[zero_cost][soak]") {
  const int frames = std::getenv("BURNISH_LONG") ? 10000 : 2000;
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, kLarge);  // and does not grow by itself any more
#endif
  const auto context = openContext({.backend = testBackend()});
  Recorder recorder(context->procAddress());
  recorder.keepCalls(false);
  recorder.ledger().keepWork(false);
  auto renderer = Renderer::create(recorder.procAddress());
  REQUIRE(renderer);
  Life life;
  std::unique_ptr<OffscreenTarget> target;
  Memory first, last;
  std::int64_t bytes = 0;
  std::size_t objects = 0;
  for (int frame = 0; frame < frames; ++frame) {
    life.step(frame);
    if (!target || target->target().size != life.subject.size) {
      auto made = OffscreenTarget::create(context->procAddress(), life.subject.size, Output::Display);
      REQUIRE(made);
      target = std::move(*made);
    }
    const auto stats = (*renderer)->render(life.subject.scene, {&life.subject.view, 1}, target->target(), life.subject.quality);
    if (!stats) FAIL("frame " << frame << ": " << stats.error().message());
    if (frame >= kWarm && frame < kWarm + kWindow) first.least(Memory::now());
    if (frame >= frames - kWindow) last.least(Memory::now());
    if (frame != kWarm) continue;
    bytes = recorder.ledger().bytes();
    objects = recorder.ledger().alive().size();
  }
  // The last frame is one before the frame that was measured, a whole number of periods later; one more is the same.
  life.step(frames);
  if (auto made = OffscreenTarget::create(context->procAddress(), life.subject.size, Output::Display)) target = std::move(*made);
  REQUIRE((*renderer)->render(life.subject.scene, {&life.subject.view, 1}, target->target(), life.subject.quality));
  const double mebibyte = 1 << 20, small = double(last.small - first.small), resident = double(last.resident - first.resident);
  const double glGrowth = double(recorder.ledger().bytes() - bytes) / double(bytes);
  WARN(fmt::format("{} frames: at least {:.2f} MiB in small blocks and {:.1f} MiB resident in the {} frames from frame {} on, {:+.2f} and {:+.1f} MiB in the last ones; {} bytes of GL objects, {:+.2f} %; {} objects, then {}", frames,
                   double(first.small) / mebibyte, double(first.resident) / mebibyte, kWindow, kWarm, small / mebibyte, resident / mebibyte, bytes, 100 * glGrowth, objects, recorder.ledger().alive().size()));
  CHECK(small < 0.01 * double(first.small));
  CHECK(resident < 0.02 * double(first.resident) + kDriversBlocks);
  CHECK(glGrowth < 0.02);
  CHECK(recorder.ledger().alive().size() == objects);
  target.reset();
  renderer->reset();
  CHECK(recorder.ledger().inventory() == std::vector<std::string>{});
  CHECK(recorder.ledger().strangeDeletions() == 0);
  CHECK(recorder.ledger().created() == recorder.ledger().deleted());
}
