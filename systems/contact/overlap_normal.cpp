#include "systems/contact/overlap_normal.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "systems/contact/law.hpp"

namespace torsion::engine {
namespace {

/// The grid's axis that is gone along.
struct Axis {
  std::size_t stride;                // between cells along it
  std::size_t across;                // between lines
  double length;                     // m, of a cell along it
  std::span<const double> gradient;  // along it, of the body's distance
  double face_slope;                 // of FacePlane, along it
  std::size_t spare;                 // cells at the beginning that take no part
};

/// What of a line of cells is inside the tool.
struct LineFall {
  double fall = 0.0;  // m: by how much the body's faces are lower at its end than at its beginning
  double length = 0.0;  // m
};

/// Along one line of cells.
class CellLine {
 public:
  CellLine(const Grid& grid, const Axis& axis, std::size_t first)
      : columns_(grid.scratch.cell_columns),
        axis_(axis),
        first_(first + axis.spare * axis.stride),
        last_(first + (grid.side - 1) * axis.stride),
        body_ends_(grid.scratch.body_edges.ends) {
    before_first_ = ends_beyond(first_, -axis_.gradient[first_]);
    beyond_last_ = ends_beyond(last_, axis_.gradient[last_]);
    level_ = law_of(grid.model, grid.identity.body).by_cells ? level() : 0.0;
  }

  [[nodiscard]] LineFall fall() const {
    LineFall sum;
    sum.fall = past_end(last_, beyond_last_) - past_end(first_, before_first_);
    for (std::size_t cell = first_;; cell += axis_.stride) {
      sum.length += share(cell) * axis_.length;
      if (cell == last_) {
        return sum;
      }
      sum.fall += between(cell, cell + axis_.stride);
    }
  }

 private:
  /// How much the body ends just beyond a cell at the grid's edge, 0 to 1.
  /// @param outward  cosine between the body's normal there and the way out
  [[nodiscard]] double ends_beyond(std::size_t cell, double outward) const {
    constexpr double kSureDistance = 1.0;  // cells
    constexpr double kTooFar = 1.5;
    if (!body_ends_) {
      return 0.0;
    }
    const double away = -columns_.points.value[cell] / axis_.length;
    return (1.0 - facing_share(columns_.points.gradient_z[cell])) * columns_.over_body[cell] *
           smooth_step((kTooFar - away) / (kTooFar - kSureDistance)) *
           std::clamp(outward, 0.0, 1.0);
  }

  /// A grid that holds what is loaded may end where the overlap is still deep. What is counted then
  /// is deeper than this, as deep as at the ends: over that the tool's faces fall as the body's do.
  [[nodiscard]] double level() const {
    constexpr double kMost = 0.9;  // of the deepest place
    double deepest = 0.0;
    for (std::size_t cell = first_; cell <= last_; cell += axis_.stride) {
      deepest = std::max(deepest, depth(cell));
    }
    const double ends =
        std::max((1.0 - before_first_) * depth(first_), (1.0 - beyond_last_) * depth(last_));
    return std::min(ends, kMost * deepest);
  }

  [[nodiscard]] double depth(std::size_t cell) const {
    return columns_.coverage[cell] > 0.0 ? columns_.depth[cell] : 0.0;
  }

  /// Of a cell, what is counted.
  [[nodiscard]] double share(std::size_t cell) const {
    const double covered = columns_.coverage[cell];
    if (level_ <= 0.0 || covered <= 0.0) {
      return covered;
    }
    return std::min(covered,
                    share_below(columns_.depth[cell] - level_, columns_.depth_change[cell]));
  }

  /// How much of a side beside a cell counts. (It is known better than the cell's own share, which
  /// an edge through it makes less.)
  [[nodiscard]] double side_share(std::size_t cell) const {
    return std::min(2.0 * share(cell), 1.0);
  }

  /// By how much a cell's own face falls across it, m.
  [[nodiscard]] double own_fall(std::size_t cell) const {
    const double normal_z = columns_.points.gradient_z[cell];
    const double facing = facing_share(normal_z);
    return axis_.length * (facing * axis_.gradient[cell] / std::max(normal_z, kSteepest) -
                           (1.0 - facing) * axis_.face_slope);
  }

  /// From one cell's middle to the next one's: by the heights of the faces there, so that it does
  /// not matter where between them an edge is, and where only one is in contact by its own face.
  [[nodiscard]] double between(std::size_t cell, std::size_t next) const {
    const double here = share(cell);
    const double there = share(next);
    double fall = 0.0;
    if (here > 0.0 || there > 0.0) {
      const double faces = columns_.points.z[cell] + columns_.depth[cell] -
                           columns_.points.z[next] - columns_.depth[next];
      fall = 0.5 * (here * std::lerp(own_fall(cell), faces, there) +
                    there * std::lerp(own_fall(next), faces, here));
    }
    return body_ends_ ? fall + side_between(cell, next) : fall;
  }

  /// The body's side between two cells, as far as it is inside the tool.
  [[nodiscard]] double side_between(std::size_t cell, std::size_t next) const {
    const double ends = columns_.over_body[cell] - columns_.over_body[next];
    if (ends == 0.0) {
      return 0.0;
    }
    const double facing = facing_share(columns_.points.gradient_z[ends > 0.0 ? next : cell]);
    const double deep = 0.5 * (columns_.under_face[cell] + columns_.under_face[next]) - level_;
    return (1.0 - facing) * ends * side_share(ends > 0.0 ? cell : next) * std::max(deep, 0.0);
  }

  /// From the middle of a cell at the grid's edge outwards.
  [[nodiscard]] double past_end(std::size_t cell, double ends) const {
    const double sign = cell == last_ ? 1.0 : -1.0;
    const double side =
        ends > 0.0 ? ends * side_share(cell) * std::max(columns_.under_face[cell] - level_, 0.0)
                   : 0.0;
    return side + 0.5 * sign * share(cell) * own_fall(cell);
  }

  const CellColumns& columns_;
  const Axis& axis_;
  std::size_t first_;  // cell
  std::size_t last_;
  bool body_ends_;
  double before_first_ = 0.0;  // ends_beyond
  double beyond_last_ = 0.0;
  double level_ = 0.0;  // m
};

/// How much the body's faces inside the tool fall along an axis, of their length.
double mean_fall(const Grid& grid, const Axis& axis) {
  LineFall sum;
  for (std::size_t line = 0; line < grid.side; ++line) {
    const LineFall one = CellLine(grid, axis, line * axis.across).fall();
    sum.fall += one.fall;
    sum.length += one.length;
  }
  return sum.length > 0.0 ? sum.fall / sum.length : 0.0;
}

/// The normal along which the volume of the overlap grows the most.
glm::dvec3 volume_normal(const Grid& grid) {
  const DistanceColumns& body = grid.scratch.cell_columns.points;
  const FacePlane& face = grid.scratch.body_edges.face;
  const glm::dvec2 cell = 2.0 * cell_half_size(grid);
  const std::size_t side = grid.side;
  const ContactLaw& law = law_of(grid.model, grid.identity.body);
  const std::size_t spare = law.spare_columns != nullptr ? law.spare_columns(grid.side) : 0;
  return glm::normalize(
      glm::dvec3(mean_fall(grid, {1, side, cell.x, body.gradient_x, face.slope_x, spare}),
                 mean_fall(grid, {side, 1, cell.y, body.gradient_y, face.slope_y, 0}), 1.0));
}

}  // namespace

glm::dvec3 normal_beside_edges(const Grid& grid, const glm::dvec3& mean) {
  // What the cells see depends on how the grid lies. With whole turns a contact on a corner was
  // seen to go to and fro.
  constexpr double kPart = 0.4;  // of the way, in a step
  const double askew = grid.scratch.body_edges.askew;
  const glm::dvec3 found = glm::mix(mean, volume_normal(grid), askew);
  return glm::mix(glm::normalize(found), glm::dvec3(0.0, 0.0, 1.0), (1.0 - kPart) * askew);
}

}  // namespace torsion::engine
