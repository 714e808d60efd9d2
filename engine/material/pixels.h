// Pictures in the one form that the map builders take: 8 bits, four channels.
#pragma once
#include <burnish/image.h>

#include <optional>

namespace burnish::material {

/// RGBA, 8 bits: grey is spread over RGB, a missing alpha is 255, 16 bits are rounded, floats are clamped to 0..1.
Image toRgba8(const Image& image);

/// The value of a channel of an RGBA8 image where all pixels agree.
std::optional<std::uint8_t> constantChannel(const Image& rgba, int channel);

/// Mean of a channel of an RGBA8 image, 0..1; `srgb` decodes it first.
float meanChannel(const Image& rgba, int channel, bool srgb);

}  // namespace burnish::material
