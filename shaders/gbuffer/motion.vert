// Where the vertices of what moved stand, and stood in the frame before.
#include "interface/layout.h"
layout(std140, binding = BINDING_DRAW) uniform Draw { DrawData draw; };
layout(location = 0) uniform mat4 previousClip;  // object then to the clip space of the frame before, without jitter
layout(location = ATTRIBUTE_POSITION) in vec3 position;
layout(location = ATTRIBUTE_PREVIOUS) in vec3 previousPosition;
layout(location = 0) out vec4 was;

invariant gl_Position;

void main() {
  vec4 p = vec4(position, 1.0);
  gl_Position = draw.clip * p;
  was = previousClip * vec4(previousPosition, 1.0);
}
