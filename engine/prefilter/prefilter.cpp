// prefilterCubemap(): checks, the table of levels, level 0.
#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include "prefilter/cube.h"
#include "prefilter/filter.h"
#include "prefilter/parallel.h"
#include "reference/shading.h"

namespace burnish {
namespace prefilter {
namespace {

constexpr int kLargestFace = 8192, kLargestSource = 16384;
constexpr const char* kPlace = "prefilter";

Result<void> checkOptions(const PrefilterOptions& o) {
  if (o.size < 16 || o.size > kLargestFace || !std::has_single_bit(unsigned(o.size)))
    return fail(kPlace, fmt::format("faces of {} texels", o.size), fmt::format("ask for a power of two from 16 to {}", kLargestFace));
  const int most = std::countr_zero(unsigned(o.size)) + 1;
  if (o.levels < 0 || o.levels > most) return fail(kPlace, fmt::format("{} levels of faces from {} texels down", o.levels, o.size), fmt::format("ask for 1 to {}, or 0 for faces down to 8", most));
  if (!(o.error >= 1e-7 && o.error <= 0.1)) return fail(kPlace, fmt::format("an error of {}", o.error), "ask for 1e-7 to 0.1");
  return {};
}

/// `name(i)`: of value i's texel.
template <class Name>
Result<void> checkValues(const float* values, std::size_t texels, std::size_t channels, const Name& name) {
  for (std::size_t i = 0; i < texels; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = values[i * channels + c];
      if (v >= 0 && v <= std::numeric_limits<float>::max()) continue;
      return fail(kPlace, fmt::format("{}: the value {} is {}", name(i), v, v < 0 ? "negative" : "not finite"), "replace it, for instance by its neighbours' mean");
    }
  return {};
}

Result<void> check(const CubeLevel& cube) {
  if (cube.size < 1 || cube.size > kLargestSource) return fail(kPlace, fmt::format("a cube of {}² faces", cube.size), fmt::format("give one of 1 to {}", kLargestSource));
  if (cube.texels.size() != 18 * faceTexels(cube.size))
    return fail(kPlace, fmt::format("a cube of {}² faces with {} values", cube.size, cube.texels.size()), fmt::format("it takes {} (three a texel)", 18 * faceTexels(cube.size)));
  return checkValues(cube.texels.data(), cube.texels.size() / 3, 3, [&](std::size_t i) { return texelName(cube.size, i); });
}

Result<void> check(const Image& image) {
  if (image.type != PixelType::F32 || image.channels < 3 || image.channels > 4) return fail(kPlace, "the picture is not of floats with 3 or 4 channels", "convert it");
  if (image.width < 1 || image.height < 1 || image.width > kLargestSource || image.height > kLargestSource || image.data.size() != image.byteSize())
    return fail(kPlace, fmt::format("a picture of {} × {} pixels in {} bytes", image.width, image.height, image.data.size()), fmt::format("give one of 1 to {} pixels a side", kLargestSource));
  return checkValues(image.f32(), image.pixelCount(), std::size_t(image.channels),
                     [&](std::size_t i) { return fmt::format("column {}, row {}", i % std::size_t(image.width), i / std::size_t(image.width)); });
}

CubeLevel levelZero(const CubeLevel& cube, int size, int threads) { return resized(cube, size, threads); }
CubeLevel levelZero(const Image& latLong, int size, int threads) { return cubeFromLatLong(latLong, size, threads); }

template <class Input>
Result<Cubemap> filtered(const Input& input, const PrefilterOptions& o, PrefilterReport* report) {
  if (auto ok = checkOptions(o); !ok) return fail(ok.error());
  if (auto ok = check(input); !ok) return fail(ok.error());
  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpuMilliseconds();
  PrefilterReport mine;
  FilterOptions options{o.lobe, o.error, threadsFor(o.threads), true};
  const int count = o.levels ? o.levels : std::countr_zero(unsigned(o.size)) - 2, last = count - 1;
  Cubemap out;
  out.lobe = o.lobe;
  out.levels.push_back(levelZero(input, o.size, options.threads));
  const auto elapsed = [&] { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count(); };
  mine.levels.push_back({o.size, 0, std::numeric_limits<double>::infinity(), 0, 0, elapsed()});
  std::vector<LevelSpec> specs;
  for (int k = 1; k <= last; ++k) specs.push_back({o.size >> k, shading::f64::environmentRoughness(double(k), double(last))});
  if (!specs.empty()) {
    const std::unique_ptr<Source> source = makeSource(input, options.threads);
    for (CubeLevel& level : filterLevels(*source, specs, options, &mine, o.progress)) out.levels.push_back(std::move(level));
  }
  mine.wallMs = elapsed();
  mine.cpuMs = cpuMilliseconds() - cpu;
  if (report) *report = std::move(mine);
  return out;
}

}  // namespace
}  // namespace prefilter

Result<Cubemap> prefilterCubemap(const CubeLevel& source, const PrefilterOptions& options, PrefilterReport* report) { return prefilter::filtered(source, options, report); }
Result<Cubemap> prefilterCubemap(const Image& latLong, const PrefilterOptions& options, PrefilterReport* report) { return prefilter::filtered(latLong, options, report); }

}  // namespace burnish
