// Where the DFG tables (engine/prefilter/dfg.h) hold what. Columns: fourth root of the cosine from 1e-4 to 1, dense toward grazing, where lobes vary fastest; two more columns
// hold the mean over the hemisphere. Rows: 0.6 (G-buffer's roughness code) + 0.4 alpha, dense where lobes are narrow and where they fill the hemisphere.

FN real dfgColumn(real cosine) { return (sqrt(sqrt(max(unitClamp(cosine), BURNISH_GUARD_NOV))) - R(0.1)) * (R(1.0) / R(0.9)); }
FN real dfgRow(real alpha) { return (R(0.6) * encodeAlpha(alpha) + R(0.4) * unitClamp(alpha) - R(0.00016)) * (R(1.0) / R(0.99984)); }

// Texture coordinates in a table of `size` texels (the two columns of means included).
FN vec2 dfgCoordinate(real cosine, real row, vec2 size) {
  return vec2((R(0.5) + dfgColumn(cosine) * (size.x - R(3.0))) / size.x, (R(0.5) + unitClamp(row) * (size.y - R(1.0))) / size.y);
}
FN vec2 dfgMeanCoordinate(real row, vec2 size) { return vec2(R(1.0) - R(1.0) / size.x, (R(0.5) + unitClamp(row) * (size.y - R(1.0))) / size.y); }

// The table of void geometry is made with the exact normalization; other ones scale it.
FN real dfgScale(real p, Rungs k) {
  if (k.specular == SPECULAR_NORMALIZED_BLINN_PHONG) return normalizationRung(p, NORMALIZATION_PLUS_8) / normalizationExact(p);
  bool bare = k.specular == SPECULAR_MICROFACET && k.geometry == GEOMETRY_VOID && k.distribution == DISTRIBUTION_BLINN_PHONG;
  return bare && k.normalization != NORMALIZATION_EXACT ? normalizationRung(p, k.normalization) / normalizationExact(p) : R(1.0);
}
