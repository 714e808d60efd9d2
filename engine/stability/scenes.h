// Small scenes and pictures for the hard cases.
#pragma once
#include "stability/cases.h"

namespace burnish::stability {

/// A unit sphere around the origin, finely tessellated.
Mesh sphere(std::uint32_t rings, std::uint32_t columns);
/// The half of it that faces +z, and two rings more.
Mesh halfBall(std::uint32_t rings, std::uint32_t columns);
/// A rectangle around `center` spanned by the half-vectors u and v; faces u × v.
Mesh quad(glm::vec3 center, glm::vec3 u, glm::vec3 v);
/// A 2x2 map B: flat normals, roughness 1.
Texture flatNormals();
void place(Scene& scene, Mesh mesh, const Material& material, const glm::dmat4& local = glm::dmat4(1));
glm::dmat4 translation(glm::dvec3 to);
/// At `position`, shining along `direction`.
void addLight(Scene& scene, Light light, glm::dvec3 position, glm::dvec3 direction = {0, 0, -1});
void addLight(Scene& scene, LightKind kind, float intensity, glm::dvec3 position, glm::dvec3 direction = {0, 0, -1});

struct Picture {
  Image image;
  std::uint64_t nonfinite = 0;  ///< pixels of the light buffer, and of the picture where it holds floats
  /// From the top left corner; 0..1 where the image is 8-bit.
  [[nodiscard]] glm::dvec3 at(int x, int y) const;
};
/// With Quality::exposureEv the picture is for a display, without it linear radiance.
Result<Picture> draw(Studio& studio, const Scene& scene, std::span<const View> views, glm::ivec2 size, RenderRequest request, const Quality& quality = {});
inline Result<Picture> draw(Studio& studio, const Scene& scene, const View& view, glm::ivec2 size, const RenderRequest& request, const Quality& quality = {}) {
  return draw(studio, scene, {&view, 1}, size, request, quality);
}

/// The brightest value of any channel.
double brightest(const Picture& picture);
/// The largest difference of a channel over the other's value there.
double largestShare(const Picture& picture, const Picture& other);

struct Ray {
  glm::dvec3 origin, direction;  ///< direction: unit length
};
/// The ray through a point of the picture (pixels from the top left corner; centres at .5) of a view that fills it.
Ray rayThrough(const View& view, glm::ivec2 size, double x, double y);

}  // namespace burnish::stability
