// Fills the G-buffer: RT0 albedo (square root) + substance code, RT1 octahedral normal + log-alpha code (interface/stored_normal.glsl), then baked ambient occlusion and shading/detail.h's four bytes, if there.
// Definitions: NORMAL_STORAGE, GENERAL, ALPHA_TEST, OCCLUSION (gbuffer/fetch.glsl; 0: no target for it), SPECULAR_ANTIALIASING (likewise), ANISOTROPIC, ROUGH_DIFFUSE (1: the surface's; either writes the target of details).
#include "shading/bridge.h"
#include "shading/constants.h"
#include "shading/rungs.h"
#include "shading/roughness.h"
#include "shading/normals.h"
#include "shading/filter.h"
#include "shading/albedo.h"
#if ANISOTROPIC || ROUGH_DIFFUSE
#include "shading/anisotropy.h"
#include "shading/detail.h"
#endif
#include "interface/layout.h"
#include "interface/stored_normal.glsl"
#include "gbuffer/fetch.glsl"

layout(location = 0) out vec4 outAlbedoSubstance;
layout(location = 1) out vec4 outNormalRoughness;
#if OCCLUSION
layout(location = 2) out float outOcclusion;
#endif
#if ANISOTROPIC || ROUGH_DIFFUSE
layout(location = OCCLUSION == 0 ? 2 : 3) out vec4 outDetail;
#endif

void main() {
  Fetched f = fetchMaterial();
  outAlbedoSubstance = vec4(encodeAlbedo(f.albedo), f.code);
  outNormalRoughness = vec4(storeNormal(f.normal), encodeAlpha(storedAlphaBeside(f.alpha, NORMAL_VARIANCE)));
#if OCCLUSION
  outOcclusion = f.occlusion;
#endif
#if ANISOTROPIC
  outDetail = packDetailCode(storedNormal(outNormalRoughness), brushedTangent(), encodeAlpha(storedAlphaBeside(brushedAlphaX(f.alpha), NORMAL_VARIANCE)), ROUGH_DIFFUSE == 1 ? material.attenuation.w : 0.0);
#elif ROUGH_DIFFUSE
  outDetail = vec4(0.0, 0.0, 0.0, material.attenuation.w);
#endif
}
