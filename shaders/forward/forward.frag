// The forward reference: shades a surface where it is drawn, from unquantised material values, with every light of the scene. Slow on purpose: nothing is culled, nothing packed.
// Definitions: those of forward/lit.glsl.
#include "forward/lit.glsl"

layout(location = 0) out vec4 outRadiance;

void main() {
  Fetched f = fetchMaterial();
  vec3 toEye;
  vec3 p = positionHere(toEye);
  Surface m = surfaceHere(f, toEye);
  float row = findEnergy(m);
  vec3 sum = litByLights(m, p, row, f.occlusion);
#if SURROUNDINGS
  sum += surroundings(m, placeAt(p), f.occlusion);
#endif
#if FOG
  sum = fogged(sum, p, toEye);
#endif
  outRadiance = vec4(limitRadiance(sum, frame.exposure.w), 1.0);
}
