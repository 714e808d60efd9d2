#include "zero_cost/cases.h"

#include <map>

#include "image/resample.h"
#include "paths.h"
#include "render/transparent.h"

namespace burnish::test {
namespace {

template <class F>
void eachMaterial(Subject& s, F&& f) {
  std::vector<Id<Material>> ids;
  s.scene.materials.each([&](Id<Material> id, const Material&) { ids.push_back(id); });
  for (const Id<Material> id : ids) f(*s.scene.materials.edit(id));
}
template <class F>
void eachInstance(Subject& s, F&& f) {
  std::vector<Id<Instance>> ids;
  s.scene.instances.each([&](Id<Instance> id, const Instance&) { ids.push_back(id); });
  for (const Id<Instance> id : ids) f(*s.scene.instances.edit(id));
}
void enableLights(Subject& s, bool directional, bool enabled) {
  std::vector<Id<Light>> ids;
  s.scene.lights.each([&](Id<Light> id, const Light& l) {
    if ((l.kind == LightKind::Directional) == directional) ids.push_back(id);
  });
  for (const Id<Light> id : ids) s.scene.lights.edit(id)->enabled = enabled;
}
void setEnvironment(Subject& s, float scale, bool background) {
  Environment& e = s.scene.environment;
  e.scale = scale;
  e.background = background;
  if (scale > 0) e.color = {0.5f, 0.6f, 0.8f};
  ++e.revision;
}
Material& ballsMaterial(Subject& s) { return *s.scene.materials.edit(s.scene.materials.at(1)); }

// ---- called by the scene ----

constexpr EffectCase kGeometry{"geometry", [](Subject& s) { eachInstance(s, [](Instance& i) { i.visible = false; }); }, [](Subject& s) { eachInstance(s, [](Instance& i) { i.visible = true; }); }};

constexpr EffectCase kDeformation{"deformation",
                                  [](Subject& s) {
                                    eachInstance(s, [](Instance& i) {
                                      i.skin = {};
                                      i.morphWeights.clear();
                                    });
                                  },
                                  [](Subject& s) {
                                    const Id<Instance> id = s.scene.instances.at(1);
                                    Mesh& mesh = *s.scene.meshes.edit(s.scene.instances.get(id)->mesh);
                                    MorphTarget wider;
                                    for (const vec3& p : mesh.positions) wider.positions.push_back(p * vec3(0.3f, 0, 0));
                                    mesh.targets.push_back(wider);
                                    s.scene.instances.edit(id)->morphWeights = {1};
                                  }};

constexpr EffectCase kTwoSided{"two_sided", [](Subject& s) { eachMaterial(s, [](Material& m) { m.twoSided = false; }); }, [](Subject& s) { ballsMaterial(s).twoSided = true; }};
constexpr EffectCase kAlphaTest{"alpha_test", [](Subject& s) { eachMaterial(s, [](Material& m) { m.alphaTest = false; }); }, [](Subject& s) { ballsMaterial(s).alphaTest = true; }};

constexpr EffectCase kBakedOcclusion{"baked_occlusion", [](Subject& s) { eachMaterial(s, [](Material& m) { m.occlusionStrength = 0; }); },
                                     [](Subject& s) {
                                       const Id<Texture> map = s.scene.textures.add(painted(MapKind::Occlusion, 8, [](float u, float) { return vec4(u, 1, 0, 0); }));
                                       ballsMaterial(s).mapC = map;
                                       ballsMaterial(s).occlusionStrength = 1;
                                       setEnvironment(s, 1, false);
                                     }};

constexpr EffectCase kAnisotropy{"anisotropy", [](Subject& s) { eachMaterial(s, [](Material& m) { m.anisotropy = 0; }); },
                                 [](Subject& s) {
                                   ballsMaterial(s).anisotropy = 0.8f;
                                   ballsMaterial(s).anisotropyRotation = 0.5f;
                                 }};
constexpr EffectCase kRoughDiffuse{"rough_diffuse", [](Subject& s) { eachMaterial(s, [](Material& m) { m.diffuseRoughness = 0; }); }, [](Subject& s) { ballsMaterial(s).diffuseRoughness = 0.4f; }};

constexpr EffectCase kEmissive{"emissive",
                               [](Subject& s) {
                                 eachMaterial(s, [](Material& m) {
                                   m.emission = vec3(0);
                                   m.unlit = false;
                                 });
                               },
                               [](Subject& s) { ballsMaterial(s).emission = vec3(2); }};

constexpr EffectCase kAlphaBlend{"alpha_blend", [](Subject& s) { eachMaterial(s, [](Material& m) { m.blend = false; }); },
                                 [](Subject& s) {
                                   Material m;
                                   m.blend = true;
                                   m.opacity = 0.5f;
                                   place(s.scene, quad({0.6f, 0.2f, 1.5f}, {0.4f, 0, 0}, {0, 0.4f, 0}), m);
                                 }};

constexpr EffectCase kGlass{"glass", [](Subject& s) { eachMaterial(s, [](Material& m) { m.transmission = 0; }); },
                            [](Subject& s) { place(s.scene, sphere(0.5f, 12, 24), glassOf(1.5f, 1), translation({0.7, 0, 1.2})); }};

constexpr EffectCase kFog{"fog", [](Subject& s) { s.scene.fog.density = 0; }, [](Subject& s) { s.scene.fog.density = 0.1f; }};
constexpr EffectCase kDirectionalLights{"directional_lights", [](Subject& s) { enableLights(s, true, false); }, [](Subject& s) { enableLights(s, true, true); }};

constexpr EffectCase kLocalLights{"local_lights", [](Subject& s) { enableLights(s, false, false); },
                                  [](Subject& s) {
                                    addLight(s.scene, light(LightKind::Point, {1, 0.6f, 0.3f}, 20, 4), {-1.2, 1, 1});
                                    addLight(s.scene, light(LightKind::Spot, {0.4f, 0.6f, 1}, 30, 6), {1, 2, 1}, {-0.5, -1, -0.5});
                                  }};

constexpr EffectCase kShadows{"shadows",
                              [](Subject& s) {
                                std::vector<Id<Light>> ids;
                                s.scene.lights.each([&](Id<Light> id, const Light&) { ids.push_back(id); });
                                for (const Id<Light> id : ids) s.scene.lights.edit(id)->castsShadow = false;
                              },
                              [](Subject& s) {
                                std::vector<Id<Light>> ids;
                                s.scene.lights.each([&](Id<Light> id, const Light&) { ids.push_back(id); });
                                for (const Id<Light> id : ids) s.scene.lights.edit(id)->castsShadow = true;
                              }};
constexpr EffectCase kEnvironmentLighting{"environment_lighting", [](Subject& s) { setEnvironment(s, 0, false); }, [](Subject& s) { setEnvironment(s, 1, false); }};
constexpr EffectCase kReflectionProbes{"reflection_probes",
                                       [](Subject& s) {
                                         s.scene.probes.reflections.clear();
                                         ++s.scene.probes.revision;
                                       },
                                       [](Subject& s) {
                                         ReflectionProbe p;
                                         p.halfSize = {1.5, 1, 1.5};
                                         p.irradiance[0] = {2, 1.5, 1};
                                         for (const int size : {16, 8}) {
                                           CubeLevel level;
                                           level.size = size;
                                           for (int i = 0; i < 18 * size * size; ++i) level.texels.push_back(0.5f + 0.1f * float(i % 7));
                                           p.radiance.levels.push_back(std::move(level));
                                         }
                                         s.scene.probes.reflections.push_back(std::move(p));
                                         ++s.scene.probes.revision;
                                       }};
constexpr EffectCase kAmbientGrid{"ambient_grid",
                                  [](Subject& s) {
                                    s.scene.probes.grid.reset();
                                    ++s.scene.probes.revision;
                                  },
                                  [](Subject& s) {
                                    AmbientGrid& g = s.scene.probes.grid.emplace();
                                    g.origin = {-2, -1, -2};
                                    g.spacing = {2, 1, 2};
                                    g.counts = {3, 3, 3};
                                    for (int i = 0; i < 27; ++i) {
                                      AmbientGrid::Point& p = g.points.emplace_back();
                                      p.valid = true;
                                      p.irradiance[0] = vec3(0.5f + 0.1f * float(i % 4), 0.6f, 0.7f);
                                      p.irradiance[1] = vec3(0.1f * float(i % 3));
                                      p.distances.assign(AmbientGrid::kDistanceSize * AmbientGrid::kDistanceSize, {3, 9});
                                    }
                                    ++s.scene.probes.revision;
                                  }};
constexpr EffectCase kBackground{"background", [](Subject& s) { s.scene.environment.background = false; }, [](Subject& s) { setEnvironment(s, 1, true); }};

constexpr EffectCase kSunDisc{"sun_disc", [](Subject& s) { s.scene.environment.sun.reset(); },
                              [](Subject& s) {
                                setEnvironment(s, 1, true);
                                Environment::Sun& sun = s.scene.environment.sun.emplace();
                                sun.toSun = glm::normalize(vec3(s.view.axes * glm::dvec3(0.2, 0.2, -1)));
                                sun.radiance = vec3(1e4f);
                                sun.radius = 0.05f;
                              }};

// ---- called by settings ----

constexpr EffectCase kForwardReference{"forward_reference", [](Subject& s) { s.quality.path = Path::Deferred; }, [](Subject& s) { s.quality.path = Path::Forward; }};

constexpr EffectCase kScreenOcclusion{"screen_occlusion", [](Subject& s) { s.quality.occlusion = std::min(s.quality.occlusion, Occlusion::Baked); },
                                      [](Subject& s) {
                                        s.quality.occlusion = Occlusion::Screen4;
                                        setEnvironment(s, 1, false);
                                      }};

constexpr EffectCase kAutoExposure{"auto_exposure",
                                   [](Subject& s) {
                                     if (!s.quality.exposureEv) s.quality.exposureEv = 3;
                                   },
                                   [](Subject& s) { s.quality.exposureEv.reset(); }};
constexpr EffectCase kBloom{"bloom", [](Subject& s) { s.quality.bloom = Bloom::None; }, [](Subject& s) { s.quality.bloom = Bloom::Scatter; }};
constexpr EffectCase kToneMapping{"tone_mapping", [](Subject& s) { s.output = Output::Linear; }, [](Subject& s) { s.output = Output::Display; }};
constexpr EffectCase kEdgeAntialiasing{"edge_antialiasing", [](Subject& s) { s.quality.antialiasing = Antialiasing::None; }, [](Subject& s) { s.quality.antialiasing = Antialiasing::Edge; }};
constexpr EffectCase kTemporalAntialiasing{"temporal_antialiasing", [](Subject& s) { s.quality.antialiasing = Antialiasing::None; }, [](Subject& s) { s.quality.antialiasing = Antialiasing::Temporal; }};
constexpr EffectCase kMotionVectors{"motion_vectors", [](Subject& s) { s.moves = false; },
                                    [](Subject& s) {
                                      s.quality.antialiasing = Antialiasing::Temporal;
                                      s.moves = true;
                                    }};
constexpr EffectCase kUpscaling{"upscaling", [](Subject& s) { s.quality.resolutionScale = 1; }, [](Subject& s) { s.quality.resolutionScale = 0.5f; }};
constexpr EffectCase kLinearOutput{"linear_output", [](Subject& s) { s.output = Output::Display; }, [](Subject& s) { s.output = Output::Linear; }};
constexpr EffectCase kDebugView{"debug_view", [](Subject& s) { s.debugView = DebugView::Final; }, [](Subject& s) { s.debugView = DebugView::Normal; }};
constexpr EffectCase kHostDepthIn{"host_depth_in", [](Subject& s) { s.hostDepthIn = false; }, [](Subject& s) { s.hostDepthIn = true; }};
constexpr EffectCase kHostDepthOut{"host_depth_out", [](Subject& s) { s.hostDepthOut = false; }, [](Subject& s) { s.hostDepthOut = true; }};
constexpr EffectCase kHostDraw{"host_draw", [](Subject& s) { s.hostDraw = false; }, [](Subject& s) { s.hostDraw = true; }};
constexpr EffectCase kNonfiniteCount{"nonfinite_count", [](Subject& s) { s.countNonfinite = false; }, [](Subject& s) { s.countNonfinite = true; }};

constexpr EffectCase kCases[] = {
    kGeometry,
    kDeformation,
    kTwoSided,
    kAlphaTest,
    kAnisotropy,
    kRoughDiffuse,
    kEmissive,
    kAlphaBlend,
    kGlass,
    kFog,
    kDirectionalLights,
    kLocalLights,
    kShadows,
    kEnvironmentLighting,
    kReflectionProbes,
    kAmbientGrid,
    kBackground,
    kBakedOcclusion,
    kSunDisc,
    kForwardReference,
    kScreenOcclusion,
    kAutoExposure,
    kBloom,
    kToneMapping,
    kEdgeAntialiasing,
    kTemporalAntialiasing,
    kMotionVectors,
    kUpscaling,
    kLinearOutput,
    kDebugView,
    kHostDepthIn,
    kHostDepthOut,
    kHostDraw,
    kNonfiniteCount,
};

void shrink(Scene& scene) {
  std::vector<Id<Texture>> ids;
  scene.textures.each([&](Id<Texture> id, const Texture&) { ids.push_back(id); });
  for (const Id<Texture> id : ids) {
    Texture& t = *scene.textures.edit(id);
    t.image = image::resampleArea(t.image, std::min(t.image.width, 4), std::min(t.image.height, 4));
  }
  // A picture of the surroundings is filtered anew by each renderer, which is most of what a frame takes here: but for the long run, its mean stands for it.
  Environment& e = scene.environment;
  if (e.map.empty() || std::getenv("BURNISH_LONG")) return;
  const Image mean = image::resampleArea(e.map, 1, 1);
  for (int c = 0; c < 3; ++c) e.color[c] = mean.f32()[c];
  e.map = {};
}

}  // namespace

std::span<const EffectCase> effectCases() { return kCases; }

const EffectCase* caseOf(std::string_view effect) {
  const auto found = std::find_if(std::begin(kCases), std::end(kCases), [&](const EffectCase& c) { return c.effect == effect; });
  return found == std::end(kCases) ? nullptr : found;
}

Subject stand() {
  Subject s;
  s.name = "stand";
  s.view = lookAt({0, 1, 5}, {0, 0, 0}, {0, 1, 0}, 0.6f);
  s.quality.exposureEv = 2.0f;
  Material floor, ball;
  floor.albedo = {0.5f, 0.5f, 0.45f};
  ball.albedo = {0.7f, 0.3f, 0.2f};
  ball.roughness = 0.4f;
  place(s.scene, box({-2, -0.9f, -2}, {2, -0.8f, 2}), floor);
  place(s.scene, sphere(0.8f, 16, 32), ball, translation({-0.4, 0, 0}));
  addLight(s.scene, light(LightKind::Directional, {1, 0.95f, 0.9f}, 12), {}, {-0.4, -1, -0.6});
  return s;
}

const Subject& sample(std::string_view name) {
  static std::map<std::string, Subject, std::less<>> loaded;
  if (const auto found = loaded.find(name); found != loaded.end()) return found->second;
  const auto decoder = makeDecoderPool({.helper = BURNISH_BINARY_DIR "/bin/burnish-decode"});
  Report report;
  auto scene = loadScene(fmt::format(BURNISH_BINARY_DIR "/share/burnish/samples/{0}/{0}.gltf", name), {.decoder = decoder.get()}, report);
  if (!scene) FAIL(scene.error().message());
  Subject s;
  s.name = name;
  s.scene = std::move(*scene);
  s.scene.cameras.each([&](Id<Camera>, const Camera& camera) {
    if (camera.name == "hero") s.view = viewOf(s.scene, camera);
  });
  shrink(s.scene);
  return loaded.emplace(name, std::move(s)).first->second;
}

}  // namespace burnish::test
