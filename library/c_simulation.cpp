// Simulations and held tools from C.

#include <cmath>
#include <cstddef>
#include <cstring>

#include "library/c_interface.hpp"

namespace {

using torsion::c_interface::failed;
using torsion::c_interface::free_handle;
using torsion::c_interface::guarded;
using torsion::c_interface::HeldTool;
using torsion::c_interface::kFailed;
using torsion::c_interface::kNoSuchTool;
using torsion::c_interface::kNullPointer;
using torsion::c_interface::made_or_null;
using torsion::c_interface::model_of;
using torsion::c_interface::pool;
using torsion::c_interface::to_c;
using torsion::c_interface::with;

void copy(const torsion::Vector3& from, double* to) {
  std::ranges::copy(from, to);
}

torsion::Pose pose_of(const torsion_pose& from) {
  torsion::Pose pose;
  std::ranges::copy(from.position, pose.position.begin());
  std::ranges::copy(from.orientation, pose.orientation.begin());
  return pose;
}

torsion_wrench to_c(const torsion::Wrench& from) {
  torsion_wrench wrench;
  copy(from.force, wrench.force);
  copy(from.torque, wrench.torque);
  return wrench;
}

torsion_region to_c(const torsion::Region& from) {
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

/// Empty, or what is wrong with the traits.
std::string traits_problem(const torsion_device_traits& traits) {
  const double numbers[] = {traits.damping,
                            traits.turn_damping,
                            traits.mass,
                            traits.inertia,
                            traits.encoder_step,
                            traits.encoder_turn_step,
                            traits.period,
                            traits.delay,
                            traits.largest_force,
                            traits.largest_torque,
                            traits.largest_stiffness,
                            traits.largest_turn_stiffness};
  for (const double number : numbers) {
    if (!(number >= 0.0) || !std::isfinite(number)) {
      return "a device's traits have " + std::to_string(number) +
             "; expected numbers of at least 0, 0 for what is not known";
    }
  }
  return "";
}

}  // namespace

torsion_simulation* torsion_new_simulation(const torsion_model* model) {
  return made_or_null([&]() -> torsion_simulation* {
    const auto found = model_of(model);
    return found == nullptr ? nullptr : pool<torsion_simulation>().make(torsion::Simulation(found));
  });
}

torsion_simulation* torsion_copy_simulation(const torsion_simulation* simulation) {
  torsion_simulation* copy = nullptr;
  with(simulation, [&copy](const torsion::Simulation& from) {
    copy = pool<torsion_simulation>().make(torsion::Simulation(from));
    return 0;
  });
  return copy;
}

int torsion_free_simulation(torsion_simulation* simulation) {
  return free_handle(simulation);
}

int torsion_step(torsion_simulation* simulation, const torsion_pose* poses, size_t count) {
  static_assert(sizeof(torsion_pose) == sizeof(torsion::Pose) &&
                offsetof(torsion_pose, orientation) == offsetof(torsion::Pose, orientation));
  return with(simulation, [=](torsion::Simulation& stepped) {
    if (poses == nullptr && count > 0) {
      return failed(kNullPointer);
    }
    if (count != stepped.model().tool_count()) {
      return failed("a step takes one pose for each tool");
    }
    stepped.step({reinterpret_cast<const torsion::Pose*>(poses), count});
    return static_cast<int>(stepped.faults());
  });
}

size_t torsion_describe_faults(uint32_t faults, char* text, size_t size) {
  std::size_t all = 0;
  guarded([&] {
    const std::string words = torsion::describe_faults(faults);
    all = words.size();
    if (text != nullptr && size > 0) {
      const std::size_t length = std::min(words.size(), size - 1);
      std::memcpy(text, words.data(), length);
      text[length] = '\0';
    }
    return 0;
  });
  return all;
}

int torsion_time(const torsion_simulation* simulation, double* seconds) {
  return with(simulation, [=](const torsion::Simulation& from) {
    if (seconds == nullptr) {
      return failed(kNullPointer);
    }
    *seconds = from.time();
    return 0;
  });
}

int torsion_tool_wrench(const torsion_simulation* simulation, size_t tool, torsion_wrench* wrench) {
  return with(simulation, [=](const torsion::Simulation& from) {
    if (wrench == nullptr || tool >= from.model().tool_count()) {
      return failed(wrench == nullptr ? kNullPointer : kNoSuchTool);
    }
    *wrench = to_c(from.wrench(tool));
    return 0;
  });
}

int torsion_tool_load_parts(const torsion_simulation* simulation, size_t tool,
                            const double point[3], torsion_load_parts* parts) {
  return with(simulation, [=](const torsion::Simulation& from) {
    if (point == nullptr || parts == nullptr || tool >= from.model().tool_count()) {
      return failed(point == nullptr || parts == nullptr ? kNullPointer : kNoSuchTool);
    }
    const torsion::LoadParts load = from.load_parts(tool, {point[0], point[1], point[2]});
    copy(load.normal_force, parts->normal_force);
    copy(load.friction, parts->friction);
    copy(load.couple, parts->couple);
    copy(load.lever_torque, parts->lever_torque);
    return 0;
  });
}

int torsion_tool_stiffness(const torsion_simulation* simulation, size_t tool,
                           double stiffness[36]) {
  return with(simulation, [=](const torsion::Simulation& from) {
    if (stiffness == nullptr || tool >= from.model().tool_count()) {
      return failed(stiffness == nullptr ? kNullPointer : kNoSuchTool);
    }
    double* next = stiffness;
    for (const std::array<double, 6>& row : from.stiffness(tool)) {
      next = std::ranges::copy(row, next).out;
    }
    return 0;
  });
}

int torsion_region_count(const torsion_simulation* simulation, size_t* count) {
  return with(simulation, [=](const torsion::Simulation& from) {
    if (count == nullptr) {
      return failed(kNullPointer);
    }
    *count = from.region_count();
    return 0;
  });
}

int torsion_get_region(const torsion_simulation* simulation, size_t region, torsion_region* made) {
  return with(simulation, [=](const torsion::Simulation& at) {
    if (made == nullptr || region >= at.region_count()) {
      return failed(made == nullptr ? kNullPointer : "there is no region of that row");
    }
    *made = to_c(at.region(region));
    return 0;
  });
}

torsion_coupling* torsion_new_coupling(const torsion_model* model, size_t tool,
                                       const torsion_device_traits* traits, torsion_hold hold) {
  return made_or_null([&]() -> torsion_coupling* {
    const auto found = model_of(model);
    if (found == nullptr) {
      return nullptr;
    }
    if (traits == nullptr || tool >= found->tool_count()) {
      failed(traits == nullptr ? kNullPointer : kNoSuchTool);
      return nullptr;
    }
    if (traits->size != sizeof(torsion_device_traits)) {
      failed("the device's traits have another size than this version's");
      return nullptr;
    }
    const auto number = static_cast<int>(hold);
    if (number < TORSION_HOLD_MASSLESS || number > TORSION_HOLD_DIRECT) {
      failed("there is no such way to hold a tool");
      return nullptr;
    }
    if (const std::string problem = traits_problem(*traits); !problem.empty()) {
      failed(problem.c_str());
      return nullptr;
    }
    return pool<torsion_coupling>().make(HeldTool{
        torsion::Coupling(*found, tool, traits_of(*traits), static_cast<torsion::Hold>(hold)),
        tool});
  });
}

int torsion_free_coupling(torsion_coupling* coupling) {
  return free_handle(coupling);
}

int torsion_coupling_next(torsion_coupling* coupling, const torsion_simulation* simulation,
                          const torsion_pose* handle, torsion_pose* pose) {
  return with(coupling, [=](HeldTool& held) {
    return with(simulation, [&](const torsion::Simulation& from) {
      if (handle == nullptr || pose == nullptr) {
        return failed(kNullPointer);
      }
      if (held.tool >= from.model().tool_count()) {
        return failed("the coupling is for a tool that the simulation has not");
      }
      *pose = to_c(held.coupling.next(from, pose_of(*handle)));
      return 0;
    });
  });
}

int torsion_coupling_felt(torsion_coupling* coupling, const torsion_simulation* simulation,
                          torsion_wrench* wrench) {
  return with(coupling, [=](HeldTool& held) {
    return with(simulation, [&](const torsion::Simulation& from) {
      if (wrench == nullptr || held.tool >= from.model().tool_count()) {
        return failed(wrench == nullptr ? kNullPointer
                                        : "the coupling is for a tool that the simulation has not");
      }
      *wrench = to_c(held.coupling.felt(from));
      return 0;
    });
  });
}
