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

// For pictures that must come quickly: on a processor most of the time goes into pixels of bodies. Fewer samples of the
// shadow map, light from all around at the corners of triangles, no highlight on bodies.
layout(constant_id = 0) const bool kQuick = false;

// Light of the studio that arrives at a surface, as if white reflected it (Ramamoorthi and Hanrahan, SIGGRAPH 2001: nine
// spherical harmonics), and a little from the eye, which brightens what faces it; `open` is the share of it that nothing
// near by takes away.
vec3 ambient_light(vec3 n, vec3 to_eye, float open) {
  vec3 around = frame.irradiance[0].rgb + frame.irradiance[1].rgb * n.y + frame.irradiance[2].rgb * n.z +
                frame.irradiance[3].rgb * n.x + frame.irradiance[4].rgb * (n.x * n.y) +
                frame.irradiance[5].rgb * (n.y * n.z) + frame.irradiance[6].rgb * (3.0 * n.z * n.z - 1.0) +
                frame.irradiance[7].rgb * (n.x * n.z) + frame.irradiance[8].rgb * (n.x * n.x - n.y * n.y);
  return (max(around, 0.0) + frame.irradiance[0].w * max(dot(n, to_eye), 0.0)) * open;
}
