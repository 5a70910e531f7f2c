// Scenes and models from C.

#include <cstring>

#include "library/c_interface.hpp"

namespace {

using torsion::c_interface::failed;
using torsion::c_interface::free_handle;
using torsion::c_interface::guarded;
using torsion::c_interface::kFailed;
using torsion::c_interface::kNoSuchTool;
using torsion::c_interface::kNullPointer;
using torsion::c_interface::made_or_null;
using torsion::c_interface::model_of;
using torsion::c_interface::pool;
using torsion::c_interface::to_c;
using torsion::c_interface::with;

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

}  // namespace

torsion_scene* torsion_load_scene(const char* path) {
  return made_or_null([path]() -> torsion_scene* {
    if (path == nullptr) {
      failed(kNullPointer);
      return nullptr;
    }
    torsion::Result<torsion::Scene> scene = torsion::load_scene(path);
    if (!scene) {
      failed(scene.error().message.c_str());
      return nullptr;
    }
    return pool<torsion_scene>().make(std::move(scene).value());
  });
}

int torsion_free_scene(torsion_scene* scene) {
  return free_handle(scene);
}

int torsion_scene_duration(const torsion_scene* scene, double* seconds) {
  return with(scene, [=](const torsion::Scene& from) {
    if (seconds == nullptr) {
      return failed(kNullPointer);
    }
    *seconds = from.duration;
    return 0;
  });
}

int torsion_animated_pose(const torsion_scene* scene, size_t tool, double time,
                          torsion_pose* pose) {
  return with(scene, [=](const torsion::Scene& from) {
    if (pose == nullptr || tool >= from.tools.size()) {
      return failed(pose == nullptr ? kNullPointer : kNoSuchTool);
    }
    *pose = to_c(torsion::animated_pose(from, tool, time));
    return 0;
  });
}

int torsion_set_number(torsion_scene* scene, const char* body, const char* key, double value) {
  return with(scene, [=](torsion::Scene& from) {
    if (body == nullptr || key == nullptr) {
      return failed(kNullPointer);
    }
    torsion::Body* const found = from.body(body);
    double* const number = found != nullptr ? number_of(*found, key) : nullptr;
    if (number == nullptr) {
      const std::string why = found == nullptr ? "there is no body \"" + std::string(body) + '"'
                                               : "a body has no number \"" + std::string(key) + '"';
      return failed(why.c_str());
    }
    *number = value;
    return 0;
  });
}

torsion_options torsion_default_options(void) {
  const torsion::Options options;
  return {sizeof(torsion_options), options.rate,       nullptr,         nullptr,
          options.grid_side,       options.iterations, options.threads, 0};
}

torsion_model* torsion_build(const torsion_scene* scene, const torsion_options* options) {
  torsion_model* model = nullptr;
  with(scene, [&](const torsion::Scene& from) {
    torsion::Options made;
    if (options != nullptr) {
      if (options->size != sizeof(torsion_options)) {
        return failed(
            "the options have another size than this version's; begin with "
            "torsion_default_options");
      }
      made.rate = options->rate;
      made.contact_model = options->contact_model != nullptr ? options->contact_model : "";
      made.body_model = options->body_model != nullptr ? options->body_model : "";
      made.grid_side = options->grid_side;
      made.iterations = options->iterations;
      made.threads = options->threads;
      made.use_cache = options->use_cache != 0;
    }
    torsion::Result<std::shared_ptr<const torsion::Model>> built = torsion::build(from, made);
    if (!built) {
      return failed(built.error().message.c_str());
    }
    model = pool<torsion_model>().make(std::move(built).value());
    return 0;
  });
  return model;
}

int torsion_free_model(torsion_model* model) {
  return free_handle(model);
}

int torsion_body_count(const torsion_model* model, size_t* count) {
  return guarded([&] {
    const auto found = model_of(model);
    if (found == nullptr || count == nullptr) {
      return found == nullptr ? kFailed : failed(kNullPointer);
    }
    *count = found->body_count();
    return 0;
  });
}

int torsion_tool_count(const torsion_model* model, size_t* count) {
  return guarded([&] {
    const auto found = model_of(model);
    if (found == nullptr || count == nullptr) {
      return found == nullptr ? kFailed : failed(kNullPointer);
    }
    *count = found->tool_count();
    return 0;
  });
}

int torsion_find_tool(const torsion_model* model, const char* name, size_t* tool) {
  return guarded([&] {
    const auto found = model_of(model);
    if (found == nullptr || name == nullptr || tool == nullptr) {
      return found == nullptr ? kFailed : failed(kNullPointer);
    }
    const std::size_t row = found->tool(name);
    if (row == found->tool_count()) {
      return failed(("there is no tool \"" + std::string(name) + '"').c_str());
    }
    *tool = row;
    return 0;
  });
}

int torsion_step_time(const torsion_model* model, double* seconds) {
  return guarded([&] {
    const auto found = model_of(model);
    if (found == nullptr || seconds == nullptr) {
      return found == nullptr ? kFailed : failed(kNullPointer);
    }
    *seconds = found->step_time();
    return 0;
  });
}
