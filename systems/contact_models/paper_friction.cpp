#include <algorithm>
#include <cmath>

#include "systems/contact_models/friction_decay.hpp"
#include "systems/contact_models/paper.hpp"
#include "systems/frames.hpp"

namespace torsion {
namespace {

/// What the cells of one region share in one step. Tractions are per area, on the tool, in the
/// grid's plane.
struct BrushState {
  double pressure = 0.0;               // Pa: F_n / A, uniform (f_max / n of the paper)
  double shear_modulus = 0.0;          // G, Pa
  double translation_stiffness = 0.0;  // Pa/m: 8 G a / (2 - nu) spread over the area (physics B4)
  double inverse_slip_displacement =
      0.0;                     // 1/m: elastic deflection at which the translating region slips
  double inverse_limit = 0.0;  // 1/Pa: of the static friction limit
  Friction friction;
  bool falls = false;     // friction, once a cell slips: mu_d is not mu_s
  glm::dvec2 pivot{0.0};  // m, grid
  glm::dvec2 slide{0.0};  // m, grid, this step
  double spin = 0.0;      // rad, this step
  double lever_origin =
      0.0;  // m: l at the grid's origin; l_i = |lever_origin + lever_slope . (x, y, z)|
  glm::dvec3 lever_slope{0.0};
  double least_lever = 0.0;  // m: a
  double kinetic_share = 0.0;
  bool several = false;  // another region of the same tool and body
};

/// Projected distance to what is fixed as a linear function over the grid (the paper's l_i, physics
/// C2 point 4).
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
bool has_siblings(const World& world, std::uint32_t region) {
  const RegionIdentity& self = world.regions.at<RegionIdentity>(region);
  return std::ranges::any_of(world.regions.column<RegionIdentity>(), [&](const auto& other) {
    return other.body == self.body && other.tool == self.tool && !(other.self == self.self);
  });
}

BrushState brush_of(const World& world, std::uint32_t region) {
  const std::uint32_t body = world.regions.at<RegionIdentity>(region).body;
  const RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  const RegionMotion& motion = world.regions.at<RegionMotion>(region);
  const Elasticity& elasticity = world.bodies.at<Elasticity>(body);
  const double normal_force = world.regions.at<RegionNormal>(region).force;
  BrushState brush;
  brush.friction = world.bodies.at<Friction>(body);
  brush.falls = brush.friction.static_friction != brush.friction.dynamic_friction;
  brush.shear_modulus = elasticity.shear_modulus();
  brush.pressure = geometry.area > 0.0 ? normal_force / geometry.area : 0.0;
  const double stiffness =
      8.0 * brush.shear_modulus * geometry.radius / (2.0 - elasticity.poisson_ratio);
  brush.translation_stiffness = geometry.area > 0.0 ? stiffness / geometry.area : 0.0;
  brush.inverse_slip_displacement = inverse_of(
      stiffness > 0.0 ? brush.friction.dynamic_friction * normal_force / stiffness : 0.0);
  brush.inverse_limit = inverse_of(brush.pressure * brush.friction.static_friction);
  brush.several = has_siblings(world, region);
  brush.pivot = motion.pivot;
  brush.slide = motion.slide;
  brush.spin = motion.spin;
  brush.kinetic_share = world.regions.at<RegionFriction>(region).kinetic_share;
  set_levers(world.bodies.at<FixedRegion>(body), world.regions.at<RegionFrame>(region), motion,
             geometry.radius, brush);
  return brush;
}

/// One cell's outcome that the region needs.
struct CellSlip {
  glm::dvec2 cut{0.0};  // Pa: what the elastic limit took from the trial traction
  double moved = 0.0;   // m: the cell's own motion over the body
};

/// The kinetic branch: the traction goes to the limit against the cell's own motion, the share
/// travelled(moved) of the way.
glm::dvec2 turn_against(glm::dvec2 traction, const glm::dvec2& motion, double moved, double limit,
                        double inverse_scale) {
  const double grown = growth(moved * inverse_scale) * inverse_scale;  // travelled / moved / kept
  const double kept = 1.0 / (1.0 + moved * grown);
  traction = kept * (traction - limit * grown * motion);
  const double square = glm::dot(traction, traction);
  return square > limit * limit ? traction * (limit / std::sqrt(square)) : traction;
}

/// The return map of one cell (physics C2 points 5 and 6): elastic trial, capped at the friction
/// limit; with the region sliding, towards the limit against the cell's own motion.
/// @param twist_stiffness  Pa/m: equation (2), tau = G r phi / l
CellSlip update_cell(const BrushState& brush, const glm::dvec2& arm, double twist_stiffness,
                     CellTraction& cell) {
  const glm::dvec2 turned = brush.spin * glm::dvec2(-arm.y, arm.x);
  const glm::dvec2 before = cell.traction;
  const glm::dvec2 trial =
      before - brush.translation_stiffness * brush.slide - twist_stiffness * turned;
  const double trial_square = glm::dot(trial, trial);

  const double kinetic = std::max(cell.kinetic_share, brush.kinetic_share);
  const double limit = brush.pressure * ((1.0 - kinetic) * brush.friction.static_friction +
                                         kinetic * brush.friction.dynamic_friction);
  CellSlip slip;
  glm::dvec2 elastic = trial;
  // mu_s comes down to mu_d as the cell slips, and is back once it has been loaded the other way as
  // far.
  const bool slips = trial_square > limit * limit;
  if (slips) {
    const double trial_size = std::sqrt(trial_square);
    elastic *= limit / trial_size;
    slip.cut = trial - elastic;
    if (brush.falls) {
      cell.kinetic_share += (1.0 - cell.kinetic_share) *
                            travelled(trial_size - limit, brush.inverse_limit / kSlipLength);
    }
  } else if (cell.kinetic_share > 0.0) {
    cell.kinetic_share *= 1.0 - travelled(glm::distance(elastic, before), brush.inverse_limit);
  }
  cell.traction = elastic;
  if (brush.kinetic_share > 0.0 || brush.several) {
    const glm::dvec2 motion = brush.slide + turned;
    slip.moved = glm::length(motion);
    const glm::dvec2 sliding =
        turn_against(before, motion, slip.moved, limit, brush.inverse_slip_displacement);
    cell.traction += brush.kinetic_share * (sliding - elastic);
  }
  cell.pressure = brush.pressure;
  cell.sticks = !slips && brush.kinetic_share < 0.5 ? 1U : 0U;
  return slip;
}

/// Sums over a region's covered cells.
struct CellSums {
  double area = 0.0;
  double stuck_area = 0.0;
  glm::dvec2 force{0.0};
  double couple = 0.0;           // N m about the normal through p_eq
  glm::dvec2 plastic{0.0};       // m, mean: translation that the elastic limit cut off
  double moved = 0.0;            // m, largest
  double stuck_couple = 0.0;     // N m about the pivot, of the cells that stick
  double stuck_stiffness = 0.0;  // N m/rad, of the same
};

CellSums update_cells(World& world, std::uint32_t region, const BrushState& brush) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  const Range rows = world.regions.at<RegionIdentity>(region).cells;
  const auto cells = world.cells.rows<CellGeometry>(rows);
  const auto tractions = world.cells.rows<CellTraction>(rows);
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  const double cell_size = cell_area(frame, side);
  const glm::dvec2 center(body_to_grid(frame, geometry.equivalent_point));
  CellSums sums;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      if (cells[cell].coverage <= 0.0) {
        tractions[cell] = CellTraction{};
        continue;
      }
      const glm::dvec2 place = cell_center(frame, side, i, j);
      const double lever =
          std::max(std::abs(brush.lever_origin +
                            glm::dot(brush.lever_slope, glm::dvec3(place, cells[cell].height))),
                   brush.least_lever);
      const double twist_stiffness = brush.shear_modulus / lever;
      const glm::dvec2 turning_arm = place - brush.pivot;
      const CellSlip slip = update_cell(brush, turning_arm, twist_stiffness, tractions[cell]);
      const double area = cells[cell].coverage * cell_size;
      const glm::dvec2 force = area * tractions[cell].traction;
      const glm::dvec2 arm = place - center;
      sums.area += area;
      sums.force += force;
      sums.couple += arm.x * force.y - arm.y * force.x;
      sums.plastic -= area * slip.cut;
      sums.moved = std::max(sums.moved, slip.moved);
      const double arm_squared = glm::dot(turning_arm, turning_arm);
      if (tractions[cell].sticks != 0 && arm_squared > 0.0) {
        sums.stuck_area += area;
        sums.stuck_couple += turning_arm.x * force.y - turning_arm.y * force.x;
        sums.stuck_stiffness += twist_stiffness * arm_squared * area;
      }
    }
  }
  const double plastic_stiffness = brush.translation_stiffness * sums.area;
  sums.plastic = plastic_stiffness > 0.0 ? sums.plastic / plastic_stiffness : glm::dvec2(0.0);
  return sums;
}

/// How far the region has gone over to sliding: by the path it slid, back by the path it moved
/// elastically. With a second region on the same pair every motion of the region that the axis goes
/// through counts as sliding (14).
double next_kinetic_share(const BrushState& brush, const CellSums& sums, double axis_share) {
  const double slid = glm::length(sums.plastic);
  const double elastic = glm::length(brush.slide - sums.plastic);
  const double forced = brush.several ? axis_share * sums.moved : 0.0;
  double share = brush.kinetic_share;
  share += (1.0 - share) * travelled(std::max(slid, forced), brush.inverse_slip_displacement);
  if (forced == 0.0) {
    share *= 1.0 - travelled(elastic, brush.inverse_slip_displacement);
  }
  return share;
}

/// r_m and phi_m of (6), (11)-(13): inside r_m the surface turns with the tool by phi_m; outside,
/// the limit traction stands for a turn that falls as 1/r.
void set_stick_radius(const BrushState& brush, const CellSums& sums, const RegionGeometry& geometry,
                      const RegionMotion& motion, RegionFriction& friction) {
  const double kinetic = friction.kinetic_share;
  const double limit = brush.pressure * ((1.0 - kinetic) * brush.friction.static_friction +
                                         kinetic * brush.friction.dynamic_friction);
  const double limit_arc =
      limit * motion.lever / brush.shear_modulus;  // m: r phi that the limit stands for
  if (sums.stuck_area > 0.0) {
    // What the springs of the cells that stick are turned by, all together: of tractions that the
    // region's sliding left in them little is left.
    friction.stick_turn = -sums.stuck_couple / sums.stuck_stiffness;
    const double twist = std::abs(friction.stick_turn);
    friction.stick_radius =
        twist * geometry.radius > limit_arc ? limit_arc / twist : geometry.radius;
    return;
  }
  const double largest = 2.0 / 3.0 * limit * geometry.area * geometry.radius;
  const double used = largest > 0.0 ? std::clamp(-friction.couple / largest, -1.0, 1.0) : 0.0;
  friction.stick_radius = geometry.radius;
  friction.stick_turn = geometry.radius > 0.0 ? used * limit_arc / geometry.radius : 0.0;
}

}  // namespace

void paper_friction_forces(StepContext& context) {
  World& world = context.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (world.bodies.at<BodyModels>(world.regions.at<RegionIdentity>(region).body).contact !=
        ContactModel::kPaper) {
      continue;
    }
    const BrushState brush = brush_of(world, region);
    const CellSums sums = update_cells(world, region, brush);
    const RegionMotion& motion = world.regions.at<RegionMotion>(region);
    RegionFriction& friction = world.regions.at<RegionFriction>(region);
    friction.force = sums.force;
    // An axis that misses the region leaves T = r x F alone (1).
    friction.couple = motion.axis_share * sums.couple;
    friction.stick_share = sums.area > 0.0 ? sums.stuck_area / sums.area : 0.0;
    friction.kinetic_share = next_kinetic_share(brush, sums, motion.axis_share);
    set_stick_radius(brush, sums, world.regions.at<RegionGeometry>(region), motion, friction);
  }
}

}  // namespace torsion
