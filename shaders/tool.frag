#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "light.glsl"
#include "reflection.glsl"

layout(set = 0, binding = 6) uniform sampler2D base_color;

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec3 tool_position;
layout(location = 3) in vec3 in_shadow_map;
layout(location = 4) in vec2 texcoord;
layout(location = 5) in vec3 painted;  // linear rgb

layout(location = 0) out vec4 color;

const float kMeridians = 12.0;
const float kTurn = 6.28318531;

// Marks that turn with the tool: meridians about its y axis. x: share of the pixel that they cover; of that, y: the
// bold one toward +x, z: the bold one toward -x. Near the axis they fade out.
vec3 meridians() {
  vec2 from_axis = tool_position.xz - draw.grid.xz;
  float turns = atan(from_axis.y, from_axis.x) / kTurn * kMeridians;
  float away = abs(turns - round(turns));
  // Turns jump by kMeridians at the back: take the width from the position, which does not jump.
  float pixel = length(vec2(dFdx(from_axis.x), dFdx(from_axis.y))) + length(vec2(dFdy(from_axis.x), dFdy(from_axis.y)));
  pixel *= kMeridians / kTurn / max(length(from_axis), 1e-9);
  vec2 bold = step(vec2(abs(turns), kMeridians * 0.5 - abs(turns)), vec2(0.5));
  float half_width = max(bold.x + bold.y > 0.0 ? 0.16 : 0.025, 0.75 * pixel);
  float line = 1.0 - smoothstep(half_width - 0.5 * pixel, half_width + 0.5 * pixel, away);
  line *= 1.0 - smoothstep(0.3, 0.8, pixel);
  return vec3(line, line * bold);
}

// The share of what is behind that glass hides: more at grazing angles, as glass does (Schlick's fit of Fresnel's law,
// with a wider rim), so that the outline stays clear while the contact shows through the middle.
float glass_cover(vec3 normal, vec3 to_eye, float mark) {
  float rim = pow(1.0 - max(dot(normal, to_eye), 0.0), 2.5);
  float cover = mix(draw.color.a, 0.92, rim);
  return mix(cover, max(cover, 0.75), mark);
}

void main() {
  vec3 normal = normalize(world_normal);
  vec3 to_eye = normalize(frame.eye.xyz - world_position);
  vec3 base = draw.color.rgb * painted;
  if ((draw.rows.w & kTextured) != 0) {
    base *= texture(base_color, texcoord).rgb;
  }
  vec3 mark = (draw.rows.w & kMarks) != 0 ? meridians() : vec3(0.0);
  base = mix(base, base * 0.25, mark.x);
  base = mix(base, vec3(0.80, 0.10, 0.03), mark.y);
  base = mix(base, vec3(0.02, 0.10, 0.45), mark.z);

  float facing = dot(normal, frame.to_key_light.xyz);
  float share = facing > 0.0 ? key_light_share(in_shadow_map) : 0.0;
  vec3 reflectance = normal_reflectance(base);
  vec3 light = ambient_light(normal, to_eye, 1.0) + frame.key_light.rgb * diffuse_key(facing, share);
  vec2 of_mirror = mirrored_share(max(dot(normal, to_eye), 0.0));
  vec3 shine = mirrored(reflect(-to_eye, normal)) * (reflectance * of_mirror.x + of_mirror.y);
  if (share > 0.0) {
    shine += share * frame.key_light.rgb * key_highlight(reflectance, normal, to_eye, facing);
  }
  vec3 seen = base * (1.0 - draw.surface.x) * light;
  if ((draw.rows.w & kGlass) == 0) {
    color = vec4(below_white(seen + shine), 1.0);
    return;
  }
  // What is mirrored lies over all that shows through: it is divided by the cover that blending multiplies with.
  float strongest = max(shine.r, max(shine.g, shine.b));
  float cover = clamp(max(glass_cover(normal, to_eye, mark.x), strongest), 0.0, 1.0);
  color = vec4(below_white(seen + shine / max(cover, 0.05)), cover);
}
