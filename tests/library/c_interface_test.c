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

static double time_of(const torsion_simulation* simulation) {
  double seconds = -1.0;
  expect(torsion_time(simulation, &seconds) == 0, "a simulation has a time");
  return seconds;
}

static torsion_pose animated(const torsion_scene* scene, double seconds) {
  torsion_pose pose;
  memset(&pose, 0, sizeof pose);
  expect(torsion_animated_pose(scene, 0, seconds, &pose) == 0, "the tool has an animation");
  return pose;
}

static void run_animation(const torsion_scene* scene, torsion_simulation* simulation) {
  while (time_of(simulation) < 2.0) {
    const torsion_pose pose = animated(scene, time_of(simulation));
    expect(torsion_step(simulation, &pose, 1) == 0, "a step has no fault");
  }
}

static void check_loads(torsion_simulation* simulation) {
  const double point[3] = {0.0, 0.0, 0.0};
  torsion_wrench wrench;
  torsion_load_parts parts;
  torsion_region region;
  double stiffness[36];
  size_t regions = 0;
  expect(torsion_tool_wrench(simulation, 0, &wrench) == 0, "there is a wrench");
  expect(torsion_tool_load_parts(simulation, 0, point, &parts) == 0, "and its parts");
  expect(torsion_tool_stiffness(simulation, 0, stiffness) == 0, "and a stiffness");
  expect(torsion_region_count(simulation, &regions) == 0 && regions == 1, "there is one contact");
  if (torsion_get_region(simulation, 0, &region) == 0) {
    expect(region.normal_force > 0.0, "it carries a force");
    expect(fabs(parts.normal_force[1] - region.normal_force * region.normal[1]) <
               1e-9 * region.normal_force,
           "the load's normal force is the region's");
    expect(region.mean_pressure > 0.0 && region.radius > 0.0, "it has a pressure and a size");
  }
  expect(wrench.force[1] > 0.0, "the tool is pushed up");
  expect(stiffness[7] > 0.0, "the contact resists being pressed");
}

static torsion_device_traits some_traits(void) {
  torsion_device_traits traits;
  memset(&traits, 0, sizeof traits);
  traits.size = sizeof traits;
  traits.period = 1e-3;
  traits.largest_force = 5.0;
  return traits;
}

static void check_coupling(const torsion_model* model, torsion_simulation* simulation,
                           const torsion_scene* scene) {
  torsion_device_traits traits = some_traits();
  torsion_coupling* const coupling = torsion_new_coupling(model, 0, &traits, TORSION_HOLD_MASSLESS);
  expect(coupling != NULL, "a coupling is made");
  for (int step = 0; step < 100; ++step) {
    const torsion_pose handle = animated(scene, 2.0);
    torsion_pose pose;
    torsion_wrench felt;
    expect(torsion_coupling_next(coupling, simulation, &handle, &pose) == 0, "the tool is held");
    torsion_step(simulation, &pose, 1);
    expect(torsion_coupling_felt(coupling, simulation, &felt) == 0, "the hand feels something");
    expect(isfinite(felt.force[1]) && fabs(felt.force[1]) <= 5.0, "what is felt is bounded");
  }
  expect(torsion_free_coupling(coupling) == 0, "a coupling is freed");
  expect(torsion_free_coupling(coupling) == -1, "once");
  traits.mass = -1.0;
  expect(torsion_new_coupling(model, 0, &traits, TORSION_HOLD_MASS) == NULL, "no mass is below 0");
  expect(strstr(torsion_last_error(), "at least 0") != NULL, "which is said");
}

/* A call with something wrong fails, says why, and writes nothing. */
static void check_refusals(const torsion_model* model, torsion_simulation* simulation) {
  torsion_wrench wrench;
  torsion_pose poses[2];
  memset(&wrench, 0, sizeof wrench);
  memset(poses, 0, sizeof poses);
  wrench.force[0] = 7.0;
  expect(torsion_tool_wrench(NULL, 0, &wrench) == -1, "there is no simulation");
  expect(strstr(torsion_last_error(), "null") != NULL, "a null handle is said to be one");
  expect(torsion_tool_wrench(simulation, 0, NULL) == -1, "there is no place for a wrench");
  expect(torsion_tool_wrench(simulation, 1, &wrench) == -1, "there is no second tool");
  expect(strstr(torsion_last_error(), "no tool") != NULL, "which is said");
  expect(torsion_step(simulation, poses, 2) == -1, "a step takes one pose a tool");
  expect(torsion_step(simulation, NULL, 1) == -1, "and not none");
  torsion_simulation* const freed = torsion_new_simulation(model);
  expect(torsion_free_simulation(freed) == 0, "a simulation is freed");
  expect(torsion_step(freed, poses, 1) == -1, "and does not step any more");
  expect(strstr(torsion_last_error(), "freed") != NULL, "which is said");
  expect(torsion_free_simulation(freed) == -1, "it is freed once");
  expect(torsion_copy_simulation(freed) == NULL, "it has no copy");
  expect(torsion_free_simulation(NULL) == 0, "null needs no freeing");
  expect(wrench.force[0] == 7.0, "nothing was written");
  poses[0].position[0] = (double)NAN;
  poses[0].orientation[0] = 1.0;
  torsion_simulation* const copy = torsion_copy_simulation(simulation);
  expect(torsion_step(copy, poses, 1) > 0, "a pose that is no number is a fault");
  torsion_free_simulation(copy);
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
  size_t tools = 0;
  size_t bodies = 0;
  double step_time = 0.0;
  expect(torsion_tool_count(model, &tools) == 0 && tools == 1, "one tool");
  expect(torsion_body_count(model, &bodies) == 0 && bodies == 1, "one body");
  expect(torsion_find_tool(model, "ball", &tools) == 0 && tools == 0, "it is the first");
  expect(torsion_find_tool(model, "nobody", &tools) == -1, "another is not there");
  expect(torsion_step_time(model, &step_time) == 0 && step_time == 1e-3, "a step takes 1 ms");
  torsion_simulation* const simulation = torsion_new_simulation(model);
  torsion_free_model(model); /* the simulation keeps what it needs */
  expect(torsion_new_simulation(model) == NULL, "a freed model has no simulations");
  run_animation(scene, simulation);
  check_loads(simulation);
  torsion_simulation* const copy = torsion_copy_simulation(simulation);
  torsion_wrench one;
  torsion_wrench other;
  torsion_tool_wrench(simulation, 0, &one);
  torsion_tool_wrench(copy, 0, &other);
  expect(memcmp(&one, &other, sizeof one) == 0, "a copy has the same load");
  torsion_model* const again = torsion_build(scene, &options);
  check_coupling(again, copy, scene);
  check_refusals(again, simulation);
  char text[8];
  expect(torsion_describe_faults(1, text, sizeof text) > 7 && strlen(text) == 7, "words are cut");
  torsion_free_model(again);
  torsion_free_simulation(copy);
  torsion_free_simulation(simulation);
  torsion_free_scene(scene);
  return failures == 0 ? 0 : 1;
}
