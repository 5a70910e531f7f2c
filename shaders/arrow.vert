#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

layout(location = 0) in vec4 position;  // m, world
layout(location = 1) in vec4 normal;    // world
layout(location = 2) in vec4 color;     // linear rgb

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec3 vertex_color;

void main() {
  world_normal = normal.xyz;
  vertex_color = color.rgb;
  gl_Position = frame.clip_from_world * vec4(position.xyz, 1.0);
}
