// Folders that nobody vouches for: one error that names the file, or a sound set.
#include <fmt/format.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "probe/manifest.h"
#include "store_fixture.h"

using namespace store_test;
using nlohmann::ordered_json;

namespace {

struct Stored {
  Folder box;
  fs::path folder = box.path / "a", manifest = folder / "probes.json";
  Stored() {
    Report report;
    REQUIRE(writeProbes(folder, sampleSet(4), report));
  }
  [[nodiscard]] Result<ProbeSet> read() const {
    Report report;
    return readProbes(folder, report);
  }
  /// The manifest with a change, and with a hash that is right again.
  void change(const std::function<void(ordered_json&)>& f) const {
    auto document = ordered_json::parse(textOf(manifest));
    document.erase(std::string(probe::kSealName));
    f(document);
    put(manifest, probe::sealed(probe::jsonText(document)));
  }
  /// Another payload under the same name, with its hash in the manifest.
  void replace(const std::string& name, const std::string& bytes) const {
    put(folder / name, bytes);
    change([&](ordered_json& j) {
      const auto fix = [&](ordered_json& file) {
        if (file.is_object() && file["name"] == name) file["xxh3_128"] = core::hashOf(std::as_bytes(std::span(bytes))).hex();
      };
      for (auto& r : j["reflections"]) fix(r["file"]);
      fix(j["grid"]["irradiance"]);
      fix(j["grid"]["distances"]);
    });
  }
};

/// An error with its three parts whose place begins with the file.
void checkError(const Result<ProbeSet>& read, const fs::path& file) {
  REQUIRE_FALSE(read);
  INFO(read.error().message());
  CHECK(read.error().place.find(file.string()) == 0);
  CHECK_FALSE(read.error().what.empty());
  CHECK_FALSE(read.error().remedy.empty());
}

}  // namespace

TEST_CASE("Each damaged byte of a folder is one error that names its file", "[probe][store][hostile]") {
  const Stored s;
  REQUIRE(s.read());
  std::size_t bytes = 0;
  for (const auto& [name, text] : contentOf(s.folder)) {
    const std::size_t step = text.size() > 16384 ? 7 : 1;
    for (std::size_t at = 0; at < text.size(); at += step) {
      setByte(s.folder / name, at, char(text[at] ^ (1 << at % 8)));
      const auto read = s.read();
      setByte(s.folder / name, at, text[at]);
      INFO(name << ", byte " << at);
      REQUIRE_FALSE(read);
      REQUIRE(read.error().place.find((s.folder / name).string()) == 0);
      REQUIRE_FALSE(read.error().remedy.empty());
      ++bytes;
    }
    for (const std::size_t length : {std::size_t(0), std::size_t(1), text.size() / 2, text.size() - 1}) {
      put(s.folder / name, text.substr(0, length));
      checkError(s.read(), s.folder / name);
    }
    put(s.folder / name, text + "x");
    checkError(s.read(), s.folder / name);
    fs::remove(s.folder / name);
    checkError(s.read(), name == "probes.json" ? s.folder : s.folder / name);
    put(s.folder / name, text);
  }
  CHECK(bytes > 10000);
  CHECK(s.read());
}

TEST_CASE("A manifest that lies is one error that names the JSON path", "[probe][store][hostile]") {
  const std::vector<std::pair<std::string, std::function<void(ordered_json&)>>> lies = {
      {"format", [](auto& j) { j["format"] = "lightmaps"; }},
      {"format_version", [](auto& j) { j["format_version"] = 2; }},
      {"schema_version", [](auto& j) { j.erase("schema_version"); }},
      {"lobe", [](auto& j) { j["lobe"] = "phong"; }},
      {"another lobe", [](auto& j) { j["lobe"] = "blinn-phong"; }},
      {"reflections", [](auto& j) { j["reflections"] = 5; }},
      {"reflections", [](auto& j) { j["reflections"] = std::vector<int>(5000); }},
      {"/reflections/0/center", [](auto& j) { j["reflections"][0]["center"] = {1, 2}; }},
      {"/reflections/0/center", [](auto& j) { j["reflections"][0]["center"][1] = "x"; }},
      {"/reflections/0", [](auto& j) { j["reflections"][0]["center"][1] = 1e30; }},
      {"/reflections/0", [](auto& j) { j["reflections"][0]["axes"][0] = 0.5; }},
      {"/reflections/0/half_size/2", [](auto& j) { j["reflections"][0]["half_size"][2] = -1; }},
      {"/reflections/0/margin", [](auto& j) { j["reflections"][0]["margin"] = nullptr; }},
      {"irradiance", [](auto& j) { j["reflections"][0]["irradiance"].erase(8); }},
      {"/reflections/0/irradiance/3", [](auto& j) { j["reflections"][0]["irradiance"][3] = {1, 2}; }},
      {"/reflections/0/size", [](auto& j) { j["reflections"][0]["size"] = 1 << 20; }},
      {"levels of faces", [](auto& j) { j["reflections"][0]["size"] = 8; }},
      {"/reflections/0/levels", [](auto& j) { j["reflections"][0]["levels"] = 13; }},
      {"multiplied", [](auto& j) { j["reflections"][0]["scale"] = 1; }},
      {"/reflections/0/file/bytes", [](auto& j) { j["reflections"][0]["file"]["bytes"] = 1000000; }},
      {"bytes long", [](auto& j) { j["reflections"][0]["file"]["bytes"] = 60000; }},
      {"XXH3-128", [](auto& j) { j["reflections"][0]["file"]["xxh3_128"] = "0123456789abcdef0123456789abcdef"; }},
      {"xxh3_128", [](auto& j) { j["reflections"][0]["file"]["xxh3_128"] = "0123"; }},
      {"plain file name", [](auto& j) { j["reflections"][0]["file"]["name"] = "../secret.ktx2"; }},
      {"plain file name", [](auto& j) { j["reflections"][0]["file"]["name"] = "/etc/passwd"; }},
      {"plain file name", [](auto& j) { j["reflections"][0]["file"]["name"] = "%2e%2e/secret.ktx2"; }},
      {"plain file name", [](auto& j) { j["reflections"][0]["file"]["name"] = "work/lock"; }},
      {"plain file name", [](auto& j) { j["reflections"][0]["file"]["name"] = ".ktx2"; }},
      {"plain file name", [](auto& j) { j["reflections"][0]["file"]["name"] = std::string("a\0.ktx2", 7); }},
      {"/grid/counts", [](auto& j) { j["grid"]["counts"][0] = 0; }},
      {"points", [](auto& j) { j["grid"]["counts"] = {200000, 200000, 200000}; }},
      {"whole", [](auto& j) { j["grid"]["counts"][0] = 2.5; }},
      {"valid", [](auto& j) { j["grid"]["counts"][0] = 4; }},
      {"valid", [](auto& j) { j["grid"]["valid"] = "11111111111x"; }},
      {"/grid/distance_size", [](auto& j) { j["grid"]["distance_size"] = 8; }},
      {"/grid/spacing/0", [](auto& j) { j["grid"]["spacing"][0] = 0; }},
      {"texels", [](auto& j) { j["grid"]["counts"] = {2, 3, 2}; }},
      {"/grid/irradiance/bytes", [](auto& j) { j["grid"]["irradiance"]["bytes"] = 1 << 30; }},
      {"decoded", [](auto& j) { j["grid"]["irradiance"] = j["grid"]["distances"]; }},
      {"/bake", [](auto& j) { j["bake"] = {{"id", 5}, {"bounces", {1}}, {"keys", {}}}; }},
  };
  for (const auto& [says, lie] : lies) {
    const Stored s;
    s.change(lie);
    const auto read = s.read();
    INFO(says);
    REQUIRE_FALSE(read);
    INFO(read.error().message());
    CHECK(read.error().message().find(says) != std::string::npos);
    CHECK(read.error().place.find(s.folder.string()) == 0);
    CHECK_FALSE(read.error().remedy.empty());
  }
}

TEST_CASE("Depth and length of a manifest are bounded before it is parsed", "[probe][store][hostile]") {
  const Stored s;
  put(s.manifest, probe::sealed("{\"a\": " + std::string(100000, '[') + "1\n}\n"));
  checkError(s.read(), s.manifest);
  CHECK(s.read().error().what.find("deeper") != std::string::npos);
  put(s.manifest, "");
  fs::resize_file(s.manifest, 3ull << 30);  // sparse: it costs nothing unless it is read
  checkError(s.read(), s.manifest);
  CHECK(s.read().error().what.find("limit") != std::string::npos);
}

TEST_CASE("Links out of a folder, folders and pipes in place of files are refused", "[probe][store][hostile]") {
  const Stored s;
  for (const auto& [name, text] : contentOf(s.folder)) {
    put(s.box.path / "outside", text);
    fs::remove(s.folder / name);
    fs::create_symlink(s.box.path / "outside", s.folder / name);
    checkError(s.read(), s.folder / name);
    fs::remove(s.folder / name);
    fs::create_directory(s.folder / name);
    checkError(s.read(), s.folder / name);
    fs::remove(s.folder / name);
    REQUIRE(::mkfifo((s.folder / name).c_str(), 0600) == 0);
    checkError(s.read(), s.folder / name);
    fs::remove(s.folder / name);
    fs::create_symlink("inside.ktx2", s.folder / name);  // within the folder is fine
    put(s.folder / "inside.ktx2", text);
    CHECK(s.read());
    fs::remove(s.folder / name);
    put(s.folder / name, text);
  }
  Report report;
  CHECK(readProbes(s.box.path / "none", report).error().what.find("no such folder") != std::string::npos);
  CHECK(readProbes(s.manifest, report).error().what.find("no folder") != std::string::npos);
  CHECK(readProbes(s.box.path, report).error().what.find("probes.json") != std::string::npos);
}

TEST_CASE("Payloads with the right hash and wrong values are refused", "[probe][store][hostile]") {
  const Stored s;
  for (const auto& [name, text] : contentOf(s.folder)) {
    if (name == "probes.json") continue;
    std::string changed = text;  // ends in texels: NaN now, as halves and as floats
    for (std::size_t i = 1; i <= 8; ++i) changed[text.size() - i] = '\xff';
    s.replace(name, changed);
    checkError(s.read(), s.folder / name);
    CHECK(s.read().error().what.find("holds") != std::string::npos);
    std::mt19937 random(5);
    for (int round = 0; round < 300; ++round) {  // headers
      changed = text;
      for (unsigned flips = 1 + random() % 4; flips > 0; --flips) changed[random() % 300] ^= char(1u << random() % 8);
      s.replace(name, changed);
      const auto read = s.read();
      if (!read) REQUIRE(read.error().place.find((s.folder / name).string()) == 0);
    }
    s.replace(name, text);
    CHECK(s.read());
  }
}
