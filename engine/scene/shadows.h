// Which shadow maps a view wants, and what is drawn into each: for lights that cast shadows and reach something in view. Placement and culling are in double precision; a map's content is a
// number that stays the same for as long as the map would be drawn the same.
#pragma once
#include <array>

#include "scene/visibility.h"

namespace burnish::scene {

/// What may stand in a light. Only casters of some map have `content`.
struct ShadowCaster {
  Placed placed;
  bool casts = true;    ///< it is drawn into maps
  bool cutout = false;  ///< alpha tested: its material counts
  bool seen = false;    ///< the view sees it: shadows may fall on it
  std::uint64_t content = 0;  ///< of what is drawn; 0: not asked for yet
};
/// One depth picture from a light, reversed depth: 1 nearest to it.
struct ShadowMap {
  std::uint64_t content = 0;  ///< the same number: the same picture
  glm::dvec3 origin{0};       ///< world, m
  glm::dmat4 clip{1};         ///< world axes, relative to `origin`, to clip space
  std::vector<std::uint32_t> casters;  ///< indices into ShadowSet::casters
  bool sun = false;           ///< of a directional light
  int layer = -1;             ///< where the pass "shadow_maps" keeps it
};
/// A cascade: all that stands within `radius` of the axis through `center`, and within it in depth.
struct Cascade {
  int map = -1;           ///< index into ShadowSet::maps
  glm::dvec3 center{0};   ///< world, m, on the texel grid
  double radius = 1;      ///< half the map's side, m
  double far = 1, near = 1;  ///< m from the centre, away from the light and toward it
};
struct SunShadow {
  glm::dmat3 axes{1};  ///< columns: right, up, toward the light
  double tangent = 0;  ///< of the angle that half the light takes, for soft shadows
  std::vector<Cascade> cascades;  ///< nearest first
};
/// Of a spot light (one map) or a point light (six, of a cube along the world's axes: shading/shadow.h has their order).
struct LocalShadow {
  bool cube = false;
  std::array<int, 6> maps{-1, -1, -1, -1, -1, -1};  ///< indices; -1: nothing stands in that part of the light, or shows it
  glm::dvec3 origin{0};
  glm::dmat3 axes{1};      ///< right, up, forward
  double tangent = 1;      ///< of half the angle of view
  double near = 0.01, far = 1;  ///< m
  double sourceRadius = 0;
};
struct ShadowSet {
  std::vector<ShadowCaster> casters;
  std::vector<ShadowMap> maps;
  std::vector<SunShadow> suns;      ///< of the first directional lights, in order
  std::vector<LocalShadow> locals;  ///< of the first local lights, in order
  std::vector<std::string> callers; ///< names of the lights, suns first
  [[nodiscard]] bool empty() const { return suns.empty() && locals.empty(); }
};

/// Texels that a rung's kernel reaches from the middle, the normal offset included: maps are as much wider than what they must show.
int shadowReach(Shadow rung);

/// Fills `out`, and moves the lights that have shadows to the front of their lists. Limits that are passed and sizes that are held are reported. `seen`: the view's instances;
/// Reach::Everywhere: all instances count as seen.
void gatherShadows(const Scene& scene, const Derived& derived, const ViewFrame& frame, const Quality& quality, const std::vector<VisibleInstance>& seen, Reach reach, LightSet& lights, Report& report,
                   ShadowSet& out);

/// Takes the shadows of directional (or of point and spot) lights away, with their maps.
void dropShadows(ShadowSet& set, bool suns);

// cascades.cpp
/// Ranges of distance along the view in which there is something to see, divided into at most `count`, in order: near and far, m. `distances`: near and far of each thing.
std::vector<glm::dvec2> splitDistances(std::vector<glm::dvec2> distances, double near, double most, int count);
/// Nearest and farthest of what a view sees of a box, along the view (m; x > y: nothing). `center` is relative to the eye.
glm::dvec2 distancesOf(const ViewFrame& frame, glm::dvec3 center, glm::dvec3 extent);
/// A sphere around the part of the view between two distances: its centre along the view's axis, and its radius (m).
glm::dvec2 boundSlice(const ViewFrame& frame, glm::dvec2 range);
/// Axes of a directional light's maps.
glm::dmat3 sunAxes(glm::dvec3 toLight);
/// A cascade around a slice of the view, on the texel grid; near and far are still the sphere's.
Cascade placeCascade(const ViewFrame& frame, const glm::dmat3& axes, glm::dvec2 range, int resolution, int reach);

}  // namespace burnish::scene
