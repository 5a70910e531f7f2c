#include "systems/surface/skeleton_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/body/skeleton/main_beam.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion {
namespace {

using std::numbers::pi;

/// What one region does to the main beam's tip, in the beam's frame: minus what the body does to
/// the tool.
struct TipLoad {
  glm::dvec3 force{0.0};   // N
  glm::dvec2 moment{0.0};  // N m, without torsion
};

TipLoad tip_load(const MainBeam& beam, const RegionFrame& frame, const RegionNormal& normal,
                 const RegionFriction& friction) {
  const glm::dvec3 force = -(frame.normal * normal.force + tangent_to_body(frame, friction.force));
  const glm::dvec3 couple = frame.normal * -friction.couple;
  return {
      {glm::dot(force, beam.first), glm::dot(force, beam.second), glm::dot(force, beam.direction)},
      {glm::dot(couple, beam.first), glm::dot(couple, beam.second)}};
}

/// Distance from the root along the beam of the section that carries a point. Sections are
/// perpendicular to the beam; over a fixed face they are parallel to the face, so that all of the
/// face belongs to the root.
double place_along(const MainBeam& beam, const FixedRegion& fixed, const glm::dvec3& from_root) {
  if (fixed.kind != FixedKind::kFace) {
    return glm::dot(from_root, beam.direction);
  }
  const double steepness = std::max(glm::dot(beam.direction, fixed.normal), 1e-3);
  return glm::dot(from_root, fixed.normal) / steepness;
}

/// u(a) = u(s) + rot(s) x r - nu e(s) r. The root keeps a free bar from contracting: the last term
/// grows from zero there to its full size within one radius of the section (Saint-Venant's
/// principle).
void move_anchors(const MainBeam& beam, const BeamDeflection& deflection, const FixedRegion& fixed,
                  double poisson_ratio, std::span<const AnchorRest> rest,
                  std::span<AnchorMotion> motion) {
  const double radius = std::sqrt(beam.sections[kBeamStations / 2].area / pi);
  const double over_entry = 1.0 / std::min(radius, 0.5 * beam.length);
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const glm::dvec3 from_root = rest[j].position - fixed.point;
    const double along = std::clamp(place_along(beam, fixed, from_root), 0.0, beam.length);
    const glm::dvec3 rib = from_root - beam.direction * along;
    const double x = glm::dot(rib, beam.first);
    const double y = glm::dot(rib, beam.second);
    const double z = glm::dot(rib, beam.direction);
    const SectionMotion section = section_motion(deflection, along);
    const double swelling =
        -poisson_ratio * axial_strain(deflection, along) * smooth_step(along * over_entry);
    const glm::dvec3 local(section.shift.x + section.turn.y * z + swelling * x,
                           section.shift.y - section.turn.x * z + swelling * y,
                           section.shift.z + section.turn.x * y - section.turn.y * x);
    motion[j].displacement +=
        beam.first * local.x + beam.second * local.y + beam.direction * local.z;
  }
}

}  // namespace

void skeleton_motions(const Model& model, const State& state, Snapshot& snapshot) {
  const auto identities = state.regions.column<RegionIdentity>();
  for (std::uint32_t body = 0; body < model.bodies.size(); ++body) {
    const Range anchors = model.bodies.at<OwnedRows>(body).anchors;
    const auto motion = snapshot.anchors.rows<AnchorMotion>(anchors);
    if (model.bodies.at<BodyModels>(body).body != BodyModel::kSkeleton || anchors.count == 0) {
      continue;
    }
    const Elasticity& elasticity = model.bodies.at<Elasticity>(body);
    const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
    for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
      if (identities[region].body != body) {
        continue;
      }
      const MainBeam beam = main_beam(model, body, state.regions.at<Contact>(region).rest_point);
      const TipLoad load = tip_load(beam, state.regions.at<RegionFrame>(region),
                                    state.regions.at<RegionNormal>(region),
                                    state.regions.at<RegionFriction>(region));
      const BeamDeflection deflection = deflect(beam, elasticity, load.force, load.moment);
      move_anchors(beam, deflection, fixed, elasticity.poisson_ratio,
                   model.anchors.rows<AnchorRest>(anchors), motion);
    }
  }
}

}  // namespace torsion
