// A scene from a file, run by its animation; prints the largest contact couple.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <torsion/torsion.h>
#include <torsion/torsion.hpp>

int main(int argc, char** argv) {
  const torsion::Result<torsion::Scene> scene =
      torsion::load_scene(argc > 1 ? argv[1] : "scene.gltf");
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message.c_str());
    return 1;
  }
  torsion::Options options;
  options.contact_model = "mdr";
  options.body_model = "none";
  const auto model = torsion::build(scene.value(), options);
  if (!model) {
    std::fprintf(stderr, "%s\n", model.error().message.c_str());
    return 1;
  }
  torsion::Simulation simulation(model.value());
  double largest = 0.0;
  while (simulation.time() < scene.value().duration) {
    const torsion::Pose pose = torsion::animated_pose(scene.value(), 0, simulation.time());
    simulation.step({&pose, 1});
    for (const torsion::Region& region : simulation.regions()) {
      largest = std::max(largest, std::abs(region.couple));
    }
  }
  std::printf("largest couple %.4g N m\n", largest);
  return largest > 0.0 ? 0 : 1;
}
