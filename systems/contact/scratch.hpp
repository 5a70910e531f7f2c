#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "ecs/column.hpp"
#include "ecs/components.hpp"
#include "ecs/state.hpp"
#include "systems/geometry/distance.hpp"

namespace torsion::engine {

/// A point of a tool's surface inside a body.
struct ContactPoint {
  glm::dvec3 position{0.0};   // m, body
  double depth = 0.0;         // m, > 0
  std::uint32_t cluster = 0;  // which group of points of its pair it belongs to: 0, 1, ...
};

/// The contact points of one tool on one body.
struct ContactPair {
  std::uint32_t tool = 0;
  std::uint32_t body = 0;
  Range points;  // in Scratch::points
  // Of points: as the links of neighbouring samples leave them, until all near ones are grouped.
  std::uint32_t clusters = 0;
  Pose tool_in_body;           // for which the points were found
  bool touches_moved = false;  // no points, but it would touch the material as others have it
};

/// A candidate sample while one pair is searched.
struct Candidate {
  std::uint32_t sample = 0;  // row in Model::samples
  double distance = 0.0;     // m, to the body; negative inside
};

/// A sample of a tool's surface while one pair is searched; what it says counts where it is
/// stamped.
struct SampleState {
  double distance = 0.0;    // m, to the body
  std::uint32_t stamp = 0;  // Scratch::stamp of the search that has found it
  std::uint32_t point = 0;  // its row in Scratch::points, or kNoRow
};

/// A region that continues, begins or ends in this step, for group_regions.
struct ClusterOwner {
  std::uint32_t region =
      kNoRow;  // row in `regions`; kNoRow: nobody continues it, a new region forms
  std::uint32_t split_from = kNoRow;  // nobody continues it, but it lies over this region
};

/// Which of a pair's clusters a region continues in this step.
struct RegionPoints {
  Range points;                    // in Scratch::points: all of the pair
  std::uint32_t cluster = kNoRow;  // which of them; kNoRow: none, it lives by its cells alone
};

/// The cells of one region as columns, in the grid's frame.
struct CellColumns {
  DistanceColumns points;             // cells' centres on the tool's underside
  std::span<double> tool_x, tool_y;   // how much higher the tool is farther along x, y
  std::span<double> gradient_square;  // of its distance, of the length: 1 but at a mesh's edges
  std::span<double> depth;            // m, as in CellGeometry
  std::span<double> depth_change;     // m, across the cell
  std::span<double> coverage;         // as in CellGeometry
  std::span<double> bearing;          // likewise
  // Of a cell what lies under the tool, and how stiff it is for that, where the tool has rims.
  std::span<double> rim_share, rim_bearing;
  std::span<double> open;  // 0 to 1: how far a cell has no underside of its own (rims.cpp)
  // Where the body has edges: the share of a cell that is over it, and how far the tool is under
  // the face that it presses on, or under that face's plane, m.
  std::span<double> over_body, under_face;
};

/// A face of a body as a plane over a grid: height = at_origin + slope_x x + slope_y y, m.
struct FacePlane {
  double at_origin = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;

  [[nodiscard]] double height(double x, double y) const {
    return at_origin + slope_x * x + slope_y * y;
  }
};

/// What the edges of the body do within one region's grid.
struct BodyEdges {
  double askew = 0.0;  // 0 to 1: how much a face there lies askew of the grid
  bool ends = false;   // whether the body has a side there: the columns of CellColumns are found
  FacePlane face;      // that the tool presses on, then
};

/// Those of a region's cells that are not yet on the tool's surface.
struct LeftCells {
  std::span<std::uint32_t> cells;
  DistanceColumns points;
  std::span<double> tool_x, tool_y, gradient_square;  // as in CellColumns
};

/// The first of the cells that are left.
LeftCells first_of(const LeftCells& left, std::size_t count);

/// The beam from what is fixed to a region, as a spring in series with its contact.
struct BeamSpring {
  double length = 0.0;     // m: at least a thousandth of the body's size; 0: there is none
  double stiffness = 0.0;  // N/m, along the beam; 0: there is none
};

/// How the body as a whole has deflected within the step to what a contact model has found in it:
/// of those that account for it (ContactLaw::moves_own_support). The body model takes it over into
/// RegionSupport and RegionReaction.
struct SupportAnswer {
  glm::dvec3 translation{0.0};  // m, body, of RegionSupport::about
  glm::dvec3 rotation{0.0};     // rad, body
  // Of it, what the contact has not accounted for and feels in the next step:
  glm::dvec3 translation_left{0.0};  // m, body
  glm::dvec3 rotation_left{0.0};     // rad, body
  std::array<double, 6>
      wrench{};  // on the material, about the support fit's centre, for which it is
};

/// Lays columns of one region's cells in one piece of memory, each followed by zeros up to whole
/// lanes (math/wide_lanes.hpp). Load time only.
/// @param cells  of one column
void lay_columns(std::size_t cells, std::span<std::span<double>* const> columns,
                 Column<double>& memory);

/// Memory that the systems of one step share about contacts. Reserved at load; nothing in it
/// outlives a step, so that a saved state replays without it.
struct ContactScratch {
  // detect_contacts
  std::vector<SampleState> sample_states;    // (samples)
  std::vector<std::uint64_t> found_samples;  // (samples of a tool) a bit each
  std::vector<std::uint32_t> walk;           // (balls of a tool) those to look at, in turn
  std::uint32_t stamp = 0;
  std::vector<Candidate> candidates;
  std::vector<ContactPoint> points;
  std::vector<ContactPair> pairs;
  // group_points
  std::vector<std::uint32_t> parent;  // (points) of one in the sets of its pair's linked points
  std::vector<std::uint32_t> order;
  std::vector<glm::dvec3> cluster_points;
  // group_regions
  std::vector<ClusterOwner> owners;          // (kMaxRegionsPerBody) of one pair's clusters
  std::vector<double> overlaps;              // (regions of the pair x clusters)
  std::vector<std::uint32_t> ended_regions;  // (regions) rows, to be erased once a pair is done
  std::vector<RegionPoints>
      region_points;  // (regions) by block of cells, which does not move when rows do
  // region_grids
  CellColumns cell_columns;               // (cells of one region)
  BodyEdges body_edges;                   // likewise
  LeftCells left_cells;                   // likewise
  std::vector<std::uint32_t> near_parts;  // (parts of all bodies and tools)

  // main_beams, for paper_normal_forces
  std::vector<BeamSpring> beams;  // (regions) by block of cells

  // the contact model, for region_wrenches and compliance
  std::vector<SupportAnswer> support_answers;  // (regions) by block of cells

  Column<double> column_memory;            // what the columns above are in
  std::vector<std::uint32_t> cell_memory;  // what the cells of left_cells are in

  /// Takes all memory that a step can need.
  void reserve(const Model& model, const State& state);
};

}  // namespace torsion::engine
