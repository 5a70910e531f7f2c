#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "shadow_position.glsl"

layout(location = 0) in vec4 position;  // m, body or tool

void main() {
  gl_Position = in_shadow_clip(point_to_world(position.xyz));
}
