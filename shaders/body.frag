#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "light.glsl"

layout(set = 0, binding = 2) uniform sampler2D color_maps;
layout(std430, set = 0, binding = 3) readonly buffer Contacts { ContactSpot contacts[]; };

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec4 rest_position;
layout(location = 3) in float heat;
layout(location = 4) in vec3 in_shadow_map;

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
  vec3 face = cross(along_x, along_y);
  vec3 flatness = face * face / max(dot(face, face), 1e-20);
  vec3 away = abs(at - round(at));
  vec3 major = step(abs(at * 0.2 - round(at * 0.2)), vec3(0.1));
  vec3 half_width = max(vec3(0.02), 0.75 * pixel) * (1.0 + 0.8 * major);
  vec3 line = 1.0 - smoothstep(half_width - 0.5 * pixel, half_width + 0.5 * pixel, away);
  line = mix(line, 2.0 * half_width, smoothstep(0.2, 0.5, pixel)) * (0.72 + 0.28 * major);
  line *= 1.0 - smoothstep(0.85, 0.97, flatness);
  return clamp(max(line.x, max(line.y, line.z)), 0.0, 1.0);
}

// Share of the light from all around that the tools and the floor leave: a tool overhangs the body outside each
// contact, most at its edge and no more one and a half radii further out.
float openness(vec3 normal) {
  float open = 1.0;
  for (uint i = 0; i < draw.rows.y; ++i) {
    vec4 spot = contacts[draw.rows.x + i].center_and_radius;
    float away = distance(rest_position.xyz, spot.xyz) / spot.w;
    open *= 1.0 - 0.3 * (1.0 - smoothstep(0.7, 2.5, away));
  }
  float height = (world_position.y - frame.floor_level.x) / frame.floor_level.y;
  float downward = 0.5 - 0.5 * normal.y;
  return open * (1.0 - 0.6 * downward * (1.0 - smoothstep(0.0, 0.5, height)));
}

void main() {
  vec3 normal = normalize(world_normal);
  vec3 to_eye = normalize(frame.eye.xyz - world_position);

  vec3 base = draw.color.rgb;
  if (draw.rows.z != kHeatNone) {
    float at = clamp((heat - frame.heat_scale.x) * frame.heat_scale.y, 0.0, 1.0);
    if (frame.heat_scale.w > 0.0) {
      float part = 2.0 * at - 1.0;
      at = 0.5 + 0.5 * sign(part) * sqrt(abs(part));
    }
    base = texture(color_maps, vec2(at * (255.0 / 256.0) + 0.5 / 256.0, frame.heat_scale.z)).rgb;
  }
  base *= 1.0 - 0.25 * rest_position.w;  // what is fixed is a little darker
  if (draw.grid.w > 0.0) {
    // Dark lines, or light ones where the colour is too dark for them.
    float luminance = dot(base, vec3(0.2126, 0.7152, 0.0722));
    vec3 line = mix(mix(base, vec3(1.0), 0.35), base * 0.12, smoothstep(0.03, 0.07, luminance));
    base = mix(base, line, material_lines());
  }

  float facing = max(dot(normal, frame.to_key_light.xyz), 0.0);
  float share = facing > 0.0 ? key_light_share(in_shadow_map) : 0.0;
  vec3 light = ambient_light(normal, to_eye, openness(normal)) + frame.key_light.rgb * facing * share;
  color = vec4(base * light + frame.key_light.rgb * share * 0.03 * highlight(normal, to_eye, 30.0), 1.0);
}
