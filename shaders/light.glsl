// One key light with a shadow map.

layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;

// Share of the key light that passes what the map holds at two places, of which each is a comparison that the sampler
// blends over the four nearest texels. A place costs about 3 ms of a 720p picture on lavapipe.
float passing(vec2 at, float depth, vec2 step) {
  return 0.5 * (textureLod(shadow_map, vec3(at - step, depth), 0.0) +
                textureLod(shadow_map, vec3(at + step, depth), 0.0));
}

// Share of the key light that arrives. Shadows of what is opaque are in the left half of the map, those of glass tools in
// the right half, since glass only dims the light. What is deeper than the map reaches is compared as if at its
// end, where nothing casts a shadow; beside the map everything is lit.
float key_light_share(vec3 in_shadow_map) {
  vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
  vec2 margin = vec2(5.0 * texel.x, 2.5 * texel.y);
  vec2 at = in_shadow_map.xy;
  if (any(lessThan(at, margin)) || any(greaterThan(at, 1.0 - margin))) {
    return 1.0;
  }
  float depth = min(in_shadow_map.z, 1.0);
  at.x *= 0.5;
  if (kQuick) {
    float both[2] = float[2](textureLod(shadow_map, vec3(at, depth), 0.0),
                             textureLod(shadow_map, vec3(at + vec2(0.5, 0.0), depth), 0.0));
    return both[0] * (1.0 - frame.floor_level.w * (1.0 - both[1]));
  }
  vec2 step = 1.5 * texel;  // makes a shadow's edge five texels wide
  float bodies = 0.5 * (passing(at, depth, step) + passing(at, depth, vec2(step.x, -step.y)));
  float tools = passing(at + vec2(0.5, 0.0), depth, step);
  return bodies * (1.0 - frame.floor_level.w * (1.0 - tools));
}

