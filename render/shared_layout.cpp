// C++'s side of shaders/shared.h against the std140 and std430 rules: a vec4, a mat4's column and a
// uvec4 begin at multiples of 16 bytes, and nothing lies between the members.

#include <cstddef>

#include "ecs/components.hpp"
#include "ecs/draw_material.hpp"
#include "shaders/shared.h"

namespace torsion::engine {
namespace {

using shared::DrawConstants;
using shared::FrameUniforms;

constexpr std::size_t kVec4 = 16;
constexpr std::size_t kMat4 = 4 * kVec4;
constexpr std::size_t kLeastPushConstants = 128;  // bytes that every Vulkan device has

static_assert(sizeof(shared::vec4) == kVec4 && sizeof(shared::mat4) == kMat4);
static_assert(offsetof(FrameUniforms, shadow_from_world) == kMat4);
static_assert(offsetof(FrameUniforms, eye) == 2 * kMat4);
static_assert(offsetof(FrameUniforms, irradiance) == 2 * kMat4 + 3 * kVec4);
static_assert(offsetof(FrameUniforms, heat_scale) == 2 * kMat4 + 15 * kVec4);
static_assert(sizeof(FrameUniforms) == 2 * kMat4 + 16 * kVec4);
static_assert(offsetof(DrawConstants, color) == 3 * kVec4);
static_assert(offsetof(DrawConstants, grid) == 4 * kVec4);
static_assert(offsetof(DrawConstants, surface) == 5 * kVec4);
static_assert(offsetof(DrawConstants, emission) == 6 * kVec4);
static_assert(offsetof(DrawConstants, rows) == 7 * kVec4);
static_assert(shared::kTextures == kTextureRoles);
static_assert(shared::kMetalRoughness == static_cast<shared::uint>(TextureRole::kMetalRoughness) &&
              shared::kEmission == static_cast<shared::uint>(TextureRole::kEmission));
static_assert(sizeof(DrawConstants) <= kLeastPushConstants);
static_assert(sizeof(shared::DeformConstants) == 6 * sizeof(shared::uint));
static_assert(sizeof(shared::NormalConstants) == 2 * sizeof(shared::uint));
static_assert(sizeof(shared::ContactSpot) == kVec4);

// Columns of the frame world as deform.comp and normals.comp read them.
static_assert(sizeof(VertexRest) == kVec4 && sizeof(VertexNormal) == kVec4);
static_assert(sizeof(VertexDisplacement) == kVec4 && sizeof(TwistAxis) == 2 * kVec4);
static_assert(sizeof(TwistAngle) == sizeof(float) && sizeof(Triangle) == 3 * sizeof(shared::uint));

}  // namespace
}  // namespace torsion::engine
