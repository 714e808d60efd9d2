// Inputs for the table of text.h: numbers by what a header says of them, and directions.
#pragma once
#include <initializer_list>

#include "text.h"

namespace burnish::test {

/// A number that a function takes.
struct Input {
  float (*ordinary)(Random&);
  float (*adverse)(Random&);
};
extern const Input kCosine;      ///< any number; well conditioned in [0.02, 1]
extern const Input kUnit;        ///< [0, 1]
extern const Input kSin2;        ///< any number
extern const Input kAlpha;       ///< any number; roughness 0.02 to 1
extern const Input kAlphaUnit;   ///< [0, 1]
extern const Input kPower;       ///< >= 0, any number; up to 1.25e7
extern const Input kAny;         ///< any number; [-1, 1]
extern const Input kIndex;       ///< any number; index of refraction 1.05 to 4
extern const Input kInside;      ///< any number; index of refraction 0.3 to 0.95
extern const Input kExtinction;  ///< any number; 0.5 to 8
extern const Input kRandom;      ///< [0, 1), as random numbers are
extern const Input kInteger;     ///< 0 to 2^24 - 1
extern const Input kCoefficient; ///< any number up to the largest float over 32
extern const Input kRadiance;    ///< >= 0, any number
extern const Input kDistance2;   ///< 1e-4 and more
extern const Input kByte;        ///< [0, 1], as 8-bit textures hold it
extern const Input kZero;

/// a.x, a.y, ... take the inputs in turn.
Domain numbers(std::string name, std::initializer_list<Input> inputs);

float uniform(Random& random, float lo, float hi);
/// Uniform on the sphere.
glm::vec3 randomUnit(Random& random);
/// Unit within rounding: along axes, near them, with zeros of both signs and denormals, at random.
glm::vec3 hardUnit(Random& random);
/// Unit, near `from`: the same, opposite, perpendicular within rounding, or turned by 1e-7 to 1 radians.
glm::vec3 hardNear(Random& random, const glm::vec3& from);

/// a: normal and alpha; b: to the light; c: to the eye; d: albedo and substance; e, f: (scale, bias) of a lobe, at n·v, at n·l and in the mean.
extern const Domain kShading;
/// The same with e: tangent and strength of anisotropy; f: two indices and two extinctions.
extern const Domain kMetal;

}  // namespace burnish::test
