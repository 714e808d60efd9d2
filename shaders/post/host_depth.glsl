// Conversion between the engine's depth (reversed, [0,1]) and the host's window depth.
// host: x near, y far (0: infinite), z 1 when reversed, w 1 when orthographic (the view's).
float distanceOfHost(float d, vec4 host) {
  d = host.z > 0.5 ? 1.0 - d : d;
  if (host.w > 0.5) return host.x + d * (host.y - host.x);
  if (host.y <= 0.0) return host.x / max(1.0 - d, 1e-30);
  return host.x * host.y / max(host.y - d * (host.y - host.x), 1e-30);
}
float hostOfDistance(float w, vec4 host) {
  float d;
  if (host.w > 0.5) d = (w - host.x) / (host.y - host.x);
  else if (host.y <= 0.0) d = 1.0 - host.x / w;
  else d = host.y / (host.y - host.x) * (1.0 - host.x / w);
  d = clamp(d, 0.0, 1.0);
  return host.z > 0.5 ? 1.0 - d : d;
}
