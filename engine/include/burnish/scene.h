// The scene: plain tables of meshes, textures, materials, nodes, instances, lights, cameras, skins and animations. Everything that a file brings can be built and changed here.
// Units: metres, seconds, lux (directional lights), candela (point and spot lights), candela per square metre (emission, environment). Right-handed, Y up.
// Ownership: the scene owns everything by value. A Scene may be read by several renderers at once; changing it while one renders it is the caller's to prevent.
#pragma once
#include <burnish/image.h>
#include <burnish/material.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace burnish {

/// Names a row of a Table. Stale ids (of removed rows) are recognised by their generation.
template <class T>
struct Id {
  std::uint32_t index = 0xffffffffu;
  std::uint32_t generation = 0;
  [[nodiscard]] explicit operator bool() const { return index != 0xffffffffu; }
  friend bool operator==(Id, Id) = default;
};

/// A growing table with stable ids. Each row has a revision that `edit` advances: whoever mirrors the table (the GPU side) compares it to see what to upload.
template <class T>
class Table {
 public:
  Id<T> add(T value) {
    ++revision_;
    if (!free_.empty()) {
      const std::uint32_t i = free_.back();
      free_.pop_back();
      rows_[i].value = std::move(value);
      rows_[i].alive = true;
      rows_[i].revision = revision_;
      return {i, rows_[i].generation};
    }
    rows_.push_back({std::move(value), revision_, 0, true});
    return {std::uint32_t(rows_.size() - 1), 0};
  }
  /// nullptr when the id is empty or stale.
  [[nodiscard]] const T* get(Id<T> id) const { return has(id) ? &rows_[id.index].value : nullptr; }
  /// For changing a row; advances its revision. nullptr when the id is empty or stale.
  [[nodiscard]] T* edit(Id<T> id) {
    if (!has(id)) return nullptr;
    rows_[id.index].revision = ++revision_;
    return &rows_[id.index].value;
  }
  /// Frees the row; false when the id is empty or stale.
  bool remove(Id<T> id) {
    if (!has(id)) return false;
    rows_[id.index].value = T{};
    rows_[id.index].alive = false;
    ++rows_[id.index].generation;
    rows_[id.index].revision = ++revision_;
    free_.push_back(id.index);
    return true;
  }
  [[nodiscard]] bool has(Id<T> id) const { return id.index < rows_.size() && rows_[id.index].alive && rows_[id.index].generation == id.generation; }
  [[nodiscard]] std::size_t size() const { return rows_.size() - free_.size(); }
  [[nodiscard]] std::size_t capacity() const { return rows_.size(); }  ///< one past the largest index in use
  [[nodiscard]] std::uint64_t revision() const { return revision_; }   ///< advances with every change of the table
  [[nodiscard]] std::uint64_t revision(Id<T> id) const { return has(id) ? rows_[id.index].revision : 0; }
  /// The id of the row at an index, empty when the row is free.
  [[nodiscard]] Id<T> at(std::uint32_t index) const { return index < rows_.size() && rows_[index].alive ? Id<T>{index, rows_[index].generation} : Id<T>{}; }
  /// f(Id<T>, const T&) for each row in order of index.
  template <class F>
  void each(F&& f) const {
    for (std::uint32_t i = 0; i < rows_.size(); ++i)
      if (rows_[i].alive) f(Id<T>{i, rows_[i].generation}, rows_[i].value);
  }

 private:
  struct Row {
    T value;
    std::uint64_t revision;
    std::uint32_t generation;
    bool alive;
  };
  std::vector<Row> rows_;
  std::vector<std::uint32_t> free_;
  std::uint64_t revision_ = 0;
};

struct Bounds {
  glm::vec3 min{std::numeric_limits<float>::infinity()}, max{-std::numeric_limits<float>::infinity()};
  [[nodiscard]] bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
};

/// What a weight of 1 adds to a mesh's vertices. Streams are empty (nothing is added) or as long as the mesh's positions.
struct MorphTarget {
  std::string name;
  std::vector<glm::vec3> positions;  ///< metres
  std::vector<glm::vec3> normals;    ///< added to unit normals; the sum is made unit length again
  std::vector<glm::vec3> tangents;   ///< added to the tangents' xyz
};

/// One indexed triangle list with one material slot. Streams are empty or as long as `positions`.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;  ///< metres, finite
  std::vector<glm::vec3> normals;    ///< unit; empty: face normals are made when the mesh is validated
  std::vector<glm::vec4> tangents;   ///< xyz unit, w = +1 or -1 (bitangent = w · n × t); empty: made on demand when a material has a normal map
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;  ///< linear, multiplies albedo and opacity
  std::vector<std::uint32_t> indices;  ///< multiple of 3, each < positions.size()
  // What moves its vertices; it shows on instances with a Skin (joints, weights) or with morph weights (targets).
  std::vector<glm::u16vec4> joints;  ///< indices into Skin::joints, four a vertex
  std::vector<glm::vec4> weights;    ///< of those joints, 0..1 with sum 1; empty exactly if `joints` is
  std::vector<MorphTarget> targets;
};

/// Checks sizes and index ranges, replaces non-finite values, unit-normalises or makes normals, scales joint weights to sum 1, drops what cannot be drawn. Errors name the
/// stream.
BURNISH_API Result<Mesh> validated(Mesh mesh, Report& report);
/// Fills `tangents` by the MikkTSpace rules (needs positions, normals, uv0); may split vertices.
BURNISH_API void makeTangents(Mesh& mesh);
BURNISH_API Bounds boundsOf(const Mesh& mesh);

enum class Wrap : std::uint8_t { Repeat, ClampToEdge, MirroredRepeat };
struct Sampler {
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  bool magnifyLinear = true, minifyLinear = true, mipLinear = true, mips = true;
  friend bool operator==(const Sampler&, const Sampler&) = default;
};

struct Texture {
  std::string name;
  MapKind kind = MapKind::AlbedoSubstance;
  Sampler sampler;
  Image image;  ///< U8; 4 channels for A and B, 1 or 2 for C, 3 or 4 for Emissive and MetalRough
};

/// u' = transform · (u, v, 1), applied to uv set `set` (0 or 1).
struct UvMapping {
  int set = 0;
  glm::mat3x2 transform{1, 0, 0, 1, 0, 0};  ///< columns: u axis, v axis, offset
  friend bool operator==(const UvMapping&, const UvMapping&) = default;
};

/// Where a material has no map, a 1x1 default stands in: white albedo and plastic for A, flat normal and roughness 1 for B, no occlusion, opaque.
struct Material {
  std::string name;
  Id<Texture> mapA, mapB, mapC, emissiveMap, metalRoughMap;
  UvMapping uvA, uvB, uvC, uvEmissive, uvMetalRough;
  glm::vec3 albedo{1};          ///< multiplies map A's albedo, linear, 0..1
  float substance = 1.0f / 3;   ///< code 0..1 where mapA is empty; with a map A its alpha decides
  float roughness = 1;          ///< multiplies map B's roughness, 0..1
  float occlusionStrength = 1;  ///< 0..1, as glTF's
  glm::vec3 emission{0};        ///< cd/m², multiplies the emissive map
  /// With blend: the pigment's share of what enters the surface, 0 (clear) to 1 (opaque); reflections keep their strength. With alphaTest: multiplies map C's opacity.
  float opacity = 1;
  float alphaCutoff = 0.5f;  ///< with alphaTest: fragments below are discarded
  bool alphaTest = false;
  bool blend = false;  ///< drawn over what is behind it; map C's opacity and the vertex colour's alpha are the share of a pixel that the surface covers
  bool twoSided = false;
  bool unlit = false;  ///< KHR_materials_unlit: albedo is shown as emission of 1 cd/m² × `unlitScale`
  bool useVertexColor = true;
  float metalness = 0;  ///< factor for metalRoughMap only

  // Glass: transmission above 0. It is drawn after everything opaque and shows what is behind it.
  float transmission = 0;          ///< 0..1: the share of what enters the surface that crosses it, tinted by albedo; the rest meets the diffuse pigment
  float thickness = 0;             ///< metres in the mesh's space along the normal, scaled as the instance is; 0: a thin pane, which shifts nothing and absorbs nothing
  glm::vec3 attenuationColor{1};   ///< 0..1, what white light becomes over attenuationDistance inside
  float attenuationDistance = 0;   ///< metres; 0 (or infinite): nothing is absorbed
  float ior = 0;                   ///< of glass, at least 1: it then gives F0 too; 0: follows from the substance's F0

  /// Strength of brushing, 0 (none) to 1, as KHR_materials_anisotropy has it: with alpha = roughness², alpha_t = mix(alpha, 1, strength²) along the direction t and
  /// alpha_b = alpha across it.
  float anisotropy = 0;
  float anisotropyRotation = 0;  ///< radians, any; counter-clockwise from the tangent: t = cos · tangent + sin · bitangent
  /// Oren and Nayar's sigma, 0 to 1: the standard deviation of the angle of the diffuse surface's facets, radians (plaster 0.3, clay and moon dust 0.5). 0: as the diffuse term has it.
  float diffuseRoughness = 0;

  // The G-buffer does not carry what follows: the deferred path draws Schlick's F of F0; the forward reference path uses it.
  /// A named conductor's Substance::eta and k (above 0), for the exact conductor Fresnel equation, which then gives the reflectance at normal incidence too;
  /// both 0: not a named conductor.
  glm::vec3 conductorEta{0}, conductorK{0};
};

/// A transform in the hierarchy.
struct Node {
  std::string name;
  Id<Node> parent;
  glm::dmat4 local{1};  ///< column vectors; any affine matrix, negative and singular ones included
};
/// The joints that meshes hang on. A vertex at v in the mesh's own space stands, in the world, at the sum over its joints of weight · world(joint) · inverseBind · v.
struct Skin {
  std::string name;
  std::vector<Id<Node>> joints;         ///< at most 65535; a joint whose node is gone counts as the identity
  std::vector<glm::mat4> inverseBind;   ///< mesh space to joint space in the bind pose, affine, one a joint; those that are missing or not finite are the identity
};

struct Instance {
  std::string name;
  Id<Node> node;
  Id<Mesh> mesh;
  Id<Material> material;
  bool visible = true;
  Id<Skin> skin;                    ///< its joints place the vertices: the instance's own node then counts for nothing (glTF 2.0, section 3.7.3.3)
  std::vector<float> morphWeights;  ///< of Mesh::targets in order, any finite number; those that are missing are 0
  bool castsShadow = true;          ///< in the light of lights that cast shadows; blended and glass surfaces cast none (docs/shadows.md)
};

enum class Interpolation : std::uint8_t {
  Step,         ///< the value of the key frame before
  Linear,       ///< rotations: spherical, the shorter way round
  CubicSpline,  ///< Hermite spline; a key frame holds in-tangent, value, out-tangent (glTF 2.0, appendix C.5)
};
/// Values over time. Before the first key frame its value holds, after the last one the last one's.
struct Curve {
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> times;   ///< seconds, strictly growing, finite
  std::vector<float> values;  ///< key frame by key frame: 3 (translation, scale), 4 (rotation: x, y, z, w) or as many numbers as there are morph weights; CubicSpline: three times as many
};
struct Animation {
  /// A node's translation, rotation and scale. What has no curve (-1) keeps its rest value.
  struct NodeTrack {
    Id<Node> node;
    glm::dvec3 restTranslation{0};            ///< metres
    glm::dquat restRotation{1, 0, 0, 0};      ///< unit
    glm::dvec3 restScale{1};
    int translation = -1, rotation = -1, scale = -1;  ///< indices into `curves`
  };
  /// Instances' morph weights.
  struct WeightTrack {
    std::vector<Id<Instance>> instances;
    int width = 0;   ///< weights a key frame
    int curve = -1;  ///< index into `curves`
  };
  std::string name;
  std::vector<Curve> curves;
  std::vector<NodeTrack> nodes;
  std::vector<WeightTrack> weights;

  /// Seconds to the last key frame of all curves; 0 without any (every time is then 0).
  [[nodiscard]] BURNISH_API double length() const;
  /// `time` brought into 0 <= t < length(): the animation loops, negative times count back from its end, a time that is not finite is 0.
  [[nodiscard]] BURNISH_API double looped(double time) const;
};

/// The curve at a time: `width` numbers into `out`, in double. `rotation`: width is 4 and the result a unit quaternion (x, y, z, w). False, and `out` untouched, where the curve is
/// empty, its sizes disagree with `width` or the result is not finite.
BURNISH_API bool evaluate(const Curve& curve, double time, int width, bool rotation, double* out);

enum class LightKind : std::uint8_t { Directional, Point, Spot };
/// A punctual light; shines along its node's -Z (KHR_lights_punctual).
struct Light {
  std::string name;
  LightKind kind = LightKind::Point;
  Id<Node> node;
  glm::vec3 color{1};     ///< linear Rec.709
  float intensity = 1;    ///< lux (directional) or candela
  float range = 0;        ///< metres; 0: none given, one follows from Quality::lightThreshold and the loss is reported
  float innerCone = 0;    ///< radians from the axis, 0 <= inner <= outer
  float outerCone = 0.7853982f;  ///< radians, at most pi/2
  bool enabled = true;
  bool castsShadow = false;      ///< what stands in its light keeps it from what is behind (docs/shadows.md)
  bool standIn = false;          ///< stands for light that probes bring (bounced light, the sky in a doorway): off while the scene has probes with light, and while they are baked
  // Its size, which is how soft its shadows are with shadow=pcss; the light itself stays punctual.
  float sourceRadius = 0.02f;        ///< metres, of a point or spot light
  float angularDiameter = 0.0093f;   ///< radians, of a directional light; the sun's from the earth
};

struct Camera {
  std::string name;
  Id<Node> node;  ///< looks along -Z
  bool orthographic = false;
  float fovY = 0.8726646f;  ///< vertical, radians (perspective)
  float height = 2;         ///< metres, full height of the view (orthographic)
  float near = 0.05f;       ///< metres
  float far = 0;            ///< metres; 0: infinite (perspective). Orthographic cameras need one.
};

/// The light of the surroundings, seen as background and reflected.
struct Environment {
  /// A disc in the background of perspective views, with smooth edges. It lights nothing: that is a directional light's.
  struct Sun {
    glm::vec3 toSun{0, 1, 0};  ///< world, unit
    glm::vec3 radiance{0};     ///< cd/m², whatever `scale` is
    float radius = 0.004652f;  ///< radians, above 0
    float horizon = -2;        ///< sine of the elevation under which it is hidden; -2: nowhere
  };
  Image map;               ///< lat-long F32 RGB(A), cd/m² × scale; +Y up, centre column looks along -Z as glTF viewers do; empty: `color`
  glm::vec3 color{0};      ///< cd/m², used without a map
  float scale = 1;
  bool background = true;  ///< draw it where nothing else is
  std::uint64_t revision = 0;  ///< advance it when the map, the colour or its filter changes
  std::optional<Sun> sun;
  /// How the map is filtered for reflections (docs/storage.md): texels along an edge of the cube, a power of two, 16 to 1024, and the error that is allowed, as PrefilterOptions has it.
  int filterSize = 256;
  double filterError = 1e-4;
};

/// Sun and sky of a clear day (docs/sky_and_fog.md).
struct SunSky {
  glm::vec3 toSun{0.35f, 0.6f, -0.7f};  ///< world, any length
  float turbidity = 2.5f;               ///< 1 (clean air) to 10 (thick haze)
  glm::vec3 ground{0.2f};               ///< albedo of the land around, 0..1
  float altitude = 2;                   ///< metres of the eye above that land, 1 to 50000
};

/// Fog that thins with height, lit by suns and surroundings (docs/sky_and_fog.md). Its extinction, h metres above `height`, is density · exp(-falloff · h).
struct Fog {
  float density = 0;    ///< 1/m: the share of light that a metre takes, at `height`; 0: there is no fog
  float falloff = 0;    ///< 1/m: every 1/falloff metres upward it is thinner by e; 0: it is even everywhere, and hides the background
  float height = 0;     ///< metres, world Y
  glm::vec3 albedo{1};  ///< 0..1: what it scatters of the light that it takes; the rest is absorbed
  float anisotropy = 0; ///< -0.95..0.95, mean cosine of the scattering angle (Henyey and Greenstein's g): above 0 it is brightest around the sun, as haze is
  float start = 0;      ///< metres from the eye that are clear
};

/// A place from which the surroundings were captured, and the box on whose walls reflections of it are looked up (docs/probes.md).
struct ReflectionProbe {
  std::string name;
  glm::dvec3 center{0};    ///< of the box, world, metres
  glm::dmat3 axes{1};      ///< of the box: columns unit and orthogonal, world
  glm::dvec3 halfSize{1};  ///< metres along the axes, at least 0
  glm::dvec3 capture{0};   ///< where the surroundings were captured, world, metres
  glm::dvec3 fade{0.5};    ///< metres inside each pair of faces over which it takes over from larger boxes; held at the half size
  double margin = 0.25;    ///< metres around the box over which it gives way to the sky, where there is no other box
  Cubemap radiance;        ///< cd/m², prefiltered, axes of the world; no levels: not baked, and left out by the renderer
  IrradianceSh irradiance{};  ///< of the capture, over π, cd/m²
};

/// Irradiance at the points of a lattice, with how far each of them sees, so that light does not pass through walls.
struct AmbientGrid {
  static constexpr int kDistanceSize = 16;  ///< texels along a side of an octahedral map of distances
  struct Point {
    bool valid = false;              ///< false: inside a wall or not baked; it lights nothing
    std::array<glm::vec3, 9> irradiance{};  ///< over π, cd/m²; basis of IrradianceSh
    std::vector<glm::vec2> distances;  ///< metres: mean and mean square of the distance over each texel's directions, kDistanceSize² texels (docs/probes.md has the mapping)
  };
  std::string name;
  glm::dvec3 origin{0};      ///< of point (0, 0, 0), world, metres
  glm::dmat3 axes{1};        ///< columns unit and orthogonal, world
  glm::dvec3 spacing{1};     ///< metres between neighbours along the axes, above 0
  glm::ivec3 counts{0};      ///< points along the axes, at least 1 each
  double margin = 0.25;      ///< metres around the lattice over which it gives way to what is there without it
  std::vector<Point> points;  ///< x fastest, then y; counts.x · counts.y · counts.z, or none: not baked
  [[nodiscard]] glm::dvec3 position(glm::ivec3 i) const { return origin + axes * (glm::dvec3(i) * spacing); }
};

/// The probes of a scene. burnish/probe.h places, bakes, reads and writes them.
struct ProbeSet {
  std::vector<ReflectionProbe> reflections;
  std::optional<AmbientGrid> grid;
  std::uint64_t revision = 0;  ///< advance it when anything here changes
  /// Some of it has been baked.
  [[nodiscard]] bool lit() const {
    for (const ReflectionProbe& probe : reflections)
      if (!probe.radiance.levels.empty()) return true;
    return grid && !grid->points.empty();
  }
};

/// Tells scenes apart, so that a renderer never takes one scene's tables for another's. Copies get an identity of their own; moving keeps it.
class BURNISH_API Identity {
 public:
  Identity();
  Identity(const Identity&) : Identity() {}
  Identity(Identity&& o) noexcept : value_(o.value_) { o.value_ = 0; }
  Identity& operator=(const Identity& o) { return *this = this == &o ? Identity(std::move(*this)) : Identity(); }
  Identity& operator=(Identity&& o) noexcept {
    std::swap(value_, o.value_);
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_;
};

struct Scene {
  Identity identity;
  std::string name;
  Table<Mesh> meshes;
  Table<Texture> textures;
  Table<Material> materials;
  Table<Node> nodes;
  Table<Instance> instances;
  Table<Light> lights;
  Table<Camera> cameras;
  Table<Skin> skins;
  Table<Animation> animations;
  Environment environment;
  Fog fog;
  ProbeSet probes;

  /// Product of the locals from the root down. Cycles are cut (the API cannot make one unless told to).
  [[nodiscard]] BURNISH_API glm::dmat4 world(Id<Node> node) const;
  /// Bounds of all visible instances in world space; empty without any.
  [[nodiscard]] BURNISH_API Bounds bounds() const;
};

/// Sets the locals of the animation's nodes and the morph weights of its instances to what they are at `time`, in seconds; each animation loops with its own length, so that
/// `time` counts modulo Animation::length() (negative and non-finite times: see there). Computed in double. Only rows that change are edited. Tracks whose row is gone or whose
/// curve cannot be evaluated (empty, sizes that disagree, a result that is not finite) leave it as it is.
BURNISH_API void animate(Scene& scene, Id<Animation> animation, double time);
/// The animations that play side by side: in order of the table each one that moves nothing that an earlier one moves.
BURNISH_API std::vector<Id<Animation>> playedTogether(const Scene& scene);
/// All that playedTogether() lists, at one time.
BURNISH_API void animate(Scene& scene, double time);
/// Checks the sizes of curves and the order of their times, and drops the tracks that use a faulty one, with one warning that counts them.
BURNISH_API Animation validated(Animation animation, Report& report);

/// Makes the environment (picture and disc) and the sun's light. `sun`: a directional light of the scene that becomes it, with a node of its own; empty: one is added. A sun under the
/// horizon is disabled. Numbers that are out of range are held, with a warning. It takes some tenths of a second: call it when the sky changes. Returns the light.
BURNISH_API Id<Light> setSky(Scene& scene, const SunSky& sky, Report& report, Id<Light> sun = {});

/// How a file becomes a scene.
struct LoadOptions {
  ImageDecoder* decoder = nullptr;  ///< not owned; nullptr: a pool of helper processes made for this call
  bool allowOutside = false;        ///< read paths outside the file's folder (never remote ones)
  std::uint64_t maxFileBytes = 2048ull * 1024 * 1024;
  double seconds = 0;               ///< 0: no limit
};
/// Reads glTF 2.0 (.gltf, .glb). Conversions, clamps and everything that the file asks for and the engine lacks are in `report`.
BURNISH_API Result<Scene> loadScene(const std::filesystem::path& file, const LoadOptions& options, Report& report);
/// Reads a lat-long picture (HDR, EXR; PNG and JPEG as sRGB) into `environment.map`, finite and half-float safe.
BURNISH_API Result<void> loadEnvironment(Scene& scene, const std::filesystem::path& file, const LoadOptions& options, Report& report);

}  // namespace burnish
