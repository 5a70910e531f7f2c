// One key light with a shadow map, and light from a sky above and a ground below.

layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;

// Share of the key light that passes what the map holds at two places, of which each is a comparison that the sampler
// blends over the four nearest texels. A place costs about 3 ms of a 720p picture on lavapipe.
float passing(vec2 at, float depth, vec2 step) {
  return 0.5 * (textureLod(shadow_map, vec3(at - step, depth), 0.0) +
                textureLod(shadow_map, vec3(at + step, depth), 0.0));
}

// Share of the key light that arrives. The bodies' shadows are in the left half of the map, the tools' in the right
// half, since a transparent tool only dims the light. What is deeper than the map reaches is compared as if at its
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

// A soft highlight (Blinn 1977, normalised so that a wider one is dimmer): share of the key light sent to the eye.
float highlight(vec3 normal, vec3 to_eye, float sharpness) {
  vec3 half_way = normalize(to_eye + frame.to_key_light.xyz);
  return (sharpness + 8.0) / 25.0 * pow(max(dot(normal, half_way), 0.0), sharpness);
}
