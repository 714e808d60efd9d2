// Quality: which rung of each term is in force, and how the picture is developed. Rungs are specialised into programs when they are linked.
#pragma once
#include <burnish/result.h>

#include <cstdint>
#include <optional>
#include <span>

namespace burnish {

enum class ToneMap : std::uint8_t { None, Neutral, AgX, Aces };  ///< None clips; Neutral is Khronos PBR Neutral; Aces is the fit by Stephen Hill
enum class Geometry : std::uint8_t { Void, Kelemen };            ///< visibility term of the specular lobe
enum class Lobe : std::uint8_t { Exp2, Stable };                 ///< evaluation of (n·h)^p
enum class EnvironmentSpecular : std::uint8_t { None, Dfg };     ///< reflection of the surroundings
enum class Occlusion : std::uint8_t { None, Baked };             ///< ambient occlusion from map C, with specular occlusion

struct Quality {
  Geometry geometry = Geometry::Kelemen;
  Lobe lobe = Lobe::Stable;
  EnvironmentSpecular environmentSpecular = EnvironmentSpecular::Dfg;
  Occlusion occlusion = Occlusion::Baked;
  ToneMap toneMap = ToneMap::Neutral;
  std::optional<float> exposureEv;  ///< EV100; empty: automatic from this picture alone
  /// Irradiance (lux) under which a light without a range is cut off; the loss is reported.
  float lightThreshold = 0.02f;
};

/// Names as the command line spells them, in the order of the enums.
BURNISH_API std::span<const std::string_view> toneMapNames();

}  // namespace burnish
