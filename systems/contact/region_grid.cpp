#include "systems/contact/region_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "systems/contact/grid_cells.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/pressed_face.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/half_space/influence.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/smooth_step.hpp"

namespace torsion::engine {
double SecondMoments::width_over_length() const {
  const double mean = 0.5 * (xx + yy);
  const double radius = std::hypot(0.5 * (xx - yy), xy);
  return mean > 0.0 ? std::sqrt(std::max(mean - radius, 0.0) / (mean + radius)) : 1.0;
}

CellMoments covered_moments(const Grid& grid) {
  CellMoments moments;
  const double* coverage = grid.scratch.cell_columns.coverage.data();
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint32_t i = 0; i < grid.side; ++i, ++coverage) {
      moments.add(*coverage, static_cast<double>(i), static_cast<double>(j));
    }
  }
  return moments;
}

ContactAxes contact_axes(const Grid& grid, const CellMoments& moments) {
  constexpr double kFewest = 5.0;  // cells along a contact, of which its axes can be told
  ContactAxes axes;
  if (moments.weight <= 0.0) {
    return axes;
  }
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  const glm::dvec2 middle = glm::dvec2(moments.x, moments.y) / moments.weight;
  axes.middle = cell * (middle + 0.5) - grid.frame.half_size;
  // A cell's own second moment is a twelfth of its side's square.
  const SecondMoments second{
      (moments.xx / moments.weight - middle.x * middle.x + 1.0 / 12.0) * cell.x * cell.x,
      (moments.xy / moments.weight - middle.x * middle.y) * cell.x * cell.y,
      (moments.yy / moments.weight - middle.y * middle.y + 1.0 / 12.0) * cell.y * cell.y};
  axes.size = glm::sqrt(12.0 * glm::dvec2(second.xx, second.yy));
  const double slender = second.width_over_length();
  const double most = std::max(axes.size.x, axes.size.y);
  if (most < kFewest * std::max(cell.x, cell.y) || kLongContact * slender > 1.0) {
    return axes;
  }
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  axes.angle = second.angle();
  const std::int32_t aspect = table_aspect(grid.frame.half_size);
  if (aspect < 0 || (aspect == 0 && std::abs(axes.angle) > 0.5 * kQuarter)) {
    axes.angle += axes.angle > 0.0 ? -kQuarter : kQuarter;
  }
  axes.allowance = slender;
  return axes;
}

void turn_axes(RegionFrame& frame, double angle) {
  const glm::dvec3 x = frame.tangent_x;
  const glm::dvec3 y = frame.tangent_y;
  frame.tangent_x = std::cos(angle) * x + std::sin(angle) * y;
  frame.tangent_y = std::cos(angle) * y - std::sin(angle) * x;
}

namespace {

/// The highest set bit alone.
std::uint64_t last_bit(std::uint64_t bits) {
  return bits == 0 ? 0 : std::uint64_t{1} << (63 - std::countl_zero(bits));
}

}  // namespace

PlaneBox covered_box(const Grid& grid, const CellBits& covered) {
  PlaneBox box;
  std::optional<glm::dvec2> middle;  // of some covered cell
  const glm::dvec2 half = cell_half_size(grid);
  const double step = 2.0 / static_cast<double>(grid.side);
  const auto include = [&](std::uint32_t i, std::uint32_t j) {
    // As cell_center, without its division.
    const glm::dvec2 cell(static_cast<double>(i), static_cast<double>(j));
    const glm::dvec2 center = grid.frame.half_size * ((cell + 0.5) * step - 1.0);
    // Below half coverage the edge is before the cell's centre. The reach is negative then, and
    // grows with the coverage without a jump.
    const glm::dvec2 reach = half * (2.0 * grid.cells[j * grid.side + i].coverage - 1.0);
    box.include(center - reach, center + reach);
    middle = center;
  };
  // A cell reaches no farther than its covered neighbour on the outer side, so the outermost cells
  // of each row and the outermost rows determine the box.
  const auto any = [](std::uint64_t row) {
    return row != 0;
  };
  const auto first = std::ranges::find_if(covered, any) - covered.begin();
  const auto last = covered.rend() - std::find_if(covered.rbegin(), covered.rend(), any) - 1;
  for (std::ptrdiff_t j = first; j <= last; ++j) {
    const auto row = static_cast<std::uint32_t>(j);
    for (std::uint64_t left = covered[row]; left != 0;) {
      include(static_cast<std::uint32_t>(std::countr_zero(left)), row);
      const bool outermost = j == first || j == last;
      left = outermost ? left & (left - 1) : last_bit(left & (left - 1));
    }
  }
  if (box.empty() && middle) {
    box.include(*middle, *middle);
  }
  return box;
}

PlaneBox covered_box(const Grid& grid, const CellBits& covered, double angle) {
  const glm::dvec2 x(std::cos(angle), std::sin(angle));
  const glm::dvec2 y(-x.y, x.x);
  const glm::dvec2 half = cell_half_size(grid);
  PlaneBox box;
  for (std::uint32_t j = 0; j < grid.side; ++j) {
    for (std::uint64_t left = covered[j]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const glm::dvec2 center = cell_center(grid.frame, grid.side, i, j);
      const glm::dvec2 at(glm::dot(x, center), glm::dot(y, center));
      const glm::dvec2 reach = half * (2.0 * grid.cells[j * grid.side + i].coverage - 1.0);
      const glm::dvec2 along(glm::dot(glm::abs(x), reach), glm::dot(glm::abs(y), reach));
      box.include(at - along, at + along);
    }
  }
  return box;
}

glm::dvec2 half_size_for(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 half = 0.5 * (box.highest - box.lowest);
  const ContactLaw& law = law_of(grid.model, grid.identity.body);
  if (law.half_size != nullptr) {
    return law.half_size(kGridMargin * glm::max(half, glm::dvec2(kSmallestHalf)));
  }
  const double least = std::max(0.1 * std::max(half.x, half.y), kSmallestHalf);
  return kGridMargin * glm::max(half, glm::dvec2(least));
}

glm::dvec2 overlap_extent(const State& state, std::uint32_t region) {
  const glm::dvec2 of_grid = state.regions.at<RegionFrame>(region).half_size / kGridMargin;
  const SmoothContact& contact = state.regions.at<SmoothContact>(region);
  return contact.depth > 0.0 ? glm::mix(of_grid, contact.extent, contact.share) : of_grid;
}

glm::dvec3 body_normal(const Grid& grid, const glm::dvec3& point) {
  return glm::normalize(
      signed_distance(grid.model, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts, point)
          .gradient);
}

void lay(const Grid& grid, const glm::dvec2& shift, const glm::dvec2& half_size) {
  RegionFrame& frame = grid.frame;
  frame.half_size = half_size;
  frame.origin += tangent_to_body(frame, shift);
  const Distance surface = signed_distance(
      grid.model, grid.model.bodies.at<OwnedRows>(grid.identity.body).parts, frame.origin);
  frame.origin -= frame.normal *
                  (surface.value / std::max(glm::dot(surface.gradient, frame.normal), kSteepest));
}

void fit(const Grid& grid, const PlaneBox& box) {
  lay(grid, 0.5 * (box.lowest + box.highest), half_size_for(grid, box));
}

void approach(const Grid& grid, const PlaneBox& box, bool moves) {
  constexpr double kShortMotion = 0.05;  // of the half size: a cell is an eighth of it
  constexpr double kLong = 0.2;
  constexpr double kPart = 0.5;
  const glm::dvec2 half = grid.frame.half_size;
  const glm::dvec2 shift = 0.5 * (box.lowest + box.highest);
  const glm::dvec2 growth = half_size_for(grid, box) - half;
  const glm::dvec2 off = glm::max(glm::abs(shift), glm::abs(growth)) / half;
  const double most = std::max(off.x, off.y);
  if (!moves && most < kShortMotion) {
    return;
  }
  const double part =
      kPart + (1.0 - kPart) * smooth_step((most - kShortMotion) / (kLong - kShortMotion));
  lay(grid, part * shift, half + part * growth);
}

void restart_heights(const Grid& grid, double depth) {
  for (CellGeometry& cell : grid.cells) {
    cell.height = -depth;
  }
}

namespace {

constexpr int kMostRegrids =
    10;  // of one grid in one step: a new region finds its size by doubling
constexpr double kSmallestBoxFill = 0.45;  // by the contact, else the grid is made smaller
constexpr double kTurn = 0.5;              // of the angle by which a grid lies askew, in a step
constexpr double kSettled =
    0.02;  // of the grid: what it is off by when a region begins, splits or takes over another

/// Where the contact sticks, the material moved with the tool in the last step: the grid turns with
/// it, and the place of the tractions moves with it. Contact is found against the rest shape, so a
/// long contact that sticks and turns would otherwise seem to leave the area that it holds.
void follow_material(State& state, std::uint32_t region) {
  RegionFrame& frame = state.regions.at<RegionFrame>(region);
  RegionFrame& tractions = state.regions.at<TractionFrame>(region).frame;
  const RegionMotion& motion = state.regions.at<RegionMotion>(region);
  const double share = state.regions.at<RegionFriction>(region).stick_share;
  const double angle = share * motion.spin;
  const glm::dvec3 pivot = grid_to_body(frame, {motion.pivot, 0.0});
  const glm::dvec3 slide = tangent_to_body(frame, share * motion.slide);
  const glm::dvec3 arm = tractions.origin - pivot;
  tractions.origin += slide + std::sin(angle) * glm::cross(frame.normal, arm);
  turn_axes(tractions, angle);
  turn_axes(frame, angle);
}

/// True when the contact reaches the grid's edge, so that some of it may lie outside.
bool reaches_edge(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 inner = grid.frame.half_size - cell_half_size(grid);
  return box.lowest.x < -inner.x || box.lowest.y < -inner.y || box.highest.x > inner.x ||
         box.highest.y > inner.y;
}

bool fills_too_little(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 fill = (box.highest - box.lowest) / (2.0 * grid.frame.half_size);
  return std::max(fill.x, fill.y) < kSmallestBoxFill;
}

/// True when a further pass would leave the grid where it is.
bool settled(const Grid& grid, const PlaneBox& box) {
  const glm::dvec2 change = glm::abs(half_size_for(grid, box) - grid.frame.half_size);
  const glm::dvec2 shift = glm::abs(0.5 * (box.lowest + box.highest));
  const glm::dvec2 off = glm::max(change, shift) / grid.frame.half_size;
  return std::max(off.x, off.y) < kSettled;
}

/// Turns the grid, and what is known in its axes.
void turn_grid(const Grid& grid, std::uint32_t region, double angle) {
  turn_axes(grid.frame, angle);
  const glm::dmat2 back(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
  const ContactLaw& law = law_of(grid.model, grid.identity.body);
  if (law.turn != nullptr) {
    law.turn(grid.state, region, back);
  }
  RegionFriction& friction = grid.state.regions.at<RegionFriction>(region);
  friction.force = back * friction.force;
}

/// Turns the grid's axes towards those of a long contact; askew, it has only a cell or two across.
/// @param part  share of the angle that is turned
/// @return the contact's box in the new axes
PlaneBox align_grid(const Grid& grid, std::uint32_t region, const CellBits& covered, double part) {
  const double angle = part * contact_axes(grid, covered_moments(grid)).angle;
  if (angle == 0.0) {
    return covered_box(grid, covered);
  }
  const PlaneBox box = covered_box(grid, covered, angle);
  turn_grid(grid, region, angle);
  return box;
}

/// Regrids until the grid holds the whole contact and little else. In most steps one pass is
/// enough, and the grid follows the contact from step to step. After an event the grid settles
/// within the step: otherwise the force would fade in while the grid still moves.
/// @return whether it was regridded
bool fit_to_contact(const Grid& grid, std::uint32_t region, const RegionPoints& contact,
                    double start_depth, bool event_now) {
  bool outgrown = false;
  std::optional<RegionFrame> wide;  // before it was made tight
  for (int pass = 0; pass < kMostRegrids; ++pass) {
    const CellBits covered = find_cells(grid, contact);
    PlaneBox box = covered_box(grid, covered);
    if (wide && (box.empty() || reaches_edge(grid, box))) {
      // On smaller cells the contact ends at another place: there is no grid that fits more
      // tightly.
      grid.frame = *wide;
      restart_heights(grid, start_depth);
      find_cells(grid, contact);
      return true;
    }
    if (box.empty()) {
      if (pass > 0) {
        return true;
      }
      // The heights start from the tool's last place. A thin tool that has turned may be missed
      // from there by every cell.
      restart_heights(grid, start_depth);
      continue;
    }
    if (reaches_edge(grid, box)) {
      box.lowest -= 0.5 * grid.frame.half_size;
      box.highest += 0.5 * grid.frame.half_size;
      outgrown = true;
    } else if (event_now ? settled(grid, box) : !fills_too_little(grid, box)) {
      if (event_now || !outgrown || wide) {
        return pass > 0;
      }
      // This large grid only finds how far the contact reaches. If it stayed, its large cells would
      // show a sharp corner as smaller than it is, the next step would shrink the grid, and the
      // step after that would find it too small.
      const glm::dvec2 cell = cell_half_size(grid);
      box.lowest -= cell;
      box.highest += cell;
      wide = grid.frame;
    }
    if (event_now && !reaches_edge(grid, box)) {
      box = align_grid(grid, region, covered, 1.0);
    }
    fit(grid, box);
    restart_heights(grid, start_depth);
  }
  return true;
}

void include_points(const Grid& grid, const RegionPoints& contact, PlaneBox& box) {
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    if (point.cluster == contact.cluster) {
      const glm::dvec2 in_grid(body_to_grid(grid.frame, point.position));
      box.include(in_grid, in_grid);
    }
  }
}

/// The region's contact in this step. It is found by the region's block of cells, which stays the
/// same when rows move.
RegionPoints& region_points_of(StepContext& context, const RegionIdentity& region) {
  return context.scratch.region_points[block_of(region)];
}

}  // namespace

ContactPoint deepest_of_cluster(const Grid& grid, const RegionPoints& contact) {
  ContactPoint deepest;
  for (const ContactPoint& point : points_of(grid.scratch, contact)) {
    if (point.cluster == contact.cluster && point.depth > deepest.depth) {
      deepest = point;
    }
  }
  return deepest;
}

void look_along_normal(const Grid& grid, const RegionPoints& contact) {
  constexpr double kLittle = 0.1;  // of the depth
  const Overlap seen = summarize_cells(grid);
  const double sine = glm::length(glm::cross(grid.frame.normal, seen.mean_normal));
  const double reach = std::max(grid.frame.half_size.x, grid.frame.half_size.y);
  if (sine * reach <= kLittle * seen.largest_depth) {
    return;
  }
  turn_normal_to(grid.frame, seen.mean_normal);
  restart_heights(grid, seen.largest_depth);
  find_cells(grid, contact);
}

void place_new_grid(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  region_points_of(context, grid.identity) = contact;
  const ContactPoint deepest = deepest_of_cluster(grid, contact);
  RegionFrame& frame = grid.frame;
  frame = RegionFrame{};
  frame.origin = deepest.position;
  turn_normal_to(frame, pressed_normal(grid, deepest));
  PlaneBox box;
  const glm::dvec2 start(2.0 * deepest.depth);
  box.include(-start, start);
  include_points(grid, contact, box);
  fit(grid, box);
  restart_heights(grid, deepest.depth);
}

void follow_overlap(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  const MotionOverBody motion = motion_over_body(context.state, region);
  const bool moves = motion.shift != glm::dvec3(0.0) || motion.turn != glm::dvec3(0.0);
  if (law_of(context.model, grid.identity.body).follows_material) {
    follow_material(context.state, region);
  }
  const CellBits covered = covered_cells(grid);
  PlaneBox box = moves ? align_grid(grid, region, covered, kTurn) : covered_box(grid, covered);
  if (box.empty()) {
    // A grid that only moved towards its contact points would shrink to a point under a single one.
    // Without points the grid stays, and its cells find either nothing or the tool again.
    if (contact.cluster != kNoRow) {
      place_new_grid(context, region, contact);
    }
    return;
  }
  include_points(grid, contact, box);
  approach(grid, box, moves);
  turn_normal_to(grid.frame, context.state.regions.at<Overlap>(region).mean_normal);
}

void find_overlap(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const Grid grid = grid_of(context, region);
  const double depth = deepest_of_cluster(grid, contact).depth;
  const bool event_now = context.state.regions.at<RegionWrench>(region).event_now != 0;
  if (fit_to_contact(grid, region, contact, depth, event_now)) {
    look_along_normal(grid, contact);
  }
}

void follow_contact(StepContext& context, std::uint32_t region, const RegionPoints& contact) {
  const RegionIdentity& identity = context.state.regions.at<RegionIdentity>(region);
  region_points_of(context, identity) = contact;
  law_of(context.model, identity.body).follow(context, region, contact);
}

void region_grids(StepContext& context) {
  const Model& model = context.model;
  State& state = context.state;
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
    law_of(model, identity.body).find_cells(context, region, region_points_of(context, identity));
    state.regions.at<Overlap>(region) = summarize_cells(grid_of(context, region));
  }
  for (std::uint32_t region = 0; region < state.regions.size(); ++region) {
    const ContactLaw& law = law_of(model, state.regions.at<RegionIdentity>(region).body);
    if (law.share_out != nullptr) {
      law.share_out(context, region);
    }
    if (law.refine != nullptr) {
      law.refine(context, region);
    }
    const BodyLaw& body = body_law_of(model, state.regions.at<RegionIdentity>(region).body);
    if (body.begin_answer != nullptr) {
      body.begin_answer(model, state, region);
    }
  }
}

}  // namespace torsion::engine
