#include "systems/body/skeleton/skeleton.hpp"

namespace torsion {

BeamSpring beam_spring(const MainBeam& beam, const Elasticity& elasticity) {
  BeamSpring spring{beam.length, 0.0};
  if (beam.has_sections) {
    double area = 0.0;
    for (const BeamSection& section : beam.sections) {
      area += 1.0 / section.area;
    }
    const double piece = beam.length / static_cast<double>(kBeamStations);
    spring.stiffness = elasticity.youngs_modulus / (area * piece);
  }
  return spring;
}

const BodyLaw kSkeletonLaw{.model = BodyModel::kSkeleton};

void main_beams(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    const std::uint32_t block = block_of(identity);
    context.scratch.beams[block] = BeamSpring{};
    const BodyModels& models = model.bodies.at<BodyModels>(identity.body);
    if (models.contact == ContactModel::kPaper && models.body == BodyModel::kSkeleton) {
      const MainBeam beam =
          main_beam(model, identity.body, state.regions.at<Overlap>(region).rest_center);
      context.scratch.beams[block] = beam_spring(beam, model.bodies.at<Elasticity>(identity.body));
    }
  }
}

}  // namespace torsion
