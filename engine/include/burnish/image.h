// Pictures and cubemaps on the CPU: containers, the decoding interface, the writers, and the filter that turns an environment into levels.
#pragma once
#include <burnish/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace burnish {

enum class PixelType : std::uint8_t { U8, U16, F16, F32 };
[[nodiscard]] constexpr int bytesPerChannel(PixelType t) { return t == PixelType::U8 ? 1 : t == PixelType::F32 ? 4 : 2; }

/// Interleaved pixels, rows from top to bottom, no padding. U8 and U16 are unsigned normalized.
/// The container does not know its colour space: the user of the image does (PNG base colour: sRGB; HDR, EXR: linear Rec.709).
struct Image {
  int width = 0, height = 0;
  int channels = 0;  ///< 1 to 4
  PixelType type = PixelType::U8;
  std::vector<std::byte> data;  ///< width * height * channels * bytesPerChannel(type) bytes

  [[nodiscard]] bool empty() const { return data.empty(); }
  [[nodiscard]] std::size_t pixelCount() const { return std::size_t(width) * std::size_t(height); }
  [[nodiscard]] std::size_t byteSize() const { return pixelCount() * std::size_t(channels) * std::size_t(bytesPerChannel(type)); }
  [[nodiscard]] const std::uint8_t* u8() const { return reinterpret_cast<const std::uint8_t*>(data.data()); }
  [[nodiscard]] std::uint8_t* u8() { return reinterpret_cast<std::uint8_t*>(data.data()); }
  [[nodiscard]] const float* f32() const { return reinterpret_cast<const float*>(data.data()); }
  [[nodiscard]] float* f32() { return reinterpret_cast<float*>(data.data()); }
};

/// Allocates a zeroed image. width, height >= 0, channels 1..4.
BURNISH_API Image makeImage(int width, int height, int channels, PixelType type);

struct DecodeLimits {
  int maxSide = 16384;                           ///< pixels
  std::uint64_t maxBytes = 1024ull * 1024 * 1024;  ///< decoded size, checked from the header before decoding
  double seconds = 20;                           ///< wall time for one picture
};

/// Turns a file's bytes into an Image. Accepts PNG, JPEG, Radiance HDR, OpenEXR by magic bytes, nothing else.
/// 8-bit files give U8, 16-bit PNG gives U16, HDR and EXR give F32. Channels stay as stored (1 grey, 2 grey and alpha, 3, 4); palettes
/// are expanded, CMYK becomes RGB, of more than four channels the first four are kept. Values are those of the file: no colour
/// conversion, no premultiplication, no EXIF rotation (glTF 2.0, 3.8.2); HDR and EXR may hold infinities and NaN. An EXR's picture is
/// its display window, zero where the file has no data. The two implementations of this project (makeDecoderPool here, and
/// makeInProcessDecoder of decode_inprocess.h) are safe to call from several threads at a time; one of your own is called from one
/// thread at a time unless its concurrency() says otherwise.
class BURNISH_API ImageDecoder {
 public:
  virtual ~ImageDecoder() = default;
  /// `name` is used in errors only. Never throws; a damaged file is one clear Error.
  virtual Result<Image> decode(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits = {}) = 0;
  /// How many calls of decode() may be under way at a time. Loaders use two threads at most, and one where this is 1.
  [[nodiscard]] virtual int concurrency() const { return 1; }
};

struct DecoderPoolOptions {
  std::filesystem::path helper;  ///< the `burnish-decode` program; empty: beside the running program, then the install folder
  int processes = 2;             ///< workers at most; started when first needed, reused, ended with the pool; a call waits for a free one
  bool startNow = false;         ///< starts the helper at once, in the background, so that its loading (160 ms of CPU) passes while you work
  std::uint64_t memoryBytes = 2048ull * 1024 * 1024;  ///< address-space limit of each worker beyond its start-up size; 64 MB go to the library
};

/// Decoding in helper processes with memory and time limits, so that a damaged picture costs one error and never the program. Nothing
/// is started for a file that is no picture or too large by its header. Destroy the pool only when no call is under way.
BURNISH_API std::unique_ptr<ImageDecoder> makeDecoderPool(DecoderPoolOptions options = {});

/// Writes an 8-bit PNG (1 to 4 channels, sRGB) under a temporary name, then renames it: never a half-written file.
BURNISH_API Result<void> writePng(const std::filesystem::path& file, const Image& image);
/// Writes a half or float OpenEXR (1 to 4 channels, linear), the same way. `F16` and `F32` images only.
BURNISH_API Result<void> writeExr(const std::filesystem::path& file, const Image& image);

/// One level of a cubemap: six square faces in OpenGL's order (+X -X +Y -Y +Z -Z), rows as OpenGL stores them (OpenGL 4.5 specification, table 8.19), linear RGB.
struct CubeLevel {
  int size = 0;               ///< texels along an edge
  double roughness = 0;       ///< what the level was filtered for; 0: the environment itself
  std::vector<float> texels;  ///< 3 · 6 · size²
};

/// The specular lobe that the levels of a cubemap match (docs/shading.md, section 5).
enum class ReflectionLobe : std::uint8_t { BlinnPhong, Ggx };

/// A cubemap with its levels, the largest first.
struct Cubemap {
  std::vector<CubeLevel> levels;
  std::optional<ReflectionLobe> lobe;  ///< none: not filtered, each level the mean of the one before
};

struct PrefilterOptions {
  ReflectionLobe lobe = ReflectionLobe::BlinnPhong;
  int size = 256;       ///< texels along an edge of level 0; a power of two, at least 16
  int levels = 0;       ///< 0: down to faces of 8²; more go down to 1² at most
  double error = 1e-4;  ///< allowed rms error of a level over its rms value, 1e-7 to 0.1
  int threads = 0;      ///< 0: one for each core; the result does not depend on it
  std::function<void(double share)> progress;  ///< called with 0 to 1 from the calling thread
};

/// What the filter did, for each level.
struct PrefilterReport {
  struct Level {
    int size = 0;
    double roughness = 0;
    double power = 0;  ///< of the Blinn-Phong lobe; infinite at roughness 0
    int bands = 0;     ///< spherical-harmonic bands summed; 0 where the sum is direct
    int samples = 0;   ///< texels of the source summed for an output texel, at most; 0 where bands are
    double ms = 0;     ///< wall time
  };
  std::vector<Level> levels;
  double wallMs = 0, cpuMs = 0;  ///< the filter alone
  double tablesMs = 0;           ///< of it, CPU time for tables that later calls find made
};

/// Levels of an environment, each the integral over the lobe of its roughness: L_k(R) = ∫ L w / ∫ w. Texels of the source count as point samples at their centres, weighted by their exact
/// solid angles. `source`: one level, or a lat-long picture (F32, 3 or 4 channels, its centre column toward -Z, its first row the zenith). Values that are not finite or negative are an
/// error that names the first of them.
BURNISH_API Result<Cubemap> prefilterCubemap(const CubeLevel& source, const PrefilterOptions& options = {}, PrefilterReport* report = nullptr);
BURNISH_API Result<Cubemap> prefilterCubemap(const Image& latLong, const PrefilterOptions& options = {}, PrefilterReport* report = nullptr);

/// Irradiance over π in a direction n, as spherical harmonics up to band 2 with every constant folded in: Σ coefficient[i] · basis[i], the basis 1, y, z, x, xy, yz, 3z² - 1, xz, x² - y² of n,
/// in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) (2,-1) (2,0) (2,1) (2,2) (Ramamoorthi and Hanrahan 2001). RGB, in the source's unit.
using IrradianceSh = std::array<std::array<double, 3>, 9>;
/// `source` as for prefilterCubemap(); values must be finite. deRing: bands 1 and 2 are damped (Sloan 2008) as little as leaves no direction negative; by nothing where none is.
BURNISH_API Result<IrradianceSh> irradianceSh(const CubeLevel& source, bool deRing = false, int threads = 0);
BURNISH_API Result<IrradianceSh> irradianceSh(const Image& latLong, bool deRing = false, int threads = 0);

/// What checkPrefilter found of one level: the filtered texels against a sum in double over every texel of the source.
struct PrefilterCheck {
  struct Level {
    int size = 0;
    double roughness = 0;
    int samples = 0;   ///< texels summed again; 0: nothing to compare with (roughness 0 of a source that is no cube of this size)
    double rms = 0;    ///< rms error of the samples' channels over the level's rms value
    double worst = 0;  ///< largest |error| / max(reference, 1e-6 of the level's mean), of the samples and of the level's brightest texel
    bool within = true;  ///< rms <= PrefilterCheckOptions::error and worst <= ten times that
  };
  std::vector<Level> levels;
  [[nodiscard]] bool within() const {
    for (const Level& level : levels)
      if (!level.within) return false;
    return true;
  }
};

struct PrefilterCheckOptions {
  int samples = 64;         ///< random texels of each level
  std::uint64_t seed = 1;   ///< which ones
  double error = 1e-4;      ///< the bound on rms; ten times it on the worst texel
  int threads = 0;          ///< 0: one for each core; the result does not depend on it
  std::function<void(double share)> progress;  ///< called with 0 to 1 from the calling thread
};

/// Sums random texels of each level again, by brute force in double: an independent judge of prefilterCubemap(), slow. `cubemap` needs a lobe; `source` as for prefilterCubemap().
BURNISH_API Result<PrefilterCheck> checkPrefilter(const CubeLevel& source, const Cubemap& cubemap, const PrefilterCheckOptions& options = {});
BURNISH_API Result<PrefilterCheck> checkPrefilter(const Image& latLong, const Cubemap& cubemap, const PrefilterCheckOptions& options = {});

/// What a file of surroundings holds: a cube, or a lat-long picture; linear, Rec.709.
struct EnvironmentFile {
  Cubemap cube;        ///< a cube's levels, the largest first; none for a lat-long picture
  Image latLong;       ///< F32, three channels; empty for a cube
  std::string layout;  ///< for people: "lat-long picture of 1024 x 512", "DDS cube, R16G16B16A16_FLOAT"
  std::string writer;  ///< the program that the file says wrote it; may be empty
  [[nodiscard]] bool isCube() const { return !cube.levels.empty(); }
};

struct EnvironmentFileOptions {
  ImageDecoder* decoder = nullptr;  ///< of PNG, JPEG, HDR and EXR pictures; none: makeDecoderPool() for this call
  DecodeLimits limits;              ///< of each picture; and of a cube's faces and of its texels as floats
  bool asStored = false;            ///< keeps values that are negative or not finite, to look at a file
};

/// Reads surroundings: a lat-long picture (2:1), a cross (4:3 or 3:4), a strip (6:1 or 1:6), a DDS or KTX2 cube, a pattern of six files ("face_%s.exr"), a folder of them, or what
/// writeCubemap wrote. docs/cubemaps.md has names, orientation, formats. 8-bit pictures are sRGB. Values that are NaN or negative become 0, infinite ones 65504, with a warning that counts
/// them and names the first. Damaged, cut off, too large or wrongly shaped files are one Error that names the file and the place.
BURNISH_API Result<EnvironmentFile> readEnvironment(const std::filesystem::path& file, Report& report, const EnvironmentFileOptions& options = {});
/// The six faces in order (+X -X +Y -Y +Z -Z); one path is as above.
BURNISH_API Result<EnvironmentFile> readEnvironment(std::span<const std::filesystem::path> faces, Report& report, const EnvironmentFileOptions& options = {});
/// A cubemap alone: a lat-long picture is an error. Levels, roughness and lobe are those that were written.
BURNISH_API Result<Cubemap> readCubemap(const std::filesystem::path& file, Report& report, const EnvironmentFileOptions& options = {});

/// Writes a cubemap as its name ends: .dds, .ktx2, .exr (all levels in one picture), or a folder of six EXR files a level (any other name). `type`: F16 or F32. Lobe and roughness go with it
/// (docs/cubemaps.md); the same cubemap gives the same bytes. Complete or absent, as every file of this library; a folder is written beside and exchanged as a whole. Values over 65504 are
/// held there in half floats, with a warning. Errors: levels that do not halve, values that are not finite, a folder that holds anything else.
BURNISH_API Result<void> writeCubemap(const std::filesystem::path& file, const Cubemap& cubemap, PixelType type, Report& report);

}  // namespace burnish
