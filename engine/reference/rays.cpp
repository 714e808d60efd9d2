#include "reference/rays.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <tuple>

#include "prefilter/parallel.h"

namespace burnish::reference {
namespace {

bool finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

struct DeviceDelete {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
struct SceneDelete {
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
};

// One instruction set and one thread while the tree is built: its shape, and so which of two coincident surfaces is met first, is the same everywhere.
constexpr const char* kDevice = "isa=sse4.2,threads=1";

/// Floats of one mesh as Embree reads them: it takes a corner's 16 bytes, the last 4 of which it ignores.
struct Soup {
  std::vector<glm::vec4> corners;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> original;  ///< triangles of the mesh that was given, where some were left out; empty: all of them
  bool twoSided = false;

  [[nodiscard]] glm::dvec3 corner(std::uint32_t triangle, std::size_t c) const { return glm::dvec3(corners[indices[triangle * std::size_t(3) + c]]); }
  /// Right-handed, of twice the triangle's area.
  [[nodiscard]] glm::dvec3 normal(std::uint32_t triangle) const { return glm::cross(corner(triangle, 1) - corner(triangle, 0), corner(triangle, 2) - corner(triangle, 0)); }
};

RTCRay embreeRay(const Ray& ray, glm::dvec3 middle) {
  const glm::dvec3 o = ray.origin - middle;
  RTCRay r{};
  r.org_x = float(o.x);
  r.org_y = float(o.y);
  r.org_z = float(o.z);
  r.dir_x = float(ray.direction.x);
  r.dir_y = float(ray.direction.y);
  r.dir_z = float(ray.direction.z);
  r.tnear = float(std::max(ray.from, 0.0));
  r.tfar = float(std::min(ray.to, double(std::numeric_limits<float>::infinity())));
  r.mask = ray.mask;
  return r;
}

// The plane's distance in double: floats are good for finding the triangle, less for how far along the ray it is.
Hit hitOf(const Soup& soup, std::uint32_t mesh, std::uint32_t triangle, glm::vec2 barycentric, double distance, glm::dvec3 origin, glm::dvec3 direction) {
  const glm::dvec3 n = soup.normal(triangle);
  const double length = glm::length(n), slope = glm::dot(n, direction);
  const double exact = glm::dot(n, soup.corner(triangle, 0) - origin) / slope, slack = 1e-4 * std::abs(distance) + 1e-30;
  Hit hit;
  hit.distance = std::abs(exact - distance) <= slack ? std::max(exact, 0.0) : distance;
  hit.mesh = mesh;
  hit.triangle = soup.original.empty() ? triangle : soup.original[triangle];
  hit.barycentric = barycentric;
  hit.normal = length > 0 ? n / length : glm::dvec3(0);
  hit.back = slope > 0;
  return hit;
}

bool good(const Ray& ray) { return finite(ray.origin) && finite(ray.direction) && ray.direction != glm::dvec3(0) && ray.from <= ray.to; }

}  // namespace

struct RayScene::Parts {
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceDelete> device;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneDelete> scene;
  std::vector<Soup> meshes;
  glm::dvec3 middle{0}, low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  std::size_t triangles = 0;

  void bound(std::span<const TriangleMesh> given);
  void take(const TriangleMesh& given);
  [[nodiscard]] Result<void> commit(std::span<const TriangleMesh> given);
};

namespace {

bool usable(const TriangleMesh& mesh, std::size_t triangle) {
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t i = mesh.indices[triangle * 3 + std::size_t(c)];
    // Embree takes coordinates below 1.8e18.
    if (i >= mesh.positions.size() || !finite(mesh.positions[i]) || glm::any(glm::greaterThan(glm::abs(mesh.positions[i]), glm::dvec3(1e15)))) return false;
  }
  return true;
}

}  // namespace

void RayScene::Parts::bound(std::span<const TriangleMesh> given) {
  for (const TriangleMesh& mesh : given)
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
      if (!usable(mesh, t)) continue;
      ++triangles;
      for (int c = 0; c < 3; ++c) {
        const glm::dvec3 p = mesh.positions[mesh.indices[t * 3 + std::size_t(c)]];
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    }
  if (triangles > 0) middle = (low + high) * 0.5;
}

void RayScene::Parts::take(const TriangleMesh& given) {
  Soup soup;
  soup.twoSided = given.twoSided;
  soup.corners.reserve(given.positions.size());
  for (const glm::dvec3& p : given.positions) soup.corners.emplace_back(finite(p) ? glm::vec3(p - middle) : glm::vec3(0), 0.0f);
  const std::size_t count = given.indices.size() / 3;
  bool whole = true;
  for (std::size_t t = 0; t < count; ++t) {
    if (!usable(given, t)) {
      whole = false;
      continue;
    }
    soup.original.push_back(std::uint32_t(t));
    soup.indices.insert(soup.indices.end(), given.indices.begin() + std::ptrdiff_t(t * 3), given.indices.begin() + std::ptrdiff_t(t * 3 + 3));
  }
  if (whole) soup.original.clear();
  meshes.push_back(std::move(soup));
}

Result<void> RayScene::Parts::commit(std::span<const TriangleMesh> given) {
  const auto embree = [&]() -> Result<void> {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_NONE) return {};
    return fail("ray tracing", error == RTC_ERROR_OUT_OF_MEMORY ? "memory runs out" : fmt::format("Embree reports error {}", int(error)), "use a smaller scene");
  };
  device.reset(rtcNewDevice(kDevice));
  if (!device) return fail("ray tracing", fmt::format("Embree does not start (error {})", int(rtcGetDeviceError(nullptr))), "a processor with SSE 4.2 is needed");
  if (!rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED)) return fail("ray tracing", "this Embree was built without ray masks", "use the distribution's package");
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Soup& soup = meshes[m];
    if (soup.indices.empty()) continue;
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, soup.corners.data(), 0, sizeof(glm::vec4), soup.corners.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, soup.indices.data(), 0, 3 * sizeof(std::uint32_t), soup.indices.size() / 3);
    rtcSetGeometryMask(geometry, given[m].mask);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene.get(), geometry, unsigned(m));
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene.get());
  return embree();
}

RayScene::RayScene(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::create(std::span<const TriangleMesh> meshes) try {
  auto parts = std::make_unique<Parts>();
  parts->bound(meshes);
  if (parts->triangles > kMaxTriangles) return fail("ray tracing", fmt::format("{} triangles, at most {} can be taken", parts->triangles, kMaxTriangles), "use a smaller scene");
  for (const TriangleMesh& mesh : meshes) parts->take(mesh);
  if (auto made = parts->commit(meshes); !made) return fail(made.error());
  return RayScene(std::move(parts));
} catch (const std::bad_alloc&) {
  return fail("ray tracing", "memory runs out", "use a smaller scene");
}

namespace {

/// What Embree hands to the filter beside its own.
struct Context {
  RTCIntersectContext base;
  const std::vector<Soup>* meshes;
  const Ray* ray;
  glm::dvec3 origin;  ///< relative to the middle
  std::vector<Hit>* hits = nullptr;

  Context(const std::vector<Soup>& all, const Ray& r, glm::dvec3 middle) : meshes(&all), ray(&r), origin(r.origin - middle) { rtcInitIntersectContext(&base); }
};

// One ray at a time. Leaves out backs, and where all hits are wanted takes each and lets the ray go on.
void filter(const RTCFilterFunctionNArguments* a) {
  const auto& context = *reinterpret_cast<const Context*>(a->context);
  const std::uint32_t mesh = RTCHitN_geomID(a->hit, 1, 0), triangle = RTCHitN_primID(a->hit, 1, 0);
  const Soup& soup = (*context.meshes)[mesh];
  const bool culled = context.ray->cull && !soup.twoSided && glm::dot(soup.normal(triangle), context.ray->direction) > 0;
  if (culled || context.hits) a->valid[0] = 0;
  if (culled || !context.hits) return;
  context.hits->push_back(hitOf(soup, mesh, triangle, {RTCHitN_u(a->hit, 1, 0), RTCHitN_v(a->hit, 1, 0)}, double(RTCRayN_tfar(a->ray, 1, 0)), context.origin, context.ray->direction));
}

}  // namespace

Hit RayScene::nearest(const Ray& ray) const {
  if (!good(ray)) return {};
  RTCRayHit r{};
  r.ray = embreeRay(ray, parts_->middle);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Context context(parts_->meshes, ray, parts_->middle);
  if (ray.cull) context.base.filter = filter;
  rtcIntersect1(parts_->scene.get(), &context.base, &r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return hitOf(parts_->meshes[r.hit.geomID], r.hit.geomID, r.hit.primID, {r.hit.u, r.hit.v}, double(r.ray.tfar), context.origin, ray.direction);
}

void RayScene::all(const Ray& ray, std::vector<Hit>& hits) const {
  hits.clear();
  if (!good(ray)) return;
  RTCRayHit r{};
  r.ray = embreeRay(ray, parts_->middle);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Context context(parts_->meshes, ray, parts_->middle);
  context.base.filter = filter;
  context.hits = &hits;
  rtcIntersect1(parts_->scene.get(), &context.base, &r);
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return std::tie(a.distance, a.mesh, a.triangle) < std::tie(b.distance, b.mesh, b.triangle); });
}

bool RayScene::occluded(const Ray& ray) const {
  if (!good(ray)) return false;
  RTCRay r = embreeRay(ray, parts_->middle);
  Context context(parts_->meshes, ray, parts_->middle);
  if (ray.cull) context.base.filter = filter;
  rtcOccluded1(parts_->scene.get(), &context.base, &r);
  return r.tfar < 0;  // Embree's way to say yes
}

bool RayScene::occluded(glm::dvec3 a, glm::dvec3 b, double gap, std::uint32_t mask) const {
  const double length = glm::length(b - a);
  if (!(length > 2 * gap)) return false;
  return occluded({a, (b - a) / length, gap, length - gap, mask});
}

void RayScene::nearest(std::span<const Ray> rays, std::span<Hit> hits, int threads) const {
  constexpr std::size_t kPiece = 4096;
  const std::size_t count = std::min(rays.size(), hits.size());
  prefilter::forEachPiece(int((count + kPiece - 1) / kPiece), prefilter::threadsFor(threads), [&](int piece) {
    const std::size_t from = std::size_t(piece) * kPiece, to = std::min(count, from + kPiece);
    for (std::size_t i = from; i < to; ++i) hits[i] = nearest(rays[i]);
  });
}

std::size_t RayScene::triangles() const { return parts_->triangles; }
glm::dvec3 RayScene::low() const { return parts_->low; }
glm::dvec3 RayScene::high() const { return parts_->high; }
double RayScene::rounding() const {
  if (parts_->triangles == 0) return 0;
  const glm::dvec3 half = (parts_->high - parts_->low) * 0.5;
  return 1.2e-7 * std::max({half.x, half.y, half.z});
}

}  // namespace burnish::reference
