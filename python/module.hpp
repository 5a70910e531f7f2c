#pragma once

#include <atomic>
#include <stdexcept>
#include <utility>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "torsion/torsion.hpp"

namespace torsion::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A pose as x, y, z, qw, qx, qy, qz.
inline constexpr py::ssize_t kPoseNumbers = 7;

/// Poses of (tools, 7), or (7) where there is one tool. Raises ValueError for another shape.
std::vector<Pose> poses_of(const Doubles& array, std::size_t tools);
Pose pose_of(const Doubles& array);
py::array_t<double> array_of(const Pose& pose);
/// Force, then torque: (6).
py::array_t<double> array_of(const Wrench& wrench);
py::array_t<double> array_of(const Vector3& vector);
Vector3 vector_of(const Doubles& array);
Mesh mesh_of(const Doubles& vertices, const py::array_t<std::uint32_t>& triangles);

/// The value, or ValueError with the error's message.
template <class T>
T value_or_raise(Result<T> result) {
  if (!result) {
    throw py::value_error(result.error().message);
  }
  return std::move(result).value();
}

/// An object for the length of one call. Raises RuntimeError where another thread's call has it:
/// step, run and update go on without the interpreter's lock.
class Exclusive {
 public:
  explicit Exclusive(std::atomic<bool>& in_use) : in_use_(in_use) {
    if (in_use_.exchange(true, std::memory_order_acquire)) {
      throw std::runtime_error("another thread is using this object; give each thread a copy");
    }
  }
  ~Exclusive() { in_use_.store(false, std::memory_order_release); }
  Exclusive(const Exclusive&) = delete;
  Exclusive& operator=(const Exclusive&) = delete;
  Exclusive(Exclusive&&) = delete;
  Exclusive& operator=(Exclusive&&) = delete;

 private:
  std::atomic<bool>& in_use_;
};

/// A simulation as Python has it.
struct OwnedSimulation {
  explicit OwnedSimulation(Simulation owned) : simulation(std::move(owned)) {}
  Simulation simulation;
  std::atomic<bool> in_use{false};
};

/// The function with a whole call's hold on the simulation.
template <class Result, class Self, class... Arguments>
auto exclusive(Result (*function)(Self&, Arguments...)) {
  return [function](OwnedSimulation& self, Arguments... arguments) {
    const Exclusive use(self.in_use);
    return function(self.simulation, static_cast<Arguments>(arguments)...);
  };
}

void add_scene(py::module_& module);
void add_simulation(py::module_& module);
void add_surface(py::module_& module);

}  // namespace torsion::python
