#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "shadow_position.glsl"

layout(location = 0) in vec4 position;  // m, body or tool
layout(location = 1) in vec2 uv;

layout(location = 0) out vec2 texcoord;

void main() {
  texcoord = uv;
  gl_Position = in_shadow_clip(point_to_world(position.xyz));
}
