// What a surface mirrors of the studio around it, and of the key light.

layout(set = 0, binding = 5) uniform sampler2D studio;

// Where a direction is on a square, 0 to 1: the octahedron's upper half in the middle, its lower half folded out over
// the corners (Meyer et al., EGSR 2010). +y is up.
vec2 on_octahedron(vec3 direction) {
  vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 folded = (1.0 - abs(d.zx)) * vec2(d.x < 0.0 ? -1.0 : 1.0, d.z < 0.0 ? -1.0 : 1.0);
  return 0.5 + 0.5 * (d.y < 0.0 ? folded : d.xz);
}

vec3 mirrored_in_tile(vec2 at, float tile) {
  return textureLod(studio, vec2(at.x, (tile + at.y) / float(kReflectionTiles)), 0.0).rgb;
}

// The studio's light from a direction, blurred as a surface of that roughness does: a draw's in its nearest step, a
// texture's between two.
vec3 mirrored(vec3 direction, float roughness) {
  float side = float(kReflectionSide);
  vec2 at = clamp(on_octahedron(direction) * side, 0.5, side - 0.5) / side;
  float tile = roughness * float(kReflectionTiles - 1);
  if (!has_texture(kMetalRoughness)) {
    return mirrored_in_tile(at, round(tile));
  }
  return mix(mirrored_in_tile(at, floor(tile)), mirrored_in_tile(at, ceil(tile)), fract(tile));
}

// Share of the light from all around that is mirrored: x times the reflectance at normal incidence, plus y (split sum of
// Karis, SIGGRAPH 2013, by Lazarov's fit).
vec2 mirrored_share(float n_dot_v, float roughness) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
  return vec2(-1.04, 1.04) * a + r.zw;
}

// Reflectance at normal incidence: 4 % of plastics and skin, a metal's colour.
vec3 normal_reflectance(vec3 base, float metal) {
  return mix(vec3(0.04), base, metal);
}

// The key light in the surface, to be added where it arrives: Cook and Torrance's microfacets with GGX's distribution
// (Walter et al., EGSR 2007), Hammon's fit of Smith's masking and Schlick's of Fresnel's law. A light counts as pi, so
// that white that faces it is 1.
vec3 key_highlight(vec3 reflectance, float roughness, vec3 n, vec3 to_eye, float facing) {
  vec3 h = normalize(to_eye + frame.to_key_light.xyz);
  float n_dot_v = max(dot(n, to_eye), 1e-3);
  float n_dot_h = clamp(dot(n, h), 0.0, 1.0);
  float alpha = max(roughness * roughness, 0.02);
  float d = n_dot_h * n_dot_h * (alpha * alpha - 1.0) + 1.0;
  float distribution = alpha * alpha / (d * d);
  float masking = 0.5 / mix(2.0 * facing * n_dot_v, facing + n_dot_v, alpha);
  vec3 fresnel = reflectance + (1.0 - reflectance) * pow(1.0 - max(dot(h, to_eye), 0.0), 5.0);
  return min(distribution * masking * facing, 40.0) * fresnel;
}

// Colours brighter than white come back below it, without a change of hue; darker ones than 0.8 stay.
vec3 below_white(vec3 light) {
  const float kStart = 0.8;
  float peak = max(light.r, max(light.g, light.b));
  if (peak <= kStart) {
    return light;
  }
  float room = 1.0 - kStart;
  return light * ((1.0 - room * room / (peak + room - kStart)) / peak);
}

// The key light's share of the diffuse light: around the edge of what scatters it inside, some arrives past the
// terminator (wrapped diffuse light; Green, GPU Gems, 2004).
// @param cosine  toward the key light
// @param share   of the key light that arrives
float diffuse_key(float cosine, float share) {
  float wrap = 0.6 * draw.surface.z;
  float lit = max((cosine + wrap) / ((1.0 + wrap) * (1.0 + wrap)), 0.0);
  return lit * mix(share, 1.0, 0.5 * draw.surface.z);
}
