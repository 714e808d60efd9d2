// irradianceSh(): checks, and the module's own sums as plain numbers.
#include <algorithm>

#include "prefilter/irradiance.h"
#include "prefilter/parallel.h"

namespace burnish {
namespace {

burnish::IrradianceSh plain(prefilter::IrradianceSh sh, bool deRing) {
  if (deRing) prefilter::deRing(sh);
  burnish::IrradianceSh out{};
  for (std::size_t i = 0; i < 9; ++i) out[i] = {sh[i].x, sh[i].y, sh[i].z};
  return out;
}

}  // namespace

Result<IrradianceSh> irradianceSh(const CubeLevel& source, bool deRing, int threads) {
  if (source.size < 1 || source.texels.size() != std::size_t(source.size) * std::size_t(source.size) * 18) return fail("irradianceSh", "the source lacks texels", "read it again");
  return plain(prefilter::irradianceOf(source, prefilter::threadsFor(threads)), deRing);
}

Result<IrradianceSh> irradianceSh(const Image& latLong, bool deRing, int threads) {
  if (latLong.type != PixelType::F32 || latLong.channels < 3 || latLong.width < 1 || latLong.height < 1 || latLong.data.size() != latLong.byteSize())
    return fail("irradianceSh", "the source is no float picture of three or four channels", "convert it first");
  return plain(prefilter::irradianceOf(latLong, prefilter::threadsFor(threads)), deRing);
}

}  // namespace burnish
