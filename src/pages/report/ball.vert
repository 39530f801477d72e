// A ball is a square that faces the eye, shaded as a sphere: cheap, and round however near.
attribute vec3 place, colour;
attribute float radius;
varying vec3 tint;
varying vec2 across;
void main() {
  tint = colour;
  across = position.xy;
  vec4 centre = viewMatrix * vec4(place, 1.0);
  gl_Position = projectionMatrix * (centre + vec4(radius * across, 0.0, 0.0));
}
