// What the tests of asset/ share: a folder of their own, a decoder that needs no helper program, and small files.
#pragma once
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "asset/asset.h"
#include "paths.h"

namespace gltf_test {

namespace fs = std::filesystem;
using burnish::Report;
using burnish::Result;
using burnish::asset::Asset;
using Json = nlohmann::json;

/// A folder that vanishes with the test. `asset` lies in it, so that there is an outside.
class Sandbox {
 public:
  Sandbox() {
    std::string name = (fs::temp_directory_path() / "burnish-gltf-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("mkdtemp");
    root = fs::canonical(name);
    fs::create_directories(folder());
  }
  ~Sandbox() {
    std::error_code ignored;
    fs::remove_all(root, ignored);
  }
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  [[nodiscard]] fs::path folder() const { return root / "asset"; }
  /// Writes a file into the asset's folder.
  fs::path put(const std::string& name, std::string_view content) const {
    std::ofstream(folder() / name, std::ios::binary) << content;
    return folder() / name;
  }
  fs::path root;
};

/// Takes anything with the magic bytes of PNG or JPEG for a 1×1 picture and counts; refuses the rest.
class TestDecoder final : public burnish::ImageDecoder {
 public:
  Result<burnish::Image> decode(std::span<const std::byte> file, std::string_view name,
                                const burnish::DecodeLimits&) override {
    ++calls;
    names.emplace_back(name);
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    if (!text.starts_with("\x89PNG") && !text.starts_with("\xff\xd8\xff"))
      return burnish::fail(std::string(name), "not a picture");
    burnish::Image image{1, 1, 4, burnish::PixelType::U8, std::vector<std::byte>(4)};
    return image;
  }
  int calls = 0;
  std::vector<std::string> names;
};
inline constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n";

struct Reading {
  Result<Asset> asset;
  Report report;
  int decoded = 0;
  double seconds = 0;  // of CPU: other programs on the machine do not count
  [[nodiscard]] std::string message() const { return asset ? "" : asset.error().message(); }
  [[nodiscard]] bool warned(std::string_view text) const {
    for (const auto& w : report.warnings())
      if (w.message().find(text) != std::string::npos) return true;
    return false;
  }
};

inline Reading read(const fs::path& file, burnish::asset::ReadOptions options = {}) {
  TestDecoder decoder;
  options.decoder = &decoder;
  Report report;
  const std::clock_t start = std::clock();
  auto asset = burnish::asset::readGltf(file, options, report);
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  return {std::move(asset), std::move(report), decoder.calls, seconds};
}

/// Numbers as little-endian bytes.
template <class T>
std::string bytes(std::initializer_list<T> values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.begin(), out.size());
  return out;
}

/// A GLB container around JSON and binary data.
inline std::string glb(std::string json, std::string binary = {}) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4);
  const auto u32 = [](std::size_t v) { return bytes<std::uint32_t>({std::uint32_t(v)}); };
  std::string body = u32(json.size()) + "JSON" + json;
  if (!binary.empty()) body += u32(binary.size()) + std::string("BIN\0", 4) + binary;
  return "glTF" + u32(2) + u32(body.size() + 12) + body;
}

/// A file with one mesh of one primitive, whose accessors are added one by one, each with a view of its own in
/// mesh.bin.
class MeshFile {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
  std::string binary;
  Json primitive = {{"attributes", Json::object()}};

  int accessor(const char* type, int component, std::size_t count, const std::string& data,
               Json more = Json::object()) {
    binary.resize((binary.size() + 3) / 4 * 4);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", data.size()}});
    binary += data;
    Json a = {
        {"bufferView", json["bufferViews"].size() - 1}, {"componentType", component}, {"count", count}, {"type", type}};
    a.update(more);
    json["accessors"].push_back(a);
    return int(json["accessors"].size()) - 1;
  }
  void attribute(const char* name, int index) { primitive["attributes"][name] = index; }
  /// `count` vertices at (i, i², 0).
  void positions(int count) {
    std::string data;
    for (int i = 0; i < count; ++i) data += bytes<float>({float(i), float(i) * float(i), 0});
    attribute("POSITION", accessor("VEC3", 5126, std::size_t(count), data,
                                   {{"min", {0, 0, 0}}, {"max", {count, double(count) * count, 0}}}));
  }
  Reading readIn(const Sandbox& box) {
    if (!json.contains("meshes")) json["meshes"] = {{{"primitives", {primitive}}}};
    if (!binary.empty()) json["buffers"] = {{{"byteLength", binary.size()}, {"uri", "mesh.bin"}}};
    box.put("mesh.bin", binary);
    return read(box.put("mesh.gltf", json.dump()));
  }
};

inline fs::path sharedData() { return fs::path(BURNISH_SOURCE_DIR) / "../shared/data"; }
/// Seconds that a step may take; sanitizers are some ten times slower.
#if defined(__SANITIZE_ADDRESS__)
constexpr double timeLimit(double seconds) { return 10 * seconds; }
#else
constexpr double timeLimit(double seconds) { return seconds; }
#endif
inline bool longRun() { return std::getenv("BURNISH_LONG") != nullptr; }

inline std::string slurp(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace gltf_test
