// Faults planted into the shading text, one at a time: each must turn a row of the stability table.
#include <burnish/measure.h>

#include <fstream>
#include <iostream>

#include "gl/embedded_shaders.h"
#include "gpu/gl_fixture.h"
#include "gpu/temporary_folder.h"

using namespace burnish;
using namespace burnish::test;

namespace {

struct Change {
  const char *file, *from, *to;
};
struct Plant {
  const char *name, *id;  ///< the case that must catch it
  std::vector<Change> changes;
};

std::string textOf(std::string_view file) {
  for (const gl::EmbeddedShader& s : gl::embeddedShaders())
    if (s.name == file) return std::string(s.text);
  FAIL("no shader " << file);
  return {};
}

/// Writes the changed files into the folder. Every change must find its place once.
void plant(const std::filesystem::path& folder, const std::vector<Change>& changes) {
  for (const Change& c : changes) {
    const std::filesystem::path file = folder / c.file;
    std::string text = textOf(c.file);
    if (std::ifstream in(file); in) text.assign(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = text.find(c.from);
    INFO(c.file << ": " << c.from);
    REQUIRE(at != std::string::npos);
    REQUIRE(text.find(c.from, at + 1) == std::string::npos);
    text.replace(at, std::string_view(c.from).size(), c.to);
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
}

}  // namespace

TEST_CASE("planted faults turn a row of the table") {
  const Plant plants[] = {
      {"the guard of the distance to a light taken out", "H21", {{"shading/constants.h", "GUARDED(4, R(1e-4), R(0.0))", "R(0.0)"}}},
      {"roughness for alpha in the lobe", "H15", {{"shading/roughness.h", "real a = max(alpha, BURNISH_GUARD_ALPHA);", "real a = max(sqrt(alpha), BURNISH_GUARD_ALPHA);"}}},
      {"roughness for alpha in specular occlusion", "H15", {{"shading/environment.h", "R(-16.0) * unitClamp(alpha)", "R(-16.0) * sqrt(unitClamp(alpha))"}}},
      {"a Fresnel exponent of 4", "H13", {{"shading/fresnel.h", "return x2 * x2 * x;", "return x2 * x2;"}}},
      {"shares of places that do not sum to 1", "H1", {{"shading/probes.h", "b.weight * (all / max(b.weight.x + b.weight.y + b.weight.z + b.weight.w, BURNISH_GUARD_LENGTH))", "b.weight * all"}}},
      {"a zero tangent's NaN not stopped before the G-buffer",
       "H18",
       {{"gbuffer/gbuffer.vert", "inversesqrt(max(dot(v, v), 1e-30))", "inversesqrt(dot(v, v))"}, {"gbuffer/fetch.glsl", "m = m2 > 1e-12 ? m : worldNormal;", ""}}},
  };
  const auto context = openContext();
  for (const Plant& p : plants) {
    INFO(p.name);
    const TemporaryFolder folder;
    plant(folder.path, p.changes);
    StabilityOptions options;
    options.cases = {p.id};
    options.quick = true;
    options.shaderOverride = folder.path;
    int caught = 0, rows = 0;
    for (const StabilityCase& r : stabilityOnGpu(context->procAddress(), "gpu", options)) {
      ++rows;
      // By its value: a program that does not compile is no catch.
      if (r.pass || !std::isfinite(r.value)) continue;
      ++caught;
      std::cout << "  " << p.name << ": " << r.id << " " << r.what << ": " << r.value << " of " << r.bound << " " << r.note << "\n";
    }
    CHECK(rows > 0);
    CHECK(caught > 0);
  }
}
