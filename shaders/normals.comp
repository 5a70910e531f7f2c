#version 450
#extension GL_GOOGLE_include_directive : require

// Unit normals of one body's deformed vertices: the sum of the cross products of the triangles around each vertex, so
// larger triangles count more. A vertex's triangles come as fans: rings of neighbours, so that each neighbour is read
// once. The CPU twin is vertex_normals() (render/normal_rings.hpp), which also says how rings are made.

#include "shared.h"
#include "texels.glsl"

layout(local_size_x = kGroupSize) in;

layout(std430, set = 0, binding = 0) readonly buffer Position { vec4 position[]; };      // m, body
layout(std430, set = 0, binding = 1) readonly buffer RingRange { uvec2 ring_range[]; };  // first entry, count
layout(std430, set = 0, binding = 2) readonly buffer Ring { uint ring[]; };              // neighbour | kRingRestart
layout(std430, set = 0, binding = 3) readonly buffer RestNormal { vec4 rest_normal[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Normal { vec4 normal[]; };
layout(set = 0, binding = 5) uniform samplerBuffer position_texels;
layout(set = 0, binding = 6) uniform usamplerBuffer ring_texels;
layout(push_constant) uniform Constants { NormalConstants constants; };

vec3 position_row(uint row) {
  if (kTexels) {
    return texelFetch(position_texels, int(row)).xyz;
  }
  return position[row].xyz;
}

uint ring_row(uint row) {
  if (kTexels) {
    return texelFetch(ring_texels, int(row)).x;
  }
  return ring[row];
}

void main() {
  uint vertex = gl_GlobalInvocationID.x;
  if (vertex >= constants.vertex_count) {
    return;
  }
  uint row = constants.vertex_first + vertex;
  uvec2 range = ring_range[row];
  vec3 center = position_row(row);
  precise vec3 sum = vec3(0.0);
  precise vec3 before = vec3(0.0);
  for (uint i = 0; i < range.y; ++i) {
    uint entry = ring_row(range.x + i);
    precise vec3 edge = position_row(constants.vertex_first + (entry & kRingVertex)) - center;
    if ((entry & kRingRestart) == 0) {
      sum = sum + vec3(before.y * edge.z - before.z * edge.y, before.z * edge.x - before.x * edge.z,
                       before.x * edge.y - before.y * edge.x);
    }
    before = edge;
  }
  precise float square = sum.x * sum.x + sum.y * sum.y + sum.z * sum.z;
  // A vertex without area around it keeps the normal it has at rest.
  normal[row] = square > 0.0 ? vec4(sum / sqrt(square), 0.0) : vec4(rest_normal[row].xyz, 0.0);
}
