#include "tests/app/live_session.hpp"

#include "tests/support/contact_scenes.hpp"
#include "tests/support/test_cache.hpp"

namespace torsion::engine::test {

PrepareOptions ball_options() {
  PrepareOptions options;
  options.contact_model = ContactModel::kMdr;
  options.body_model = BodyModel::kNone;
  options.use_cache = has_test_cache();
  return options;
}

Session ball_session() {
  Session session;
  session.scene = ball_on_cube();
  session.scene.path = "ball";
  session.scene.bodies[0].models = {};
  MotionLink place;
  place.translation = {0.0, kTouching + 1e-3, 0.0};
  session.scene.tools[0].script.links = {place};
  session.simulation = prepare(session.scene, ball_options()).value();
  session.tool_poses.resize(1);
  return session;
}

}  // namespace torsion::engine::test
