// One key light with a shadow map, and light from a sky above and a ground below.

layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;

// Share of the key light that arrives: one comparison, which the sampler blends over the four nearest texels. What is
// deeper than the map reaches is compared as if at its end, where nothing casts a shadow.
float key_light_share(vec3 in_shadow_map) {
  return texture(shadow_map, vec3(in_shadow_map.xy, min(in_shadow_map.z, 1.0)));
}

// Light from all around, `open` being the share of it that nothing near by takes away.
vec3 ambient_light(vec3 normal, float open) {
  return mix(frame.ground_light.rgb, frame.sky_light.rgb, 0.5 + 0.5 * normal.y) * open;
}

// A soft highlight (Blinn 1977, normalised so that a wider one is dimmer): share of the key light sent to the eye.
float highlight(vec3 normal, vec3 to_eye, float sharpness) {
  vec3 half_way = normalize(to_eye + frame.to_key_light.xyz);
  return (sharpness + 8.0) / 25.0 * pow(max(dot(normal, half_way), 0.0), sharpness);
}
