// A rigid-body engine beside Torsion: MuJoCo carries a free ball with gravity and inertia; Torsion
// gives the wrench of its contact with a soft pad. The ball lies on the pad and spins about the
// vertical. What stops it is the contact couple: the friction of a point has no arm about that
// axis.
//
//   c++ -std=c++20 beside_mujoco.cpp $(pkg-config --cflags --libs torsion) -lmujoco

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <mujoco/mujoco.h>
#include <torsion/torsion.hpp>

namespace {

constexpr double kRadius = 0.02;  // m
constexpr double kMass = 0.2;     // kg
constexpr double kHeight = 0.05;  // m: of the pad's upper face
constexpr double kStep = 5e-4;    // s

torsion::Scene make_scene() {
  torsion::Body pad;
  pad.name = "pad";
  pad.parts = {torsion::make_box({0.1, 2.0 * kHeight, 0.1})};
  pad.material.youngs_modulus = 1e5;
  pad.material.static_friction = pad.material.dynamic_friction = 0.4;
  pad.fixed = torsion::Fixed::kBottomFace;
  torsion::Tool ball;
  ball.name = "ball";
  ball.mass = kMass;
  ball.parts = {torsion::make_sphere(kRadius)};
  torsion::Scene scene;
  scene.bodies = {pad};
  scene.tools = {ball};
  return scene;
}

/// MuJoCo's y is up here, too. It finds no contacts: they are Torsion's.
mjModel* make_ball() {
  const std::string text =
      "<mujoco><option timestep='" + std::to_string(kStep) +
      "' gravity='0 -9.81 0'/><worldbody><body pos='0 " + std::to_string(kHeight + kRadius) +
      " 0'><freejoint/><geom type='sphere' size='" + std::to_string(kRadius) + "' mass='" +
      std::to_string(kMass) + "' contype='0' conaffinity='0'/></body></worldbody></mujoco>";
  mjVFS files;
  mj_defaultVFS(&files);
  mj_makeEmptyFileVFS(&files, "ball.xml", static_cast<int>(text.size()) + 1);
  std::copy(text.begin(), text.end(), static_cast<char*>(files.filedata[0]));
  char problem[500] = "";
  mjModel* const model = mj_loadXML("ball.xml", &files, problem, sizeof problem);
  mj_deleteVFS(&files);
  if (model == nullptr) {
    std::fprintf(stderr, "%s\n", problem);
    std::exit(1);
  }
  return model;
}

}  // namespace

int main() {
  torsion::Options options;
  options.rate = 1.0 / kStep;
  const auto built = torsion::build(make_scene(), options);
  if (!built) {
    std::fprintf(stderr, "%s\n", built.error().message.c_str());
    return 1;
  }
  torsion::Simulation simulation(built.value());
  mjModel* const model = make_ball();
  mjData* const data = mj_makeData(model);
  double* const force = data->xfrc_applied + 6;  // of body 1: N, then N m about its mass centre
  double spin = 0.0;
  double stopped = -1.0;
  double weight = 0.0;
  double couple = 0.0;  // N m: while it slides everywhere
  for (int step = 0; step < 4000; ++step) {
    if (data->time < 1.0) {
      data->qvel[4] = 20.0;  // rad/s: kept up for a second, while the ball comes to rest
    }
    torsion::Pose pose;
    std::copy(data->qpos, data->qpos + 3, pose.position.begin());
    std::copy(data->qpos + 3, data->qpos + 7, pose.orientation.begin());
    simulation.step({&pose, 1});
    const torsion::Wrench wrench = simulation.wrench(0, pose.position);
    for (int axis = 0; axis < 3; ++axis) {
      const double damping =
          axis == 1 ? 2.0 : 0.0;  // N s/m: the pad's own loss, which has no model
      force[axis] = wrench.force[axis] - damping * data->qvel[axis];
      force[3 + axis] = wrench.torque[axis];
    }
    mj_step(model, data);
    spin = data->qvel[4];
    if (data->time > 1.0 && stopped < 0.0 && spin <= 0.0) {
      stopped = data->time - 1.0;
    }
    weight = wrench.force[1];
    if (data->time < 1.0) {
      couple = std::fabs(wrench.torque[1]);
    }
  }
  mj_deleteData(data);
  mj_deleteModel(model);
  // A constant couple stops the inertia 2/5 m r^2 in this time.
  const double inertia = 0.4 * kMass * kRadius * kRadius;
  std::printf("carried weight %.3f N of %.3f N; couple %.3f mN m\n", weight, 9.81 * kMass,
              1e3 * couple);
  std::printf("20 rad/s stopped in %.3f s, as %.3f s by that couple; then it swings on the pad\n",
              stopped, inertia * 20.0 / couple);
  const bool right = std::fabs(weight - 9.81 * kMass) < 0.02 * 9.81 * kMass && stopped > 0.0 &&
                     std::fabs(stopped - inertia * 20.0 / couple) < 0.05 * stopped;
  return right && simulation.faults_ever() == 0 ? 0 : 1;
}
