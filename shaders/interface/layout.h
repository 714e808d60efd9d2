// Structs and binding points that C++ and GLSL share. Only vec4, mat4, ivec4 members: std140, std430 and C++ then agree; gpu_scene asserts the offsets.
#ifndef BURNISH_INTERFACE_LAYOUT
#define BURNISH_INTERFACE_LAYOUT

// Uniform blocks
#define BINDING_FRAME 0
#define BINDING_DRAW 1
#define BINDING_MATERIAL 2
#define BINDING_SHADOW 3
#define BINDING_CUBE_FILTER 4
#define BINDING_GRID 5

// Storage blocks
#define STORAGE_DEFORM_SOURCE 0
#define STORAGE_DEFORM_RESULT 1
#define STORAGE_DEFORM_JOINTS 2
#define STORAGE_DEFORM_TARGETS 3
#define DEFORM_GROUP 64  // vertices of a work group

// Texture units
#define UNIT_MAP_A 0
#define UNIT_MAP_B 1
#define UNIT_MAP_C 2
#define UNIT_METAL_ROUGH 3
#define UNIT_EMISSIVE 4
#define UNIT_GBUFFER_A 0
#define UNIT_GBUFFER_B 1
#define UNIT_DEPTH 2
#define UNIT_GBUFFER_C 3
#define UNIT_GBUFFER_D 9  // no exposure where it is read
#define UNIT_ENVIRONMENT 4
#define UNIT_DFG 5
#define UNIT_LIGHTS 6
#define UNIT_LIGHT_LISTS 7
#define UNIT_LIGHT_BUFFER 8
#define UNIT_FORWARD_ENVIRONMENT 8  // unit 4 is the emissive map's on the forward path
#define UNIT_EXPOSURE 9
#define UNIT_POSE 0
#define UNIT_CUBE_FILTER 0
#define UNIT_BLOOM 0
#define UNIT_DISPLAY 0
#define UNIT_OCCLUSION 0  // what the denoise pass reads
#define UNIT_SCENE_COLOR 7  // of the pass that draws transparent surfaces, which reads no light lists
#define UNIT_SCENE_DEPTH 9  // and no exposure
#define UNIT_PROBE_CUBES 10   // light of captured places
#define UNIT_PROBES 11        // and their records
#define UNIT_GRID_LIGHT 12    // the ambient lattice: harmonics of its points
#define UNIT_GRID_PLANES 13   // and what they see
#define UNIT_SHADOW 14        // shadow maps, compared
#define UNIT_SHADOW_DEPTH 15  // and as depths
#define UNIT_HISTORY 0
#define UNIT_HISTORY_DISTANCE 1
#define UNIT_VELOCITY 3

// Vertex attributes
#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_PREVIOUS 1  // of motion vectors: the position in the frame before
#define ATTRIBUTE_TANGENT 2
#define ATTRIBUTE_UV0 3
#define ATTRIBUTE_UV1 4
#define ATTRIBUTE_COLOR 5
#define ATTRIBUTE_DRAW 6  // instanced programs: the ten vectors of DrawData, clip's columns first
#define DRAW_VECTORS 10

#include "interface/limits.h"

struct FrameData {
  mat4 viewProjection;   // camera-relative world to clip, depth reversed in [0,1]
  vec4 rayOrigin;        // perspective: direction through pixel (0,0), scaled so that its depth is 1; orthographic: origin on the eye's plane. xyz camera-relative world
  vec4 rayX;             // added per pixel to the right
  vec4 rayY;             // added per pixel upward
  vec4 forward;          // xyz unit; orthographic positions are origin + forward * w
  vec4 depthParams;      // perspective: w = x / (z + y); orthographic: w = x - z * y
  vec4 exposure;         // x pre-exposure (what the light buffer holds is radiance times this), y its inverse, z fixed display exposure, w what a pass writes to the light buffer at most
  vec4 eye;              // xyz world position of the eye (m), for debug views only
  vec4 environment;      // x last level of the prefiltered cube; y number of point and spot lights (forward path); z radius of screen-space occlusion (m), w its bound on the screen (pixels)
  vec4 background;       // rgb pre-exposed background colour; w scale of the environment cube
  ivec4 viewport;        // x, y, width, height in pixels
  ivec4 target;          // the same on the target, where it is larger if pixels are shaded at a smaller size
  vec4 irradiance[9];    // pre-exposed irradiance/pi of the surroundings, SH L2 with all constants folded in (shading/environment.h)
  vec4 fog;              // x extinction (1/m) at the reference height, y its falloff (1/m), z height of the eye above that (m), w metres that are clear
  vec4 fogLight[5];      // pre-exposed radiance that fog shows: constant, along y, z, x; rgb albedo, w mean cosine of its scattering
  vec4 sun[2];           // xyz unit direction to the sun's disc, w its radius (radians); pre-exposed rgb radiance, w sine of the elevation under which it is hidden
  vec4 probes;           // x reflection probes in view; y last level of their cubes; their boxes reach z of a point's distance from the eye, and w (m), farther: what its position may be off
  vec4 directional[2 * MAX_DIRECTIONAL];  // xyz unit direction to the light; rgb pre-exposed lux
};

struct DrawData {
  mat4 clip;         // object to clip space: one product a vertex
  vec4 model[3];    // rows: object to camera-relative world; tangents go through it
  vec4 normal[3];   // rows of the cofactor matrix times the sign of the determinant; w of the first: instance index + 1 (exact up to 2^24), of the second: 1 when the mesh has colours, of the third: -1 where the transform mirrors, else 1
};

struct MaterialData {
  vec4 albedo;      // rgb factor, a opacity
  vec4 params;      // x code scale, y code bias, z roughness factor, w occlusion strength
  vec4 emission;    // rgb pre-exposure not applied, cd/m²; w alpha cutoff
  vec4 more;        // x metalness factor (metal-rough kept apart), y 1 when unlit, z 1 when vertex colour counts, w 1 when metal-rough is kept apart, 2 when there is no map B beside it
  vec4 uv[10];      // two rows for each of A, B, C, metal-rough, emissive: u' = dot(row.xyz, (u, v, 1)); row.w of the first: uv set
  vec4 conductorEta;  // rgb index of a named conductor, 0 elsewhere; w anisotropy's strength² times the cosine of its rotation
  vec4 conductorK;    // rgb its extinction; w the same times its sine
  vec4 glass;         // x transmission, y thickness (m, of the mesh), z index of refraction (0: from F0), w 1 when blended
  vec4 attenuation;   // rgb absorption inside, 1/m; w sigma of rough diffuse, radians
};

// A reflection probe's record, PROBE_TEXELS texels of a buffer, smaller boxes before larger ones:
//   0 to 2: rows from camera-relative world to the box's axes, relative to its middle
//   3: half sizes (m), w margin (m); 4: fades (m, at most the half sizes), w its cube in the array; 5: the capture's place in those axes
//   6 to 14: pre-exposed irradiance/pi, as FrameData::irradiance

// Where the ambient lattice lies (shading/grid.h). Lattice coordinates: points are whole numbers.
struct GridData {
  vec4 toLattice[3];  // rows from camera-relative world to lattice coordinates
  vec4 step[3];       // xyz to the next point along each axis, m; w: gridAim, gridBias, 1/gridDepth
  vec4 last;          // xyz coordinates of the last point; w what the harmonics' half floats are multiplied by: pre-exposed
  vec4 margin;        // xyz spacing over the margin
};

// Directional lights' shadows. Those of point and spot lights are records of SHADOW_TEXELS texels behind the lights in their buffer:
//   0: x 1 with a cube of maps, else 0; y and z: depth in the map = y / w - z, w the distance along the map's axis (m); w: the map's half side at 1 m
//   1 to 3, without a cube: rows from camera-relative world to the map: x and y in (-1, 1) after division by w, and w
//   4 to 9: x the map's layer (of a cube: of each face), negative where nothing casts
// The light's own fourth texel has the record's number + 1 in y and the light's radius (m) in z.
struct ShadowData {
  vec4 params;  // x texels along a side of a map, y its inverse, z point and spot lights that have shadows (the first ones), w first texel of their records
  // Each: rows to the light's axes (right, up, toward it; xyz), w of the first: tangent of half the angle that the light takes; x of the fourth: cascades. Then two for each cascade:
  // x 1 / half side (1/m), yz the eye's place in the map, w layer (negative: nothing casts); x and y: depth = x · (along the light) + y, z a texel's side (m), w depth of the map (m).
  vec4 suns[SUN_SHADOW_VECTORS * MAX_SHADOW_SUNS];
};
#endif
