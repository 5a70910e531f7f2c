#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 in_shadow_map;

// A square of two triangles around the bodies, facing up.
void main() {
  const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(-1, 1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(1, -1));
  vec2 corner = corners[gl_VertexIndex] * frame.floor_level.z + frame.floor_box.xy;
  world_position = vec3(corner.x, frame.floor_level.x, corner.y);
  in_shadow_map = shadow_lookup(world_position, vec3(0.0, 1.0, 0.0));
  gl_Position = frame.clip_from_world * vec4(world_position, 1.0);
}
