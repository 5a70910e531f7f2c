#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "ecs/components.hpp"
#include "ecs/motion_script.hpp"
#include "ecs/table.hpp"

namespace torsion::engine {

/// How large the tables of a model and its state are. Set at load; a full table sets a fault that
/// names the limit to raise.
struct Capacities {
  std::uint32_t bodies = 0;
  std::uint32_t tools = 0;
  std::uint32_t parts = 0;
  std::uint32_t fields = 0;
  std::uint32_t field_nodes = 0;
  std::uint32_t field_bricks = 0;
  std::uint32_t field_creases = 0;
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

/// Most cells along one side of a region's grid: one row of them fits the bits of a machine word.
inline constexpr std::uint32_t kMaxGridSide = 64;

inline constexpr std::uint32_t kMostIterations = 100;

/// One row: what the user may set. Written by: load.
struct Settings {
  std::uint32_t grid_side = 16;  // cells along one side of a region's grid, 1 to kMaxGridSide; 16
                                 // gives about 200 in a round contact
  std::uint32_t iterations = 2;  // over the cells of a region with contact model patch in one step,
                                 // at most; those of friction 8 where that is more;
                                 // 1 to kMostIterations
};

/// What a step knows that is constant once a scene has been prepared. What a column means is said
/// at its struct in ecs/components.hpp.
struct Model {
  Settings settings;
  double dt = 1e-3;  // s, of a step
  Table<Pose, Elasticity, Friction, FixedRegion, BodyModels, OwnedRows, Bounds> bodies;
  std::vector<MotionScript> body_scripts;  // (bodies) what moves them; without links: they rest
  Table<MassProperties, OwnedRows, Bounds> tools;
  Table<ShapePart> parts;
  Table<DistanceField> fields;
  Table<DistanceNode> field_nodes;
  Table<DistanceBrick> field_bricks;
  Table<DistanceCrease> field_creases;
  Table<FixedVolume> fixed_volumes;
  Table<SurfaceSample> samples;
  Table<SurfaceBall> balls;
  Table<AnchorRest> anchors;
  Table<BeamSection> sections;  // kBeamStations rows an anchor, in the order of `anchors`
  Table<Influence> influences;
  Table<CompliancePort> ports;
  Table<ComplianceValue> compliance;

  /// Whether an animation moves the body.
  [[nodiscard]] bool moves(std::uint32_t body) const {
    return body < body_scripts.size() && !body_scripts[body].links.empty();
  }

  /// Takes all memory, and empties all tables.
  void reserve(const Capacities& capacities, const Settings& chosen);

  /// The part of reserve() that depends on the models: takes the memory of their tables anew, and
  /// empties them. What is in the others stays, so that models can be chosen by what the shapes
  /// say.
  void reserve_models(const Capacities& capacities, const Settings& chosen);

  [[nodiscard]] auto tables() {
    return std::tie(bodies, tools, parts, fields, field_nodes, field_bricks, field_creases,
                    fixed_volumes, samples, balls, anchors, sections, influences, ports,
                    compliance);
  }
  [[nodiscard]] auto tables() const {
    return std::tie(bodies, tools, parts, fields, field_nodes, field_bricks, field_creases,
                    fixed_volumes, samples, balls, anchors, sections, influences, ports,
                    compliance);
  }
};

}  // namespace torsion::engine
