// What every draw has: the frame's uniforms, the draw's constants, and the light.

#include "shared.h"

layout(std140, set = 0, binding = 0) uniform Uniforms { FrameUniforms frame; };
layout(push_constant) uniform Constants { DrawConstants draw; };

vec3 point_to_world(vec3 point) {
  vec4 p = vec4(point, 1.0);
  return vec3(dot(draw.to_world[0], p), dot(draw.to_world[1], p), dot(draw.to_world[2], p));
}

// Where to look into the shadow map: a step off the surface, so that it does not shade itself.
vec3 shadow_lookup(vec3 world_position, vec3 world_normal) {
  return (frame.shadow_from_world * vec4(world_position + frame.key_light.w * world_normal, 1.0)).xyz;
}

vec3 direction_to_world(vec3 direction) {
  return vec3(dot(draw.to_world[0].xyz, direction), dot(draw.to_world[1].xyz, direction),
              dot(draw.to_world[2].xyz, direction));
}
