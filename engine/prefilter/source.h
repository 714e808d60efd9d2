// What is filtered: texels as point samples at their centres, weighted by their exact solid angles.
#pragma once
#include <burnish/image.h>

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "prefilter/harmonics.h"
#include "prefilter/kernels.h"

namespace burnish::prefilter {

/// A direction as the transforms have it: their axis is the cube's Y.
[[nodiscard]] inline glm::dvec3 aboutY(const glm::dvec3& d) { return {d.x, d.z, d.y}; }

/// The centres of a cube's texels, sorted into bins. `values`: room for four a point; `order`: kept.
SortedPoints cubePoints(int size, int bins, bool values, bool order);

/// A source splits into its mean, a few texels far over it (summed one by one), and the rest less the mean. Sums over the sphere, Σ over texels of f ω, then come as four channels: the rest
/// in red, green and blue, and 1 in the fourth, so that Σ L w ω/Σ w ω is mean + (rest + bright)/fourth, exact for a constant source whatever the transforms round off.
class Source {
 public:
  virtual ~Source() = default;
  [[nodiscard]] virtual std::size_t texels() const = 0;
  /// The largest angle across a texel, radians.
  [[nodiscard]] virtual double texelAngle() const = 0;
  /// Σ rest ω Y_lm*. *made: CPU ms spent on tables that later calls find.
  [[nodiscard]] virtual Harmonics analyse(int bands, const GridChoice& choice, int threads, double* made) const = 0;
  /// Arrays of all texels (directions as aboutY makes them), made on the first call, which must not be made by several threads at once.
  [[nodiscard]] virtual const TexelsView& texelArrays(int threads) const = 0;
  /// Runs of texels that cover those within 1 - l·R < end, and some more. `direction` in world space.
  virtual void runsNear(const glm::dvec3& direction, double end, std::vector<Run>& runs) const = 0;

  glm::dvec3 mean{0};          ///< of all but the bright ones
  std::vector<double> bright;  ///< six each: direction (aboutY), (radiance - mean) · solid angle

 protected:
  std::vector<std::uint32_t> brightTexels_;  ///< rising
};

/// The source keeps a reference to the level or picture. All texels finite and not negative.
std::unique_ptr<Source> makeSource(const CubeLevel& cube, int threads);
std::unique_ptr<Source> makeSource(const Image& latLong, int threads);

}  // namespace burnish::prefilter
