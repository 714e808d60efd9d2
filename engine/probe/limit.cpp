// Surfaces that reflect more than light in a room can bear: what they reflect in all, and how far their colour is darkened for it.
//
// Of uniform light a surface reflects S = F0 + (1 - F0)/21 (the mean of Schlick's F over the hemisphere, which no lobe that keeps energy passes) in its lobe, and of the rest, or of all where
// the diffuse rung does not know of the lobe, its diffuse albedo. Both grow with the albedo in each channel, so that a code of substance has one largest albedo that keeps the limit.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "image/convert.h"
#include "material/codec.h"
#include "probe/capture.h"

namespace burnish::probe {
namespace {

class Limit {
 public:
  Limit(double limit, const Quality& q)
      : limit_(limit), specular_(q.environmentSpecular != EnvironmentSpecular::None), diffuse_(q.ambient != Ambient::None), apart_(q.diffuse == Diffuse::Lambert) {
    for (std::size_t i = 0; i < 256; ++i) {
      const material::CodeEntry& e = material::codeTable()[i];
      byCode_[i] = largest(e.base, e.metalness);
    }
  }
  /// What is reflected in all. F0 = base + metalness · albedo, diffuse = albedo - metalness · albedo.
  [[nodiscard]] double reflected(double base, double metalness, double albedo) const {
    const double lobe = specular_ ? mean(base + metalness * albedo) : 0, diffuse = diffuse_ ? albedo * (1 - metalness) : 0;
    // Of a part that is no metal the rungs take what that part's own lobe reflects.
    const double taken = apart_ || !specular_ || metalness >= 1 ? 0 : mean(base / (1 - metalness));
    return lobe + diffuse * (1 - taken);
  }
  /// The largest albedo that keeps the limit, at most 1; 0 where the lobe alone passes it.
  [[nodiscard]] double largest(double base, double metalness) const {
    if (reflected(base, metalness, 1) <= limit_) return 1;
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) (reflected(base, metalness, (low + high) / 2) <= limit_ ? low : high) = (low + high) / 2;
    return low;
  }
  [[nodiscard]] const std::array<double, 256>& byCode() const { return byCode_; }

 private:
  static double mean(double f0) { return f0 + (1 - f0) / 21; }

  double limit_;
  bool specular_, diffuse_, apart_;
  std::array<double, 256> byCode_{};
};

std::string nameOf(const Material* m) { return !m ? "surfaces without a material" : m->name.empty() ? "an unnamed material" : fmt::format("material '{}'", m->name); }

/// What was darkened of one material.
struct Found {
  double most = 0;  ///< reflected in all before
  std::string where;
};

class Limiter {
 public:
  Limiter(Scene scene, const Limit& limit, double asked, Report& report) : scene_(std::move(scene)), limit_(limit), asked_(asked), report_(report) {}

  Scene run() {
    std::vector<Id<Instance>> bare;
    scene_.instances.each([&](Id<Instance> id, const Instance& i) {
      const Mesh* mesh = scene_.meshes.get(i.mesh);
      if (!i.visible || !mesh) return;
      const Material* m = scene_.materials.get(i.material);
      if (!m) {
        bare.push_back(id);
        return;
      }
      glm::dvec3& brightest = brightest_.try_emplace(i.material.index, 0.0).first->second;
      glm::dvec3 most(1);
      if (m->useVertexColor && !mesh->colors.empty()) {
        most = glm::dvec3(0);
        for (const glm::vec4& c : mesh->colors) most = glm::max(most, glm::dvec3(c));
      }
      brightest = glm::max(brightest, most);
    });
    dress(bare);
    for (const auto& [index, brightest] : brightest_) limitMaterial(scene_.materials.at(index), brightest);
    return std::move(scene_);
  }

 private:
  /// Instances without a material are white plastic: they get one, if that is too bright.
  void dress(const std::vector<Id<Instance>>& bare) {
    const Material plain;
    const Range range = rangeOf(plain);
    if (bare.empty() || range.cap >= 1) return;
    Material m = plain;
    m.albedo = glm::vec3(below(range.cap));
    tell(nameOf(nullptr), {limit_.reflected(range.base, range.metalness, 1), "everywhere"});
    const Id<Material> id = scene_.materials.add(m);
    for (Id<Instance> i : bare) scene_.instances.edit(i)->material = id;
  }

  /// The codes that a material without a map A, or with metalness of its own map, can have: the one that bears least.
  struct Range {
    double base = 0, metalness = 0, cap = 1;
  };
  Range worst(double base, double metalness) const { return {base, metalness, limit_.largest(base, metalness)}; }
  Range rangeOf(const Material& m) const {
    if (m.transmission > 0 && m.ior >= 1) return worst(double(f0FromIor(m.ior)), 0);
    if (!m.metalRoughMap) {
      const double s = std::clamp(double(m.substance), 0.0, 1.0), metal = std::max(s - 0.4, 0.0) / 0.6, root = 0.5 - 0.9 * std::min(s, 0.4);
      return worst(root * root * (1 - metal), metal);
    }
    Range range = worst(double(material::kPlasticF0), 0);
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
      const double metal = std::clamp(double(m.metalness), 0.0, 1.0) * i / kSteps;
      if (metal < double(material::kMetalnessStart)) continue;
      const Range at = worst(double(material::kWaterF0) * (1 - metal), metal);
      if (at.cap < range.cap) range = at;
    }
    return range;
  }

  void limitMaterial(Id<Material> id, const glm::dvec3& brightest) {
    const Material m = *scene_.materials.get(id);
    if (m.unlit) return;
    Found found;
    const Texture* map = scene_.textures.get(m.mapA);
    if (map && map->image.type == PixelType::U8 && map->image.channels == 4)
      limitMap(id, m, brightest, found);
    else
      limitFactor(id, m, brightest, found);
    if (found.most > 0) tell(nameOf(&m), found);
  }

  // Vertex by vertex where there are colours: what they leave of the factor.
  void limitFactor(Id<Material> id, const Material& m, const glm::dvec3& brightest, Found& found) {
    const Range range = rangeOf(m);
    const glm::dvec3 factor = glm::clamp(glm::dvec3(m.albedo), 0.0, 1.0), product = factor * brightest;
    const double most = std::max({product.x, product.y, product.z});
    if (most <= range.cap) return;
    found = {limit_.reflected(range.base, range.metalness, std::min(most, 1.0)), "everywhere"};
    bool plain = false;
    std::set<std::uint32_t> colored;  // meshes
    scene_.instances.each([&](Id<Instance>, const Instance& i) {
      const Mesh* mesh = scene_.meshes.get(i.mesh);
      if (!i.visible || i.material != id || !mesh) return;
      if (m.useVertexColor && !mesh->colors.empty())
        colored.insert(i.mesh.index);
      else
        plain = true;
    });
    glm::vec3 left = m.albedo;
    if (plain) scene_.materials.edit(id)->albedo = left = glm::min(left, glm::vec3(below(range.cap)));
    std::size_t vertices = 0, all = 0;
    for (const std::uint32_t index : colored) {
      const Id<Mesh> mesh = scene_.meshes.at(index);
      all += scene_.meshes.get(mesh)->colors.size();
      vertices += limitColors(mesh, range.cap, glm::clamp(glm::dvec3(left), 0.0, 1.0));
    }
    if (vertices > 0) found.where = fmt::format("{} of {} vertex colours{}", vertices, all, plain ? " and everywhere else" : "");
  }
  /// How many were too bright.
  std::size_t limitColors(Id<Mesh> id, double cap, const glm::dvec3& factor) {
    const std::vector<glm::vec4>& colors = scene_.meshes.get(id)->colors;
    const auto bright = [&](const glm::vec4& c) {
      const glm::dvec3 a = glm::dvec3(c) * factor;
      return std::max({a.x, a.y, a.z}) > cap;
    };
    const auto count = std::size_t(std::count_if(colors.begin(), colors.end(), bright));
    if (count == 0) return 0;
    for (glm::vec4& c : scene_.meshes.edit(id)->colors)
      for (int k = 0; k < 3; ++k)
        if (double(c[k]) * factor[k] > cap) c[k] = below(cap / factor[k]);
    return count;
  }
  /// A float that is not above.
  static float below(double x) {
    const float f = float(x);
    return double(f) > x ? std::nextafter(f, 0.0f) : f;
  }

  // Texel by texel, on a copy for each colour that multiplies the map.
  void limitMap(Id<Material> id, const Material& m, const glm::dvec3& brightest, Found& found) {
    const bool own = m.metalRoughMap || (m.transmission > 0 && m.ior >= 1);  // the map's codes do not count
    const Range fixed = rangeOf(m);
    std::array<Range, 256> ranges;
    for (std::size_t code = 0; code < 256; ++code) ranges[code] = own ? fixed : Range{double(material::codeTable()[code].base), double(material::codeTable()[code].metalness), limit_.byCode()[code]};
    const glm::dvec3 scale = glm::clamp(glm::dvec3(m.albedo), 0.0, 1.0) * brightest;
    const Bytes most = largestBytes(ranges, scale);
    const Texture& map = *scene_.textures.get(m.mapA);
    if (!findTexels(map, ranges, scale, most, found)) return;
    Id<Texture>& copy = copies_[std::tuple(m.mapA.index, own ? fixed.cap : -1.0, scale.x, scale.y, scale.z)];
    if (!copy) {
      Texture darker = map;
      std::uint8_t* texel = darker.image.u8();
      for (std::size_t i = 0; i < darker.image.pixelCount(); ++i, texel += 4)
        for (std::size_t c = 0; c < 3; ++c) texel[c] = std::min(texel[c], most[c][texel[3]]);
      copy = scene_.textures.add(std::move(darker));
    }
    scene_.materials.edit(id)->mapA = copy;
  }
  using Bytes = std::array<std::array<std::uint8_t, 256>, 3>;  // of a channel, for a code
  static Bytes largestBytes(const std::array<Range, 256>& ranges, const glm::dvec3& scale) {
    const std::array<float, 256>& linear = image::srgbToLinearTable();
    Bytes most{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t code = 0; code < 256; ++code) {
        std::size_t byte = 255;
        while (byte > 0 && ranges[code].cap < 1 && double(linear[byte]) * scale[int(c)] > ranges[code].cap) --byte;
        most[c][code] = std::uint8_t(byte);
      }
    return most;
  }
  /// Those that are too bright; false: none.
  bool findTexels(const Texture& map, const std::array<Range, 256>& ranges, const glm::dvec3& scale, const Bytes& most, Found& found) const {
    std::size_t changed = 0, brightest = 0;
    const std::uint8_t* texel = map.image.u8();
    for (std::size_t i = 0; i < map.image.pixelCount(); ++i, texel += 4) {
      if (texel[0] <= most[0][texel[3]] && texel[1] <= most[1][texel[3]] && texel[2] <= most[2][texel[3]]) continue;
      ++changed;
      const Range& range = ranges[texel[3]];
      for (int c = 0; c < 3; ++c) {
        const double r = limit_.reflected(range.base, range.metalness, std::min(double(image::srgbToLinearTable()[texel[c]]) * scale[c], 1.0));
        if (r > found.most) found.most = r, brightest = i;
      }
    }
    const auto width = std::size_t(map.image.width);
    found.where = fmt::format("{:.3g} % of the texels of its map{}, the brightest at column {}, row {}", 100.0 * double(changed) / double(map.image.pixelCount()),
                              map.name.empty() ? "" : fmt::format(" '{}'", map.name), brightest % width, brightest / width);
    return changed > 0;
  }

  void tell(const std::string& place, const Found& found) {
    report_.warn(place, fmt::format("reflects up to {:.3f} of the light, diffuse and specular together ({}): darkened to {:.3g} while baking", found.most, found.where, asked_));
  }

  Scene scene_;
  const Limit& limit_;
  double asked_;
  Report& report_;
  std::map<std::uint32_t, glm::dvec3> brightest_;  // vertex colours, by index of the material; ones where a mesh has none
  std::map<std::tuple<std::uint32_t, double, double, double, double>, Id<Texture>> copies_;
};

}  // namespace

Scene limited(const Scene& scene, double albedoLimit, const Quality& quality, Report& report) {
  double held = albedoLimit;
  if (!(held >= 0 && held <= 1)) {
    held = held > 1 ? 1 : 0;
    report.warn("albedo limit", fmt::format("it is {}: {} is used, 0 to 1 can be", albedoLimit, held));
  }
  const Limit limit(held, quality);
  return Limiter(scene, limit, held, report).run();
}

}  // namespace burnish::probe
