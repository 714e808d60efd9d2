// Included once for each precision by reference/shading.h.
#include "reference/shading_functions.inl"
#include "shading/all.h"
#include "shading/tonemap.h"
