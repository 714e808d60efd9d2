#include "scene/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/transforms.h"

namespace burnish::scene {

void Derived::update(const Scene& scene, Report* report) {
  const bool posesStale = scene.nodes.revision() != nodesRevision_ || scene.meshes.revision() != meshesRevision_ || scene.instances.revision() != instancesRevision_ ||
                          scene.skins.revision() != skinsRevision_;
  if (scene.nodes.revision() != nodesRevision_) {
    world_ = worldMatrices(scene);
    nodesRevision_ = scene.nodes.revision();
  }
  if (scene.meshes.revision() != meshesRevision_) {
    bounds_.resize(scene.meshes.capacity());
    scene.meshes.each([&](Id<Mesh> id, const Mesh& mesh) {
      MeshBounds& b = bounds_[id.index];
      const std::uint64_t revision = scene.meshes.revision(id);
      if (b.revision == revision) return;
      b.bounds = boundsOf(mesh);
      b.revision = revision;
      b.shape.reset();
    });
    meshesRevision_ = scene.meshes.revision();
  }
  if (posesStale) updatePoses(scene, report);
}

void Derived::updatePoses(const Scene& scene, Report* report) {
  poses_.resize(scene.instances.capacity());
  for (std::uint32_t i = 0; i < poses_.size(); ++i) {
    const Id<Instance> id = scene.instances.at(i);
    const Instance* instance = scene.instances.get(id);
    const Mesh* mesh = instance ? scene.meshes.get(instance->mesh) : nullptr;
    if (!mesh || !deforms(scene, *instance, *mesh)) {
      poses_[i] = nullptr;
      continue;
    }
    MeshBounds& b = bounds_[instance->mesh.index];
    if (!b.extents || b.extentsRevision != b.revision) b.extents = std::make_unique<Extents>(extentsOf(*mesh));
    b.extentsRevision = b.revision;
    Pose pose = poseOf(scene, *instance, *mesh, *b.extents, world_, report);
    if (!pose.skinned && !pose.morphed)
      poses_[i] = nullptr;  // it has a skin that does not fit
    else if (poses_[i])
      *poses_[i] = std::move(pose);
    else
      poses_[i] = std::make_unique<Pose>(std::move(pose));
  }
  instancesRevision_ = scene.instances.revision();
  skinsRevision_ = scene.skins.revision();
}

const glm::dmat4& Derived::placement(Id<Instance> id, const Instance& instance) const {
  const Pose* p = pose(id);
  return p ? p->placement : world(instance.node);
}

const glm::dmat4& Derived::world(Id<Node> node) const {
  static const glm::dmat4 kIdentity(1);
  return node.index < world_.size() ? world_[node.index] : kIdentity;
}

MeshShape Derived::shape(Id<Mesh> id, const Mesh& mesh) const {
  const MeshBounds& b = bounds_[id.index];
  if (!b.shape) b.shape = shapeOf(mesh);
  return *b.shape;
}

namespace {

double within(double value, double low, double high, double otherwise) { return std::isfinite(value) ? std::clamp(value, low, high) : otherwise; }

}  // namespace

// Six planes, or five without a far plane.
Frustum::Frustum(const ViewFrame& f) {
  const glm::dmat4 t = glm::transpose(f.viewProjection);
  // Clip space: -w <= x, y <= w; reversed depth: z <= w is the near plane, z >= 0 the far plane.
  for (const glm::dvec4& plane : {t[3] + t[0], t[3] - t[0], t[3] + t[1], t[3] - t[1], t[3] - t[2], t[2]}) {
    const double length = glm::length(glm::dvec3(plane));
    if (length > 1e-300) plane_[count_++] = plane / length;
  }
}

bool Frustum::meetsBox(glm::dvec3 center, glm::dvec3 halfExtent) const {
  for (int i = 0; i < count_; ++i) {
    const glm::dvec3 n(plane_[i]);
    if (glm::dot(n, center) + plane_[i].w + glm::dot(glm::abs(n), halfExtent) < 0) return false;
  }
  return true;
}

bool Frustum::meetsSphere(glm::dvec3 center, double radius) const {
  for (int i = 0; i < count_; ++i)
    if (glm::dot(glm::dvec3(plane_[i]), center) + plane_[i].w + radius < 0) return false;
  return true;
}

namespace {

/// A rectangle of a target on one of another size. Rectangles that share a border still do.
glm::ivec4 rescaled(glm::ivec4 v, glm::ivec2 from, glm::ivec2 to) {
  glm::ivec4 r;
  for (int i = 0; i < 2; ++i) {
    const double k = double(to[i]) / std::max(from[i], 1);
    r[i] = std::clamp(int(std::lround(v[i] * k)), 0, std::max(to[i] - 1, 0));
    r[i + 2] = std::max(int(std::lround((v[i] + v[i + 2]) * k)) - r[i], 1);
  }
  return r;
}

/// Moves the picture by so many pixels of the view.
glm::dmat4 shifted(glm::dvec2 pixels, glm::ivec4 viewport) {
  glm::dmat4 m(1);
  m[3][0] = 2 * pixels.x / std::max(viewport.z, 1);
  m[3][1] = 2 * pixels.y / std::max(viewport.w, 1);
  return m;
}

}  // namespace

glm::dmat4 withoutJitter(const ViewFrame& f) { return shifted(f.jitter, f.viewport) * f.viewProjection; }

ViewFrame frameOf(const View& view, glm::ivec2 size, glm::dvec2 jitter, glm::ivec2 shaded) {
  ViewFrame f;
  f.target = view.viewport.z > 0 && view.viewport.w > 0 ? view.viewport : glm::ivec4(0, 0, size);
  f.viewport = shaded == glm::ivec2(0) || shaded == size ? f.target : rescaled(f.target, size, shaded);
  f.orthographic = view.orthographic;
  f.eye = view.eye;
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(f.eye[i])) f.eye[i] = 0;
  f.axes = view.axes;
  f.near = within(view.near, 1e-6, 1e9, 0.05);
  f.far = view.far > 0 ? within(view.far, f.near * 1.0001, 1e12, 0) : 0;
  const double aspect = double(std::max(f.target.z, 1)) / double(std::max(f.target.w, 1));
  glm::dmat4 projection(0);
  if (f.orthographic) {
    if (f.far <= 0) f.far = 1000;
    f.tanY = within(view.height, 1e-6, 1e9, 2) * 0.5;
    f.tanX = f.tanY * aspect;
    projection = glm::dmat4(1);
    projection[0][0] = 1 / f.tanX;
    projection[1][1] = 1 / f.tanY;
    projection[2][2] = 1 / (f.far - f.near);  // z = (far - w) / (far - near), w = -z_view
    projection[3][2] = f.far / (f.far - f.near);
    f.depthParams = {f.far, f.far - f.near};
  } else {
    f.tanY = std::tan(within(view.fovY, 1e-4, 3.1, 0.87) * 0.5);
    f.tanX = f.tanY * aspect;
    const bool infinite = f.far <= 0;
    const double a = infinite ? f.near : f.near * f.far / (f.far - f.near), b = infinite ? 0 : f.near / (f.far - f.near);
    projection[0][0] = 1 / f.tanX;
    projection[1][1] = 1 / f.tanY;
    projection[2][3] = -1;
    projection[2][2] = b;  // z_clip = a - b w
    projection[3][2] = a;
    f.depthParams = {a, b};
  }
  f.viewProjection = projection * glm::dmat4(glm::transpose(f.axes));
  f.jitter = jitter;
  // What lies at the sampled place comes to the pixel's middle.
  if (jitter != glm::dvec2(0)) f.viewProjection = shifted(-jitter, f.viewport) * f.viewProjection;
  return f;
}

ViewFrame narrowed(const ViewFrame& frame, glm::ivec2 pixel) {
  ViewFrame f = frame;
  const double w = frame.viewport.z, h = frame.viewport.w;
  const double cx = 2 * (pixel.x + 0.5) / w - 1, cy = 2 * (pixel.y + 0.5) / h - 1;
  glm::dmat4 zoom(1);
  zoom[0][0] = w;
  zoom[1][1] = h;
  zoom[3][0] = -cx * w;
  zoom[3][1] = -cy * h;
  f.viewProjection = zoom * frame.viewProjection;
  f.viewport = f.target = {0, 0, 1, 1};
  return f;
}

namespace {

struct WorldBox {
  glm::dvec3 center, extent;
};
/// Around placed bounds, along the world's axes, relative to the eye.
WorldBox boxAt(const Bounds& bounds, const glm::dmat4& placement, glm::dvec3 eye) {
  const glm::dvec3 half = (glm::dvec3(bounds.max) - glm::dvec3(bounds.min)) * 0.5, middle = (glm::dvec3(bounds.max) + glm::dvec3(bounds.min)) * 0.5;
  const glm::dmat3 m(placement);
  return {m * middle + glm::dvec3(placement[3]) - eye, glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y + glm::abs(m[2]) * half.z};
}

}  // namespace

bool setPlacement(VisibleInstance& v, const glm::dmat4& placement, glm::dvec3 eye) {
  glm::dmat4 world = placement;
  world[3] -= glm::dvec4(eye, 0);
  if (!finite(world)) return false;
  const glm::dmat3 m(world);
  const bool mirrors = glm::determinant(m) < 0;
  // The joints turn triangles round before the placement does; the normals that come out of them look outward already.
  v.flipped = mirrors != (v.pose && v.pose->flipped);
  // Cofactors carry normals through any transform, singular ones included; scaled so that floats neither overflow nor vanish.
  glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const double largest = std::max({glm::length(cofactor[0]), glm::length(cofactor[1]), glm::length(cofactor[2])});
  if (largest > 0) cofactor *= (mirrors ? -1 : 1) / largest;
  for (int r = 0; r < 3; ++r) {
    v.model[r] = {float(m[0][r]), float(m[1][r]), float(m[2][r]), float(world[3][r])};
    v.normal[r] = {float(cofactor[0][r]), float(cofactor[1][r]), float(cofactor[2][r])};
  }
  return true;
}

void makeRigid(const Scene& scene, const Derived& derived, const ViewFrame& frame, VisibleInstance& v) {
  v.pose = nullptr;
  const glm::dmat4 placement = scene.nodes.has(v.instance->node) ? derived.world(v.instance->node) : glm::dmat4(1);
  const WorldBox box = boxAt(derived.bounds(v.instance->mesh), placement, frame.eye);
  v.center = box.center;
  v.extent = box.extent;
  setPlacement(v, placement, frame.eye);
}

void makeRigid(const Scene& scene, const Derived& derived, Placed& p) {
  p.pose = nullptr;
  p.placement = scene.nodes.has(p.instance->node) ? derived.world(p.instance->node) : glm::dmat4(1);
}

void eachPlaced(const Scene& scene, const Derived& derived, glm::dvec3 eye, const std::function<void(const Placed&)>& f) {
  scene.instances.each([&](Id<Instance> id, const Instance& instance) {
    const Mesh* mesh = scene.meshes.get(instance.mesh);
    if (!instance.visible || !mesh || mesh->indices.empty()) return;
    const Pose* pose = derived.pose(id);
    const Bounds& bounds = pose ? pose->bounds : derived.bounds(instance.mesh);
    if (bounds.empty()) return;
    Placed p{id, &instance, mesh, pose, pose ? pose->placement : scene.nodes.has(instance.node) ? derived.world(instance.node) : glm::dmat4(1)};
    glm::dmat4 world = p.placement;
    world[3] -= glm::dvec4(eye, 0);
    if (!finite(world)) return;
    const WorldBox box = boxAt(bounds, p.placement, eye);
    p.center = box.center;
    p.extent = box.extent;
    f(p);
  });
}

void findVisible(const Scene& scene, const Derived& derived, const ViewFrame& frame, std::vector<VisibleInstance>& out, Reach reach) {
  out.clear();
  const Frustum frustum(frame);
  eachPlaced(scene, derived, frame.eye, [&](const Placed& p) {
    if (reach == Reach::InView && !frustum.meetsBox(p.center, p.extent)) return;
    VisibleInstance v;
    v.id = p.id;
    v.instance = p.instance;
    v.mesh = p.mesh;
    v.pose = p.pose;
    v.distance = float(glm::length(p.center));
    v.center = p.center;
    v.extent = p.extent;
    setPlacement(v, p.placement, frame.eye);
    out.push_back(v);
  });
  std::stable_sort(out.begin(), out.end(), [](const VisibleInstance& a, const VisibleInstance& b) { return a.distance < b.distance; });
}

}  // namespace burnish::scene
