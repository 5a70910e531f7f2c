#include <algorithm>
#include <cstring>
#include <exception>

#include "ecs/assert.hpp"
#include "torsion/torsion.h"
#include "torsion/torsion.hpp"

struct torsion_scene {
  torsion::Scene scene;
};
struct torsion_model {
  std::shared_ptr<const torsion::Model> model;
};
struct torsion_simulation {
  torsion::Simulation simulation;
};
struct torsion_coupling {
  torsion::Coupling coupling;
};

namespace {

thread_local std::string last_error;

/// What `make` returns, or null with the reason in last_error: no exception gets into C.
template <class Make>
auto made_or_null(const Make& make) noexcept -> decltype(make()) {
  try {
    return make();
  } catch (const std::exception& error) {
    last_error = error.what();
  }
  return nullptr;
}

void copy(const torsion::Vector3& from, double* to) {
  std::ranges::copy(from, to);
}

torsion::Pose pose_of(const torsion_pose& from) {
  torsion::Pose pose;
  std::ranges::copy(from.position, pose.position.begin());
  std::ranges::copy(from.orientation, pose.orientation.begin());
  return pose;
}

torsion_pose to_c(const torsion::Pose& from) {
  torsion_pose pose;
  std::ranges::copy(from.position, pose.position);
  std::ranges::copy(from.orientation, pose.orientation);
  return pose;
}

torsion_wrench to_c(const torsion::Wrench& from) {
  torsion_wrench wrench;
  copy(from.force, wrench.force);
  copy(from.torque, wrench.torque);
  return wrench;
}

/// Where a number of a body is; null for a key that it has not.
double* number_of(torsion::Body& body, const char* key) {
  const std::pair<const char*, double*> numbers[] = {
      {"youngs_modulus", &body.material.youngs_modulus},
      {"poisson_ratio", &body.material.poisson_ratio},
      {"density", &body.material.density},
      {"static_friction", &body.material.static_friction},
      {"dynamic_friction", &body.material.dynamic_friction},
      {"tolerance", &body.tolerance}};
  for (const auto& [name, number] : numbers) {
    if (std::strcmp(name, key) == 0) {
      return number;
    }
  }
  return nullptr;
}

torsion::DeviceTraits traits_of(const torsion_device_traits& from) {
  return {from.damping,
          from.turn_damping,
          from.mass,
          from.inertia,
          from.encoder_step,
          from.encoder_turn_step,
          from.period,
          from.delay,
          from.largest_force,
          from.largest_torque,
          from.largest_stiffness,
          from.largest_turn_stiffness};
}

}  // namespace

uint32_t torsion_interface_version(void) {
  return TORSION_INTERFACE_VERSION;
}

const char* torsion_version(void) {
  return torsion::version();
}

const char* torsion_last_error(void) {
  return last_error.c_str();
}

void torsion_set_assertion_handler(void (*handler)(const char*, const char*, int)) {
  torsion::set_assertion_handler(handler);
}

torsion_scene* torsion_load_scene(const char* path) {
  return made_or_null([path]() -> torsion_scene* {
    torsion::Result<torsion::Scene> scene = torsion::load_scene(path);
    if (!scene) {
      last_error = scene.error().message;
      return nullptr;
    }
    return new torsion_scene{std::move(scene).value()};
  });
}

void torsion_free_scene(torsion_scene* scene) {
  delete scene;
}

double torsion_scene_duration(const torsion_scene* scene) {
  return scene->scene.duration;
}

torsion_pose torsion_animated_pose(const torsion_scene* scene, size_t tool, double time) {
  return to_c(torsion::animated_pose(scene->scene, tool, time));
}

int torsion_set_number(torsion_scene* scene, const char* body, const char* key, double value) {
  torsion::Body* const found = scene->scene.body(body);
  double* const number = found != nullptr ? number_of(*found, key) : nullptr;
  if (number == nullptr) {
    last_error = found == nullptr ? "there is no body \"" + std::string(body) + '"'
                                  : "a body has no number \"" + std::string(key) + '"';
    return -1;
  }
  *number = value;
  return 0;
}

torsion_options torsion_default_options(void) {
  const torsion::Options options;
  return {sizeof(torsion_options), options.rate,       nullptr,         nullptr,
          options.grid_side,       options.iterations, options.threads, 0};
}

torsion_model* torsion_build(const torsion_scene* scene, const torsion_options* options) {
  return made_or_null([&]() -> torsion_model* {
    torsion::Options made;
    if (options != nullptr) {
      TORSION_ASSERT(options->size == sizeof(torsion_options));
      made.rate = options->rate;
      made.contact_model = options->contact_model != nullptr ? options->contact_model : "";
      made.body_model = options->body_model != nullptr ? options->body_model : "";
      made.grid_side = options->grid_side;
      made.iterations = options->iterations;
      made.threads = options->threads;
      made.use_cache = options->use_cache != 0;
    }
    torsion::Result<std::shared_ptr<const torsion::Model>> model =
        torsion::build(scene->scene, made);
    if (!model) {
      last_error = model.error().message;
      return nullptr;
    }
    return new torsion_model{std::move(model).value()};
  });
}

void torsion_free_model(torsion_model* model) {
  delete model;
}

size_t torsion_body_count(const torsion_model* model) {
  return model->model->body_count();
}

size_t torsion_tool_count(const torsion_model* model) {
  return model->model->tool_count();
}

size_t torsion_find_tool(const torsion_model* model, const char* name) {
  return model->model->tool(name);
}

double torsion_step_time(const torsion_model* model) {
  return model->model->step_time();
}

torsion_simulation* torsion_new_simulation(const torsion_model* model) {
  return made_or_null([&] { return new torsion_simulation{torsion::Simulation(model->model)}; });
}

torsion_simulation* torsion_copy_simulation(const torsion_simulation* simulation) {
  return made_or_null([&] { return new torsion_simulation(*simulation); });
}

void torsion_free_simulation(torsion_simulation* simulation) {
  delete simulation;
}

uint32_t torsion_step(torsion_simulation* simulation, const torsion_pose* poses, size_t count) {
  static_assert(sizeof(torsion_pose) == sizeof(torsion::Pose) &&
                offsetof(torsion_pose, orientation) == offsetof(torsion::Pose, orientation));
  simulation->simulation.step({reinterpret_cast<const torsion::Pose*>(poses), count});
  return simulation->simulation.faults();
}

size_t torsion_describe_faults(uint32_t faults, char* text, size_t size) {
  const std::string words = torsion::describe_faults(faults);
  if (size > 0) {
    const std::size_t length = std::min(words.size(), size - 1);
    std::memcpy(text, words.data(), length);
    text[length] = '\0';
  }
  return words.size();
}

double torsion_time(const torsion_simulation* simulation) {
  return simulation->simulation.time();
}

torsion_wrench torsion_tool_wrench(const torsion_simulation* simulation, size_t tool) {
  return to_c(simulation->simulation.wrench(tool));
}

torsion_load_parts torsion_tool_load_parts(const torsion_simulation* simulation, size_t tool,
                                           const double point[3]) {
  const torsion::LoadParts parts =
      simulation->simulation.load_parts(tool, {point[0], point[1], point[2]});
  torsion_load_parts made;
  copy(parts.normal_force, made.normal_force);
  copy(parts.friction, made.friction);
  copy(parts.couple, made.couple);
  copy(parts.lever_torque, made.lever_torque);
  return made;
}

void torsion_tool_stiffness(const torsion_simulation* simulation, size_t tool,
                            double stiffness[36]) {
  double* next = stiffness;
  for (const std::array<double, 6>& row : simulation->simulation.stiffness(tool)) {
    next = std::ranges::copy(row, next).out;
  }
}

size_t torsion_region_count(const torsion_simulation* simulation) {
  return simulation->simulation.region_count();
}

torsion_region torsion_get_region(const torsion_simulation* simulation, size_t region) {
  const torsion::Region from = simulation->simulation.region(region);
  torsion_region made;
  made.id = from.id;
  made.body = from.body;
  made.tool = from.tool;
  copy(from.point, made.point);
  copy(from.normal, made.normal);
  made.area = from.area;
  made.radius = from.radius;
  made.depth = from.depth;
  made.normal_force = from.normal_force;
  made.mean_pressure = from.mean_pressure;
  copy(from.friction, made.friction);
  made.couple = from.couple;
  made.turn = from.turn;
  made.stick_share = from.stick_share;
  made.stick_radius = from.stick_radius;
  return made;
}

torsion_coupling* torsion_new_coupling(const torsion_model* model, size_t tool,
                                       const torsion_device_traits* traits, torsion_hold hold) {
  return made_or_null([&] {
    TORSION_ASSERT(traits->size == sizeof(torsion_device_traits));
    return new torsion_coupling{torsion::Coupling(*model->model, tool, traits_of(*traits),
                                                  static_cast<torsion::Hold>(hold))};
  });
}

void torsion_free_coupling(torsion_coupling* coupling) {
  delete coupling;
}

torsion_pose torsion_coupling_next(torsion_coupling* coupling, const torsion_simulation* simulation,
                                   const torsion_pose* handle) {
  return to_c(coupling->coupling.next(simulation->simulation, pose_of(*handle)));
}

torsion_wrench torsion_coupling_felt(torsion_coupling* coupling,
                                     const torsion_simulation* simulation) {
  return to_c(coupling->coupling.felt(simulation->simulation));
}
