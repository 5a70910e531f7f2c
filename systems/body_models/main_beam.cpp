#include "systems/body_models/main_beam.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "systems/beam_sections.hpp"

namespace torsion {
namespace {

constexpr double kStations = static_cast<double>(kBeamStations);

void add_scaled(const BeamSection& section, double weight, BeamSection& sum) {
  sum.area += weight * section.area;
  sum.bending_xx += weight * section.bending_xx;
  sum.bending_yy += weight * section.bending_yy;
  sum.bending_xy += weight * section.bending_xy;
  sum.torsion_constant += weight * section.torsion_constant;
  sum.polar += weight * section.polar;
}

/// Weights (1 - d/R)^2 / (d^2 + e^2) with R a little more than twice the distance of the nearest
/// anchor: at least one anchor always counts, those that enter or leave the circle do so with
/// weight zero.
void interpolate_sections(const World& world, Range anchors, const glm::dvec3& tip, double size,
                          MainBeam& beam) {
  const auto rest = world.anchors.rows<AnchorRest>(anchors);
  const auto sections = world.sections.column<BeamSection>();
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
      add_scaled(sections[first + k], weight, beam.sections[k]);
    }
  }
  const double scale = 1.0 / sum;
  for (BeamSection& section : beam.sections) {
    BeamSection mean;
    add_scaled(section, scale, mean);
    section = mean;
  }
  beam.has_sections = true;
}

/// Timoshenko's shear coefficient: 6/7 for a circle, 5/6 for a rectangle, by how near J is to the
/// polar moment.
double shear_coefficient(const BeamSection& section) {
  constexpr double kSquare = 0.14057701 * 6.0;  // J / polar moment of a square
  const double roundness = (section.torsion_constant / section.polar - kSquare) / (1.0 - kSquare);
  return 5.0 / 6.0 + (6.0 / 7.0 - 5.0 / 6.0) * std::clamp(roundness, 0.0, 1.0);
}

}  // namespace

MainBeam main_beam(const World& world, std::uint32_t body, const glm::dvec3& tip) {
  const FixedRegion& fixed = world.bodies.at<FixedRegion>(body);
  const Bounds& bounds = world.bodies.at<Bounds>(body);
  const Range anchors = world.bodies.at<OwnedRows>(body).anchors;
  const double size = glm::length(bounds.highest - bounds.lowest);
  const glm::dvec3 reference = beam_reference(fixed, bounds);
  MainBeam beam;
  // A contact at the fixed point itself has no beam: a very short one along the reference stands
  // in.
  const double shortest = 1e-3 * size;
  const glm::dvec3 along = tip - fixed.point;
  const double length = glm::length(along);
  beam.length = std::max(length, shortest);
  beam.direction = length > 1e-3 * shortest ? along / length : reference;
  const TransverseAxes axes = transverse_axes(beam.direction, reference);
  beam.first = axes.first;
  beam.second = axes.second;
  if (anchors.count > 0) {
    interpolate_sections(world, anchors, tip, size, beam);
  }
  return beam;
}

BeamDeflection deflect(const MainBeam& beam, const Elasticity& elasticity, const glm::dvec3& force,
                       const glm::dvec2& moment) {
  BeamDeflection deflection;
  deflection.force = force;
  deflection.moment = moment;
  deflection.length = beam.length;
  const double youngs_modulus = elasticity.youngs_modulus;
  const double shear_modulus = elasticity.shear_modulus();
  deflection.turn[0] = glm::dvec2(0.0);
  deflection.shift[0] = glm::dvec3(0.0);
  const double piece = beam.length / kStations;
  for (std::size_t k = 0; k < kBeamStations; ++k) {
    const BeamSection& section = beam.sections[k];
    const double determinant =
        section.bending_xx * section.bending_yy - section.bending_xy * section.bending_xy;
    const double scale = 1.0 / (youngs_modulus * determinant);
    deflection.bending[k] = glm::dvec3(section.bending_yy * scale, section.bending_xx * scale,
                                       section.bending_xy * scale);
    const double shear = 1.0 / (shear_coefficient(section) * shear_modulus * section.area);
    deflection.straining[k] = glm::dvec3(shear, shear, 1.0 / (youngs_modulus * section.area));
    // The end of this piece is the start of the next one.
    const SectionMotion end = section_motion(deflection, piece * static_cast<double>(k + 1));
    deflection.turn[k + 1] = end.turn;
    deflection.shift[k + 1] = end.shift;
  }
  return deflection;
}

SectionMotion section_motion(const BeamDeflection& deflection, double along) {
  const double piece = deflection.length / kStations;
  // A piece owns its far end, so that `deflect` can ask for it before the next piece is there.
  const double place = along / piece * (1.0 - 1e-12);
  const auto k = static_cast<std::size_t>(std::clamp(place, 0.0, kStations - 1.0));
  const double start = piece * static_cast<double>(k);
  const double t = along - start;
  const double lever = deflection.length - start;
  // Moment over the piece: M = m + (lever - x) B with B = direction x force; its first and second
  // integral to t.
  const glm::dvec2 lever_moment(-deflection.force.y, deflection.force.x);
  const glm::dvec2 once = deflection.moment * t + lever_moment * (lever * t - 0.5 * t * t);
  const glm::dvec2 twice =
      deflection.moment * (0.5 * t * t) + lever_moment * (0.5 * lever * t * t - t * t * t / 6.0);
  const glm::dvec3& c = deflection.bending[k];
  const glm::dvec2& turn = deflection.turn[k];
  const glm::dvec2 turned(turn.x * t + c.x * twice.x + c.z * twice.y,
                          turn.y * t + c.z * twice.x + c.y * twice.y);
  SectionMotion motion;
  motion.turn = turn + glm::dvec2(c.x * once.x + c.z * once.y, c.z * once.x + c.y * once.y);
  motion.shift = deflection.shift[k] + glm::dvec3(turned.y, -turned.x, 0.0) +
                 deflection.straining[k] * deflection.force * t;
  return motion;
}

double axial_strain(const BeamDeflection& deflection, double along) {
  const double place =
      std::clamp(along / deflection.length * kStations - 0.5, 0.0, kStations - 1.0);
  const auto k =
      std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kBeamStations - 2));
  const double share = place - static_cast<double>(k);
  return deflection.force.z *
         (deflection.straining[k].z * (1.0 - share) + deflection.straining[k + 1].z * share);
}

}  // namespace torsion
