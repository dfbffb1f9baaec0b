// Positions are in metres. `right`, `up` and `towards` are the directions of the picture, `centre` lies in its middle,
// `scale` takes metres to clip space, `depth` is one over the reach of the depth. What lies beyond the plane
// `cut` . (x, 1) > 0 is left out.

const TO_CLIP = `
uniform vec3 centre, right, up, towards;
uniform vec2 scale;
uniform float depth;
vec4 to_clip(vec3 x) {
  vec3 d = x - centre;
  return vec4(scale * vec2(dot(d, right), dot(d, up)), -depth * dot(d, towards), 1);
}
`;

const CUT = `
uniform vec3 cut_normal;
uniform float cut_place;
bool is_cut_off(vec3 x) { return dot(cut_normal, x) > cut_place; }
`;

export const SURFACE_VERTEX = `${TO_CLIP}
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float grain;
layout(location = 3) in vec3 colour;
out vec3 place;
out vec3 away;
out vec3 paint;
flat out float number;
void main() {
  gl_Position = to_clip(position);
  place = position;
  away = normal;
  paint = colour;
  number = grain;
}
`;

// glass: 0 for what is solid, else the surfaces are seen through, best where they are seen flat on. The back of a
// surface is seen where it is cut: it stands for the cut, in the plain colour, and so much nearer (before, in metres) that
// a neighbour whose flat quads reach into it stays hidden.
export const SURFACE_FRAGMENT = `${CUT}
uniform vec3 towards, light;
uniform float highlight, glass, depth, before;
in vec3 place;
in vec3 away;
in vec3 paint;
flat in float number;
out vec4 colour;
void main() {
  if (is_cut_off(place)) discard;
  vec3 n = normalize(away);
  float shade = gl_FrontFacing ? 0.4 + 0.6 * max(dot(n, light), 0.0) : 0.86;
  vec3 rgb = number == highlight ? mix(paint, vec3(1), 0.4) : paint;
  float rim = 1.0 - abs(dot(n, towards));
  float cover = glass > 0.0 ? 0.04 + 0.3 * rim * rim * rim : 1.0;
  colour = vec4(rgb * shade, 1) * cover;
  gl_FragDepth = gl_FragCoord.z - (gl_FrontFacing ? 0.0 : 0.5 * depth * before);
}
`;

// A segment as a quad that faces us, with round ends; its width is at least `thinnest` pixels. corner: from the middle
// of its first end, along it and across [pixels].
export const LINE_VERTEX = `${TO_CLIP}
uniform float pixels, thinnest;
layout(location = 0) in vec3 begin;
layout(location = 1) in vec3 end;
layout(location = 2) in float width;
layout(location = 3) in vec4 tint;
out vec3 place;
out vec2 corner;
flat out vec2 shape;
flat out vec4 paint;
void main() {
  vec2 seen = vec2(dot(end - begin, right), dot(end - begin, up)) * pixels;
  float length_ = max(length(seen), 1e-3);
  float half_width = 0.5 * max(width * pixels, thinnest);
  vec2 along = seen / length_;
  vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  float margin = half_width + 1.0;
  corner = vec2(mix(-margin, length_ + margin, at.x), mix(-margin, margin, at.y));
  shape = vec2(length_, half_width);
  paint = tint;
  vec2 offset = along * corner.x + vec2(-along.y, along.x) * corner.y;
  place = mix(begin, end, clamp(corner.x / length_, 0.0, 1.0));
  vec3 x = begin + (offset.x * right + offset.y * up) / pixels;
  gl_Position = to_clip(x);
  gl_Position.z = to_clip(place).z;
}
`;

export const LINE_FRAGMENT = `${CUT}
uniform float round_;
in vec3 place;
in vec2 corner;
flat in vec2 shape;
flat in vec4 paint;
out vec4 colour;
void main() {
  if (is_cut_off(place)) discard;
  float r = distance(corner, vec2(clamp(corner.x, 0.0, shape.x), 0));
  float cover = clamp(shape.y + 0.5 - r, 0.0, 1.0) * paint.a;
  if (cover <= 0.02) discard;
  float s = r / shape.y;
  float shade = mix(1.0, 0.45 + 0.55 * sqrt(max(0.0, 1.0 - s * s)), round_ * smoothstep(1.0, 3.0, shape.y));
  colour = vec4(paint.rgb * shade, 1) * cover;
}
`;
