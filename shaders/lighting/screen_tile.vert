// One point a tile of 16 x 16 pixels, as lighting/tile.vert, for passes that look around on the screen: the view in its own axes (right, up, back) travels in flat varyings.
// Definitions: ORTHOGRAPHIC.
#include "interface/layout.h"
layout(std140, binding = BINDING_FRAME) uniform Frame { FrameData frame; };

layout(location = 0) in ivec4 tile;

layout(location = 0) flat out vec4 viewAxes[3];  // right, up, back in world axes; w: depthParams.x, depthParams.y, radius of occlusion (m)
layout(location = 3) flat out vec4 viewRay;      // slope (orthographic: metres) of the window's pixel (0, 0) along right and up; of a step of one pixel; the radius' bound (pixels)

void main() {
  vec2 tiles = vec2((frame.viewport.zw + TILE_SIZE - 1) / TILE_SIZE);
  gl_Position = vec4((vec2(tile.xy) + 0.5) / tiles * 2.0 - 1.0, 0.5, 1.0);
  gl_PointSize = float(TILE_SIZE);
  float step = length(frame.rayX.xyz);
  vec3 right = frame.rayX.xyz / step, up = frame.rayY.xyz / length(frame.rayY.xyz);
  vec3 corner = frame.rayOrigin.xyz - frame.rayX.xyz * float(frame.viewport.x) - frame.rayY.xyz * float(frame.viewport.y);
  viewAxes[0] = vec4(right, frame.depthParams.x);
  viewAxes[1] = vec4(up, frame.depthParams.y);
  viewAxes[2] = vec4(-frame.forward.xyz, frame.environment.z);
  viewRay = vec4(dot(corner, right), dot(corner, up), step, frame.environment.w);
}
