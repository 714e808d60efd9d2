// Skins and morph targets: the GPU's vertices against an oracle in double, what is computed when, pictures against meshes that were deformed beforehand.
#include <catch2/catch.hpp>

#include <iostream>

#include "gpu_scene/frame.h"
#include "plan/variants.h"
#include "render/deformed.h"
#include "render/workshop.h"

namespace burnish::test {
namespace {

/// deform() alone, on a device of its own.
struct Bench {
  GlFixture f;
  gl::ProgramCache cache{*f.device, gl::ShaderLibrary(std::filesystem::path())};
  gpu_scene::ProgramSet programs{*f.device, cache};
  gpu_scene::TargetPool targets{*f.device};
  std::optional<gpu_scene::GpuScene> state;  // of one scene, as Renderer keeps it
  gpu_scene::FrameBuffers buffers = *gpu_scene::FrameBuffers::create(*f.device);
  scene::Derived derived;
  std::vector<scene::VisibleInstance> visible;
  FramePlan plan;
  Report report;

  Bench() {
    for (int key = 1; key < 4; ++key) plan.programs.push_back(plan::deformProgram({(key & 1) != 0, (key & 2) != 0}));
    REQUIRE(programs.prepare(plan));
    forget();
  }
  /// For another scene.
  void forget() {
    state.emplace(*f.device);
    derived = {};
  }
  gpu_scene::Deformation& deformation() { return state->deformation(); }
  /// One frame; how many instances were computed.
  int frame(const Scene& scene, bool previous = false) {
    derived.update(scene, &report);
    const scene::ViewFrame view = scene::frameOf(lookAt({0, 0, 10}, {0, 0, 0}), {64, 64});
    scene::findVisible(scene, derived, view, visible, scene::Reach::Everywhere);
    const Quality quality;
    const scene::LightSet lights;
    FrameStats stats;
    gpu_scene::FrameContext c{.device = *f.device, .plan = plan, .programs = programs, .targets = targets, .gpuScene = *state, .buffers = buffers, .scene = scene, .quality = quality,
                              .view = view, .visible = visible, .batches = {}, .lights = lights, .size = {64, 64}, .report = report, .stats = stats};
    state->beginFrame(scene, 0);
    deformation().beginFrame(scene, previous);
    const auto done = gpu_scene::deform(c, visible);
    if (!done) FAIL(done.error().message());
    return deformation().dispatches();
  }
  /// Vertices of a buffer in GpuMesh's layout.
  std::vector<Vertex> read(GLuint id) {
    GLint bytes = 0;
    f.gl.GetNamedBufferParameteriv(id, GL_BUFFER_SIZE, &bytes);
    std::vector<std::byte> data(static_cast<std::size_t>(bytes));
    f.gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    f.gl.GetNamedBufferSubData(id, 0, bytes, data.data());
    std::vector<Vertex> out(data.size() / gpu_scene::GpuMesh::kStride);
    for (std::size_t v = 0; v < out.size(); ++v) {
      const std::byte* at = data.data() + v * gpu_scene::GpuMesh::kStride;
      vec3 p;
      std::int16_t codes[8];
      std::memcpy(&p, at, sizeof p);
      std::memcpy(codes, at + 12, sizeof codes);
      out[v].position = dvec3(p);
      for (int c = 0; c < 3; ++c) {
        out[v].normal[c] = codes[c] / 32767.0;
        out[v].tangent[c] = codes[4 + c] / 32767.0;
      }
    }
    return out;
  }
};

double degrees(dvec3 a, dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / kPi; }

struct Worst {
  double position = 0, normal = 0, tangent = 0;  ///< relative to the instance's size; degrees
};
Worst compare(Bench& bench, const Scene& scene, Id<Instance> id) {
  const std::vector<Vertex> gpu = bench.read(bench.deformation().previousVertices(id)), oracle = deformedBy(scene, *scene.instances.get(id));
  REQUIRE(gpu.size() == oracle.size());
  const scene::Pose& pose = *bench.derived.pose(id);
  const glm::dmat4 placement = pose.placement;
  const double size = glm::length(dvec3(pose.bounds.max - pose.bounds.min)) * std::cbrt(std::abs(glm::determinant(glm::dmat3(placement))));
  const glm::dmat3 a(placement);
  const glm::dmat3 cofactor(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
  Worst worst;
  for (std::size_t v = 0; v < gpu.size(); ++v) {
    worst.position = std::max(worst.position, glm::length(dvec3(placement * glm::dvec4(gpu[v].position, 1)) - oracle[v].position) / size);
    worst.normal = std::max(worst.normal, degrees(cofactor * gpu[v].normal, oracle[v].normal));
    worst.tangent = std::max(worst.tangent, degrees(a * gpu[v].tangent, oracle[v].tangent));
  }
  return worst;
}

void pose(Arm& arm, double amount) {
  arm.turn(1, 0.7 * amount, {0, 0, 1});
  arm.turn(2, -1.1 * amount, glm::normalize(dvec3(1, 2, 0.5)));
  arm.turn(3, 0.9 * amount, {0, 1, 0});
}

}  // namespace

TEST_CASE("deformed vertices agree with an oracle in double, near the origin and 1e6 m from it", "[deformation]") {
  Bench bench;
  struct Row {
    const char* what;
    bool skin, morph;
    dvec3 origin, scale;
  };
  for (const Row& row : {Row{"skin", true, false, {0, 0, 0}, {1, 1, 1}}, Row{"skin, stretched", true, false, {0, 0, 0}, {1, 3, 0.4}}, Row{"skin, mirrored", true, false, {0, 0, 0}, {1, -1, 1}},
                         Row{"skin, tiny", true, false, {0, 0, 0}, {1e-9, 1e-9, 1e-9}}, Row{"skin, far", true, false, {1e6, -2e6, 3e5}, {1, 1, 1}},
                         Row{"morph", false, true, {0, 0, 0}, {1, 1, 1}}, Row{"morph, far", false, true, {1e6, 0, 1e6}, {2, 1, 1}}, Row{"both", true, true, {0, 0, 0}, {1, 1, 1}},
                         Row{"both, far", true, true, {1e6, -2e6, 3e5}, {1, 1.5, 1}}}) {
    Arm arm(4, row.origin, row.morph);
    arm.scene.nodes.edit(arm.joints[0])->local = glm::scale(arm.scene.nodes.get(arm.joints[0])->local, row.scale);
    pose(arm, 1);
    if (!row.skin) {
      arm.scene.instances.edit(arm.instance)->skin = {};
      arm.scene.nodes.edit(arm.row().node)->local = glm::scale(translation(row.origin), row.scale);
    }
    if (row.morph) arm.scene.instances.edit(arm.instance)->morphWeights = {0.8f, 0, -0.6f};
    CHECK(bench.frame(arm.scene) == 1);
    const Worst w = compare(bench, arm.scene, arm.instance);
    std::cout << "  " << row.what << ": position " << w.position << " of the size, normal " << w.normal << " deg, tangent " << w.tangent << " deg\n";
    INFO(row.what);
    CHECK(w.position < 1e-5);
    CHECK(w.normal < 0.1);
    CHECK(w.tangent < 0.1);
    bench.forget();
  }
  CHECK(bench.report.empty());
}

TEST_CASE("a skin in its bind pose is the mesh as it is", "[deformation]") {
  Bench bench;
  Arm arm;
  bench.frame(arm.scene);
  const std::vector<Vertex> vertices = bench.read(bench.deformation().previousVertices(arm.instance));
  const Mesh& mesh = *arm.scene.meshes.get(arm.mesh);
  const dvec3 anchor(bench.derived.pose(arm.instance)->placement[3]);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    CHECK(glm::length(vertices[v].position + anchor - dvec3(mesh.positions[v])) < 4e-7);
    for (int c = 0; c < 3; ++c) {
      CHECK(std::abs(vertices[v].normal[c] - double(mesh.normals[v][c])) <= 1.01 / 32767);
      CHECK(std::abs(vertices[v].tangent[c] - double(mesh.tangents[v][c])) <= 1.01 / 32767);
    }
  }
}

TEST_CASE("bounds of a pose hold every vertex and little else", "[deformation]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-1, 1);
  double loosest = 0;
  for (int round = 0; round < 40; ++round) {
    Arm arm(5, {some(random) * 1e6, 0, 0}, round % 2 == 1);
    for (int k = 0; k < 5; ++k) arm.turn(k, 2 * some(random), glm::normalize(dvec3(some(random), some(random), some(random))));
    if (round % 2) arm.scene.instances.edit(arm.instance)->morphWeights = {float(some(random)), float(some(random))};
    scene::Derived derived;
    derived.update(arm.scene);
    const scene::Pose& p = *derived.pose(arm.instance);
    dvec3 least(INFINITY), most(-INFINITY);
    for (const Vertex& v : deformedBy(arm.scene, arm.row())) {
      const dvec3 at = v.position - dvec3(p.placement[3]);
      least = glm::min(least, at), most = glm::max(most, at);
      for (int c = 0; c < 3; ++c) {
        REQUIRE(at[c] >= double(p.bounds.min[c]));
        REQUIRE(at[c] <= double(p.bounds.max[c]));
      }
    }
    loosest = std::max(loosest, glm::length(dvec3(p.bounds.max - p.bounds.min)) / glm::length(most - least));
    const Bounds world = arm.scene.bounds();
    CHECK(world.max.x >= least.x + p.placement[3].x - 0.1);
  }
  std::cout << "  diagonals of the boxes: at most " << loosest << " of the vertices' own\n";
  CHECK(loosest < 2);
}

TEST_CASE("a pose that does not change is not computed again; what is gone is freed", "[deformation]") {
  Bench bench;
  Arm arm;
  const Id<Instance> rigid = place(arm.scene, box({0, 0, 0}, {1, 1, 1}), Material{});
  CHECK(bench.frame(arm.scene) == 1);
  CHECK(bench.frame(arm.scene) == 0);
  CHECK(bench.deformation().previousVertices(rigid) == 0);
  arm.turn(2, 0.5);
  CHECK(bench.frame(arm.scene) == 1);
  // Another node moves: the pose is what it was.
  arm.scene.nodes.edit(arm.scene.instances.get(rigid)->node)->local = translation({9, 9, 9});
  CHECK(bench.frame(arm.scene) == 0);
  // The whole arm moves without turning: its vertices stay, their place changes.
  arm.scene.nodes.edit(arm.joints[0])->local[3].y += 2;
  CHECK(bench.frame(arm.scene) == 0);
  CHECK(compare(bench, arm.scene, arm.instance).position < 1e-5);
  // A new mesh in its place.
  arm.scene.meshes.edit(arm.mesh)->positions[0].x -= 0.1f;
  CHECK(bench.frame(arm.scene) == 1);
  const std::int64_t with = bench.f.device->bytesAllocated();
  arm.scene.instances.edit(arm.instance)->visible = false;
  for (int i = 0; i < 61; ++i) bench.frame(arm.scene);
  CHECK(bench.f.device->bytesAllocated() < with);
  CHECK(bench.deformation().previousVertices(arm.instance) == 0);
  arm.scene.instances.remove(arm.instance);
  CHECK(bench.frame(arm.scene) == 0);
}

TEST_CASE("the frame before is kept when it is asked for, and costs nothing otherwise", "[deformation]") {
  Bench bench;
  Arm arm;
  auto& d = bench.deformation();
  bench.frame(arm.scene);
  const std::int64_t one = bench.f.device->bytesAllocated();
  arm.turn(1, 0.4);
  bench.frame(arm.scene);
  CHECK(bench.f.device->bytesAllocated() <= one + 4096);
  const std::vector<Vertex> before = deformedBy(arm.scene, arm.row());
  arm.turn(1, 0.8);
  arm.scene.nodes.edit(arm.joints[0])->local[3].x += 3;
  bench.frame(arm.scene, true);
  const std::vector<Vertex> kept = bench.read(d.previousVertices(arm.instance));
  const glm::dmat4 placement = *d.previousPlacement(arm.instance);
  for (std::size_t v = 0; v < kept.size(); v += 17) CHECK(glm::length(dvec3(placement * glm::dvec4(kept[v].position, 1)) - before[v].position) < 1e-5);
  bench.frame(arm.scene, true);  // it keeps still: both are the same
  CHECK(compare(bench, arm.scene, arm.instance).position < 1e-5);
  CHECK(*d.previousPlacement(arm.instance) == bench.derived.pose(arm.instance)->placement);
}

TEST_CASE("skins that do not fit and weights that are no numbers are said, and shown at rest", "[deformation]") {
  Bench bench;
  Arm arm(4, {0, 0, 0}, true);
  arm.scene.skins.edit(arm.skin)->joints.resize(2);
  arm.scene.instances.edit(arm.instance)->morphWeights = {NAN, INFINITY};
  CHECK(bench.frame(arm.scene) == 0);
  CHECK(bench.derived.pose(arm.instance) == nullptr);
  REQUIRE(bench.report.warnings().size() == 2);
  CHECK(bench.report.warnings()[0].message().find("not finite") != std::string::npos);
  CHECK(bench.report.warnings()[1].message().find("4 joints where its skin has 2") != std::string::npos);
  // A joint that is gone, a singular joint, an overflowing one: finite vertices or none.
  Arm odd;
  odd.scene.nodes.remove(odd.joints[3]);
  odd.scene.nodes.edit(odd.joints[2])->local = glm::dmat4(0);
  odd.scene.skins.edit(odd.skin)->inverseBind[0][0][0] = NAN;
  bench.forget();
  CHECK(bench.frame(odd.scene) == 1);
  for (const Vertex& v : bench.read(bench.deformation().previousVertices(odd.instance)))
    CHECK(std::isfinite(glm::length(v.position) + glm::length(v.normal) + glm::length(v.tangent)));
  odd.scene.nodes.edit(odd.joints[1])->local *= 1e300;
  bench.frame(odd.scene);
  CHECK(bench.visible.empty());
}

TEST_CASE("the plan has deformation exactly while a deformed instance is in view", "[deformation]") {
  Arm arm(4, {0, 0, 0}, true);
  const View view = lookAt({1.5, 0, 6}, {1.5, 0, 0}), away = lookAt({1.5, 0, 6}, {1.5, 0, 12});
  const auto plan = [&](const View& v) { return makePlan(arm.scene, {&v, 1}, {}, Capabilities{}, {.size = {64, 64}}); };
  const auto programs = [&](const FramePlan& p) {
    std::vector<std::string> names;
    for (const ProgramPlan& program : p.programs)
      if (!program.compute.empty()) names.push_back(program.name);
    return names;
  };
  CHECK(plan(view).on("deformation"));
  CHECK(plan(view).passes.front().name == "deform");
  CHECK(programs(plan(view)) == std::vector<std::string>{"deform+skin"});
  CHECK_FALSE(plan(away).on("deformation"));
  CHECK(plan(away).pass("deform") == nullptr);
  CHECK(programs(plan(away)).empty());
  arm.scene.instances.edit(arm.instance)->morphWeights = {0, 0, 0.5f};
  CHECK(programs(plan(view)) == std::vector<std::string>{"deform+morph+skin"});
  arm.scene.instances.edit(arm.instance)->skin = {};
  arm.scene.nodes.edit(arm.row().node)->local = glm::dmat4(1);
  CHECK(programs(plan(view)) == std::vector<std::string>{"deform+morph"});
  arm.scene.instances.edit(arm.instance)->morphWeights = {0, 0, 0};
  CHECK_FALSE(plan(view).on("deformation"));
  CHECK(plan(view).pass("deform") == nullptr);
}

TEST_CASE("an instance is drawn when its moved limb alone is in view, and culled when that has left", "[deformation]") {
  Arm arm(4);
  const View view = lookAt({0, -2.6, 4}, {0, -2.6, 0}, {0, 1, 0}, 0.5f);
  const auto sees = [&] {
    scene::Derived derived;
    derived.update(arm.scene);
    std::vector<scene::VisibleInstance> visible;
    scene::findVisible(arm.scene, derived, scene::frameOf(view, {64, 64}), visible);
    return !visible.empty();
  };
  CHECK_FALSE(sees());
  arm.turn(0, -kPi / 2);
  CHECK(sees());
  Stage stage;
  RenderRequest request;
  request.debugView = DebugView::Albedo;
  const Picture p = stage.draw(arm.scene, {&view, 1}, {64, 64}, {}, request);
  CHECK(p.stats.draws == 1);
  CHECK(p.at(32, 32) != dvec3(0));
  CHECK(stage.renderer->pick(arm.scene, view, {64, 64}, {32, 32}).value() == arm.instance);
}

TEST_CASE("pictures of deformed instances are those of meshes that were deformed beforehand", "[deformation]") {
  Stage stage;
  for (const dvec3 origin : {dvec3(0), dvec3(1e6, -2e6, 3e5)})
    for (const bool mirrored : {false, true}) {
      INFO("origin " << origin.x << ", mirrored " << mirrored);
      Arm arm(4, origin, true);
      arm.scene.instances.edit(arm.instance)->morphWeights = {0.3f, 0, 0};
      pose(arm, 1);
      if (mirrored) {
        glm::dmat4& local = arm.scene.nodes.edit(arm.joints[0])->local;
        local = glm::scale(local, dvec3(1, -1, 1));
      }
      Scene still;
      place(still, frozen(arm.scene, arm.row(), origin), Material{}, translation(origin));
      if (mirrored) {  // the frozen mesh's triangles look inward
        Mesh& m = *still.meshes.edit(still.meshes.at(0));
        for (std::size_t i = 0; i < m.indices.size(); i += 3) std::swap(m.indices[i], m.indices[i + 1]);
      }
      for (Scene* s : {&arm.scene, &still}) {
        addLight(*s, light(LightKind::Directional, vec3(1), 10), {0, 0, 0}, {-0.5, -1, -0.6});
        s->environment.color = vec3(0.2f);
      }
      const View view = lookAt(origin + dvec3(1.5, 0.5, 5), origin + dvec3(1.5, 0, 0), {0, 1, 0}, 0.8f);
      for (const DebugView shown : {DebugView::Position, DebugView::Normal, DebugView::Depth, DebugView::Final}) {
        RenderRequest request;
        request.debugView = shown;
        Quality quality;
        quality.exposureEv = 1;
        const Errors e = difference(stage.draw(arm.scene, {&view, 1}, {160, 120}, quality, request), stage.draw(still, {&view, 1}, {160, 120}, quality, request), 2.01 / 255);
        INFO("view " << debugViewNames()[std::size_t(shown)] << ": " << e.share() << " within 2/255, largest " << e.largest);
        CHECK(e.share() > 0.998);  // an edge pixel may fall to either side
      }
      Quality forward;
      forward.path = Path::Forward;
      const Errors e = difference(stage.linear(arm.scene, view, {160, 120}, forward), stage.linear(still, view, {160, 120}, forward), 0.02);
      CHECK(e.share() > 0.998);
    }
}

TEST_CASE("a mesh that two materials share is drawn whole in the first frame, with tangents made for one of them", "[deformation]") {
  Workshop w;
  Arm arm;
  Mesh mesh = *arm.scene.meshes.get(arm.mesh);
  mesh.tangents.clear();
  *arm.scene.meshes.edit(arm.mesh) = mesh;
  Instance second = arm.row();
  Material mapped;
  mapped.mapB = arm.scene.textures.add(*w.scene.textures.get(w.normals));
  second.material = arm.scene.materials.add(mapped);
  arm.scene.instances.add(second);
  const View view = lookAt({1.5, 0, 5}, {1.5, 0, 0});
  Stage stage;
  CHECK(stage.display(arm.scene, view, {64, 48}).stats.draws == 2);
  CHECK(stage.renderer->report().empty());
}

TEST_CASE("a crowd of deformed instances: each is drawn with vertices of its own", "[deformation]") {
  Arm arm;
  Scene still;
  for (int k = 0; k < 10; ++k) {
    Skin skin;
    skin.inverseBind = arm.scene.skins.get(arm.skin)->inverseBind;
    for (int j = 0; j < 4; ++j)
      skin.joints.push_back(addNode(arm.scene, j == 0 ? translation({-1.5, -2 + 0.45 * k, 0}) : glm::rotate(translation({1, 0, 0}), 0.07 * k - 0.3, dvec3(0, 0, 1)), j == 0 ? Id<Node>{} : skin.joints.back()));
    Instance one = arm.row();
    one.skin = arm.scene.skins.add(skin);
    const Id<Instance> id = arm.scene.instances.add(one);
    place(still, frozen(arm.scene, *arm.scene.instances.get(id)), Material{});
  }
  arm.scene.instances.remove(arm.instance);
  const View view = lookAt({0, 0, 7}, {0, 0, 0});
  Stage stage;
  RenderRequest request;
  request.debugView = DebugView::Normal;
  const Picture crowd = stage.draw(arm.scene, {&view, 1}, {160, 120}, {}, request);
  CHECK(difference(crowd, stage.draw(still, {&view, 1}, {160, 120}, {}, request), 2.01 / 255).share() > 0.995);
}

TEST_CASE("taken off the list, deformation leaves the mesh at its node", "[deformation]") {
  RendererOptions options;
  options.removedEffects = {"deformation"};
  Stage stage(options);
  Arm arm;
  arm.scene.nodes.edit(arm.row().node)->local = glm::dmat4(1);
  Scene still;
  place(still, *arm.scene.meshes.get(arm.mesh), Material{});
  RenderRequest request;
  request.debugView = DebugView::Normal;
  const View view = lookAt({1.5, 0.5, 5}, {1.5, 0, 0});
  CHECK(same(stage.draw(arm.scene, {&view, 1}, {64, 48}, {}, request), stage.draw(still, {&view, 1}, {64, 48}, {}, request)));
}

}  // namespace burnish::test
