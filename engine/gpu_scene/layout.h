// shaders/interface/layout.h as C++, offsets asserted against std140.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>

namespace burnish::gpu_scene {
using glm::ivec4;
using glm::mat4;
using glm::vec4;
#include "interface/layout.h"

static_assert(offsetof(FrameData, rayOrigin) == 64 && offsetof(FrameData, viewport) == 208 && offsetof(FrameData, irradiance) == 240);
static_assert(offsetof(FrameData, fog) == 384 && sizeof(FrameData) == 384 + 9 * 16 + 2 * MAX_DIRECTIONAL * 16);
static_assert(sizeof(DrawData) == DRAW_VECTORS * 16 && offsetof(DrawData, normal) == 112);
static_assert(sizeof(ShadowData) == 16 + MAX_SHADOW_SUNS * SUN_SHADOW_VECTORS * 16 && SUN_SHADOW_VECTORS == 4 + 2 * MAX_CASCADES);
static_assert(sizeof(GridData) == 8 * 16);
static_assert(sizeof(MaterialData) == 18 * 16 && offsetof(MaterialData, uv) == 64);

}  // namespace burnish::gpu_scene
