#include "app/drawn_detail.hpp"

#include <algorithm>

#include <glm/common.hpp>

#include "systems/model/choose_models.hpp"
#include "systems/surface/refine_mesh.hpp"

namespace torsion::engine {
namespace {

constexpr double kEverywhere = 1.0 / 16.0;  // of the longest side
// Of the contact's radius: a dozen edges across, and as many beside, where the dent is steepest.
constexpr double kInContact = 0.3;
constexpr double kAround = 0.5;  // of the radius: as fine as in the contact

DrawnDetail detail_of(const Model& model, std::uint32_t body,
                      std::span<const std::vector<Pose>> poses) {
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  DrawnDetail detail;
  detail.everywhere = kEverywhere * std::max({size.x, size.y, size.z});
  if (poses.empty()) {
    return detail;
  }
  const ExpectedContact contact = expect_contact(model, body, poses);
  if (contact.any && contact.radius > 0.0) {
    detail.touched = true;
    detail.where = {contact.touched.lowest - kAround * contact.radius,
                    contact.touched.highest + kAround * contact.radius};
    detail.there = kInContact * contact.radius;
  }
  return detail;
}

}  // namespace

void refine_drawn_bodies(SceneDescription& scene, const Model& model,
                         std::span<const std::vector<Pose>> poses) {
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    refine_mesh(scene.bodies[body].draw, detail_of(model, body, poses));
  }
}

}  // namespace torsion::engine
