// Which rung of each term is in force. GLSL makes a constant of it, so that nothing is left of the branches that it selects; the numbers are those of the enums in
// burnish/quality.h (asserted in engine/plan/rungs.cpp).
#ifndef BURNISH_RUNGS
#define BURNISH_RUNGS
#define SPECULAR_MICROFACET 0
#define SPECULAR_PHONG 1
#define SPECULAR_BLINN_PHONG 2
#define SPECULAR_MODIFIED_PHONG 3
#define SPECULAR_MAX_PHONG 4
#define SPECULAR_NORMALIZED_BLINN_PHONG 5
#define SPECULAR_COOK_TORRANCE 6
#define SPECULAR_WARD 7
#define SPECULAR_WARD_ANISOTROPIC 8
#define SPECULAR_WARD_BOUNDED 9
#define SPECULAR_GGX_SMITH 10

#define FRESNEL_NONE 0
#define FRESNEL_SCHLICK 1
#define FRESNEL_SPHERICAL_GAUSSIAN 2
#define FRESNEL_DIELECTRIC 3
#define FRESNEL_CONDUCTOR 4

#define NORMALIZATION_NONE 0
#define NORMALIZATION_LINEAR_FIT 1
#define NORMALIZATION_LINEAR_FIT_8 2
#define NORMALIZATION_PLUS_2 3
#define NORMALIZATION_PLUS_8 4
#define NORMALIZATION_EXACT 5

#define LOBE_POW 0
#define LOBE_EXP2 1
#define LOBE_STABLE 2

#define DISTRIBUTION_BLINN_PHONG 0
#define DISTRIBUTION_BECKMANN 1
#define DISTRIBUTION_GGX 2

#define GEOMETRY_VOID 0
#define GEOMETRY_KELEMEN 1
#define GEOMETRY_SCHLICK_SMITH 2
#define GEOMETRY_SMITH 3
#define GEOMETRY_V_CAVITY 4

#define DIFFUSE_LAMBERT 0
#define DIFFUSE_LAMBERT_FRESNEL 1
#define DIFFUSE_COUPLED_FIT 2
#define DIFFUSE_COUPLED 3
#define DIFFUSE_OREN_NAYAR_QUALITATIVE 4
#define DIFFUSE_OREN_NAYAR 5
#define DIFFUSE_OREN_NAYAR_ENERGY 6

#define COMPENSATION_NONE 0
#define COMPENSATION_MULTIPLE_SCATTERING 1

#define ENVIRONMENT_SPECULAR_NONE 0
#define ENVIRONMENT_SPECULAR_SCHLICK 1
#define ENVIRONMENT_SPECULAR_ROUGH_SCHLICK 2
#define ENVIRONMENT_SPECULAR_DFG 3
#define ENVIRONMENT_SPECULAR_SAMPLED 4

#define AMBIENT_NONE 0
#define AMBIENT_CONSTANT 1
#define AMBIENT_SH_L1 2
#define AMBIENT_SH_L2 3
#define AMBIENT_BOX 4

#define AMBIENT_SOURCE_PROBES 0
#define AMBIENT_SOURCE_GRID 1

#define REFLECTION_INFINITE 0
#define REFLECTION_BOX 1
#define REFLECTION_BOX_ROUGH 2

#define SPECULAR_OCCLUSION_NONE 0
#define SPECULAR_OCCLUSION_AO 1
#define SPECULAR_OCCLUSION_LAGARDE 2

#define DIRECT_OCCLUSION_NONE 0
#define DIRECT_OCCLUSION_SPECULAR 1

// Families of microfacet normals (or, for Phong's, of mirrored directions) that a specular rung scatters with: what sampling.h draws from.
#define LOBE_FAMILY_BLINN_PHONG 0
#define LOBE_FAMILY_BECKMANN 1
#define LOBE_FAMILY_GGX 2
#define LOBE_FAMILY_PHONG 3

// The rungs that the lighting equation of one light direction has.
struct Rungs {
  int specular;       // SPECULAR_*; the next five count for SPECULAR_MICROFACET alone, lobe for every power of a cosine
  int distribution;   // DISTRIBUTION_*
  int geometry;       // GEOMETRY_*
  int normalization;  // NORMALIZATION_*: void geometry with Blinn-Phong's distribution
  int lobe;           // LOBE_*
  int fresnel;        // FRESNEL_*
  int diffuse;        // DIFFUSE_*
  int compensation;   // COMPENSATION_*
  int anisotropic;    // 1: the surface may bring tangents and two widths
  int roughDiffuse;   // 1: the surface may bring a diffuse roughness of its own
};

// The directional albedo of the rungs is read from a table (the second argument of shadeDirection).
FN bool needsAlbedoTable(Rungs k) { return k.compensation != COMPENSATION_NONE || k.diffuse == DIFFUSE_COUPLED || k.diffuse == DIFFUSE_OREN_NAYAR_ENERGY; }

// Models whose lobe can have two widths. The others are round whatever the surface brings.
FN bool hasTwoWidths(Rungs k) {
  return k.specular == SPECULAR_MICROFACET || k.specular == SPECULAR_COOK_TORRANCE || k.specular == SPECULAR_WARD_ANISOTROPIC || k.specular == SPECULAR_WARD_BOUNDED || k.specular == SPECULAR_GGX_SMITH;
}

FN int lobeFamily(Rungs k) {
  if (k.specular == SPECULAR_PHONG || k.specular == SPECULAR_MODIFIED_PHONG || k.specular == SPECULAR_MAX_PHONG) return LOBE_FAMILY_PHONG;
  if (k.specular == SPECULAR_BLINN_PHONG || k.specular == SPECULAR_NORMALIZED_BLINN_PHONG) return LOBE_FAMILY_BLINN_PHONG;
  if (k.specular == SPECULAR_GGX_SMITH) return LOBE_FAMILY_GGX;
  if (k.specular != SPECULAR_MICROFACET) return LOBE_FAMILY_BECKMANN;
  return k.distribution;
}
#endif
