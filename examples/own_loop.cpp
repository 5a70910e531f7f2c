// Your own loop at 1 kHz: a hand holds a screwdriver's ball tip on a soft pad and turns it. Reads a
// handle (here a made-up one), steps, and has the wrench that a device would be sent.
//
//   c++ -std=c++20 own_loop.cpp $(pkg-config --cflags --libs torsion) -o own_loop

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include <torsion/torsion.hpp>

namespace {

torsion::Scene make_scene() {
  torsion::Body pad;
  pad.name = "pad";
  pad.parts = {torsion::make_box({0.1, 0.05, 0.1})};
  pad.material.youngs_modulus = 2e5;  // Pa
  pad.material.static_friction = pad.material.dynamic_friction = 0.6;
  pad.fixed = torsion::Fixed::kBottomFace;
  torsion::Tool tip;
  tip.name = "tip";
  tip.parts = {torsion::make_sphere(0.01)};
  torsion::Scene scene;
  scene.bodies = {pad};
  scene.tools = {tip};
  return scene;
}

/// Where the hand is at a time [s]: down by 1.5 mm, then to and fro by half a radian.
torsion::Pose handle_at(double time) {
  const double depth = 1.5e-3 * std::fmin(time / 0.3, 1.0);
  const double turn = time < 0.3 ? 0.0 : 0.5 * std::sin(4.0 * (time - 0.3));
  return {{0.0, 0.025 + 0.01 - depth, 0.0}, {std::cos(turn / 2), 0.0, std::sin(turn / 2), 0.0}};
}

}  // namespace

int main() {
  const auto model = torsion::build(make_scene());
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message.c_str());
    return 1;
  }
  torsion::Simulation simulation(model.value());
  torsion::DeviceTraits traits;  // of the device: what it can be given, how often it is asked
  traits.period = model.value()->step_time();
  traits.damping = 2.0;        // N s/m: bounds the stiffness that a sampled hand can feel
  traits.turn_damping = 2e-3;  // N m s/rad
  traits.largest_force = 8.0;
  traits.largest_torque = 0.05;
  torsion::Coupling coupling(*model.value(), model.value()->tool("tip"), traits);

  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  double busy = 0.0;     // s, of all steps
  double largest = 0.0;  // N m
  const int steps = 1000;
  for (int step = 0; step < steps; ++step) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(step));
    const auto begin = Clock::now();
    const torsion::Pose pose = coupling.next(simulation, handle_at(simulation.time()));
    simulation.step({&pose, 1});
    const torsion::Wrench felt = coupling.felt(simulation);  // to the device
    busy += std::chrono::duration<double>(Clock::now() - begin).count();
    largest = std::fmax(largest, std::fabs(felt.torque[1]));
    if (step % 100 == 99) {
      std::printf("%.1f s: force %.2f N, torque %.2f mN m\n", simulation.time(), felt.force[1],
                  1e3 * felt.torque[1]);
    }
  }
  std::printf("%.0f us a step; largest torque %.2f mN m; faults: %u\n", 1e6 * busy / steps,
              1e3 * largest, simulation.faults_ever());
  return simulation.faults_ever() == 0 && largest > 0.0 ? 0 : 1;
}
