#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

layout(location = 0) in vec4 position;  // m, tool
layout(location = 1) in vec4 normal;    // tool
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 paint;  // linear rgb

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec3 tool_position;
layout(location = 3) out vec3 in_shadow_map;
layout(location = 4) out vec2 texcoord;
layout(location = 5) out vec3 painted;

// tool_depth and tool draw the same triangles; both must come out at the same depth to the last bit.
invariant gl_Position;

void main() {
  world_position = point_to_world(position.xyz);
  world_normal = direction_to_world(normal.xyz);
  tool_position = position.xyz;
  texcoord = uv;
  painted = paint;
  in_shadow_map = shadow_lookup(world_position, world_normal);
  gl_Position = frame.clip_from_world * vec4(world_position, 1.0);
}
