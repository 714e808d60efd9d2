// Pictures in the one form that the map builders take: 8 bits, four channels.
#pragma once
#include <burnish/image.h>
#include <burnish/scene.h>

#include <optional>

namespace burnish::material {

/// RGBA, 8 bits: grey is spread over RGB, a missing alpha is 255, 16 bits are rounded, floats are clamped to 0..1.
Image toRgba8(const Image& image);

/// The value of a channel of an RGBA8 image where all pixels agree.
std::optional<std::uint8_t> constantChannel(const Image& rgba, int channel);

/// Mean of a channel of an RGBA8 image, 0..1; `srgb` decodes it first.
float meanChannel(const Image& rgba, int channel, bool srgb);

/// Bilinear enlargement of an RGBA8 image to width x height, as a sampler with this wrap would see it. `srgb` interpolates RGB in linear light.
Image resized(const Image& rgba, int width, int height, bool srgb, Wrap wrapU, Wrap wrapV);

}  // namespace burnish::material
