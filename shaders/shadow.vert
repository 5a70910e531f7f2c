#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

layout(location = 0) in vec4 position;  // m, body or tool

void main() {
  // Shadow map coordinates are 0 to 1, clip coordinates -1 to 1.
  vec3 at = (frame.shadow_from_world * vec4(point_to_world(position.xyz), 1.0)).xyz;
  // What is nearer to the light than the map reaches, as a long tool's far end, casts its shadow from the map's beginning.
  gl_Position = vec4(2.0 * at.xy - 1.0, max(at.z, 0.0), 1.0);
}
