#include "systems/body/skeleton/skeleton.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/body/skeleton/beam_sections.hpp"
#include "systems/contact/law.hpp"

namespace torsion::engine {
namespace {

constexpr double kStations = static_cast<double>(kBeamStations);

void add_section(const BeamSection& section, double weight, BeamSection& sum) {
  sum.area += weight * section.area;
  sum.bending_xx += weight * section.bending_xx;
  sum.bending_yy += weight * section.bending_yy;
  sum.bending_xy += weight * section.bending_xy;
  sum.torsion_constant += weight * section.torsion_constant;
  sum.polar += weight * section.polar;
}

/// Weights (1 - d/R)^2 / (d^2 + e^2) with R a little more than twice the distance of the nearest
/// anchor: at least one anchor counts, and those that enter or leave the circle have weight zero
/// there.
void interpolate_sections(const Model& model, Range anchors, const glm::dvec3& tip, double size,
                          MainBeam& beam) {
  const auto rest = model.anchors.rows<AnchorRest>(anchors);
  const auto sections = model.sections.column<BeamSection>();
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (const AnchorRest& anchor : rest) {
    const glm::dvec3 offset = anchor.position - tip;
    nearest_squared = std::min(nearest_squared, glm::dot(offset, offset));
  }
  const double reach = 2.0 * std::sqrt(nearest_squared) + 0.1 * size;
  const double softening = 1e-6 * size * size;
  double sum = 0.0;
  beam.sections.fill(BeamSection{});
  for (std::uint32_t j = 0; j < anchors.count; ++j) {
    const glm::dvec3 offset = rest[j].position - tip;
    const double squared = glm::dot(offset, offset);
    if (squared >= reach * reach) {
      continue;
    }
    const double taper = 1.0 - std::sqrt(squared) / reach;
    const double weight = taper * taper / (squared + softening);
    sum += weight;
    const std::size_t first = static_cast<std::size_t>(anchors.first + j) * kBeamStations;
    for (std::size_t k = 0; k < kBeamStations; ++k) {
      add_section(sections[first + k], weight, beam.sections[k]);
    }
  }
  const double scale = 1.0 / sum;
  for (BeamSection& section : beam.sections) {
    BeamSection mean;
    add_section(section, scale, mean);
    section = mean;
  }
  beam.has_sections = true;
}

/// Timoshenko's shear coefficient: between 6/7 for a circle and 5/6 for a rectangle, by how near J
/// is to the polar moment.
double shear_coefficient(const BeamSection& section) {
  constexpr double kSquare = 0.14057701 * 6.0;  // J / polar moment of a square
  const double roundness = (section.torsion_constant / section.polar - kSquare) / (1.0 - kSquare);
  return 5.0 / 6.0 + (6.0 / 7.0 - 5.0 / 6.0) * std::clamp(roundness, 0.0, 1.0);
}

/// @param t  m from the piece's start
SectionMotion motion_in_piece(const BeamPiece& piece, double t) {
  const glm::dvec2 across = t * t * (piece.shift2 + t * piece.shift3);
  return {piece.shift0 + t * piece.shift1 + glm::dvec3(across, 0.0),
          piece.turn0 + t * (piece.turn1 + t * piece.turn2)};
}

}  // namespace

MainBeam main_beam(const Model& model, std::uint32_t body, const glm::dvec3& tip) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  const Bounds& bounds = model.bodies.at<Bounds>(body);
  const Range anchors = model.bodies.at<OwnedRows>(body).anchors;
  const double size = glm::length(bounds.highest - bounds.lowest);
  const glm::dvec3 reference = beam_reference(fixed, bounds);
  MainBeam beam;
  // A contact at the fixed point has no beam: a very short one along the reference is used instead.
  const double shortest = 1e-3 * size;
  const glm::dvec3 along = tip - fixed.point;
  const double length = glm::length(along);
  beam.length = std::max(length, shortest);
  beam.direction = length > 1e-3 * shortest ? along / length : reference;
  const TransverseAxes axes = transverse_axes(beam.direction, reference);
  beam.first = axes.first;
  beam.second = axes.second;
  // Other body models have anchors too, but no sections.
  if (anchors.count > 0 && model.bodies.at<BodyModels>(body).body == BodyModel::kSkeleton) {
    interpolate_sections(model, anchors, tip, size, beam);
  }
  return beam;
}

BeamDeflection deflect(const MainBeam& beam, const Elasticity& elasticity, const glm::dvec3& force,
                       const glm::dvec2& moment) {
  BeamDeflection deflection;
  const double youngs_modulus = elasticity.youngs_modulus;
  const double shear_modulus = elasticity.shear_modulus();
  const double length = beam.length / kStations;
  deflection.piece_length = length;
  // Moment over a piece: m + (lever - t) B, with the lever from its start to the tip, B = direction
  // x force.
  const glm::dvec2 lever_moment(-force.y, force.x);
  glm::dvec2 turn(0.0);
  glm::dvec3 shift(0.0);
  for (std::size_t k = 0; k < kBeamStations; ++k) {
    const BeamSection& section = beam.sections[k];
    const double scale = 1.0 / (youngs_modulus * (section.bending_xx * section.bending_yy -
                                                  section.bending_xy * section.bending_xy));
    const auto curvature = [&](const glm::dvec2& m) {
      return scale * glm::dvec2(section.bending_yy * m.x + section.bending_xy * m.y,
                                section.bending_xy * m.x + section.bending_xx * m.y);
    };
    const double lever = beam.length - length * static_cast<double>(k);
    const glm::dvec2 bent = curvature(moment + lever * lever_moment);
    const glm::dvec2 falls = curvature(lever_moment);
    const double shear = 1.0 / (shear_coefficient(section) * shear_modulus * section.area);
    deflection.strain[k] = force.z / (youngs_modulus * section.area);
    BeamPiece& piece = deflection.pieces[k];
    piece.turn0 = turn;
    piece.turn1 = bent;
    piece.turn2 = -0.5 * falls;
    piece.shift0 = shift;
    piece.shift1 = {turn.y + shear * force.x, -turn.x + shear * force.y, deflection.strain[k]};
    piece.shift2 = {0.5 * bent.y, -0.5 * bent.x};
    piece.shift3 = {-1.0 / 6.0 * falls.y, 1.0 / 6.0 * falls.x};
    // The next piece starts at the end of this one.
    const SectionMotion end = motion_in_piece(piece, length);
    turn = end.turn;
    shift = end.shift;
  }
  return deflection;
}

SectionMotion section_motion(const BeamDeflection& deflection, double along) {
  const double place =
      std::clamp(along / deflection.piece_length * (1.0 - 1e-12), 0.0, kStations - 1.0);
  const auto k = static_cast<std::uint32_t>(place);
  return motion_in_piece(deflection.pieces[k],
                         along - deflection.piece_length * static_cast<double>(k));
}

double axial_strain(const BeamDeflection& deflection, double along) {
  const double place = std::clamp(along / deflection.piece_length - 0.5, 0.0, kStations - 1.0);
  const auto k = std::min(static_cast<std::uint32_t>(place), kBeamStations - 2);
  const double share = place - static_cast<double>(k);
  return deflection.strain[k] + share * (deflection.strain[k + 1] - deflection.strain[k]);
}

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
    if (contact_law(models.contact).takes_beams && models.body == BodyModel::kSkeleton) {
      const MainBeam beam =
          main_beam(model, identity.body, state.regions.at<Overlap>(region).rest_center);
      context.scratch.beams[block] = beam_spring(beam, model.bodies.at<Elasticity>(identity.body));
    }
  }
}

}  // namespace torsion::engine
