#include "scene/transparency.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace burnish::scene {
namespace {

/// Perceptual roughness under which a thin pane blurs by less than a pixel of a picture 1000 pixels high (shading/transmission.h, scatteredAngle: 0.0006 rad).
constexpr float kClear = 0.04f;

/// An instance's box relative to the eye, and what it covers of the screen.
struct Item {
  std::uint32_t instance = 0;
  float distance = 0;
  glm::dvec3 center{0};
  glm::dmat3 half{0};    ///< columns: half edges
  glm::dmat3 normals{1}; ///< columns: unit normals of its faces
  glm::ivec4 rect{0};
  MeshShape shape = MeshShape::General;
  bool twoSided = false, refracts = false, blurs = false;
  [[nodiscard]] int layers() const { return shape == MeshShape::General ? 0 : shape == MeshShape::Flat || !twoSided ? 1 : 2; }
};

glm::ivec4 rectOf(const Item& item, const ViewFrame& f) {
  glm::dvec2 low(1e30), high(-1e30);
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 p = item.center;
    for (int k = 0; k < 3; ++k) p += item.half[k] * (corner >> k & 1 ? 1.0 : -1.0);
    const glm::dvec4 clip = f.viewProjection * glm::dvec4(p, 1);
    if (!f.orthographic && !(clip.w > f.near * 0.5)) return f.viewport;  // it reaches behind the eye
    const glm::dvec2 at = glm::dvec2(clip) / clip.w;
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const glm::dvec2 size(f.viewport.z, f.viewport.w);
  const glm::ivec2 from(glm::clamp(glm::floor((low * 0.5 + 0.5) * size) - 1.0, glm::dvec2(0), size)), to(glm::clamp(glm::ceil((high * 0.5 + 0.5) * size) + 1.0, glm::dvec2(0), size));
  return {glm::ivec2(f.viewport) + from, to - from};
}

Item itemOf(const Scene& scene, const Derived& derived, const ViewFrame& frame, const VisibleInstance& v, std::uint32_t index) {
  Item item;
  item.instance = index;
  item.distance = v.distance;
  const Bounds& b = v.pose ? v.pose->bounds : derived.bounds(v.instance->mesh);
  const glm::dvec3 extent = (glm::dvec3(b.max) - glm::dvec3(b.min)) * 0.5, middle = (glm::dvec3(b.max) + glm::dvec3(b.min)) * 0.5;
  for (int r = 0; r < 3; ++r) {
    item.center[r] = glm::dot(glm::dvec3(v.model[r]), middle) + double(v.model[r].w);
    for (int k = 0; k < 3; ++k) {
      item.half[k][r] = double(v.model[r][k]) * extent[k];
      item.normals[k][r] = double(v.normal[r][k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double length = glm::length(item.normals[k]);
    item.normals[k] = length > 0 ? item.normals[k] / length : glm::dvec3(0);
  }
  item.rect = rectOf(item, frame);
  item.shape = v.pose ? MeshShape::General : derived.shape(v.instance->mesh, *v.mesh);  // a pose may fold anything
  const Material* material = scene.materials.get(v.instance->material);
  item.twoSided = material && material->twoSided;
  item.refracts = material && refracts(*material);
  item.blurs = material && blurs(*material, item.shape);
  return item;
}

bool meet(const glm::ivec4& a, const glm::ivec4& b) { return a.x < b.x + b.z && b.x < a.x + a.z && a.y < b.y + b.w && b.y < a.y + a.w; }

glm::ivec4 unite(const glm::ivec4& a, const glm::ivec4& b) {
  const glm::ivec2 from = glm::min(glm::ivec2(a), glm::ivec2(b)), to = glm::max(glm::ivec2(a.x + a.z, a.y + a.w), glm::ivec2(b.x + b.z, b.y + b.w));
  return {from, to - from};
}

enum class Order : std::uint8_t { Apart, FirstBehind, SecondBehind, Open };

// A plane between the two settles it: the one on the eye's side cannot be covered by the other. Tried are planes along the faces of both boxes and across the view.
Order orderOf(const Item& a, const Item& b, const ViewFrame& f) {
  if (!meet(a.rect, b.rect)) return Order::Apart;
  const glm::dvec3 forward = -f.axes[2];
  const std::array<glm::dvec3, 7> axes{a.normals[0], a.normals[1], a.normals[2], b.normals[0], b.normals[1], b.normals[2], forward};
  for (const glm::dvec3& n : axes) {
    if (n == glm::dvec3(0)) continue;
    const auto reach = [&](const Item& i) { return std::abs(glm::dot(n, i.half[0])) + std::abs(glm::dot(n, i.half[1])) + std::abs(glm::dot(n, i.half[2])); };
    const double ca = glm::dot(n, a.center), cb = glm::dot(n, b.center), ra = reach(a), rb = reach(b);
    if (std::abs(ca - cb) < (ra + rb) * (1 - 1e-6)) continue;
    // Along n the lower one ends at `low`, the other begins at `high`; the eye is at 0, or infinitely far against the view's direction.
    const bool aLower = ca < cb;
    const double low = aLower ? ca + ra : cb + rb, high = aLower ? cb - rb : ca - ra;
    const double side = f.orthographic ? glm::dot(n, forward) : 0;
    const bool eyeLow = f.orthographic ? side > 0 : low >= 0, eyeHigh = f.orthographic ? side < 0 : high <= 0;
    if (eyeLow == eyeHigh) return Order::Apart;  // the eye is in the gap, or looks along it
    return eyeLow == aLower ? Order::SecondBehind : Order::FirstBehind;
  }
  return Order::Open;
}

// Strongly connected components (Tarjan 1972, "Depth-first search and linear graph algorithms"): what cannot be put in order is one component; components come out with those that
// nothing waits for last.
class Components {
 public:
  explicit Components(const std::vector<std::vector<std::uint32_t>>& before) : before_(before), index_(before.size(), 0), low_(before.size(), 0), stacked_(before.size(), false) {
    for (std::uint32_t v = 0; v < before.size(); ++v)
      if (!index_[v]) visit(v);
  }
  std::vector<std::vector<std::uint32_t>> found;

 private:
  struct Step {
    std::uint32_t node;
    std::size_t next;
  };
  void enter(std::uint32_t v, std::vector<Step>& path) {
    index_[v] = low_[v] = ++count_;
    stack_.push_back(v);
    stacked_[v] = true;
    path.push_back({v, 0});
  }
  void visit(std::uint32_t root) {
    std::vector<Step> path;
    enter(root, path);
    while (!path.empty()) {
      Step& step = path.back();
      const std::uint32_t v = step.node;
      if (step.next < before_[v].size()) {
        const std::uint32_t w = before_[v][step.next++];
        if (!index_[w]) enter(w, path);
        else if (stacked_[w]) low_[v] = std::min(low_[v], index_[w]);
        continue;
      }
      path.pop_back();
      if (!path.empty()) low_[path.back().node] = std::min(low_[path.back().node], low_[v]);
      if (low_[v] == index_[v]) close(v);
    }
  }
  void close(std::uint32_t v) {
    std::vector<std::uint32_t>& component = found.emplace_back();
    for (std::uint32_t w = ~0u; w != v;) {
      w = stack_.back();
      stack_.pop_back();
      stacked_[w] = false;
      component.push_back(w);
    }
  }
  const std::vector<std::vector<std::uint32_t>>& before_;
  std::vector<std::uint32_t> index_, low_, stack_;
  std::vector<bool> stacked_;
  std::uint32_t count_ = 0;
};

TransparentGroup groupOf(const std::vector<Item>& items, std::vector<std::uint32_t> members) {
  TransparentGroup group;
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) { return items[a].distance > items[b].distance; });
  group.rect = items[members[0]].rect;
  group.layers = 0;
  bool known = true;
  for (std::uint32_t m : members) {
    group.rect = unite(group.rect, items[m].rect);
    known = known && items[m].layers() > 0;
    group.layers += items[m].layers();
  }
  if (!known) group.layers = 0;
  group.peel = members.size() > 1 || !known;
  for (std::uint32_t m : members) {
    const Item& item = items[m];
    if (group.peel || item.layers() < 2) {
      group.parts.push_back({item.instance, Faces::Material, item.refracts, item.blurs});
    } else {
      // The far side of a convex body first.
      const bool outward = item.shape == MeshShape::Convex;
      group.parts.push_back({item.instance, outward ? Faces::Back : Faces::Front, item.refracts, item.blurs});
      group.parts.push_back({item.instance, outward ? Faces::Front : Faces::Back, item.refracts, item.blurs});
    }
  }
  return group;
}

}  // namespace

bool refracts(const Material& m) { return isGlass(m) && (m.thickness > 0 || m.roughness > kClear); }
bool blurs(const Material& m, MeshShape shape) { return refracts(m) && (m.roughness > kClear || shape != MeshShape::Flat || m.mapB); }

std::vector<TransparentGroup> orderTransparent(const Scene& scene, const Derived& derived, const ViewFrame& frame, const std::vector<VisibleInstance>& instances) {
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < instances.size(); ++i)
    if (const Material* m = scene.materials.get(instances[i].instance->material); m && isTransparent(*m)) items.push_back(itemOf(scene, derived, frame, instances[i], i));
  std::erase_if(items, [](const Item& i) { return i.rect.z <= 0 || i.rect.w <= 0; });
  if (items.empty()) return {};
  // before[i]: what must be drawn before i, for it lies behind.
  std::vector<std::vector<std::uint32_t>> before(items.size());
  std::vector<std::uint32_t> byLeft(items.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) byLeft[i] = i;
  std::sort(byLeft.begin(), byLeft.end(), [&](std::uint32_t a, std::uint32_t b) { return items[a].rect.x < items[b].rect.x; });
  for (std::size_t i = 0; i < byLeft.size(); ++i)
    for (std::size_t j = i + 1; j < byLeft.size() && items[byLeft[j]].rect.x < items[byLeft[i]].rect.x + items[byLeft[i]].rect.z; ++j) {
      const std::uint32_t a = byLeft[i], b = byLeft[j];
      const Order order = orderOf(items[a], items[b], frame);
      if (order == Order::FirstBehind || order == Order::Open) before[b].push_back(a);
      if (order == Order::SecondBehind || order == Order::Open) before[a].push_back(b);
    }
  std::vector<TransparentGroup> groups;
  for (std::vector<std::uint32_t>& members : Components(before).found) groups.push_back(groupOf(items, std::move(members)));
  return groups;
}

}  // namespace burnish::scene
