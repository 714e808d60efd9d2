// The Khronos validator's own files with its verdicts, and the Khronos sample models, where ../shared/data holds them.
#include <fmt/format.h>

#include <algorithm>

#include "gltf_fixture.h"

using namespace gltf_test;

namespace {

// What is mended with a warning, on purpose: content of pictures, a byte order mark (readers may skip it, glTF 2.0,
// section 2.7), vectors and colours that a clamp or a normalization puts right, textures without coordinates.
const std::set<std::string> kMended = {"IMAGE_DATA_INVALID",        "IMAGE_UNEXPECTED_EOS",
                                       "IMAGE_MIME_TYPE_INVALID",   "ROTATION_NON_UNIT",
                                       "ACCESSOR_VECTOR3_NON_UNIT", "ACCESSOR_INVALID_SIGN",
                                       "ACCESSOR_NON_CLAMPED",      "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS"};

// Range, type, reference and finiteness faults. Not among them: what a GLB header or JSON syntax gets wrong (those have
// no JSON path), the content of pictures, and files that are not there.
bool isContentFault(const std::string& code) {
  if (code.starts_with("GLB_") || code.starts_with("IMAGE_DATA") || code.starts_with("IMAGE_UNEXPECTED") ||
      code.starts_with("IMAGE_MIME"))
    return false;
  return code != "INVALID_JSON" && code != "IO_ERROR" && code != "INVALID_URI";
}

struct Case {
  fs::path file;
  std::vector<std::string> errors;  // codes
};

std::vector<Case> validatorCases() {
  std::vector<Case> cases;
  const fs::path base = sharedData() / "gltf-validator/base";
  if (!fs::exists(base)) return cases;
  for (const auto& entry : fs::recursive_directory_iterator(base)) {
    const std::string name = entry.path().string();
    constexpr std::string_view kEnd = ".report.json";
    if (!name.ends_with(kEnd)) continue;
    Case c{name.substr(0, name.size() - kEnd.size()), {}};
    const Json report = Json::parse(slurp(name));
    for (const Json& m : report["issues"]["messages"])
      if (m["severity"] == 0) c.errors.push_back(m["code"]);
    cases.push_back(std::move(c));
  }
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.file < b.file; });
  return cases;
}

bool namesPath(const burnish::Error& e) { return e.place.find(": /") != std::string::npos; }

}  // namespace

TEST_CASE("the validator's files get the validator's verdict", "[gltf]") {
  const auto cases = validatorCases();
  if (cases.empty()) {
    WARN("no ../shared/data/gltf-validator: nothing to compare with");
    return;
  }
  int invalid = 0, refused = 0, faults = 0, faultsRefused = 0;
  double slowest = 0;
  std::set<std::string> mended;
  for (const Case& c : cases) {
    const Reading r = read(c.file);
    slowest = std::max(slowest, r.seconds);
    INFO(c.file.string() << ": " << r.message());
    CHECK(r.seconds < timeLimit(1));
    if (c.errors.empty()) {
      CHECK(r.asset);
      continue;
    }
    const bool fault = std::any_of(c.errors.begin(), c.errors.end(), isContentFault);
    ++invalid, refused += !r.asset, faults += fault, faultsRefused += fault && !r.asset && namesPath(r.asset.error());
    if (!fault) continue;
    if (r.asset)
      for (const std::string& code : c.errors) {
        CHECK(kMended.contains(code));
        mended.insert(code);
        CHECK_FALSE(r.report.empty());
      }
    else
      CHECK(namesPath(r.asset.error()));
  }
  const double share = 100.0 * faultsRefused / faults;
  std::string codes;
  for (const std::string& code : mended) codes += " " + code;
  WARN(fmt::format(
      "validator's set: {} of {} invalid files refused; of {} with range, type, reference or finiteness faults "
      "{} with a JSON path ({:.1f} %); mended with a warning:{}; slowest {:.1f} ms",
      refused, invalid, faults, faultsRefused, share, codes, slowest * 1e3));
  CHECK(share >= 95);
}

TEST_CASE("the Khronos sample models load", "[gltf]") {
  struct Expected {
    const char* file;
    std::size_t nodes, triangles, materials, warnings;
  };
  // Triangles and nodes of the scenes as the files' own accessors count them.
  const Expected models[] = {{"EnvironmentTest/EnvironmentTest.gltf", 6, 25344, 3, 0},
                             {"Fox/Fox.glb", 26, 576, 1, 0},
                             {"LightsPunctualLamp/LightsPunctualLamp.gltf", 8, 6000, 3, 0},
                             {"MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", 119, 1040409, 98, 0},
                             {"NormalTangentMirrorTest/NormalTangentMirrorTest.glb", 1, 5240, 1, 0},
                             {"SpecularTest/SpecularTest.glb", 25, 44828, 24, 0},
                             {"TextureTransformTest/TextureTransformTest.gltf", 12, 18, 9, 0},
                             {"WaterBottle/WaterBottle.gltf", 1, 4510, 1, 0}};
  for (const Expected& e : models) {
    const fs::path file = sharedData() / "gltf" / e.file;
    if (!fs::exists(file)) continue;
    const Reading r = read(file);
    INFO(e.file << ": " << r.message());
    REQUIRE(r.asset);
    CHECK(r.asset->nodes.size() == e.nodes);
    CHECK(r.asset->materials.size() == e.materials);
    CHECK(r.report.warnings().size() == e.warnings);
    std::size_t triangles = 0;
    for (const auto& mesh : r.asset->meshes)
      for (const auto& p : mesh.primitives) triangles += p.indices.size() / 3;
    CHECK(triangles == e.triangles);
    CHECK(r.seconds < timeLimit(1));
  }
}
