// What a material is at a pixel: glTF's metallic-roughness material (glTF 2.0, section 3.9 and appendix B).

// Pixels with less alpha than the cutoff are not there. A constant of the pipeline, since a shader that may discard
// tests depth late: on a processor that costs all that is hidden.
layout(constant_id = 1) const bool kCutOut = false;

// One sees through it.
layout(constant_id = 3) const bool kGlass = false;

struct Material {
  vec3 base;        // linear rgb
  float alpha;
  float metal;
  float roughness;
  float open;       // share of the light from all around that the material's own hollows leave
  vec3 emission;    // linear rgb
};

// @param painted  the vertex' colour, linear rgb
Material material_at(vec2 at, vec3 painted) {
  Material it = Material(draw.color.rgb * painted, draw.color.a, draw.surface.x, draw.surface.y, 1.0, draw.emission.rgb);
  if (has_texture(kBaseColor)) {
    vec4 texel = texture(textures[kBaseColor], at);
    it.base *= texel.rgb;
    it.alpha *= texel.a;
  }
  if (has_texture(kMetalRoughness)) {
    vec2 texel = texture(textures[kMetalRoughness], at).bg;
    it.metal *= texel.x;
    it.roughness *= texel.y;
  }
  if (has_texture(kOcclusion)) {
    float strength = float(draw.rows.w >> kOcclusionShift) / 255.0;
    it.open = 1.0 + strength * (texture(textures[kOcclusion], at).r - 1.0);
  }
  if (has_texture(kEmission)) {
    it.emission *= texture(textures[kEmission], at).rgb;
  }
  return it;
}

// The surface's normal turned as the texture of normals says. The tangents, along u and against v, are found from what
// lies beside the pixel (Mikkelsen, JCGT 2020, volume 9, number 3), so that a mesh needs none.
vec3 mapped_normal(vec3 normal, vec3 position, vec2 at) {
  if (!has_texture(kNormal)) {
    return normal;
  }
  vec3 along_x = dFdx(position);
  vec3 along_y = dFdy(position);
  vec3 across_x = cross(along_y, normal);
  vec3 across_y = cross(normal, along_x);
  vec2 at_x = dFdx(at);
  vec2 at_y = dFdy(at);
  float sign_of_view = dot(along_x, across_x) < 0.0 ? -1.0 : 1.0;
  vec3 tangent = sign_of_view * (across_x * at_x.x + across_y * at_y.x);
  vec3 bitangent = -sign_of_view * (across_x * at_x.y + across_y * at_y.y);
  float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
  if (!(longest > 0.0)) {
    return normal;
  }
  vec3 mapped = texture(textures[kNormal], at).xyz * 2.0 - 1.0;
  mapped.xy *= draw.emission.w;
  return normalize(inversesqrt(longest) * (mapped.x * tangent + mapped.y * bitangent) + mapped.z * normal);
}

// The share of what is behind that glass hides: more at grazing angles, as glass does (Schlick's fit of Fresnel's law,
// with a wider rim), so that the outline stays clear while the contact shows through the middle.
// @param facing  cosine toward the eye
// @param mark    share of the pixel that lines on it cover
float glass_cover(float alpha, float facing, float mark) {
  float rim = pow(1.0 - max(facing, 0.0), 2.5);
  float cover = mix(alpha, 0.92, rim);
  return mix(cover, max(cover, 0.75), mark);
}

// Colour and alpha of glass. What is mirrored lies over all that shows through: it is divided by the cover that blending
// multiplies with.
vec4 glass(vec3 scattered, vec3 shine, float cover) {
  float strongest = max(shine.r, max(shine.g, shine.b));
  float all = clamp(max(cover, strongest), 0.0, 1.0);
  return vec4(below_white(scattered + shine / max(all, 0.05)), all);
}
