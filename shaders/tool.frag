#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "light.glsl"
#include "textures.glsl"
#include "reflection.glsl"
#include "material.glsl"

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

void main() {
  Material material = material_at(texcoord, painted);
  if (kCutOut && material.alpha < draw.surface.w) {
    discard;
  }
  vec3 outward = gl_FrontFacing ? world_normal : -world_normal;  // what is double-sided
  vec3 normal = mapped_normal(normalize(outward), world_position, texcoord);
  vec3 to_eye = normalize(frame.eye.xyz - world_position);
  vec3 base = material.base;
  vec3 mark = (draw.rows.w & kMarks) != 0 ? meridians() : vec3(0.0);
  base = mix(base, base * 0.25, mark.x);
  base = mix(base, vec3(0.80, 0.10, 0.03), mark.y);
  base = mix(base, vec3(0.02, 0.10, 0.45), mark.z);

  float facing = dot(normal, frame.to_key_light.xyz);
  float share = facing > 0.0 ? key_light_share(in_shadow_map) : 0.0;
  vec3 reflectance = normal_reflectance(base, material.metal);
  vec3 light =
      ambient_light(normal, to_eye, material.open) + frame.key_light.rgb * diffuse_key(facing, share);
  float seen_by = max(dot(normal, to_eye), 0.0);
  vec2 of_mirror = mirrored_share(seen_by, material.roughness);
  vec3 shine = material.open * mirrored(reflect(-to_eye, normal), material.roughness) *
               (reflectance * of_mirror.x + of_mirror.y);
  if (share > 0.0) {
    shine += share * frame.key_light.rgb * key_highlight(reflectance, material.roughness, normal, to_eye, facing);
  }
  vec3 seen = base * (1.0 - material.metal) * light + material.emission;
  color = kGlass ? glass(seen, shine, glass_cover(material.alpha, seen_by, mark.x))
                 : vec4(below_white(seen + shine), 1.0);
}
