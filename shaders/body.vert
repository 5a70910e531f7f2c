#version 450
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"
#include "openness.glsl"
#include "textures.glsl"
#include "reflection.glsl"

layout(location = 0) in vec4 position;  // m, body; w what the heat map shows
layout(location = 1) in vec4 normal;    // body
layout(location = 2) in vec4 rest;      // m, body; w 1 where fixed
layout(location = 3) in vec2 uv;
layout(location = 4) in vec3 paint;  // linear rgb

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec4 rest_position;
layout(location = 3) out float heat;
layout(location = 4) out vec3 in_shadow_map;
layout(location = 5) out vec2 texcoord;
layout(location = 6) out vec3 painted;

// Glass is drawn twice: its depth, then its colour, which must come out at the same depth to the last bit.
invariant gl_Position;

// Of the whole material: the last level of a texture is its mean.
float mean_roughness() {
  return draw.surface.y *
         (has_texture(kMetalRoughness) ? textureLod(textures[kMetalRoughness], vec2(0.5), 99.0).g : 1.0);
}

void main() {
  world_position = point_to_world(position.xyz);
  world_normal = direction_to_world(normal.xyz);
  rest_position = rest;
  heat = position.w;
  texcoord = uv;
  painted = paint;
  in_shadow_map = shadow_lookup(world_position, world_normal);
  if (kQuick) {
    vec3 to_eye = normalize(frame.eye.xyz - world_position);
    float facing = dot(world_normal, frame.to_key_light.xyz);
    float open = openness(rest.xyz, world_position.y, world_normal);
    vec3 around = ambient_light(world_normal, to_eye, open);
    float roughness = mean_roughness();
    float mirror =
        open * dot(mirrored(reflect(-to_eye, world_normal), roughness), vec3(0.2126, 0.7152, 0.0722));
    gl_Position = frame.clip_from_world * vec4(world_position, 1.0);
    world_position = around;
    world_normal = vec3(facing, mirror * mirrored_share(max(dot(world_normal, to_eye), 0.0), roughness));
    return;
  }
  gl_Position = frame.clip_from_world * vec4(world_position, 1.0);
}
