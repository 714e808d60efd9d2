// A light's reflection as the renderer samples it (H27 of docs/hard_cases.md): engine/stability/reflected_disc.h.
#include "stability/reflected_disc.h"

#include "gl_fixture.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

TEST_CASE("a disc of 0.53 degrees reflected through GL has the analytic light's profile (H27)") {
  GlFixture f;
  gl::ProgramCache programs(*f.device, gl::ShaderLibrary(std::filesystem::path()));
  // In the middle of a face; across the edge of +X and -Z; in a corner.
  for (const dvec3& centre : {dvec3(0.1, 0.2, 1), dvec3(1, 0.3, -0.99), dvec3(-1, 0.985, -0.99)}) {
    stability::Disc disc;
    disc.centre = glm::normalize(centre);
    const auto levels = stability::reflectedDisc(*f.device, programs, disc, 2048, 1024);
    if (!levels) FAIL(levels.error().message());
    REQUIRE(!levels->empty());
    for (const stability::ReflectedLevel& l : *levels) {
      WARN("disc at (" << centre.x << ", " << centre.y << ", " << centre.z << "), level " << l.level << ", r " << l.roughness << ": off by " << 100 * l.ours << " % of the peak, a perfect level by " << 100 * l.bilinear
                       << " %; from that at most " << 100 * l.beyond << " %, at " << glm::degrees(l.at) << " degrees");
      CHECK(l.ours < l.bilinear + 5e-3);
      CHECK(l.beyond < 5e-3);
    }
  }
}
