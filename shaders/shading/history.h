// Light averaged over frames (docs/antialiasing.md): the space that it is averaged in, what of the frames before is kept, and how they are looked up between pixels.

#define LUMA_RED R(0.2126)
#define LUMA_GREEN R(0.7152)
#define LUMA_BLUE R(0.0722)
// Light of display white is 1 here; past it the curve below ends at 2. 1/65504: what is left of it where half floats end.
#define COMPRESSED_END (R(1.0) / R(65504.0))

FN real lumaOf(vec3 c) { return LUMA_RED * c.x + LUMA_GREEN * c.y + LUMA_BLUE * c.z; }

// Up to display white light is averaged as it is; past it, where the display shows no more, on a curve that flattens: 2 - 1/luma, so that one lamp in one sample does not outweigh all
// others (after Karis 2014, "High Quality Temporal Supersampling", who averages tone mapped light). c: not negative, up to 65504.
FN vec3 compressLight(vec3 c) {
  real l = lumaOf(c);
  return l > R(1.0) ? c * ((R(2.0) - R(1.0) / l) / l) : c;
}
// The inverse. t: [-1, 2]; what no compressed light is ends at what a half float holds.
FN vec3 expandLight(vec3 t) {
  real l = lumaOf(t);
  return l > R(1.0) ? t * (R(1.0) / (max(R(2.0) - l, COMPRESSED_END) * l)) : t;  // model: the space ends there
}

// Luma and two differences of colour (Malvar and Sullivan 2003, "YCoCg-R"): their boxes hold neighbours more tightly than those of red, green and blue.
FN vec3 lumaFromRgb(vec3 c) { return vec3(R(0.25) * (c.x + c.z) + R(0.5) * c.y, R(0.5) * (c.x - c.z), R(0.5) * c.y - R(0.25) * (c.x + c.z)); }
FN vec3 rgbFromLuma(vec3 y) { return vec3(y.x + y.y - y.z, y.x + y.z, y.x - y.y - y.z); }

// Half the size of the box that light before is clipped to: 1.25 standard deviations of the neighbours (`spread`, in luma and differences of colour) around their mean. Never under a step of
// half floats there: where nothing has colour the box has no width, and what rounding makes of a grey would throw all of the past away.
FN vec3 clipBox(vec3 middle, vec3 spread) {
  real least = abs(middle.x) * (R(1.0) / R(512.0));
  return spread * R(1.25) + vec3(least);
}

// `old` moved toward `middle` until it is inside the box of half size `extent` around it (Karis 2014: clipped, not clamped, so that hue holds). Any finite numbers under 1e18.
FN vec3 clippedToward(vec3 middle, vec3 extent, vec3 old) {
  vec3 d = old - middle;
  real k = R(1.0);
  if (abs(d.x) > extent.x) k = min(k, extent.x / abs(d.x));  // model: the box's side
  if (abs(d.y) > extent.y) k = min(k, extent.y / abs(d.y));  // model: the box's side
  if (abs(d.z) > extent.z) k = min(k, extent.z / abs(d.z));  // model: the box's side
  return middle + d * k;
}

// Weights of four pixels in a row for a place f past the second one, [0, 1] (Catmull and Rom 1974). They add up to 1.
FN vec4 catmullRom(real f) {
  real g = R(1.0) - f;
  return vec4(R(-0.5) * f * g * g, R(1.0) + f * f * (R(1.5) * f - R(2.5)), R(1.0) + g * g * (R(1.5) * g - R(2.5)), R(-0.5) * g * f * f);
}
