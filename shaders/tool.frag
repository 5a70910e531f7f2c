#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "light.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec3 tool_position;
layout(location = 3) in vec3 in_shadow_map;

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

void main() {
  vec3 normal = normalize(world_normal);
  vec3 to_eye = normalize(frame.eye.xyz - world_position);
  vec3 mark = meridians();
  vec3 base = mix(draw.color.rgb, draw.color.rgb * 0.25, mark.x);
  base = mix(base, vec3(0.80, 0.10, 0.03), mark.y);
  base = mix(base, vec3(0.02, 0.10, 0.45), mark.z);

  float facing = max(dot(normal, frame.to_key_light.xyz), 0.0);
  float share = facing > 0.0 ? key_light_share(in_shadow_map) : 0.0;
  float shine = share * 0.08 * highlight(normal, to_eye, 60.0);
  vec3 light = ambient_light(normal, to_eye, 1.0) + frame.key_light.rgb * facing * share;

  // More opaque at grazing angles, as glass is (Schlick's approximation of Fresnel's law, with a wider rim), so that
  // the outline stays clear while the contact shows through the middle.
  float rim = pow(1.0 - max(dot(normal, to_eye), 0.0), 2.5);
  float cover = mix(draw.color.a, 0.92, rim);
  cover = mix(cover, max(cover, 0.75), mark.x);
  cover = clamp(cover + shine, 0.0, 1.0);
  color = vec4(base * light + vec3(shine), cover);
}
