#pragma once

#include "systems/body/compliance/supported_regions.hpp"

namespace torsion::engine {

// Where the material under a region is by its support: translation and rotation, m and rad, body.

/// The material's motion at `point` by the region's support.
Vector6 support_at(const RegionSupport& support, const glm::dvec3& point);

/// The part of its last step that comes from the other regions' answers (take_answers).
Vector6 answer_at(const RegionSupport& support, const glm::dvec3& point);

/// The part of it that depends on other regions.
Vector6 support_by_others(const RegionSupport& support, const glm::dvec3& point);

/// The remaining part, by the region's own load.
Vector6 own_support(const CompliantBody& body, const SupportedRegion& supported);

/// The motion that Newton's step starts from. A region with contact model patch computes the
/// displacement by its load in its own equations (patch/support.hpp), so it starts from there.
Vector6 support_now(const CompliantBody& body, const SupportedRegion& supported);

/// How a load's wrench about its support fit's centre changes when the material under it is
/// translated: the load then acts at another place of the material, which adds the couple force x
/// translation. Zero for a contact model that does not say where on the material its load acts.
Matrix6 wrench_by_place(const SupportedRegion& supported);

}  // namespace torsion::engine
