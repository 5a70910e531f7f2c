#pragma once

#include <cstdint>
#include <tuple>

#include "ecs/model.hpp"

namespace torsion::engine {

/// What can go wrong in a step. The step still ends; the tools' wrenches fade to zero while a fault
/// lasts.
enum class Fault : std::uint32_t {
  kPoseNotFinite = 1U << 0U,  // the device's pose has a NaN or infinity; the last good pose is kept
  kPoseJumped = 1U << 1U,     // the tool moved or turned further in one step than a hand can
  kTooDeep = 1U << 2U,        // half of the tool is inside the body, or it is beyond half the body
  kRegionsFull =
      1U << 3U,  // more than kMaxRegionsPerBody regions on a body, or the regions table is full
  kResultNotFinite = 1U << 4U,  // a wrench came out as NaN or infinity
  kForceTooLarge =
      1U << 5U,  // a region's force is beyond what its overlap or the tools' work allow
};

/// The clock and the state of the run. Written by: the step itself.
struct Clock {
  double time = 0.0;  // s: the last step took the poses of this time; step k takes those of k dt
  std::uint64_t step = 0;  // of the next step
  std::uint64_t regions_formed = 0;
  std::uint32_t faults = 0;       // Fault bits of the last step
  std::uint32_t faults_ever = 0;  // Fault bits of all steps
};

// Parallel columns of each table. What a column means is said at its struct in ecs/components.hpp.
using RegionTable =
    Table<RegionIdentity, RegionFrame, RegionCarrier, RegionSupport, RegionReaction, SupportField,
          TractionFrame, Overlap, Contact, RegionMotion, RegionNormal, RegionFriction, PatchState,
          PatchEnergy, LayerGrid, SmoothContact, MdrState, RegionWrench>;
using CellTable = Table<CellGeometry, CellTraction>;
using PatchCellTable = Table<PatchMovedX, PatchMovedY, PatchDepression, PatchHeldX, PatchHeldY,
                             PatchKnown, PatchChangeX, PatchChangeY, PatchChangePressure,
                             PatchChangeMovedX, PatchChangeMovedY, PatchChangeDepression>;
using MdrLayerTable = Table<MdrLayer>;

/// What a step changes. A step is a pure function of it, of a Model and of the input poses. It may
/// be copied: both go on alike, and neither disturbs the other.
struct State {
  Clock clock;
  Table<StoredEnergy, BodyPose> bodies;           // the same rows as Model::bodies
  Table<ToolPose, ToolMotion, ToolWrench> tools;  // likewise
  Table<ToolOverBody> tools_over_bodies;          // one for each pair: row tool x bodies + body
  RegionTable regions;
  CellTable cells;  // blocks of grid_side^2 rows, one for each row that `regions` can hold
  PatchCellTable patch_cells;  // the same rows as `cells`; none without contact model patch
  MdrLayerTable mdr_layers;    // kMdrLayers rows a block of cells; none without contact model mdr
  Table<Influence> layer_influences;  // tables of one grid a block of cells, or none
  Table<SupportFit, SupportResponse>
      support_fits;  // one a block of cells; none without body model compliance
  Table<RegionCoupling>
      couplings;  // likewise, one for each two blocks: i, j < i at i (i - 1)/2 + j

  [[nodiscard]] ToolOverBody& over(std::uint32_t tool, std::uint32_t body) {
    return tools_over_bodies.at<ToolOverBody>(tool * bodies.size() + body);
  }
  [[nodiscard]] const ToolOverBody& over(std::uint32_t tool, std::uint32_t body) const {
    return tools_over_bodies.at<ToolOverBody>(tool * bodies.size() + body);
  }

  /// Takes all memory, and fills all tables but that of the regions with rows of zero.
  void reserve(const Capacities& capacities, const Settings& settings);

  [[nodiscard]] auto tables() {
    return std::tie(bodies, tools, tools_over_bodies, regions, cells, patch_cells, mdr_layers,
                    layer_influences, support_fits, couplings);
  }
  [[nodiscard]] auto tables() const {
    return std::tie(bodies, tools, tools_over_bodies, regions, cells, patch_cells, mdr_layers,
                    layer_influences, support_fits, couplings);
  }
};

}  // namespace torsion::engine
