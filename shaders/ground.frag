#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "light.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 in_shadow_map;

layout(location = 0) out vec4 color;

// The floor is of the background's colour where it is fully lit, so that it has no visible edge: only the shadow and
// the shade that the bodies' box casts around its foot show.
void main() {
  vec2 from_center = world_position.xz - frame.floor_box.xy;
  if (dot(from_center, from_center) > frame.floor_level.z * frame.floor_level.z) {
    color = vec4(frame.background.rgb, 1.0);  // as what is below comes to there
    return;
  }
  // From a box of 0.6 of the bodies' size, so that the corners that a round body leaves free are not shaded flat.
  vec2 outside = max(abs(from_center) - 0.6 * frame.floor_box.zw, 0.0) / frame.floor_level.y;
  float shade = 0.5 * exp(-3.5 * length(outside));
  float shadow = 0.34 * (1.0 - key_light_share(in_shadow_map));
  float near = 1.0 - smoothstep(0.5, 1.0, length(from_center) / frame.floor_level.z);
  color = vec4(frame.background.rgb * (1.0 - near * (1.0 - (1.0 - shade) * (1.0 - shadow))), 1.0);
}
