// Quality: which rung of each term is in force, and how the picture is developed. Rungs are specialised into programs when they are linked: changing one
// recompiles the programs that it is part of and nothing else.
#pragma once
#include <burnish/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

enum class ToneMap : std::uint8_t { None, Neutral, AgX, Aces };  ///< None clips; Neutral is Khronos PBR Neutral; Aces is the fit by Stephen Hill

// The rungs of each term, cheap to exact; terms() below says what each is and where it comes from. docs/shading.md has the equations.

enum class Specular : std::uint8_t { Microfacet, Phong, BlinnPhong, ModifiedPhong, MaxPhong, NormalizedBlinnPhong, CookTorrance, Ward, WardAnisotropic, WardBounded, GgxSmith };
enum class Distribution : std::uint8_t { BlinnPhong, Beckmann, Ggx };
enum class Geometry : std::uint8_t { Void, Kelemen, SchlickSmith, Smith, VCavity };
enum class Normalization : std::uint8_t { None, LinearFit, LinearFit8, Plus2, Plus8, Exact };
enum class Lobe : std::uint8_t { Pow, Exp2, Stable };
enum class Fresnel : std::uint8_t { None, Schlick, SphericalGaussian, Dielectric, Conductor };
enum class Diffuse : std::uint8_t { Lambert, LambertFresnel, CoupledFit, Coupled, OrenNayarQualitative, OrenNayar, OrenNayarEnergy };
enum class Compensation : std::uint8_t { None, MultipleScattering };
enum class EnvironmentSpecular : std::uint8_t { None, Schlick, RoughSchlick, Dfg, Sampled };
enum class Ambient : std::uint8_t { None, Constant, ShL1, ShL2, Box };
enum class AmbientSource : std::uint8_t { Probes, Grid };  ///< where the scene has an ambient lattice (docs/probes.md)
enum class Reflection : std::uint8_t { Infinite, Box, BoxRough };  ///< of captured places (docs/probes.md)
enum class Occlusion : std::uint8_t { None, Baked, Screen4, Screen8, Screen16 };  ///< the screen's rungs take baked occlusion too, where it is the darker
enum class SpecularOcclusion : std::uint8_t { None, Ao, Lagarde };
enum class DirectOcclusion : std::uint8_t { None, Specular };
enum class Anisotropy : std::uint8_t { None, Tangents };         ///< of materials that are brushed
enum class RoughDiffuse : std::uint8_t { None, OrenNayar };     ///< of materials with a diffuse roughness of their own
enum class Path : std::uint8_t { Deferred, Forward };
enum class Shadow : std::uint8_t { None, Tap, Pcf, Pcss };
// Of the picture, not of the lighting equation (docs/post.md).
enum class Antialiasing : std::uint8_t { None, Edge, Temporal };
enum class Bloom : std::uint8_t { None, Scatter };
// Of how the lighting equation is sampled (docs/antialiasing.md).
enum class SpecularAntialiasing : std::uint8_t { None, Geometric };
// Of how a frame is stored (docs/storage.md).
enum class NormalStorage : std::uint8_t { Oct8, Oct12, Oct16 };          ///< octahedral normals of the G-buffer, bits an axis
enum class LightBuffer : std::uint8_t { R11G11B10, Rgba16F, Rgba32F };   ///< the format that radiance is gathered in

struct Quality {
  Specular specular = Specular::Microfacet;          ///< the next four count for Microfacet alone; Lobe for every power of a cosine
  Distribution distribution = Distribution::BlinnPhong;
  Geometry geometry = Geometry::Kelemen;
  Normalization normalization = Normalization::Exact;  ///< with Geometry::Void and Distribution::BlinnPhong; elsewhere D has its own
  Lobe lobe = Lobe::Stable;
  Fresnel fresnel = Fresnel::Schlick;
  Diffuse diffuse = Diffuse::CoupledFit;
  Compensation compensation = Compensation::None;
  EnvironmentSpecular environmentSpecular = EnvironmentSpecular::Dfg;
  Ambient ambient = Ambient::ShL2;
  AmbientSource ambientSource = AmbientSource::Grid;
  Reflection reflection = Reflection::Box;
  Occlusion occlusion = Occlusion::Baked;
  SpecularOcclusion specularOcclusion = SpecularOcclusion::Lagarde;
  DirectOcclusion directOcclusion = DirectOcclusion::None;
  Anisotropy anisotropy = Anisotropy::Tangents;
  RoughDiffuse roughDiffuse = RoughDiffuse::OrenNayar;
  /// Forward shades each surface where it is drawn, with every light: slow, unquantised, the reference of the deferred path. Rungs that the G-buffer cannot feed take it by themselves.
  Path path = Path::Deferred;

  /// Of lights that cast them (docs/shadows.md); the next four count where there are any.
  Shadow shadow = Shadow::Pcf;
  int shadowResolution = 1024;  ///< texels along a side of a shadow map, 16 to 8192
  int shadowCascades = 4;       ///< maps of a directional light, 1 to 4, each for a range of distances from the eye
  float shadowDistance = 0;     ///< metres from the eye up to which directional lights have shadows; 0: as far as there is something to see
  int shadowMaps = 64;          ///< of one view, 1 to 1024; a directional light takes shadowCascades, a spot light 1 (6 when wider than 60 degrees from its axis), a point light up to 6

  NormalStorage normalStorage = NormalStorage::Oct12;  ///< of Path::Deferred
  LightBuffer lightBuffer = LightBuffer::Rgba16F;      ///< of pictures for a display; linear output has 32-bit floats (but see RenderRequest::displayLight)
  /// Pixels that are shaded along a side, over those of the target: 0.25 to 1. What is drawn smaller is enlarged (bilinear, in linear light) before it is tone mapped. No effect with a debug view
  /// or where the target brings depth.
  float resolutionScale = 1;

  Antialiasing antialiasing = Antialiasing::None;
  SpecularAntialiasing specularAntialiasing = SpecularAntialiasing::None;
  Bloom bloom = Bloom::None;
  /// Share of the light that bloom scatters, 0 to 1.
  float bloomShare = 0.08f;
  /// Transparent surfaces over one pixel that are sorted exactly, 1 to 64; what lies in front of them is blended unsorted, with a warning.
  int transparentLayers = 8;

  ToneMap toneMap = ToneMap::Neutral;
  std::optional<float> exposureEv;  ///< EV100; empty: automatic from this picture alone
  /// Irradiance (lux) under which a light without a range is cut off; the loss is reported.
  float lightThreshold = 0.02f;
  /// How far screen-space occlusion looks, metres: occluders count in full up to half of it, then fade. On the screen it is held at a sixth of the view's height.
  float occlusionRadius = 1;
  friend bool operator==(const Quality&, const Quality&) = default;
};

/// One implementation of a term.
struct Rung {
  std::string_view name;    ///< as --set spells it
  std::string_view what;    ///< one line
  std::string_view source;  ///< paper and equation
  bool forwardOnly = false; ///< needs what the G-buffer does not hold: the frame takes Path::Forward
};
/// One function of the lighting equation and its rungs, in the order of its enum (cheap to exact).
struct Term {
  std::string_view name;  ///< as --set spells it
  std::string_view what;
  std::span<const Rung> rungs;
  bool picture = false;   ///< no part of a surface's lighting equation: it works on the finished picture or on how it is sampled or stored, or decides which light arrives
};

/// Every term. The index of a term is what rungOf and setRung take.
BURNISH_API std::span<const Term> terms();
/// The rung of a term that is in force; term < terms().size().
BURNISH_API std::size_t rungOf(const Quality& quality, std::size_t term);
/// Puts a rung in force; term and rung are indices into terms().
BURNISH_API void setRung(Quality& quality, std::size_t term, std::size_t rung);
/// By name, "fresnel", "schlick". Errors list what there is.
BURNISH_API Result<void> setRung(Quality& quality, std::string_view term, std::string_view rung);

/// seed: the talk that the project grew from (void geometry, (p + 8)/8 pi, Schlick, Lambert, occlusion on direct specular). default: Quality{}. exact: the top rung of each term.
/// Tone map, exposure, light threshold, occlusion radius, sizes of shadow maps and the terms of the picture (all but shadow) are no part of a preset.
BURNISH_API std::span<const std::string_view> presetNames();
/// Puts a preset's rungs in force. Errors list the names.
BURNISH_API Result<void> setPreset(Quality& quality, std::string_view name);

/// The first rung in force that the G-buffer cannot feed, as "term=rung"; empty when there is none.
BURNISH_API std::string forwardOnlyRung(const Quality& quality);
/// What the settings ask for that has no effect beside the others ("normalization=plus-8 has no effect with geometry=kelemen"), one text each.
BURNISH_API std::vector<std::string> idleRungs(const Quality& quality);

/// Everything in `quality` but the exposure, as a JSON file that people can edit: rungs by name, sizes as numbers. Complete or absent. `comment`: a line for people, may be empty.
BURNISH_API Result<void> writeQuality(const std::filesystem::path& file, const Quality& quality, std::string_view comment = {});
/// Reads what writeQuality wrote. What the file does not name is as in `base` there (a preset), else in the preset `default`; the exposure is left empty. Errors name the file, the place and what
/// there is: damaged JSON, names that are not known, numbers out of their range.
BURNISH_API Result<Quality> readQuality(const std::filesystem::path& file);

/// Names as the command line spells them, in the order of the enums.
BURNISH_API std::span<const std::string_view> toneMapNames();

}  // namespace burnish
