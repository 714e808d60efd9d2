// The doctor's own look at the machine, and its trial frame.
#include <burnish/renderer.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <thread>

#include "doctor_report.h"

namespace cli {
namespace {

using Clock = std::chrono::steady_clock;
double msSince(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

/// What follows the key and its separator in a file's first line that begins with it; quotes and blanks taken off.
std::string valueIn(const char* file, std::string_view key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t at = line.find_first_of("=:");
    if (at == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", at + 1), last = line.find_last_not_of(" \t\"");
    return first == std::string::npos ? "" : line.substr(first, last - first + 1);
  }
  return {};
}

burnish::Mesh floorOf(float half) {
  burnish::Mesh m;
  m.positions = {{-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half}};
  m.normals.assign(4, {0, 1, 0});
  m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  m.indices = {0, 1, 2, 0, 2, 3};
  return m;
}

/// A floor under a sun, a lamp and an even sky.
burnish::Scene trialScene() {
  burnish::Scene scene;
  burnish::Instance floor;
  floor.mesh = scene.meshes.add(floorOf(4));
  floor.material = scene.materials.add({});
  floor.node = scene.nodes.add({});
  scene.instances.add(floor);
  burnish::Light sun, lamp;
  sun.kind = burnish::LightKind::Directional;
  sun.intensity = 3;
  burnish::Node down, above;
  down.local = glm::dmat4(glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0)));  // its -Z looks down
  above.local[3] = glm::dvec4(0.5, 1, 0, 1);
  sun.node = scene.nodes.add(down);
  lamp.node = scene.nodes.add(above);
  scene.lights.add(sun);
  scene.lights.add(lamp);
  scene.environment.color = glm::vec3(0.5f);
  return scene;
}

double sumOf(const burnish::FrameStats& stats) {
  double sum = 0;
  for (const burnish::PassTime& p : stats.passes) sum += p.gpuMs;
  return sum;
}
double medianOf(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

burnish::Result<TrialFrame> drawn(const burnish::ProcAddress& address) {
  constexpr glm::ivec2 kSize{320, 180};
  constexpr int kFrames = 9;
  TrialFrame t;
  burnish::RendererOptions options;
  options.debugOutput = true;
  auto renderer = burnish::Renderer::create(address, options);
  if (!renderer) return burnish::fail(renderer.error());
  auto target = burnish::OffscreenTarget::create(address, kSize, burnish::Output::Display);
  if (!target) return burnish::fail(target.error());
  const burnish::Scene scene = trialScene();
  const burnish::View view = burnish::lookAt({0, 1.5, 3}, {0, 0, 0});
  burnish::PlanOptions planned;
  planned.size = kSize;
  const auto began = Clock::now();
  const auto linked = (*renderer)->warmUp(burnish::makePlan(scene, {&view, 1}, {}, (*renderer)->capabilities(), planned));
  if (!linked) return burnish::fail(linked.error());
  t.programs = *linked;
  t.linkMs = msSince(began);
  std::vector<double> frames, queried, finished;
  for (const auto timing : {burnish::TimingMode::Async, burnish::TimingMode::Profile})
    for (int i = 0; i < kFrames; ++i) {
      burnish::RenderRequest request;
      request.timing = timing;
      request.countNonfinite = i == 0;
      const auto start = Clock::now();
      const auto stats = (*renderer)->render(scene, {&view, 1}, (*target)->target(), {}, request);
      if (!stats) return burnish::fail(stats.error());
      if (auto read = (*target)->read(); !read) return burnish::fail(read.error());
      t.nonfinitePixels += stats->nonfinitePixels;
      t.glErrors.insert(t.glErrors.end(), stats->glErrors.begin(), stats->glErrors.end());
      if (i < 3) continue;  // uploads, and queries that have not arrived
      if (timing == burnish::TimingMode::Async) frames.push_back(msSince(start));
      if (!stats->passes.empty()) (timing == burnish::TimingMode::Async ? queried : finished).push_back(sumOf(*stats));
    }
  t.frameMs = medianOf(frames);
  if (!queried.empty()) t.queryMs = medianOf(queried);
  if (!finished.empty()) t.finishedMs = medianOf(finished);
  return t;
}

}  // namespace

MachineReport lookAtMachine() {
  MachineReport m;
  utsname kernel{};
  const std::string release = uname(&kernel) == 0 ? fmt::format("{} {}", kernel.sysname, kernel.release) : std::string("unknown kernel");
  const std::string name = valueIn("/etc/os-release", "PRETTY_NAME");
  m.system = name.empty() ? release : name + ", " + release;
  m.processor = valueIn("/proc/cpuinfo", "model name");
  if (m.processor.empty()) m.processor = "unknown processor";
  m.threads = int(std::thread::hardware_concurrency());
  return m;
}

TrialFrame tryFrame(const burnish::ProcAddress& getProcAddress) {
  auto t = drawn(getProcAddress);
  if (t) return *t;
  TrialFrame failed;
  failed.error = t.error().message();
  return failed;
}

}  // namespace cli
