#pragma once

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

void add_scene(py::module_& module);
void add_simulation(py::module_& module);
void add_surface(py::module_& module);

}  // namespace torsion::python
