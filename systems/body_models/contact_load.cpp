#include "systems/body_models/contact_load.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/body_models/support_field.hpp"
#include "systems/frames.hpp"
#include "systems/patch_grid.hpp"

namespace torsion {
namespace {

/// One region's cells.
struct LoadedCells {
  const RegionFrame& frame;
  std::uint32_t side;
  double area;  // m^2, of a cell
  std::span<const CellTraction> tractions;
};

LoadedCells cells_of(const World& world, std::uint32_t region) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  return {frame, side, cell_area(frame, side),
          world.cells.rows<CellTraction>(world.regions.at<RegionIdentity>(region).cells)};
}

/// Calls each(x and y of the cell's centre, traction) for the cells with pressure.
template <class Each>
void for_loaded(const LoadedCells& cells, const Each& each) {
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < cells.side; ++j) {
    for (std::uint32_t i = 0; i < cells.side; ++i, ++cell) {
      if (cells.tractions[cell].pressure > 0.0) {
        each(cell_center(cells.frame, cells.side, i, j), cells.tractions[cell]);
      }
    }
  }
}

/// A disc at the region's place.
ContactEllipse disc_of(const World& world, std::uint32_t region) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
  const double least = 1e-3 * std::max(frame.half_size.x, frame.half_size.y);
  ContactEllipse disc;
  disc.center = geometry.rest_point;
  disc.normal = frame.normal;
  disc.radius = std::max(geometry.radius, least);
  disc.axis_1 = frame.tangent_x * disc.radius;
  disc.axis_2 = frame.tangent_y * disc.radius;
  return disc;
}

ContactEllipse ellipse_of(const World& world, std::uint32_t region) {
  const LoadedCells cells = cells_of(world, region);
  double count = 0.0;
  glm::dvec2 sum(0.0);
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for_loaded(cells, [&](const glm::dvec2& at, const CellTraction&) {
    count += 1.0;
    sum += at;
    xx += at.x * at.x;
    xy += at.x * at.y;
    yy += at.y * at.y;
  });
  if (count == 0.0) {
    return disc_of(world, region);
  }
  const glm::dvec2 middle = sum / count;
  // A cell's own second moment is a twelfth of its side's square.
  const glm::dvec2 side = 2.0 * cells.frame.half_size / static_cast<double>(cells.side);
  xx = xx / count - middle.x * middle.x + side.x * side.x / 12.0;
  yy = yy / count - middle.y * middle.y + side.y * side.y / 12.0;
  xy = xy / count - middle.x * middle.y;
  // An ellipse has a quarter of its half axes' squares: axes are twice a root of the moments, here
  // Cholesky's; any root makes the same ellipse of the unit disc.
  const double first = std::sqrt(xx);
  const double across = xy / first;
  const double second = std::sqrt(std::max(yy - across * across, 1e-6 * yy));
  ContactEllipse ellipse;
  ellipse.normal = cells.frame.normal;
  ellipse.center = grid_to_body(cells.frame, glm::dvec3(middle, 0.0));
  ellipse.axis_1 = tangent_to_body(cells.frame, 2.0 * glm::dvec2(first, across));
  ellipse.axis_2 = tangent_to_body(cells.frame, 2.0 * glm::dvec2(0.0, second));
  ellipse.radius = std::sqrt(count * cells.area / std::numbers::pi);
  return ellipse;
}

void add_wrench(ContactLoad& load, const glm::dvec3& arm, const glm::dvec3& force) {
  const glm::dvec3 couple = glm::cross(arm, force);
  load.wrench += (Vector6() << force.x, force.y, force.z, couple.x, couple.y, couple.z).finished();
}

ContactLoad load_of_cells(const World& world, std::uint32_t region, const Footing& footing) {
  const LoadedCells cells = cells_of(world, region);
  const RegionFrame& frame = cells.frame;
  ContactLoad load;
  for_loaded(cells, [&](const glm::dvec2& at, const CellTraction& traction) {
    const glm::dvec3 force = -cells.area * (frame.normal * traction.pressure +
                                            tangent_to_body(frame, traction.traction));
    const glm::dvec3 point = frame.origin + tangent_to_body(frame, at);
    const auto terms = support_terms(coordinates_in(footing, point));
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      load.moments[k] += terms[k] * force;
    }
    add_wrench(load, point - footing.center, force);
  });
  return load;
}

/// Force and couple spread over the region's disc.
ContactLoad load_of_disc(const World& world, std::uint32_t region, const Footing& footing) {
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const RegionFriction& friction = world.regions.at<RegionFriction>(region);
  const ContactEllipse disc = disc_of(world, region);
  const glm::dvec3 force = -frame.normal * world.regions.at<RegionNormal>(region).force -
                           tangent_to_body(frame, friction.force);
  ContactLoad load;
  double polar = 0.0;
  for (const DiscPoint& point : disc_points()) {
    polar += point.ball_share * glm::dot(point.place, point.place);
  }
  const double turning = -friction.couple / (polar * disc.radius * disc.radius);
  for (const DiscPoint& point : disc_points()) {
    const glm::dvec3 arm = disc.axis_1 * point.place.x + disc.axis_2 * point.place.y;
    const glm::dvec3 here = point.ball_share * (force + turning * glm::cross(frame.normal, arm));
    const auto terms = support_terms(coordinates_in(footing, disc.center + arm));
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      load.moments[k] += terms[k] * here;
    }
    add_wrench(load, disc.center + arm - footing.center, here);
  }
  return load;
}

}  // namespace

PortCompliance ports_of(const World& world, std::uint32_t body) {
  const OwnedRows& owned = world.bodies.at<OwnedRows>(body);
  return {world.ports.rows<CompliancePort>(owned.ports),
          world.compliance.rows<ComplianceValue>(owned.compliance)};
}

ContactEllipse contact_ellipse(const World& world, std::uint32_t region) {
  return has_patch(world, world.regions.at<RegionIdentity>(region)) ? ellipse_of(world, region)
                                                                    : disc_of(world, region);
}

ContactLoad contact_load(const World& world, std::uint32_t region, const Footing& footing) {
  return has_patch(world, world.regions.at<RegionIdentity>(region))
             ? load_of_cells(world, region, footing)
             : load_of_disc(world, region, footing);
}

}  // namespace torsion
