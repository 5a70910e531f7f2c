#include "systems/step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "systems/body/compliance/compliance.hpp"
#include "systems/body/skeleton/skeleton.hpp"
#include "systems/contact/couple_tools.hpp"
#include "systems/contact/detect_contacts.hpp"
#include "systems/contact/group_regions.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/contact/region_motion.hpp"
#include "systems/contact/region_wrenches.hpp"
#include "systems/mdr/mdr.hpp"
#include "systems/mdr/smooth_contact.hpp"
#include "systems/model/prepare.hpp"
#include "systems/paper/carry_tractions.hpp"
#include "systems/paper/paper.hpp"
#include "systems/patch/patch.hpp"
#include "systems/scratch.hpp"
#include "systems/surface/anchor_motions.hpp"
#include "systems/surface/region_fields.hpp"

namespace torsion {
namespace {

bool any_tool_and_body(const StepContext& context) {
  return !context.world.tools.empty() && !context.world.bodies.empty();
}

template <ContactModel Model>
bool any_contact_model(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(context.world.bodies.column<BodyModels>(),
                             [](const BodyModels& models) { return models.contact == Model; });
}

bool any_skeleton(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(
             context.world.bodies.column<BodyModels>(),
             [](const BodyModels& models) { return models.body == BodyModel::kSkeleton; });
}

bool any_compliance(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(
             context.world.bodies.column<BodyModels>(),
             [](const BodyModels& models) { return models.body == BodyModel::kCompliance; });
}

bool any_friction(const StepContext& context) {
  return any_tool_and_body(context) &&
         std::ranges::any_of(context.world.bodies.column<Friction>(), [](const Friction& friction) {
           return friction.static_friction > 0.0;
         });
}

bool any_half_space(const StepContext& context) {
  return any_contact_model<ContactModel::kPatch>(context) ||
         any_contact_model<ContactModel::kMdr>(context);
}

bool any_moving(const StepContext& context) {
  return any_friction(context) || any_half_space(context);
}

bool any_paper_friction(const StepContext& context) {
  return any_friction(context) && any_contact_model<ContactModel::kPaper>(context);
}

}  // namespace

std::vector<System<StepContext>> step_systems(double dt) {
  constexpr double kFieldInterval = 8e-3;  // s; frames are farther apart
  const auto field_period =
      static_cast<std::uint32_t>(std::clamp(std::round(kFieldInterval / dt), 1.0, 1e6));
  // The paper's Fig. 4, top to bottom.
  return {
      {"couple_tools", "takes the tools' poses and their motion", "a tool", nullptr, couple_tools},
      {"detect_contacts", "finds the tool's surface points inside a body", "a tool and a body",
       any_tool_and_body, detect_contacts},
      {"group_contact_points", "groups contact points closer than r_th", "a tool and a body",
       any_tool_and_body, group_contact_points},
      {"group_regions", "keeps the identity of contact regions", "a tool and a body",
       any_tool_and_body, group_regions},
      {"region_grids", "finds depth and area cell by cell", "a tool and a body", any_tool_and_body,
       region_grids},
      {"carry_tractions", "keeps tractions at their place on the body",
       "a body with contact model paper and friction", any_paper_friction, carry_tractions},
      {"main_beams", "the beam from what is fixed to every region",
       "a body with body model skeleton", any_skeleton, main_beams},
      {"paper_normal_forces", "normal force f = k1 x + k3 x^3", "a body with contact model paper",
       any_contact_model<ContactModel::kPaper>, paper_normal_forces},
      {"mdr_contacts", "where smooth shapes lie deepest in each other",
       "a body with contact model mdr", any_contact_model<ContactModel::kMdr>, mdr_contacts},
      {"region_motion", "slide, spin and axis of every region", "a body with friction", any_moving,
       region_motion},
      {"mdr_forces", "round contacts of an elastic half-space: force, friction and torque",
       "a body with contact model mdr", any_contact_model<ContactModel::kMdr>, mdr_forces},
      {"patch_forces", "elastic half-space cell by cell: pressure, friction and torque",
       "a body with contact model patch", any_contact_model<ContactModel::kPatch>, patch_forces},
      {"paper_friction_forces", "friction and contact torque, equations (2)-(9), (14)",
       "a body with contact model paper and friction", any_paper_friction, paper_friction_forces},
      {"region_fields", "what a region does to the surface around it, for those who draw it",
       "a body with contact model mdr or patch", any_half_space, region_fields, field_period},
      {"region_wrenches", "force and torque of every region, equation (1)", "a tool and a body",
       any_tool_and_body, region_wrenches},
      {"skeleton", "beam skeleton: displacement of the anchors, for those who draw it",
       "a body with body model skeleton", any_skeleton, skeleton, field_period},
      {"compliance", "the whole body's deformation under its regions",
       "a body with body model compliance", any_compliance, compliance},
      {"anchor_motions", "the whole body's deformation at its anchors, for those who draw it",
       "a body with body model compliance", any_compliance, anchor_motions, field_period},
      {"sum_wrenches", "the wrench on every tool, faults, work", "a tool", nullptr, sum_wrenches},
  };
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
  simulation.scratch->reserve(simulation.world);
  simulation.schedule = Schedule<StepContext>(step_systems(1.0 / options.rate),
                                              simulation.scratch->context(simulation.world, {}));
  return simulation;
}

void step(Simulation& simulation, std::span<const Pose> tool_poses) {
  TORSION_ASSERT(tool_poses.size() == simulation.world.tools.size());
  StepContext context = simulation.scratch->context(simulation.world, tool_poses);
  simulation.schedule.run(context, simulation.world.clock.at<Clock>(0).step);
  Clock& clock = simulation.world.clock.at<Clock>(0);
  clock.faults_ever |= clock.faults;
  clock.time = static_cast<double>(clock.step) * clock.dt;
  clock.step += 1;
}

}  // namespace torsion
