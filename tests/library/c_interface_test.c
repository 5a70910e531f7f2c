/* A scene, steps, loads and a held tool, from C. Prints what is wrong, and fails then. */

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "torsion/torsion.h"

static int failures = 0;

static void expect(int holds, const char* what) {
  if (!holds) {
    printf("not so: %s\n", what);
    ++failures;
  }
}

static void run_animation(const torsion_scene* scene, torsion_simulation* simulation) {
  while (torsion_time(simulation) < 2.0) {
    const torsion_pose pose = torsion_animated_pose(scene, 0, torsion_time(simulation));
    expect(torsion_step(simulation, &pose, 1) == 0, "a step has no fault");
  }
}

static void check_loads(torsion_simulation* simulation) {
  const torsion_wrench wrench = torsion_tool_wrench(simulation, 0);
  const double point[3] = {0.0, 0.0, 0.0};
  const torsion_load_parts parts = torsion_tool_load_parts(simulation, 0, point);
  double stiffness[36];
  torsion_tool_stiffness(simulation, 0, stiffness);
  expect(torsion_region_count(simulation) == 1, "there is one contact");
  if (torsion_region_count(simulation) == 1) {
    const torsion_region region = torsion_get_region(simulation, 0);
    expect(region.normal_force > 0.0, "it carries a force");
    expect(fabs(parts.normal_force[1] - region.normal_force * region.normal[1]) <
               1e-9 * region.normal_force,
           "the load's normal force is the region's");
    expect(region.mean_pressure > 0.0 && region.radius > 0.0, "it has a pressure and a size");
  }
  expect(wrench.force[1] > 0.0, "the tool is pushed up");
  expect(stiffness[7] > 0.0, "the contact resists being pressed");
}

static void check_coupling(const torsion_model* model, torsion_simulation* simulation,
                           const torsion_scene* scene) {
  torsion_device_traits traits;
  memset(&traits, 0, sizeof traits);
  traits.size = sizeof traits;
  traits.period = 1e-3;
  traits.largest_force = 5.0;
  torsion_coupling* const coupling = torsion_new_coupling(model, 0, &traits, TORSION_HOLD_MASSLESS);
  expect(coupling != NULL, "a coupling is made");
  for (int step = 0; step < 100; ++step) {
    const torsion_pose handle = torsion_animated_pose(scene, 0, 2.0);
    const torsion_pose pose = torsion_coupling_next(coupling, simulation, &handle);
    torsion_step(simulation, &pose, 1);
    const torsion_wrench felt = torsion_coupling_felt(coupling, simulation);
    expect(isfinite(felt.force[1]) && fabs(felt.force[1]) <= 5.0, "what is felt is bounded");
  }
  torsion_free_coupling(coupling);
}

int main(int argc, char** argv) {
  if (argc != 2) {
    return 2;
  }
  expect(torsion_interface_version() == TORSION_INTERFACE_VERSION, "the interface is the header's");
  expect(torsion_load_scene("nowhere.gltf") == NULL, "a scene that is not there is no scene");
  expect(strstr(torsion_last_error(), "nowhere.gltf") != NULL, "and its name is said");
  torsion_scene* const scene = torsion_load_scene(argv[1]);
  if (scene == NULL) {
    printf("%s\n", torsion_last_error());
    return 1;
  }
  expect(torsion_set_number(scene, "nobody", "density", 1.0) == -1, "there is no such body");
  expect(torsion_set_number(scene, "cube", "colour", 1.0) == -1, "there is no such number");
  expect(torsion_set_number(scene, "cube", "youngs_modulus", 2e6) == 0, "E can be set");
  torsion_options options = torsion_default_options();
  options.contact_model = "rubber";
  expect(torsion_build(scene, &options) == NULL, "there is no such model");
  expect(strstr(torsion_last_error(), "rubber") != NULL, "and its name is said");
  options.contact_model = "mdr";
  options.body_model = "none";
  torsion_model* const model = torsion_build(scene, &options);
  if (model == NULL) {
    printf("%s\n", torsion_last_error());
    return 1;
  }
  expect(torsion_tool_count(model) == 1 && torsion_body_count(model) == 1, "one tool, one body");
  expect(torsion_find_tool(model, "nobody") == 1, "a tool that is not there has no row");
  expect(torsion_step_time(model) == 1e-3, "a step takes a millisecond");
  torsion_simulation* const simulation = torsion_new_simulation(model);
  torsion_free_model(model); /* the simulation keeps what it needs */
  run_animation(scene, simulation);
  check_loads(simulation);
  torsion_simulation* const copy = torsion_copy_simulation(simulation);
  const torsion_wrench one = torsion_tool_wrench(simulation, 0);
  const torsion_wrench other = torsion_tool_wrench(copy, 0);
  expect(memcmp(&one, &other, sizeof one) == 0, "a copy has the same load");
  torsion_model* const again = torsion_build(scene, &options);
  check_coupling(again, copy, scene);
  char text[8];
  expect(torsion_describe_faults(1, text, sizeof text) > 7 && strlen(text) == 7, "words are cut");
  torsion_free_model(again);
  torsion_free_simulation(copy);
  torsion_free_simulation(simulation);
  torsion_free_scene(scene);
  return failures == 0 ? 0 : 1;
}
