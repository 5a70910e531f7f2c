#include "systems/paper/paper.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "systems/contact/region_grid.hpp"
#include "systems/contact/scratch.hpp"
#include "systems/contact/stick_slip.hpp"
#include "systems/math/frames.hpp"
#include "systems/paper/brush.hpp"
#include "systems/paper/carry_tractions.hpp"

namespace torsion::engine {
namespace {

// Of the body's smallest side and of the beam's length. Small-strain laws do not hold beyond it,
// and the cubic term would grow without bound.
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
  const double punch = 2.0 * contact_modulus * radius;  // Boussinesq's flat punch
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

namespace {

/// Projected distance to the fixed part, the paper's l_i, as a linear function over the grid.
void set_levers(const FixedRegion& fixed, const RegionFrame& frame, const RegionMotion& motion,
                double radius, BrushState& brush) {
  glm::dvec3 direction = glm::dot(motion.axis, motion.axis) > 0.0 ? motion.axis : frame.normal;
  if (fixed.kind == FixedKind::kFace) {
    direction = fixed.normal / std::max(std::abs(glm::dot(direction, fixed.normal)), 0.1);
  }
  brush.lever_origin = glm::dot(frame.origin - fixed.point, direction);
  brush.lever_slope = body_to_grid_direction(frame, direction);
  brush.least_lever = radius;
}

/// True when another region of the same tool lies on the same body.
bool has_siblings(const State& state, std::uint32_t region) {
  const RegionIdentity& self = state.regions.at<RegionIdentity>(region);
  return std::ranges::any_of(state.regions.column<RegionIdentity>(), [&](const auto& other) {
    return other.body == self.body && other.tool == self.tool && other.order != self.order;
  });
}

BrushState brush_of(const Model& model, const State& state, std::uint32_t region) {
  const std::uint32_t body = state.regions.at<RegionIdentity>(region).body;
  const Contact& contact = state.regions.at<Contact>(region);
  const RegionMotion& motion = state.regions.at<RegionMotion>(region);
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const Elasticity& elasticity = model.bodies.at<Elasticity>(body);
  const double normal_force = state.regions.at<RegionNormal>(region).force;
  BrushState brush;
  brush.friction = model.bodies.at<Friction>(body);
  brush.falls = brush.friction.static_friction != brush.friction.dynamic_friction;
  brush.shear_modulus = elasticity.shear_modulus();
  brush.pressure = contact.area > 0.0 ? normal_force / contact.area : 0.0;
  const double stiffness =
      8.0 * brush.shear_modulus * contact.radius / (2.0 - elasticity.poisson_ratio);
  brush.translation_stiffness = contact.area > 0.0 ? stiffness / contact.area : 0.0;
  brush.inverse_slip_displacement = inverse_of(
      stiffness > 0.0 ? brush.friction.dynamic_friction * normal_force / stiffness : 0.0);
  brush.inverse_limit = inverse_of(brush.pressure * brush.friction.static_friction);
  brush.several = has_siblings(state, region);
  brush.pivot = motion.pivot;
  brush.center = glm::dvec2(body_to_grid(frame, contact.equivalent_point));
  brush.slide = motion.slide;
  brush.spin = motion.spin;
  brush.kinetic_share = state.regions.at<RegionFriction>(region).kinetic_share;
  set_levers(model.bodies.at<FixedRegion>(body), frame, motion, contact.radius, brush);
  return brush;
}

/// @param place  in the block
void put(const BrushState& brush, const BrushBlock& block, std::size_t place, CellTraction& cell) {
  cell.traction = {block.traction_x[place], block.traction_y[place]};
  cell.pressure = brush.pressure;
  cell.kinetic_share = block.kinetic_share[place];
  cell.sticks = block.sticks[place] > 0.0 ? 1U : 0U;
}

/// Updates the region's cells in contact, kBrushBlock at a time: from the tables, through the
/// return map, and back. Cells without contact carry nothing.
BrushSums update_cells(const Model& model, State& state, std::uint32_t region,
                       const BrushState& brush) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const Range rows = state.regions.at<RegionIdentity>(region).cells;
  const auto cells = state.cells.rows<CellGeometry>(rows);
  const auto tractions = state.cells.rows<CellTraction>(rows);
  const std::uint32_t side = model.settings.grid_side;
  const double cell_size = cell_area(frame, side);
  BrushLanes lanes;
  BrushBlock block{};
  std::array<std::uint32_t, kBrushBlock> owner{};
  std::size_t count = 0;
  const auto finish_block = [&] {
    std::fill(block.area.begin() + static_cast<std::ptrdiff_t>(count), block.area.end(), 0.0);
    update_brushes(brush, block, lanes);
    for (std::size_t k = 0; k < count; ++k) {
      put(brush, block, k, tractions[owner[k]]);
    }
    count = 0;
  };
  std::uint32_t cell = 0;
  std::array<double, kMaxGridSide> x;
  for (std::uint32_t i = 0; i < side; ++i) {
    x[i] = cell_center(frame, side, i, 0).x;
  }
  for (std::uint32_t j = 0; j < side; ++j) {
    const double y = cell_center(frame, side, 0, j).y;
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      if (cells[cell].coverage <= 0.0) {
        tractions[cell] = CellTraction{};
        continue;
      }
      block.x[count] = x[i];
      block.y[count] = y;
      block.height[count] = cells[cell].height;
      block.area[count] = cells[cell].coverage * cell_size;
      block.traction_x[count] = tractions[cell].traction.x;
      block.traction_y[count] = tractions[cell].traction.y;
      block.kinetic_share[count] = tractions[cell].kinetic_share;
      owner[count++] = cell;
      if (count == kBrushBlock) {
        finish_block();
      }
    }
  }
  if (count > 0) {
    finish_block();
  }
  return total(lanes);
}

/// The share of the region that has gone over to sliding: it grows with the path slid and falls
/// with the path moved elastically. Where a second region is on the same pair, every motion of a
/// region that the axis passes through counts as sliding (14).
double next_kinetic_share(const BrushState& brush, const BrushSums& sums, double axis_share) {
  const double stiffness = brush.translation_stiffness * sums.area;
  // Mean translation that the elastic limit cut off, m.
  const glm::dvec2 plastic = stiffness > 0.0 ? -sums.cut / stiffness : glm::dvec2(0.0);
  const double slid = glm::length(plastic);
  const double elastic = glm::length(brush.slide - plastic);
  const double forced = brush.several ? axis_share * sums.moved : 0.0;
  double share = brush.kinetic_share;
  share += (1.0 - share) * travelled(std::max(slid, forced), brush.inverse_slip_displacement);
  if (forced == 0.0) {
    share *= 1.0 - travelled(elastic, brush.inverse_slip_displacement);
  }
  return share;
}

/// r_m and phi_m of (6), (11)-(13): inside r_m the surface turns with the tool by phi_m; outside,
/// the friction limit corresponds to a turn that falls as 1/r.
void set_stick_radius(const BrushState& brush, const BrushSums& sums, const Contact& contact,
                      const RegionMotion& motion, RegionFriction& friction) {
  const double kinetic = friction.kinetic_share;
  const double limit = brush.pressure * ((1.0 - kinetic) * brush.friction.static_friction +
                                         kinetic * brush.friction.dynamic_friction);
  const double limit_arc =
      limit * motion.lever / brush.shear_modulus;  // m: r phi that the limit stands for
  if (sums.stuck_stiffness > 0.0) {
    // The mean turn of the springs of the cells that stick. After sliding little traction is left
    // in them, so it is small.
    friction.stick_turn = -sums.stuck_couple / sums.stuck_stiffness;
    const double twist = std::abs(friction.stick_turn);
    friction.stick_radius = twist * contact.radius > limit_arc ? limit_arc / twist : contact.radius;
    return;
  }
  const double largest = 2.0 / 3.0 * limit * contact.area * contact.radius;
  const double used = largest > 0.0 ? std::clamp(-friction.couple / largest, -1.0, 1.0) : 0.0;
  friction.stick_radius = contact.radius;
  friction.stick_turn = contact.radius > 0.0 ? used * limit_arc / contact.radius : 0.0;
}

}  // namespace

void paper_friction_forces(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    if (model.bodies.at<BodyModels>(state.regions.at<RegionIdentity>(region).body).contact !=
        ContactModel::kPaper) {
      continue;
    }
    const BrushState brush = brush_of(model, state, region);
    const BrushSums sums = update_cells(model, state, region, brush);
    const RegionMotion& motion = state.regions.at<RegionMotion>(region);
    RegionFriction& friction = state.regions.at<RegionFriction>(region);
    friction.force = sums.force;
    // Where the axis misses the region, the torque is r x F alone (1).
    friction.couple = motion.axis_share * sums.couple;
    friction.stick_share = sums.area > 0.0 ? sums.stuck_area / sums.area : 0.0;
    friction.kinetic_share = next_kinetic_share(brush, sums, motion.axis_share);
    set_stick_radius(brush, sums, state.regions.at<Contact>(region), motion, friction);
  }
}

namespace {

bool any_paper_friction(const StepContext& context) {
  return any_friction(context) && any_contact_model(context, ContactModel::kPaper);
}

constexpr System<StepContext> kPlace[] = {
    {"carry_tractions", "keeps tractions at their place on the body",
     "a body with contact model paper and friction", any_paper_friction, carry_tractions,
     columns<TractionFrame>(), columns<CellTraction>()},
    {"paper_normal_forces", "normal force f = k1 x + k3 x^3", "a body with contact model paper",
     any_with<ContactModel::kPaper>, paper_normal_forces, columns<RegionNormal, Contact>()},
};
constexpr System<StepContext> kSolve[] = {
    {"paper_friction_forces", "friction and contact torque, equations (2)-(9), (14)",
     "a body with contact model paper and friction", any_paper_friction, paper_friction_forces,
     columns<RegionFriction, CellTraction>()},
};

}  // namespace

// The force is a formula of the depth, which stiffens without bound and takes no account of other
// regions.
const ContactLaw kPaperLaw{
    .model = ContactModel::kPaper,
    .answers_from = std::numeric_limits<double>::infinity(),
    .is_bounded = false,
    .needs_motion = false,
    .takes_beams = true,
    .place = kPlace,
    .solve = kSolve,
    .follow = follow_overlap,
    .find_cells = find_overlap,
    .follows_material = true,
};

}  // namespace torsion::engine
