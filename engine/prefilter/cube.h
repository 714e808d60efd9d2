// Where a cube's texels are and how large, and pictures brought onto cubes.
#pragma once
#include <burnish/image.h>

#include <glm/glm.hpp>
#include <vector>

namespace burnish::prefilter {

/// Direction (not normalized) of a point on a face; u, v in [-1, 1] (OpenGL 4.5 specification, table 8.19).
glm::dvec3 cubeDirection(int face, double u, double v);
/// Unit vector to the centre of texel (x, y) of an N² face.
glm::dvec3 texelDirection(int size, int face, int x, int y);
/// Solid angle of texel (x, y) of an N² face, exact (Driscoll 2012).
double texelSolidAngle(int size, int x, int y);
/// Of all texels of a face, row by row.
std::vector<double> texelSolidAngles(int size);
/// "face +X, column 3, row 7".
std::string texelName(int size, std::size_t texel);

[[nodiscard]] inline std::size_t faceTexels(int size) { return std::size_t(size) * std::size_t(size); }

/// A lat-long picture (F32, 3 or 4 channels) on a cube: each texel is the mean of n × n bilinear samples, n such that no texel of the picture is stepped over.
CubeLevel cubeFromLatLong(const Image& latLong, int size, int threads = 1);
/// A cube at another size: the mean of its texels by solid angle where the size divides, else bilinear samples within faces, as many as no texel is stepped over by.
CubeLevel resized(const CubeLevel& cube, int size, int threads = 1);

}  // namespace burnish::prefilter
