// Limits that C++ and GLSL share.
#ifndef BURNISH_INTERFACE_LIMITS
#define BURNISH_INTERFACE_LIMITS
#define MAX_DIRECTIONAL 8
#define LIGHT_TEXELS 4
#define TILE_SIZE 16
#define MAX_TILE_PROBES 4     // reflection probes that light a tile, and a pixel
#define PROBE_TEXELS 15       // of a reflection probe's record
#define MAX_PROBES 341        // reflection probes of a scene: six layers each in an array of 2048, which every device has
#define GRID_MAP_SIZE 16      // texels along a side of a lattice point's map of distances
#define GRID_TILE 18          // and of its planes, with a border
#define GRID_LIGHT_TEXELS 4   // of a lattice point's harmonics
#define MAX_CASCADES 4
#define MAX_SHADOW_SUNS 4
#define SHADOW_TEXELS 10      // of a point or spot light's shadow record
#define SUN_SHADOW_VECTORS 12
#define SHADOW_WIDEST 16      // texels: the widest radius of a soft edge (shadow=pcss)
#endif
