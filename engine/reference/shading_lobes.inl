// As shading_terms.inl, with the specular models alone (BURNISH_SHADING_TERMS).
#include "reference/shading_functions.inl"
#include "shading/lobes.h"
