// Where a point is on the shadow map.

// Shadow map coordinates are 0 to 1, clip coordinates -1 to 1. What is nearer to the light than the map reaches, as a long
// tool's far end, casts its shadow from the map's beginning.
vec4 in_shadow_clip(vec3 world) {
  vec3 at = (frame.shadow_from_world * vec4(world, 1.0)).xyz;
  return vec4(2.0 * at.xy - 1.0, max(at.z, 0.0), 1.0);
}
