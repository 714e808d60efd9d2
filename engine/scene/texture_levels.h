// A texture's levels as every way of reading it has them.
#pragma once
#include <burnish/scene.h>

#include <vector>

namespace burnish::scene {

/// The default map's one texel of each unit (A, B, C, metal-rough, emissive), RGBA: what stands in where a material has none.
inline constexpr std::uint8_t kDefaultTexels[5][4] = {{255, 255, 255, 85}, {128, 128, 255, 255}, {255, 255, 0, 0}, {255, 255, 255, 255}, {255, 255, 255, 255}};

/// Level 0 first, with the channels that its kind is stored with (four; a map C one or two); that level alone where the sampler wants no mips.
/// `occlusion`: a map C to pack into the third channel of a map B (plan::packsOcclusion), or nullptr. Errors: an image that is empty, not 8 bit, or shorter than its size says.
Result<std::vector<Image>> levelsOf(const Texture& texture, const Texture* occlusion);

}  // namespace burnish::scene
