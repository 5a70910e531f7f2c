#pragma once

// What the functions of torsion.h share: handles, errors, and how a call is kept from throwing.

#include <algorithm>
#include <exception>
#include <memory>
#include <string>

#include "library/handles.hpp"
#include "torsion/torsion.h"
#include "torsion/torsion.hpp"

// What a handle points to (library/handles.hpp). A model's value is copied under in_use, which
// other threads' calls wait for: it is for all of them.
struct torsion_scene : torsion::Handle<torsion::Scene> {};
struct torsion_model : torsion::Handle<std::shared_ptr<const torsion::Model>> {};
struct torsion_simulation : torsion::Handle<torsion::Simulation> {};
namespace torsion::c_interface {
/// A coupling and the row of its tool.
struct HeldTool {
  Coupling coupling;
  std::size_t tool;
};
}  // namespace torsion::c_interface
struct torsion_coupling : torsion::Handle<torsion::c_interface::HeldTool> {};

namespace torsion::c_interface {

inline constexpr int kFailed = -1;

inline constexpr const char* kNullPointer = "a pointer is null";
inline constexpr const char* kNoSuchTool = "there is no tool of that row";

/// Remembers, for the calling thread, why a call failed. @return kFailed
int failed(const char* why) noexcept;

/// The pool of a kind of handles; it stays until the program has ended.
template <class H>
torsion::HandlePool<H>& pool() {
  static auto* const made = new torsion::HandlePool<H>;
  return *made;
}

/// What `call` returns, or kFailed with the reason in last_error: no exception gets into C.
template <class Call>
int guarded(const Call& call) noexcept {
  try {
    return call();
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

/// The handle that `make` makes, or null with the reason in last_error.
template <class Make>
auto made_or_null(const Make& make) noexcept -> decltype(make()) {
  try {
    return make();
  } catch (const std::exception& error) {
    failed(error.what());
  }
  return nullptr;
}

/// Why a handle cannot be used; null: it can.
template <class H>
const char* problem_of(const HandleUse<H>& use) {
  switch (use.state()) {
    case HandleState::kUsable:
      return nullptr;
    case HandleState::kNull:
      return "a handle is null";
    case HandleState::kFreed:
      return "a handle was freed before";
    case HandleState::kBusy:
      return "another thread is using this handle; give each thread an object of its own";
  }
  return nullptr;
}

/// Calls with what the handle points to, if it can be used.
template <class H, class Call>
int with(const H* handle, const Call& call) noexcept {
  return guarded([&] {
    const HandleUse<H> use(handle);
    const char* const problem = problem_of(use);
    return problem != nullptr ? failed(problem) : call(*use);
  });
}

/// The model of a handle, which several threads may ask for at once; null with the reason in
/// last_error where it cannot be used.
std::shared_ptr<const Model> model_of(const torsion_model* handle);

template <class H>
int free_handle(H* handle) noexcept {
  return handle == nullptr ? 0 : with(handle, [handle](auto& /*value*/) {
    pool<H>().free(handle);
    return 0;
  });
}

inline torsion_pose to_c(const Pose& from) {
  torsion_pose pose;
  std::ranges::copy(from.position, pose.position);
  std::ranges::copy(from.orientation, pose.orientation);
  return pose;
}

}  // namespace torsion::c_interface
