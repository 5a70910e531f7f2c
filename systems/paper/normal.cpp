#include <algorithm>
#include <cmath>

#include "systems/contact/scratch.hpp"
#include "systems/paper/paper.hpp"

namespace torsion {
namespace {

// Of the body's smallest side and of the beam's length: beyond it no small-strain law means
// anything, and the cubic term would grow without bound.
constexpr double kDeepestOfSide = 0.5;

double deepest_allowed(const Bounds& bounds, const BeamSpring& beam) {
  const glm::dvec3 size = bounds.highest - bounds.lowest;
  const double side = std::min({size.x, size.y, size.z});
  return kDeepestOfSide * (beam.length > 0.0 ? std::min(side, beam.length) : side);
}

}  // namespace

PaperNormalLaw paper_normal_law(double contact_modulus, double radius, double axial_stiffness,
                                double length) {
  PaperNormalLaw law;
  if (radius <= 0.0) {
    return law;
  }
  const double punch = 2.0 * contact_modulus * radius;  // Boussinesq's flat punch (physics B3)
  if (axial_stiffness <= 0.0) {
    law.linear = punch;
    return law;
  }
  law.linear = punch * axial_stiffness / (punch + axial_stiffness);
  law.cubic = 4.0 / 3.0 * axial_stiffness / (length * length);
  return law;
}

void paper_normal_forces(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    const std::uint32_t body = identity.body;
    if (model.bodies.at<BodyModels>(body).contact != ContactModel::kPaper) {
      continue;
    }
    const Overlap& overlap = state.regions.at<Overlap>(region);
    const Elasticity& elasticity = model.bodies.at<Elasticity>(body);
    const BeamSpring& beam = context.scratch.beams[block_of(identity)];
    const double deepest = deepest_allowed(model.bodies.at<Bounds>(body), beam);
    const double depth = std::min(overlap.mean_depth, deepest);
    const PaperNormalLaw law =
        paper_normal_law(elasticity.contact_modulus(), overlap.radius, beam.stiffness, beam.length);
    state.regions.at<Contact>(region) = contact_of(overlap);
    RegionNormal& normal = state.regions.at<RegionNormal>(region);
    normal.force = law.linear * depth + law.cubic * depth * depth * depth;
    normal.stiffness = law.linear + 3.0 * law.cubic * depth * depth;
  }
}

}  // namespace torsion
