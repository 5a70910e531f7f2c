#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec3 vertex_color;

layout(location = 0) out vec4 color;

// Lit like the rest but never in shadow, since an arrow is not a thing of the scene.
void main() {
  vec3 normal = normalize(world_normal);
  vec3 light = ambient_light(normal, normal, 1.0) + frame.key_light.rgb * max(dot(normal, frame.to_key_light.xyz), 0.0);
  color = vec4(vertex_color * light, 1.0);
}
