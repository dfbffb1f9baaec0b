// Positions are in metres; `centre` and `scale` take them to clip space, `pixels` is pixels per metre.
// paint is a colour and the number of a grain. Grains are drawn twice: in their colours, and, into a texture, in
// their numbers, so that the points of one grain are not drawn on its neighbours.

const TO_CLIP = `
uniform vec2 centre, scale;
vec2 to_clip(vec2 x) { return (x - centre) * scale; }
`;

export const FILL_VERTEX = `${TO_CLIP}
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 colour_body;
flat out vec4 paint;
void main() { gl_Position = vec4(to_clip(position), 0, 1); paint = colour_body; }
`;

export const FILL_FRAGMENT = `
uniform float numbers;
flat in vec4 paint;
out vec4 colour;
void main() {
  float n = paint.w + 1.0;
  vec3 digits = vec3(mod(n, 256.0), mod(floor(n / 256.0), 256.0), floor(n / 65536.0)) / 255.0;
  colour = vec4(numbers > 0.0 ? digits : paint.rgb, 1);
}
`;

export const DISK_VERTEX = `${TO_CLIP}
uniform float pixels;
layout(location = 0) in vec3 disk;
layout(location = 1) in vec4 colour_body;
flat out vec4 paint;
flat out float radius;
void main() {
  gl_Position = vec4(to_clip(disk.xy), 0, 1);
  radius = disk.z * pixels;
  gl_PointSize = 2.0 * radius + 1.5;
  paint = colour_body;
}
`;

export const DISK_FRAGMENT = `
uniform float rim;
flat in vec4 paint;
flat in float radius;
out vec4 colour;
void main() {
  float r = length(gl_PointCoord - 0.5) * (2.0 * radius + 1.5);
  float cover = clamp(radius + 0.5 - r, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float edge = rim * smoothstep(radius - 1.4, radius - 0.4, r) * smoothstep(2.0, 5.0, radius);
  colour = vec4(mix(paint.rgb, vec3(0), 0.45 * edge), 1) * cover;
}
`;

// Points as cones seen from above: each pixel of a grain takes the colour of the nearest point of that grain.
export const CONE_FRAGMENT = `
uniform sampler2D grains;
flat in vec4 paint;
flat in float radius;
out vec4 colour;
void main() {
  vec3 digits = floor(255.0 * texelFetch(grains, ivec2(gl_FragCoord.xy), 0).rgb + 0.5);
  if (dot(digits, vec3(1, 256, 65536)) != paint.w + 1.0) discard;
  gl_FragDepth = min(length(gl_PointCoord - 0.5), 1.0) * (2.0 * radius + 1.5) / 2048.0;
  colour = vec4(paint.rgb, 1);
}
`;

// A segment as a quad around it, with round ends; its width is at least `thinnest` pixels.
export const LINE_VERTEX = `${TO_CLIP}
uniform float pixels, thinnest;
layout(location = 0) in vec4 ends;
layout(location = 1) in float width;
layout(location = 2) in vec4 tint;
out vec2 place;
flat out vec2 shape;
flat out vec4 paint;
void main() {
  float length_ = max(distance(ends.xy, ends.zw) * pixels, 1e-3);
  float half_width = 0.5 * max(width * pixels, thinnest);
  vec2 along = (ends.zw - ends.xy) * pixels / length_;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  float margin = half_width + 1.0;
  place = vec2(mix(-margin, length_ + margin, corner.x), mix(-margin, margin, corner.y));
  shape = vec2(length_, half_width);
  paint = tint;
  vec2 offset = along * place.x + vec2(-along.y, along.x) * place.y;
  gl_Position = vec4(to_clip(ends.xy + offset / pixels), 0, 1);
}
`;

export const LINE_FRAGMENT = `
in vec2 place;
flat in vec2 shape;
flat in vec4 paint;
out vec4 colour;
void main() {
  float r = distance(place, vec2(clamp(place.x, 0.0, shape.x), 0));
  float cover = clamp(shape.y + 0.5 - r, 0.0, 1.0) * paint.a;
  colour = vec4(paint.rgb, 1) * cover;
}
`;
