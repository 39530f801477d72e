// The sphere, and its soft edge.
varying vec3 tint;
varying vec2 across;
void main() {
  float r = length(across), edge = clamp((1.0 - r) / fwidth(r) + 0.5, 0.0, 1.0);
  if (edge == 0.0) discard;
  vec3 normal = vec3(across, sqrt(max(0.0, 1.0 - r * r)));
  float light = 0.55 + 0.6 * max(0.0, dot(normal, normalize(vec3(-0.4, 0.7, 1.0))));
  gl_FragColor = vec4(light * tint, edge);
}
