#include "systems/step.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "systems/body/compliance/compliance.hpp"
#include "systems/body/skeleton/skeleton.hpp"
#include "systems/check_columns.hpp"
#include "systems/contact/detect_contacts.hpp"
#include "systems/contact/group_points.hpp"
#include "systems/contact/group_regions.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/model/prepare.hpp"
#include "systems/scratch.hpp"
#include "systems/surface/take_snapshot.hpp"

namespace torsion::engine {
namespace {

bool any_compliance(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(
             context.model.bodies.column<BodyModels>(),
             [](const BodyModels& models) { return models.body == BodyModel::kCompliance; });
}

bool any_beam_taken(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(context.model.bodies.column<BodyModels>(),
                             [](const BodyModels& models) {
                               return contact_law(models.contact).takes_beams &&
                                      models.body == BodyModel::kSkeleton;
                             });
}

/// What regions keep from the last step: their rows and the rows of their blocks.
constexpr ColumnSet kOfRegions = table_columns<RegionTable>() | table_columns<CellTable>() |
                                 table_columns<PatchCellTable>() | table_columns<MdrLayerTable>() |
                                 columns<SupportFit, RegionCoupling>();

bool any_moving(const StepContext& context) {
  return any_friction(context) ||
         std::ranges::any_of(contact_laws(), [&context](const ContactLaw* law) {
           return law->needs_motion && any_contact_model(context, law->model);
         });
}

}  // namespace

std::vector<System<StepContext>> step_systems() {
  // The paper's Fig. 4, top to bottom.
  std::vector<System<StepContext>> systems{
      {"couple_tools", "takes the tools' poses and their motion", "a tool", nullptr, couple_tools,
       columns<ToolPose, ToolMotion>()},
      {"move_bodies", "moves the bodies that an animation moves", "a tool and a body",
       any_tool_and_body, move_bodies, columns<BodyPose, ToolOverBody>()},
      {"detect_contacts", "finds the tool's surface points inside a body", "a tool and a body",
       any_tool_and_body, detect_contacts},
      {"group_contact_points", "groups contact points closer than r_th", "a tool and a body",
       any_tool_and_body, group_contact_points},
      {"group_regions", "keeps the identity of contact regions", "a tool and a body",
       any_tool_and_body, group_regions, columns<RegionIdentity>(), kOfRegions},
      {"region_grids", "finds depth and area cell by cell", "a tool and a body", any_tool_and_body,
       region_grids, columns<RegionFrame, CellGeometry, Overlap, SmoothContact>(), kOfRegions},
      {"main_beams", "the beam from what is fixed to every region",
       "a body with contact model paper and body model skeleton", any_beam_taken, main_beams},
  };
  for (const ContactLaw* const law : contact_laws()) {
    systems.insert(systems.end(), law->place.begin(), law->place.end());
  }
  systems.push_back({"region_motion", "slide, spin and axis of every region",
                     "a body with friction", any_moving, region_motion, columns<RegionMotion>()});
  for (const ContactLaw* const law : contact_laws()) {
    systems.insert(systems.end(), law->solve.begin(), law->solve.end());
  }
  const System<StepContext> last[] = {
      {"region_wrenches", "force and torque of every region, equation (1)", "a tool and a body",
       any_tool_and_body, region_wrenches, columns<RegionWrench, StoredEnergy>()},
      {"compliance", "the whole body's deformation under its regions",
       "a body with body model compliance", any_compliance, compliance,
       columns<RegionSupport, RegionReaction, SupportField, SupportFit, RegionCoupling>()},
      {"sum_wrenches", "the wrench on every tool, faults, work", "a tool", nullptr, sum_wrenches,
       columns<ToolWrench>()},
  };
  systems.insert(systems.end(), std::begin(last), std::end(last));
  return systems;
}

void Scratch::reserve(const Model& model, State& state, const MdrTables* tables) {
  contact.reserve(model, state);
  paper.reserve(model);
  patch.reserve(model, state);
  compliance.reserve(state);
  if (!state.mdr_layers.empty()) {
    mdr = tables != nullptr ? *tables : make_mdr_tables();
  }
  schedule = Schedule<StepContext>(step_systems(), context(model, state, {}));
}

StepContext Scratch::context(const Model& model, State& state, std::span<const Pose> tool_poses) {
  return {model, state, tool_poses, contact, paper, mdr, patch, compliance};
}

Simulation::Simulation() : scratch(std::make_unique<Scratch>()) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> prepare(const SceneDescription& scene, const PrepareOptions& options) {
  Result<PreparedWorld> prepared = prepare_world(scene, options);
  if (!prepared) {
    return prepared.error();
  }
  Simulation simulation;
  simulation.world = std::move(prepared.value().world);
  simulation.choices = std::move(prepared.value().choices);
  simulation.united_nodes = std::move(prepared.value().united_nodes);
  World& world = simulation.world;
  simulation.scratch->reserve(world.model, world.state);
  simulation.snapshot_tables = std::make_unique<const SnapshotTables>(
      make_snapshot_tables(world.state, simulation.scratch->mdr));
  return simulation;
}

Simulation simulation_of_materials(const PreparedWorld& unit, const SceneDescription& scene,
                                   const MdrTables& tables) {
  Simulation simulation;
  simulation.world = world_of_materials(unit.world, scene);
  simulation.choices = unit.choices;
  simulation.united_nodes = unit.united_nodes;
  World& world = simulation.world;
  simulation.scratch->reserve(world.model, world.state, &tables);
  return simulation;
}

void step(const Model& model, State& state, std::span<const Pose> tool_poses, Scratch& scratch) {
  TORSION_ASSERT(tool_poses.size() == model.tools.size());
  StepContext context = scratch.context(model, state, tool_poses);
#ifdef NDEBUG
  scratch.schedule.run(context);
#else
  run_with_checks(scratch.schedule, context);
#endif
  Clock& clock = state.clock;
  clock.faults_ever |= clock.faults;
  clock.time = static_cast<double>(clock.step) * model.dt;
  clock.step += 1;
}

void step(Simulation& simulation, std::span<const Pose> tool_poses) {
  step(simulation.world.model, simulation.world.state, tool_poses, *simulation.scratch);
}

void take_snapshot(const Simulation& simulation, Snapshot& snapshot) {
  take_snapshot(simulation.world.model, simulation.world.state, *simulation.snapshot_tables,
                snapshot);
}

}  // namespace torsion::engine
