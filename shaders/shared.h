// What C++ and GLSL share: constants, and structs whose bytes both read. Rows are multiples of 16 bytes, so that the
// std140 and std430 rules and C++ agree; render/shared_layout.cpp checks the offsets.
#ifndef TORSION_SHADERS_SHARED_H_
#define TORSION_SHADERS_SHARED_H_

#ifdef __cplusplus
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace torsion::engine::shared {
using glm::mat4;
using glm::uvec4;
using glm::vec4;
using uint = unsigned int;
#define TORSION_CONSTANT(name, value) inline constexpr uint name = value
#else
#define TORSION_CONSTANT(name, value) const uint name = value
#endif

TORSION_CONSTANT(kGroupSize, 128);  // invocations of one work group; 64 to 1024 were within 10 % on lavapipe

// What deform.comp puts into the fourth lane of a position, and body.frag shows. Values as HeatMap's.
TORSION_CONSTANT(kHeatNone, 0);
TORSION_CONSTANT(kHeatTwist, 1);
TORSION_CONSTANT(kHeatPressure, 2);

// Which deform.comp: how many regions turn.
TORSION_CONSTANT(kNoRegion, 0);
TORSION_CONSTANT(kOneRegion, 1);
TORSION_CONSTANT(kManyRegions, 2);

// What a draw is, bits of DrawConstants::rows.w. Bit i of the first kTextures: its material has a texture of the role i
// (TextureRole), which the shaders' array has at i.
TORSION_CONSTANT(kTextures, 5);
TORSION_CONSTANT(kBaseColor, 0);
TORSION_CONSTANT(kMetalRoughness, 1);
TORSION_CONSTANT(kNormal, 2);
TORSION_CONSTANT(kOcclusion, 3);
TORSION_CONSTANT(kEmission, 4);
TORSION_CONSTANT(kMarks, 32);           // tools: lines that turn with it
TORSION_CONSTANT(kOcclusionShift, 8);   // from that bit on: the strength of the occlusion, 0 to 255

// Reflections of the studio (render/studio_light.hpp): a square tile of the map for each of these
// steps of roughness, one over another; the tile of roughness r is round(r * (tiles - 1)).
TORSION_CONSTANT(kReflectionSide, 48);
TORSION_CONSTANT(kReflectionTiles, 17);

// The top bit of an entry of a normal ring: a new fan begins here.
TORSION_CONSTANT(kRingRestart, 0x80000000U);
TORSION_CONSTANT(kRingVertex, 0x7FFFFFFFU);

// Push constants of deform.comp. "first" counts rows from the start of what is bound.
struct DeformConstants {
  uint vertex_first;  // in rest, displacement and position
  uint vertex_count;
  uint twist_first;   // the body's first block of angles
  uint axis_first;
  uint regions;       // blocks of angles and rows of axes that hold something
  uint heat;          // kHeat...
};

// Push constants of normals.comp.
struct NormalConstants {
  uint vertex_first;
  uint vertex_count;
};

// Uniform block of every draw.
struct FrameUniforms {
  mat4 clip_from_world;
  mat4 shadow_from_world;   // to shadow map coordinates: xy 0 to 1, z depth
  vec4 eye;                 // xyz: m, world
  vec4 to_key_light;        // xyz: world, unit
  vec4 key_light;           // linear rgb; w: how far off a surface its shadow is looked up, m
  vec4 irradiance[9];       // linear rgb, of the studio, by spherical harmonics in the order of studio_light.hpp;
                            // w of the first: light from the eye
  vec4 background;          // linear rgb
  vec4 floor_box;           // xz centre, xz half size of the bodies' footprint, m, world
  vec4 floor_level;         // x: y of the floor, m; y: height of the bodies, m; z: radius of the visible floor, m; w: share of the
                            // key light that a tool takes away
  vec4 heat_scale;          // x: value at 0, y: 1 / (value at 1 - value at 0), z: row of the colour map (0 to 1),
                            // w: 1: square roots on both sides of the middle, 0: linear
};

// A contact region, for the shade in the crease between tool and body.
struct ContactSpot {
  vec4 center_and_radius;   // m, body at rest
};

// Push constants of every draw.
struct DrawConstants {
  vec4 to_world[3];         // rows of the rigid placement: world = to_world * (x, 1)
  vec4 color;               // linear rgb, alpha
  vec4 grid;                // body: xyz a crossing of the material lines, m, at rest; w their distance, m, 0: none
                            // tool: xyz the middle of its box, m, tool
  vec4 surface;             // x: metal, y: roughness, z: scattering, w: alpha's cutoff, 0 to 1
  vec4 emission;            // linear rgb; w: scale of the texture's normals
  uvec4 rows;               // x: first contact spot, y: number of them, z: kHeat..., w: bits, see above
};

// Push constants of the overlay.
struct OverlayConstants {
  vec4 pixel_to_clip;       // xy: 2 / picture's size in pixels
};

#ifdef __cplusplus
}  // namespace torsion::engine::shared
#endif

#endif  // TORSION_SHADERS_SHARED_H_
