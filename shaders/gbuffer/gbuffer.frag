// Fills the G-buffer: RT0 albedo (square root) + substance code, RT1 octahedral normal 2x12 + log-alpha code, RT2 baked ambient occlusion.
// Definitions: GENERAL, ALPHA_TEST, OCCLUSION (0: no third target), SPECULAR_ANTIALIASING (gbuffer/fetch.glsl).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/rungs.h"
#include "shading/roughness.h"
#include "shading/normals.h"
#include "shading/filter.h"
#include "shading/albedo.h"
#include "interface/layout.h"
#include "gbuffer/fetch.glsl"

layout(location = 0) out vec4 outAlbedoSubstance;
layout(location = 1) out vec4 outNormalRoughness;
#if OCCLUSION
layout(location = 2) out float outOcclusion;
#endif

void main() {
  Fetched f = fetchMaterial();
  outAlbedoSubstance = vec4(encodeAlbedo(f.albedo), f.code);
  outNormalRoughness = vec4(packNormal(f.normal), encodeAlpha(storedAlpha(f.alpha)));
#if OCCLUSION
  outOcclusion = f.occlusion;
#endif
}
