// Antialiasing over time, where the camera or things move: what was seen before is found again, what is uncovered leaves no trail, and motion vectors are where an oracle in double
// has them.
#include <fmt/format.h>

#include <iostream>

#include "render/deformed.h"
#include "render/temporal.h"
#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{64, 48};

/// An unlit square of smooth waves, `cycles` of them across.
Id<Instance> placeWaves(Scene& scene, vec3 center, float half, float cycles, vec3 tint, float base = 0.5f) {
  Material m;
  m.unlit = true;
  m.albedo = tint;
  m.mapA = scene.textures.add(painted(MapKind::AlbedoSubstance, 256, [=](float u, float v) {
    const float w = base + 0.3f * std::sin(6.2831853f * cycles * u) * std::cos(6.2831853f * cycles * v);
    const float s = w <= 0.0031308f ? 12.92f * w : 1.055f * std::pow(w, 1 / 2.4f) - 0.055f;
    return vec4(vec3(s), 1.0f / 3);
  }));
  return place(scene, quad({0, 0, 0}, {half, 0, 0}, {0, half, 0}), m, translation(dvec3(center)));
}

struct Drawn {
  Picture none, temporal, exact;
};
/// The last picture of a sequence, beside one sample and 8 x 8 samples a pixel.
template <class Step>
Drawn sequence(Easel& easel, Scene& scene, int frames, Step&& step) {
  Drawn d;
  View view;
  for (int i = 0; i < frames; ++i) {
    view = step(i);
    d.temporal = easel.develop(scene, {&view, 1}, kSize, temporal());
  }
  d.none = easel.develop(scene, {&view, 1}, kSize, temporal(false));
  d.exact = reduced(easel.develop(scene, {&view, 1}, kSize * 8, temporal(false)), 8);
  return d;
}

}  // namespace

TEST_CASE("temporal antialiasing of a camera that pans, turns and nears: a plane is found again", "[temporal]") {
  struct Row {
    const char* name;
    std::function<View(int)> view;
    double bound;
  };
  const auto perspective = [](dvec3 eye, dvec3 at) {
    View v = lookAt(eye, at);
    v.fovY = 0.7f;
    return v;
  };
  const Row rows[] = {{"pans, orthographic", [](int i) { return facing(0.0157 * i, 0.0089 * i); }, 0.01},
                      {"pans by whole pixels", [](int i) { return facing(2.0 / 48 * i, 0); }, 0.01},
                      {"pans", [&](int i) { return perspective({0.02 * i, 0.01 * i, 3}, {0.02 * i, 0.01 * i, 0}); }, 0.01},
                      {"turns", [&](int i) { return perspective({0, 0, 3}, {0.03 * i, 0.011 * i, 0}); }, 0.02},
                      {"nears, slanted", [&](int i) { return perspective({0, -1.5, 3 - 0.02 * i}, {0, 0.3, 0}); }, 0.02}};
  for (const Row& row : rows) {
    Easel easel;
    Scene scene;
    placeWaves(scene, {0, 0, 0}, 6, 24, vec3(1));
    const Drawn d = sequence(easel, scene, 24, row.view);
    // What came in over the border has few samples yet.
    const auto inner = [](int x, int y) { return x > 10 && x < kSize.x - 11 && y > 10 && y < kSize.y - 11; };
    const double one = rms(d.none, d.exact), over = rms(d.temporal, d.exact), within = rms(d.temporal, d.exact, inner);
    std::cout << fmt::format("  {:<22}: rms error {:.4f} with one sample, {:.4f} after 24 frames, {:.4f} away from the border\n", row.name, one, over, within);
    CHECK(!easel.stage.renderer->lastPlan().on("motion_vectors"));
    // 24 frames move by 10 pixels and more, waves are 9 to 16 pixels long: a place that is off by a pixel has an error over 0.08.
    CHECK(within < row.bound);
    CHECK(over < 0.03);
  }
}

TEST_CASE("temporal antialiasing of edges that move with the camera", "[temporal]") {
  Easel easel;
  Scene scene = slanted(20, 0.9f, 0.05f);
  const Drawn d = sequence(easel, scene, 24, [](int i) { return facing(0.0157 * i - 0.2, 0.0089 * i - 0.1); });
  const double one = rms(d.none, d.exact), over = rms(d.temporal, d.exact);
  std::cout << fmt::format("  edges under a panning camera: rms error {:.4f} with one sample, {:.4f} after 24 frames, {:.2f} times less\n", one, over, one / over);
  CHECK(one / over > 1.2);
}

TEST_CASE("temporal antialiasing of a thing that moves: it is sharp, and what it uncovers is seen at once", "[temporal]") {
  for (const bool rigid : {true, false}) {
    Easel easel;
    Scene scene;
    placeWaves(scene, {0, 0, -1}, 6, 20, vec3(0.4f, 0.6f, 1));
    const Id<Instance> front = placeWaves(scene, {0, 0, 0}, 0.45f, 2, vec3(1, 0.8f, 0.5f), 0.65f);
    const Id<Node> node = scene.instances.get(front)->node;
    const double step = rigid ? 0.0633 : 0.13;  // metres; a pixel is 0.0417
    double x = -0.8;
    const Drawn d = sequence(easel, scene, 18, [&](int i) {
      x = -0.8 + step * i;
      scene.nodes.edit(node)->local = translation({x, 0.003 * i, 0});
      return facing();
    });
    CHECK(easel.stage.renderer->lastPlan().on("motion_vectors") == false);  // the picture without a history came last
    const auto at = [&](int px, int py) { return dvec3((px + 0.5) / 24 - 64.0 / 48, 1 - (py + 0.5) / 24, 0); };
    const auto inside = [&](int px, int py) { return std::abs(at(px, py).x - x) < 0.45 - 0.09 && std::abs(at(px, py).y - 0.003 * 17) < 0.45 - 0.09; };
    const auto trail = [&](int px, int py) { return at(px, py).x < x - 0.45 - 0.09 && at(px, py).x > x - 0.45 - 0.6 && std::abs(at(px, py).y) < 0.4; };
    const double contrast = rms(d.exact, d.none, [&](int, int) { return true; });
    std::cout << fmt::format("  {:.1f} pixels a frame: rms error inside {:.4f} ({:.4f} with one sample), where it was {:.4f} ({:.4f}); all {:.4f} ({:.4f})\n", step * 24, rms(d.temporal, d.exact, inside),
                             rms(d.none, d.exact, inside), rms(d.temporal, d.exact, trail), rms(d.none, d.exact, trail), rms(d.temporal, d.exact), contrast);
    CHECK(rms(d.temporal, d.exact, inside) < 0.02);
    CHECK(rms(d.temporal, d.exact, trail) < 0.02);
  }
}

namespace {

/// What a target that the renderer keeps holds, found by its label.
struct Held {
  std::vector<vec4> texels;
  glm::ivec2 size{0};
};
Held heldBy(Easel& easel, const std::string& label) {
  REQUIRE(easel.stage.context->makeCurrent());
  const GladGLContext& gl = easel.gl;
  Held held;
  for (GLuint id = 1; id < 4000; ++id) {
    if (!gl.IsTexture(id)) continue;
    char text[256] = {};
    GLsizei length = 0;
    gl.GetObjectLabel(GL_TEXTURE, id, sizeof text, &length, text);
    if (std::string_view(text, std::size_t(length)) != label) continue;
    gl.GetTextureLevelParameteriv(id, 0, GL_TEXTURE_WIDTH, &held.size.x);
    gl.GetTextureLevelParameteriv(id, 0, GL_TEXTURE_HEIGHT, &held.size.y);
    held.texels.resize(std::size_t(held.size.x * held.size.y));
    gl.GetTextureImage(id, 0, GL_RGBA, GL_FLOAT, GLsizei(held.texels.size() * sizeof(vec4)), held.texels.data());
  }
  return held;
}

/// Where a world point is seen: pixels from the lower left corner, and its distance along the view.
dvec3 pixelOf(const View& view, dvec3 p) {
  const dvec3 local = glm::transpose(view.axes) * (p - view.eye);
  const double w = -local.z, t = std::tan(double(view.fovY) / 2), aspect = double(kSize.x) / kSize.y;
  const double k = view.orthographic ? 2 / double(view.height) : 1 / (w * t);
  return {(local.x * k / aspect + 1) * 0.5 * kSize.x, (local.y * k + 1) * 0.5 * kSize.y, w};
}

/// The nearest triangle of a mesh in the world on a ray: where it is hit, and the same point of another pose of it. False: none.
bool hit(const Ray& ray, const std::vector<dvec3>& now, const std::vector<dvec3>& then, const std::vector<std::uint32_t>& indices, double& distance, dvec3& before) {
  bool any = false;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const dvec3 a = now[indices[i]], u = now[indices[i + 1]] - a, v = now[indices[i + 2]] - a, n = glm::cross(u, v), s = ray.origin - a;
    const double d = glm::dot(ray.direction, n);
    if (d >= 0) continue;
    const dvec3 c = glm::cross(s, ray.direction);
    const double p = -glm::dot(v, c) / d, q = glm::dot(u, c) / d, t = -glm::dot(s, n) / d;
    if (p < 0 || q < 0 || p + q > 1 || t < 0 || (any && t >= distance)) continue;
    any = true;
    distance = t;
    const dvec3 b = then[indices[i]];
    before = b + p * (then[indices[i + 1]] - b) + q * (then[indices[i + 2]] - b);
  }
  return any;
}

std::vector<dvec3> standing(const Scene& scene, Id<Instance> id) {
  std::vector<dvec3> out;
  for (const Vertex& v : deformedBy(scene, *scene.instances.get(id))) out.push_back(v.position);
  return out;
}

}  // namespace

TEST_CASE("motion vectors of rigid, skinned and morphed instances agree with an oracle in double, far from the origin too", "[temporal]") {
  for (const char* kind : {"rigid", "skinned", "morphed", "crowd"})
    for (const bool orthographic : {false, true})
      for (const dvec3 origin : {dvec3(0), dvec3(1e6, 2e5, -3e5)}) {
        CAPTURE(kind, orthographic, origin.x);
        const std::string_view what(kind);
        Arm arm(4, what == "skinned" ? origin : dvec3(0), what == "morphed");
        Scene& scene = arm.scene;
        Instance& row = *scene.instances.edit(arm.instance);
        std::vector<Id<Instance>> all{arm.instance};
        if (what != "skinned") {
          row.skin = {};
          scene.nodes.edit(row.node)->local = translation(origin);
        }
        if (what == "morphed") row.morphWeights = {0.3f, 0.5f, -0.4f};
        if (what == "crowd")  // drawn by one call: the depth that vectors are drawn onto is an instanced program's
          for (int k = 1; k < 12; ++k) {
            Instance more = *scene.instances.get(arm.instance);
            more.node = addNode(scene, translation(origin + dvec3(0.1 * k, 0.13 * (k % 5) - 0.3, -0.3 * k)));
            all.push_back(scene.instances.add(more));
          }
        if (scene.meshes.get(arm.mesh)->joints.size() && what != "skinned") {
          Mesh plain = *scene.meshes.get(arm.mesh);
          plain.joints.clear();
          plain.weights.clear();
          *scene.meshes.edit(arm.mesh) = plain;
        }
        const auto move = [&](int i) {
          if (what == "skinned") {
            arm.turn(1, 0.2 + 0.06 * i);
            arm.turn(2, -0.5 - 0.05 * i, {0, 1, 1});
          } else {
            for (std::size_t k = 0; k < all.size(); ++k) {
              glm::dmat4& local = scene.nodes.edit(scene.instances.get(all[k])->node)->local;
              local = glm::rotate(translation(dvec3(local[3]) + dvec3(0.02, 0.01 * double(k % 3), -0.015)), 0.03 * i, dvec3(0, 0.3, 1));
            }
            if (what == "morphed") scene.instances.edit(arm.instance)->morphWeights = {0.3f + 0.1f * float(i), 0.5f, -0.4f - 0.1f * float(i)};
          }
          View v = lookAt(origin + dvec3(1.3 + 0.03 * i, 0.4, 5), origin + dvec3(1.4, 0.1, 0), {0, 1, 0}, 0.6f);
          v.orthographic = orthographic;
          v.height = 3;
          v.far = 40;
          return v;
        };
        Easel easel;
        Quality q = temporal();
        q.exposureEv = 5;
        View then, now;
        std::vector<std::vector<dvec3>> before, at;
        for (int i = 0; i < 3; ++i) {
          then = now;
          now = move(i);
          before = at;
          at.clear();
          for (Id<Instance> id : all) at.push_back(standing(scene, id));
          easel.develop(scene, {&now, 1}, kSize, q);
        }
        REQUIRE(easel.stage.renderer->lastPlan().on("motion_vectors"));
        const Held velocity = heldBy(easel, "velocity");
        REQUIRE(velocity.size == kSize);
        const glm::dvec2 jitter = plan::jitterOf(2);
        const std::vector<std::uint32_t>& indices = scene.meshes.get(arm.mesh)->indices;
        double worst = 0, farthest = 0, longest = 0;
        int compared = 0, edges = 0;
        for (int y = 0; y < kSize.y; ++y)
          for (int x = 0; x < kSize.x; ++x) {
            const glm::dvec2 sampled = glm::dvec2(x + 0.5, y + 0.5) + jitter;
            const Ray ray = rayThrough(now, kSize, sampled.x, kSize.y - sampled.y);
            double distance = 0;
            dvec3 was(0), nearest(0);
            bool any = false;
            for (std::size_t k = 0; k < all.size(); ++k) {
              double d = distance;
              if (!hit(ray, at[k], before[k], indices, d, was) || (any && d >= distance)) continue;
              any = true;
              distance = d;
              nearest = was;
            }
            const vec4 got = velocity.texels[std::size_t(y * kSize.x + x)];
            edges += any != (got.w > 0.5f);
            if (!any || got.w < 0.5f) continue;
            const dvec3 wanted = pixelOf(then, nearest);
            const double error = glm::length(glm::dvec2(got.x, got.y) + sampled - glm::dvec2(wanted));
            longest = std::max(longest, glm::length(glm::dvec2(got.x, got.y)));
            // Where two surfaces meet, the ray and the rasteriser may disagree on which is seen.
            if (error > 0.3) {
              ++edges;
              continue;
            }
            ++compared;
            worst = std::max(worst, error);
            farthest = std::max(farthest, std::abs(double(got.z) * wanted.z - 1));
          }
        std::cout << fmt::format("  {:<8} {:<12} {:>7.0e} m: {} pixels, off by at most {:.4f} pixels of up to {:.1f}, distance by {:.5f}; {} at edges differ\n", kind, orthographic ? "orthographic" : "perspective", origin.x,
                                 compared, worst, longest, farthest, edges);
        CHECK(compared > 200);
        CHECK(edges < compared / 25);
        CHECK(worst < 0.02);  // half floats hold 8 pixels to 1/256; 16-bit positions of the raster 1/256 too
        CHECK(farthest < 2e-3);
        CHECK(longest > 0.8);
      }
}
