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
  World& world = context.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
    const std::uint32_t block = block_of(identity);
    context.scratch.beams[block] = BeamSpring{};
    if (world.bodies.at<BodyModels>(identity.body).body == BodyModel::kSkeleton) {
      const MainBeam beam =
          main_beam(world, identity.body, world.regions.at<RegionGeometry>(region).rest_point);
      context.scratch.beams[block] = beam_spring(beam, world.bodies.at<Elasticity>(identity.body));
    }
  }
}

}  // namespace torsion
