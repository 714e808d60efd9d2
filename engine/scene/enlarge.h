// Enlarging a picture to the size of the one it is merged with.
#pragma once
#include <burnish/scene.h>

namespace burnish::scene {

/// Bilinear enlargement of an RGBA8 image to width x height, as a sampler with this wrap would see it. `srgb`
/// interpolates RGB in linear light.
Image enlarged(const Image& rgba, int width, int height, bool srgb, Wrap wrapU, Wrap wrapV);

}  // namespace burnish::scene
