// Another reader as the judge: tinygltf parses the same valid files, and both must see the same numbers. It is the only
// place where it is used; the engine itself has no need of it (docs/decisions/gltf_reader.md says why).
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "gltf_fixture.h"

using namespace gltf_test;

namespace {

std::optional<tinygltf::Model> judge(const fs::path& file) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  tinygltf::Model model;
  std::string error, warning;
  const bool ok = file.extension() == ".glb" ? loader.LoadBinaryFromFile(&model, &error, &warning, file.string())
                                             : loader.LoadASCIIFromFile(&model, &error, &warning, file.string());
  return ok ? std::optional(std::move(model)) : std::nullopt;
}

// Element `i` of an accessor without sparse replacements, as float or index.
double value(const tinygltf::Model& m, const tinygltf::Accessor& a, std::size_t i, int component) {
  const tinygltf::BufferView& view = m.bufferViews[std::size_t(a.bufferView)];
  const int bytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(a.componentType));
  const unsigned char* from = m.buffers[std::size_t(view.buffer)].data.data() + view.byteOffset + a.byteOffset +
                              i * std::size_t(a.ByteStride(view)) + std::size_t(component * bytes);
  const auto load = [&](auto v) {
    std::memcpy(&v, from, sizeof v);
    return double(v);
  };
  switch (a.componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load(float{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load(std::uint8_t{}) / (a.normalized ? 255 : 1);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load(std::uint16_t{}) / (a.normalized ? 65535 : 1);
    default:
      return load(std::uint32_t{});
  }
}

template <class V>
std::size_t differences(const tinygltf::Model& m, const tinygltf::Primitive& p, const char* name,
                        const std::vector<V>& ours) {
  const auto found = p.attributes.find(name);
  if (found == p.attributes.end()) return ours.size();
  const tinygltf::Accessor& a = m.accessors[std::size_t(found->second)];
  std::size_t wrong = a.count == ours.size() ? 0 : 1;
  for (std::size_t i = 0; i < ours.size() && !wrong; ++i)
    for (int c = 0; c < std::min(V::length(), tinygltf::GetNumComponentsInType(std::uint32_t(a.type))); ++c)
      wrong += float(value(m, a, i, c)) != ours[i][c];
  return wrong;
}

void compare(const tinygltf::Model& m, const Asset& a) {
  REQUIRE(m.meshes.size() == a.meshes.size());
  for (std::size_t i = 0; i < m.meshes.size(); ++i) {
    REQUIRE(m.meshes[i].primitives.size() == a.meshes[i].primitives.size());
    for (std::size_t k = 0; k < m.meshes[i].primitives.size(); ++k) {
      const tinygltf::Primitive& p = m.meshes[i].primitives[k];
      const auto& ours = a.meshes[i].primitives[k];
      CHECK(differences(m, p, "POSITION", ours.positions) == 0);
      CHECK(differences(m, p, "NORMAL", ours.normals) == 0);
      CHECK(differences(m, p, "TANGENT", ours.tangents) == 0);
      CHECK(differences(m, p, "TEXCOORD_0", ours.uv0) == 0);
      CHECK(differences(m, p, "COLOR_0", ours.colors) == 0);
      CHECK(p.material == ours.material);
      if (p.indices < 0) continue;
      const tinygltf::Accessor& indices = m.accessors[std::size_t(p.indices)];
      std::size_t wrong = indices.count == ours.indices.size() ? 0 : 1;
      for (std::size_t n = 0; n < ours.indices.size() && !wrong; ++n)
        wrong += value(m, indices, n, 0) != ours.indices[n];
      CHECK(wrong == 0);
    }
  }
  REQUIRE(m.materials.size() == a.materials.size());
  for (std::size_t i = 0; i < m.materials.size(); ++i) {
    const auto& pbr = m.materials[i].pbrMetallicRoughness;
    CHECK(float(pbr.roughnessFactor) == a.materials[i].roughness);
    CHECK(float(pbr.metallicFactor) == a.materials[i].metallic);
    CHECK(float(pbr.baseColorFactor[1]) == a.materials[i].baseColor.y);
    CHECK(m.materials[i].doubleSided == a.materials[i].doubleSided);
    CHECK(m.materials[i].name == a.materials[i].name);
  }
}

}  // namespace

TEST_CASE("tinygltf sees the same meshes and materials", "[gltf]") {
  const Sandbox box;
  MeshFile own;
  own.positions(5);
  own.primitive["indices"] = own.accessor("SCALAR", 5123, 6, bytes<std::uint16_t>({0, 1, 2, 2, 1, 4}));
  own.attribute("NORMAL", own.accessor("VEC3", 5126, 5, bytes<float>({0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0})));
  own.primitive["material"] = 0;
  own.json["materials"] = {{{"name", "m"}, {"pbrMetallicRoughness", {{"roughnessFactor", 0.3}}}}};
  REQUIRE(own.readIn(box).asset);
  std::vector<fs::path> files = {box.folder() / "mesh.gltf"};
  if (fs::exists(sharedData() / "gltf"))
    for (const auto& entry : fs::recursive_directory_iterator(sharedData() / "gltf"))
      if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
  for (const fs::path& file : files) {
    INFO(file.string());
    const auto model = judge(file);
    REQUIRE(model);
    const Reading ours = read(file);
    REQUIRE(ours.asset);
    compare(*model, *ours.asset);
  }
}
