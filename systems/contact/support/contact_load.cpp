#include "systems/contact/support/contact_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/support/body_law.hpp"
#include "systems/contact/support/support_fit.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/lanes.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

/// One region's cells.
struct LoadedCells {
  const RegionFrame& frame;
  std::uint32_t side;
  double area;  // m^2, of a cell
  std::span<const CellTraction> tractions;
};

LoadedCells cells_of(const Model& model, const State& state, std::uint32_t region) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const std::uint32_t side = model.settings.grid_side;
  return {frame, side, cell_area(frame, side),
          state.cells.rows<CellTraction>(state.regions.at<RegionIdentity>(region).cells)};
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

bool by_cells(const Model& model, const State& state, std::uint32_t region) {
  return law_of(model, state.regions.at<RegionIdentity>(region).body).by_cells;
}

/// A disc at the region's origin.
ContactEllipse disc_of(const State& state, std::uint32_t region) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const Contact& contact = state.regions.at<Contact>(region);
  const glm::dvec2 extent = overlap_extent(state, region);
  const double least = 1e-3 * std::max(extent.x, extent.y);
  ContactEllipse disc;
  disc.center = contact.rest_point;
  disc.normal = frame.normal;
  disc.radius = std::max(contact.radius, least);
  disc.axis_1 = frame.tangent_x * disc.radius;
  disc.axis_2 = frame.tangent_y * disc.radius;
  return disc;
}

ContactEllipse ellipse_of(const Model& model, const State& state, std::uint32_t region) {
  const LoadedCells cells = cells_of(model, state, region);
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
    return disc_of(state, region);
  }
  const glm::dvec2 middle = sum / count;
  // A cell's own second moment is a twelfth of its side's square.
  const glm::dvec2 side = 2.0 * cells.frame.half_size / static_cast<double>(cells.side);
  xx = xx / count - middle.x * middle.x + side.x * side.x / 12.0;
  yy = yy / count - middle.y * middle.y + side.y * side.y / 12.0;
  xy = xy / count - middle.x * middle.y;
  // The second moments of an ellipse's area are a quarter of its half axes' squares. So its axes
  // are twice a square root of the moments' matrix; Cholesky's root will do, because any root maps
  // the unit disc to the same ellipse.
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

/// One row of loaded cells.
struct LoadedRow {
  std::size_t count = 0;
  // A cell's place in the support fit's coordinates, and the traction on the tool, Pa, grid axes.
  std::array<double, kMaxGridSide> x, y, along_x, along_y, pressure;
};

/// The terms of a SupportField and a zero, which fills the vectors.
constexpr std::size_t kPaddedTerms = kSupportTerms + 1;

/// Sums of term times traction, Pa, grid.
struct TermSums {
  std::array<double, kPaddedTerms> along_x{}, along_y{}, pressure{};
};

/// Adds a row. Terms lie side by side in vectors: no sum is split over lanes.
TORSION_WIDEST
void add_terms(const LoadedRow& __restrict row, TermSums& __restrict sums) {
  for (std::size_t cell = 0; cell < row.count; ++cell) {
    const auto terms = support_terms({row.x[cell], row.y[cell]});
    std::array<double, kPaddedTerms> padded{};
    std::copy(terms.begin(), terms.end(), padded.begin());
    for (std::size_t k = 0; k < kPaddedTerms; ++k) {
      sums.along_x[k] += padded[k] * row.along_x[cell];
      sums.along_y[k] += padded[k] * row.along_y[cell];
      sums.pressure[k] += padded[k] * row.pressure[cell];
    }
  }
}

/// Tractions and their first moments about the grid's origin, grid axes.
struct PlainSums {
  glm::dvec2 along{0.0};                 // Pa
  double pressure = 0.0;                 // Pa
  glm::dvec2 pressure_times_place{0.0};  // Pa m
  double turning = 0.0;                  // Pa m: place x traction
};

ContactLoad load_of_cells(const Model& model, const State& state, std::uint32_t region,
                          const SupportFit& support_fit) {
  const LoadedCells cells = cells_of(model, state, region);
  const RegionFrame& frame = cells.frame;
  const glm::dvec2 origin = plain_coordinates_in(support_fit, frame.origin);
  const glm::dvec2 by_x(glm::dot(support_fit.tangent_x, frame.tangent_x) / support_fit.reach,
                        glm::dot(support_fit.tangent_y, frame.tangent_x) / support_fit.reach);
  const glm::dvec2 by_y(glm::dot(support_fit.tangent_x, frame.tangent_y) / support_fit.reach,
                        glm::dot(support_fit.tangent_y, frame.tangent_y) / support_fit.reach);
  PlainSums plain;
  TermSums sums;
  LoadedRow row;
  std::size_t cell = 0;
  for (std::uint32_t j = 0; j < cells.side; ++j) {
    row.count = 0;
    for (std::uint32_t i = 0; i < cells.side; ++i, ++cell) {
      const CellTraction& at = cells.tractions[cell];
      if (at.pressure <= 0.0) {
        continue;
      }
      const glm::dvec2 place = cell_center(frame, cells.side, i, j);
      const glm::dvec2 coordinates = support_coordinates(origin + by_x * place.x + by_y * place.y);
      row.x[row.count] = coordinates.x;
      row.y[row.count] = coordinates.y;
      row.along_x[row.count] = at.traction.x;
      row.along_y[row.count] = at.traction.y;
      row.pressure[row.count++] = at.pressure;
      plain.along += at.traction;
      plain.pressure += at.pressure;
      plain.pressure_times_place += at.pressure * place;
      plain.turning += place.x * at.traction.y - place.y * at.traction.x;
    }
    add_terms(row, sums);
  }
  const auto on_material = [&](double along_x, double along_y, double pressure) {
    return -cells.area *
           (frame.normal * pressure + tangent_to_body(frame, glm::dvec2(along_x, along_y)));
  };
  ContactLoad load;
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    load.moments[k] = on_material(sums.along_x[k], sums.along_y[k], sums.pressure[k]);
  }
  add_wrench(load, frame.origin - support_fit.center,
             on_material(plain.along.x, plain.along.y, plain.pressure));
  const glm::dvec3 couple =
      on_material(plain.pressure_times_place.y, -plain.pressure_times_place.x, plain.turning);
  load.wrench.tail<3>() += Eigen::Vector3d(couple.x, couple.y, couple.z);
  return load;
}

/// Force and couple spread over the region's disc.
ContactLoad load_of_disc(const State& state, std::uint32_t region, const SupportFit& support_fit) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const RegionFriction& friction = state.regions.at<RegionFriction>(region);
  const ContactEllipse disc = disc_of(state, region);
  const glm::dvec3 force = -frame.normal * state.regions.at<RegionNormal>(region).force -
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
    const auto terms = support_terms(coordinates_in(support_fit, disc.center + arm));
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      load.moments[k] += terms[k] * here;
    }
    add_wrench(load, disc.center + arm - support_fit.center, here);
  }
  return load;
}

}  // namespace

PortCompliance ports_of(const Model& model, std::uint32_t body) {
  const OwnedRows& owned = model.bodies.at<OwnedRows>(body);
  return {model.ports.rows<CompliancePort>(owned.ports),
          model.compliance.rows<ComplianceValue>(owned.compliance)};
}

ContactEllipse contact_ellipse(const Model& model, const State& state, std::uint32_t region) {
  return by_cells(model, state, region) ? ellipse_of(model, state, region) : disc_of(state, region);
}

ContactLoad contact_load(const Model& model, const State& state, std::uint32_t region,
                         const SupportFit& support_fit) {
  return by_cells(model, state, region) ? load_of_cells(model, state, region, support_fit)
                                        : load_of_disc(state, region, support_fit);
}

namespace {

// Share of the displacement by the loads that is taken over in the step in which they are found.
// Compliance adds the rest one step later, which dissipates energy. The answer of a support fit
// that no longer quite fits may be too large and would have to be taken back, which would feed
// energy in.
constexpr double kFirst = 0.9;

using LoadColumns = Eigen::Matrix<double, 6, 4>;  // wrenches by loads

/// The support fit whose compliance the region's support comes from, or null.
const SupportFit* support_fit_under(const Model& model, const State& state, std::uint32_t region) {
  const RegionIdentity& identity = state.regions.at<RegionIdentity>(region);
  if (!body_law_of(model, identity.body).moves_as_a_whole) {
    return nullptr;
  }
  const SupportFit& support_fit = state.support_fits.at<SupportFit>(block_of(identity));
  return support_fit.reach > 0.0 && support_fit.on_layer == 0 ? &support_fit : nullptr;
}

/// Each load of 1 as a wrench about the support fit's centre.
LoadColumns unit_loads(const RegionFrame& frame, const SupportFit& support_fit,
                       const glm::dvec3& point) {
  const glm::dvec3 arm = point - support_fit.center;
  LoadColumns columns = LoadColumns::Zero();
  const auto set_force = [&](Eigen::Index column, const glm::dvec3& force) {
    const glm::dvec3 couple = glm::cross(arm, force);
    columns.col(column) << force.x, force.y, force.z, couple.x, couple.y, couple.z;
  };
  set_force(0, frame.tangent_x);
  set_force(1, frame.tangent_y);
  columns.col(2) << 0.0, 0.0, 0.0, frame.normal.x, frame.normal.y, frame.normal.z;
  set_force(3, -frame.normal);
  return columns;
}

/// What the region's own loads displace it by, less what the reactions of other regions take back.
Matrix6 yielding(const State& state, std::uint32_t region, const SupportFit& support_fit) {
  const RegionReaction& reaction = state.regions.at<RegionReaction>(region);
  Matrix6 motion = Eigen::Map<const Matrix6>(support_fit.own.data());
  if (reaction.active != 0) {
    motion -= Eigen::Map<const Matrix6>(reaction.motion.data());
  }
  return kFirst * motion;
}

}  // namespace

OwnAnswer own_answer(const Model& model, const State& state, std::uint32_t region,
                     const glm::dvec3& point) {
  OwnAnswer answer;
  const SupportFit* const support_fit = support_fit_under(model, state, region);
  if (support_fit == nullptr) {
    return answer;
  }
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  answer.wrenches = unit_loads(frame, *support_fit, point);
  answer.motions.noalias() = yielding(state, region, *support_fit) * answer.wrenches;
  const Eigen::Matrix4d compliance = answer.wrenches.transpose() * answer.motions;
  const auto& wrench = state.regions.at<RegionReaction>(region).wrench;
  const glm::dvec3 force(wrench[0], wrench[1], wrench[2]);
  const glm::dvec3 couple(wrench[3], wrench[4], wrench[5]);
  answer.any = true;
  answer.point = point;
  answer.known = {glm::dot(force, frame.tangent_x), glm::dot(force, frame.tangent_y),
                  glm::dot(couple - glm::cross(point - support_fit->center, force), frame.normal),
                  -glm::dot(force, frame.normal)};
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      answer.compliance[column][row] = compliance(row, column);
    }
  }
  return answer;
}

SupportAnswer support_answer(const Model& model, const State& state, std::uint32_t region,
                             const OwnAnswer& answer, const ContactLoads& more,
                             const ContactLoads& accounted) {
  const RegionFrame& frame = state.regions.at<RegionFrame>(region);
  const SupportFit& support_fit = *support_fit_under(model, state, region);
  const glm::dvec3& about = state.regions.at<RegionSupport>(region).about;
  const Eigen::Vector4d loads(more.x, more.y, more.z, more.w);
  const Vector6 motion = answer.motions * loads;
  SupportAnswer found;
  found.rotation = {motion[3], motion[4], motion[5]};
  found.translation = glm::dvec3(motion[0], motion[1], motion[2]) +
                      glm::cross(found.rotation, about - support_fit.center);
  const ContactLoads left = answer.compliance * more - accounted;
  found.rotation_left = left.z * frame.normal;
  found.translation_left = left.x * frame.tangent_x + left.y * frame.tangent_y +
                           glm::cross(found.rotation_left, about - answer.point);
  Eigen::Map<Vector6>(found.wrench.data()) = answer.wrenches * loads;
  return found;
}

}  // namespace torsion::engine
