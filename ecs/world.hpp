#pragma once

#include <cstdint>
#include <tuple>

#include "ecs/components.hpp"
#include "ecs/table.hpp"

namespace torsion {

/// How large the tables of a world are. Set at load; a full table sets a fault that names the limit
/// to raise.
struct Capacities {
  std::uint32_t bodies = 0;
  std::uint32_t tools = 0;
  std::uint32_t parts = 0;
  std::uint32_t fields = 0;
  std::uint32_t field_nodes = 0;
  std::uint32_t field_bricks = 0;
  std::uint32_t fixed_volumes = 0;
  std::uint32_t samples = 0;
  std::uint32_t balls = 0;
  std::uint32_t anchors = 0;
  std::uint32_t regions = 0;
  std::uint32_t mdr_bodies = 0;         // with contact model mdr
  std::uint32_t patch_bodies = 0;       // with contact model patch
  std::uint32_t ports = 0;              // 0 when no body has body model compliance
  std::uint32_t compliance_values = 0;  // likewise
  std::uint32_t influences = 0;         // of contact models patch, and layers' kernels
  std::uint32_t layer_influences = 0;   // of one region; 0: no body is a layer or bent
};

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

/// One row: the clock and the state of the run. Written by: the step itself.
struct Clock {
  double time = 0.0;  // s: the last step took the poses of this time; step k takes those of k dt
  double dt = 1e-3;   // s
  std::uint64_t step = 0;  // of the next step
  std::uint64_t regions_formed = 0;
  std::uint32_t faults = 0;       // Fault bits of the last step
  std::uint32_t faults_ever = 0;  // Fault bits of all steps
};

/// Most cells along one side of a region's grid: one row of them fits the bits of a machine word.
inline constexpr std::uint32_t kMaxGridSide = 64;

inline constexpr std::uint32_t kMostSweeps = 100;

/// One row: what the user may set. Written by: load.
struct Settings {
  std::uint32_t grid_side = 16;  // cells along one side of a region's grid, 1 to kMaxGridSide; 16
                                 // gives about 200 in a round contact
  std::uint32_t sweeps = 2;      // over the cells of a region with contact model patch in one step,
                                 // 1 to kMostSweeps
};

// Parallel columns of each table. What a column means is said at its struct in ecs/components.hpp.
using BodyTable =
    Table<Pose, Elasticity, Friction, FixedRegion, BodyModels, OwnedRows, Bounds, StoredEnergy>;
using ToolTable = Table<ToolPose, ToolMotion, MassProperties, ToolWrench, OwnedRows, Bounds>;
using RegionTable =
    Table<RegionIdentity, RegionFrame, RegionCarrier, RegionSupport, RegionReaction, SupportField,
          TractionFrame, RegionGeometry, RegionMotion, RegionNormal, RegionFriction, PatchState,
          PatchEnergy, LayerGrid, SmoothContact, MdrState, RegionWrench>;
using CellTable = Table<CellGeometry, CellTraction>;
using PatchCellTable = Table<PatchMovedX, PatchMovedY, PatchDepression, PatchHeldX, PatchHeldY,
                             PatchKnown, PatchChangeX, PatchChangeY, PatchChangePressure,
                             PatchChangeMovedX, PatchChangeMovedY, PatchChangeDepression>;
using MdrLayerTable = Table<MdrLayer>;

/// The physics world: everything that one step knows. A step is a pure function of it and of the
/// input poses.
struct World {
  // constant after load
  Table<Settings> settings;
  Table<ShapePart> parts;
  Table<DistanceField> fields;
  Table<DistanceNode> field_nodes;
  Table<DistanceBrick> field_bricks;
  Table<FixedVolume> fixed_volumes;
  Table<SurfaceSample> samples;
  Table<SurfaceBall> balls;
  Table<Influence> influences;
  Table<CompliancePort> ports;
  Table<ComplianceValue> compliance;
  Table<BeamSection> sections;  // kBeamStations rows an anchor, in the order of `anchors`
  // written by the step
  Table<Clock> clock;
  BodyTable bodies;
  ToolTable tools;
  RegionTable regions;
  CellTable cells;  // blocks of grid_side^2 rows, one for each row that `regions` can hold
  PatchCellTable patch_cells;  // the same rows as `cells`; none without contact model patch
  MdrLayerTable mdr_layers;    // kMdrLayers rows a block of cells; none without contact model mdr
  Table<Influence> layer_influences;  // tables of one grid a block of cells, or none
  Table<Footing, FootingResponse>
      footings;  // one a block of cells; none without body model compliance
  Table<RegionCoupling>
      couplings;  // likewise, one for each two blocks: i, j < i at i (i - 1)/2 + j
  Table<AnchorRest> anchors;

  /// Takes all memory, empties all tables, and appends the one row of `settings` and `clock`.
  void reserve(const Capacities& capacities, const Settings& chosen);

  /// The part of reserve() that depends on the models: takes the memory of the settings and of the
  /// tables of regions, cells and contact models anew, and empties them. What is in the others
  /// stays, so that models can be chosen by what the shapes say.
  void reserve_models(const Capacities& capacities, const Settings& chosen);

  [[nodiscard]] auto tables() {
    return std::tie(settings, parts, fields, field_nodes, field_bricks, fixed_volumes, samples,
                    balls, influences, ports, compliance, sections, clock, bodies, tools, regions,
                    cells, patch_cells, mdr_layers, layer_influences, footings, couplings, anchors);
  }
  [[nodiscard]] auto tables() const {
    return std::tie(settings, parts, fields, field_nodes, field_bricks, fixed_volumes, samples,
                    balls, influences, ports, compliance, sections, clock, bodies, tools, regions,
                    cells, patch_cells, mdr_layers, layer_influences, footings, couplings, anchors);
  }
};

}  // namespace torsion
