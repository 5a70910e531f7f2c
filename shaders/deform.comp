#version 450
#extension GL_GOOGLE_include_directive : require

// Where every vertex of one body is: turned about the axis of each region in the order of their formation, then
// displaced. The CPU twin is deform_vertices() (systems/surface/surface_field.hpp).
//
// Sources: Rodrigues' rotation in the form x + sin(t) k x r + (1 - cos(t)) k x (k x r), r from the axis point to x,
// which leaves x alone, bit for bit, where t = 0, so nothing asks whether it is. Vulkan promises sin() and cos() only
// to 2^-11, so both come from their Taylor series here: with t/2 brought to [-pi/4, pi/4] the first terms left out are
// 1.8e-9 (x^11/11!) and 2.5e-8 (x^10/10!). `precise` keeps the compiler from contracting and reordering.

#include "shared.h"
#include "texels.glsl"

// How many regions turn: kNoRegion, kOneRegion, or kManyRegions for as many as constants.regions says. Known to the
// compiler, because a processor's driver reads an axis once for all lanes only outside loops and branches, and goes
// through the body of a loop even where nothing is left to do.
layout(constant_id = 1) const uint kRegions = kManyRegions;

layout(local_size_x = kGroupSize) in;

struct Axis {
  vec4 point;      // m, body
  vec4 direction;  // body, unit
};

layout(std430, set = 0, binding = 0) readonly buffer Rest { vec4 rest[]; };                  // m, body
layout(std430, set = 0, binding = 1) readonly buffer Displacement { vec4 displacement[]; };  // m, body; w Pa
layout(std430, set = 0, binding = 2) readonly buffer Twist { float twist[]; };               // rad, region-major
layout(std430, set = 0, binding = 3) readonly buffer Axes { Axis axes[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Position { vec4 position[]; };         // m, body; w heat
layout(set = 0, binding = 5) uniform samplerBuffer rest_texels;
layout(set = 0, binding = 6) uniform samplerBuffer displacement_texels;
layout(push_constant) uniform Constants { DeformConstants constants; };

// sin(angle) and 1 - cos(angle). With h = angle / 2: sin = 2 sin h cos h, 1 - cos = 2 sin^2 h, so that small angles
// keep their relative precision. h is brought to [-pi/4, pi/4] by quarter turns, pi/2 being split in three so that
// the products with the number of quarter turns are exact (Cody and Waite, 1980).
void sine_and_versine(float angle, out float sine, out float versine) {
  precise float h = 0.5 * angle;
  precise float quarters = round(h * 0.636619772);
  precise float x = ((h - quarters * 1.5703125) - quarters * 4.83989716e-4) + quarters * 1.62920680e-7;
  precise float z = x * x;
  precise float s = x + x * z * (-1.66666667e-1 + z * (8.33333333e-3 + z * (-1.98412698e-4 + z * 2.75573192e-6)));
  precise float c = 1.0 + z * (-0.5 + z * (4.16666667e-2 + z * (-1.38888889e-3 + z * 2.48015873e-5)));
  bool swap = (int(quarters) & 1) != 0;  // an odd number of quarter turns exchanges sine and cosine
  // The signs: 2 s c changes sign with each quarter turn; 2 s^2 knows none.
  precise float product = 2.0 * s * c;
  precise float square = swap ? 2.0 * c * c : 2.0 * s * s;
  sine = swap ? -product : product;
  versine = square;
}

vec4 rest_row(uint row) {
  if (kTexels) {
    return texelFetch(rest_texels, int(row));
  }
  return rest[row];
}

vec4 displacement_row(uint row) {
  if (kTexels) {
    return texelFetch(displacement_texels, int(row));
  }
  return displacement[row];
}

// Turns `x` about the axis of a region; `heat` is the sum of the angles so far.
void turn(uint region, uint vertex, inout vec3 x, inout float heat) {
  float angle = twist[constants.twist_first + region * constants.vertex_count + vertex];
  Axis axis = axes[constants.axis_first + region];
  vec3 k = axis.direction.xyz;
  precise float sine;
  precise float versine;
  sine_and_versine(angle, sine, versine);
  precise vec3 r = x - axis.point.xyz;
  precise vec3 across = vec3(k.y * r.z - k.z * r.y, k.z * r.x - k.x * r.z, k.x * r.y - k.y * r.x);
  precise vec3 inward = vec3(k.y * across.z - k.z * across.y, k.z * across.x - k.x * across.z,
                             k.x * across.y - k.y * across.x);
  precise vec3 turned = x + (sine * across + versine * inward);
  x = turned;
  heat += angle;
}

void main() {
  // Invocations beyond the last vertex do its work again and write nothing: to return here would be a branch.
  uint vertex = min(gl_GlobalInvocationID.x, constants.vertex_count - 1);
  uint row = constants.vertex_first + vertex;
  vec3 x = rest_row(row).xyz;
  vec4 displaced = displacement_row(row);
  float heat = 0.0;
  if (kRegions != kNoRegion) {
    turn(0, vertex, x, heat);
  }
  if (kRegions == kManyRegions) {
    for (uint region = 1; region < constants.regions; ++region) {
      turn(region, vertex, x, heat);
    }
  }
  precise vec3 moved = x + displaced.xyz;
  if (constants.heat == kHeatPressure) {
    heat = displaced.w;
  }
  if (gl_GlobalInvocationID.x < constants.vertex_count) {
    position[row] = vec4(moved, heat);
  }
}
