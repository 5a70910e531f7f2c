#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "light.glsl"
#include "openness.glsl"
#include "textures.glsl"
#include "reflection.glsl"
#include "material.glsl"

layout(set = 0, binding = 2) uniform sampler2D color_maps;

layout(location = 0) in vec3 world_position;  // with kQuick: linear rgb of the light from all around
layout(location = 1) in vec3 world_normal;    // with kQuick: x is the cosine toward the key light; y and z are what
                                              // is mirrored: y times the reflectance, plus z
layout(location = 2) in vec4 rest_position;
layout(location = 3) in float heat;
layout(location = 4) in vec3 in_shadow_map;
layout(location = 5) in vec2 texcoord;
layout(location = 6) in vec3 painted;  // linear rgb

layout(location = 0) out vec4 color;

// How much of the pixel material lines cover: planes through the body at rest, grid.w apart, every fifth one bolder.
// A line is a pixel and a half wide or 4 % of the spacing, whichever is more, its edges softened over a pixel. Where
// the surface lies along a set of planes these would fill it whole, so they fade out there; where lines come closer
// than a few pixels they fade to their mean.
float material_lines() {
  vec3 at = (rest_position.xyz - draw.grid.xyz) / draw.grid.w;
  vec3 along_x = dFdx(at);
  vec3 along_y = dFdy(at);
  vec3 pixel = abs(along_x) + abs(along_y);
  vec3 away = abs(at - round(at));
  vec3 major = step(abs(at * 0.2 - round(at * 0.2)), vec3(0.1));
  vec3 half_width = max(vec3(0.02), 0.75 * pixel) * (1.0 + 0.8 * major);
  vec3 line = kQuick ? clamp(0.5 + (half_width - away) / max(pixel, 1e-9), 0.0, 1.0)
                     : 1.0 - smoothstep(half_width - 0.5 * pixel, half_width + 0.5 * pixel, away);
  line = mix(line, 2.0 * half_width, smoothstep(0.2, 0.5, pixel)) * (0.72 + 0.28 * major);
  if (kQuick) {
    // A set lies along the surface where its planes are met slowest.
    line *= clamp(4.0 * pixel / max(pixel.x, max(pixel.y, pixel.z)) - 0.8, 0.0, 1.0);
  } else {
    vec3 face = cross(along_x, along_y);
    vec3 flatness = face * face / max(dot(face, face), 1e-20);
    line *= 1.0 - smoothstep(0.85, 0.97, flatness);
  }
  return clamp(max(line.x, max(line.y, line.z)), 0.0, 1.0);
}

void main() {
  Material material = material_at(texcoord, painted);
  if (kCutOut && material.alpha < draw.surface.w) {
    discard;
  }
  vec3 base = material.base;
  if (draw.rows.z != kHeatNone) {
    float at = clamp((heat - frame.heat_scale.x) * frame.heat_scale.y, 0.0, 1.0);
    if (frame.heat_scale.w > 0.0) {
      float part = 2.0 * at - 1.0;
      at = 0.5 + 0.5 * sign(part) * sqrt(abs(part));
    }
    base = texture(color_maps, vec2(at * (255.0 / 256.0) + 0.5 / 256.0, frame.heat_scale.z)).rgb;
    material.emission = vec3(0.0);
  }
  base *= 1.0 - 0.25 * rest_position.w;  // what is fixed is a little darker
  float mark = draw.grid.w > 0.0 ? material_lines() : 0.0;
  if (mark > 0.0) {
    // Dark lines, or light ones where the colour is too dark for them.
    float luminance = dot(base, vec3(0.2126, 0.7152, 0.0722));
    vec3 line = mix(mix(base, vec3(1.0), 0.35), base * 0.12, smoothstep(0.03, 0.07, luminance));
    base = mix(base, line, mark);
  }

  vec3 reflectance = normal_reflectance(base, material.metal);
  vec3 scattered = base * (1.0 - material.metal);
  if (kQuick) {
    float share = world_normal.x > 0.0 ? key_light_share(in_shadow_map) : 0.0;
    vec3 light = material.open * world_position + frame.key_light.rgb * diffuse_key(world_normal.x, share);
    vec3 seen = scattered * light + material.emission;
    vec3 shine = reflectance * world_normal.y + world_normal.z;
    color = kGlass ? glass(seen, shine, glass_cover(material.alpha, 1.0, mark))
                   : vec4(below_white(seen + shine), 1.0);
    return;
  }
  vec3 outward = gl_FrontFacing ? world_normal : -world_normal;  // what is double-sided
  vec3 normal = mapped_normal(normalize(outward), world_position, texcoord);
  vec3 to_eye = normalize(frame.eye.xyz - world_position);
  float facing = dot(normal, frame.to_key_light.xyz);
  float share = facing > 0.0 ? key_light_share(in_shadow_map) : 0.0;
  float open = material.open * openness(rest_position.xyz, world_position.y, normal);
  vec3 light = ambient_light(normal, to_eye, open) + frame.key_light.rgb * diffuse_key(facing, share);
  float seen_by = max(dot(normal, to_eye), 0.0);
  vec2 of_mirror = mirrored_share(seen_by, material.roughness);
  vec3 shine = open * mirrored(reflect(-to_eye, normal), material.roughness) *
               (reflectance * of_mirror.x + of_mirror.y);
  if (share > 0.0) {
    shine += share * frame.key_light.rgb * key_highlight(reflectance, material.roughness, normal, to_eye, facing);
  }
  vec3 seen = scattered * light + material.emission;
  color = kGlass ? glass(seen, shine, glass_cover(material.alpha, seen_by, mark))
                 : vec4(below_white(seen + shine), 1.0);
}
