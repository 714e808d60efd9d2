// Limits that C++ and GLSL share.
#ifndef BURNISH_INTERFACE_LIMITS
#define BURNISH_INTERFACE_LIMITS
#define MAX_DIRECTIONAL 8
#define LIGHT_TEXELS 4
#define TILE_SIZE 16
#endif
