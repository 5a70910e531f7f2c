#include "app/live/rebuild.hpp"

#include <algorithm>

namespace torsion::engine {

std::vector<BodyPick> picks_of(const SceneDescription& scene, const PrepareOptions& options) {
  std::vector<BodyPick> picks;
  for (const BodyDescription& body : scene.bodies) {
    const bool scene_contact = options.contact_model == ContactModel::kAuto;
    const bool scene_body = options.body_model == BodyModel::kAuto;
    picks.push_back({scene_contact ? body.models.contact : options.contact_model,
                     scene_body ? body.models.body : options.body_model, body.elasticity,
                     body.friction});
  }
  return picks;
}

void apply_picks(const std::vector<BodyPick>& picks, SceneDescription& scene) {
  TORSION_ASSERT(picks.size() == scene.bodies.size());
  for (std::size_t i = 0; i < picks.size(); ++i) {
    BodyDescription& body = scene.bodies[i];
    body.models.contact = picks[i].contact;
    body.models.body = picks[i].body;
    body.elasticity = picks[i].elasticity;
    body.friction = picks[i].friction;
  }
}

void carry_over(const World& from, World& to) {
  TORSION_ASSERT(from.model.tools.size() == to.model.tools.size());
  const Clock& old_clock = from.state.clock;
  Clock& clock = to.state.clock;
  clock.time = old_clock.time;
  clock.step = old_clock.step;
  clock.faults_ever = old_clock.faults_ever;
  std::ranges::copy(from.state.tools.column<ToolPose>(), to.state.tools.column<ToolPose>().begin());
  std::ranges::copy(from.state.tools.column<ToolMotion>(),
                    to.state.tools.column<ToolMotion>().begin());
  std::ranges::copy(from.state.bodies.column<BodyPose>(),
                    to.state.bodies.column<BodyPose>().begin());
  std::ranges::copy(from.state.tools_over_bodies.column<ToolOverBody>(),
                    to.state.tools_over_bodies.column<ToolOverBody>().begin());
  for (std::uint32_t tool = 0; tool < to.model.tools.size(); ++tool) {
    to.state.tools.at<ToolWrench>(tool).work = from.state.tools.at<ToolWrench>(tool).work;
  }
}

}  // namespace torsion::engine
