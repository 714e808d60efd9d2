// Albedo in the G-buffer: its square root in 8 bits. The same precision as sRGB (steps differ by at most 14 % over 0.046 .. 1, by 29 % at 0.01;
// the worst error is 0.0039 against 0.0045), without the power function that a
// software renderer pays on every write and read.

FN vec3 encodeAlbedo(vec3 c) { return vec3(sqrt(unitClamp(c.x)), sqrt(unitClamp(c.y)), sqrt(unitClamp(c.z))); }
FN vec3 decodeAlbedo(vec3 e) { return e * e; }
