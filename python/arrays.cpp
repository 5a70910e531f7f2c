#include <algorithm>

#include "python/module.hpp"

namespace torsion::python {
namespace {

py::array_t<double> filled(std::initializer_list<double> numbers) {
  py::array_t<double> array(static_cast<py::ssize_t>(numbers.size()));
  std::ranges::copy(numbers, array.mutable_data());
  return array;
}

Pose pose_at(const double* numbers) {
  return {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5], numbers[6]}};
}

}  // namespace

std::vector<Pose> poses_of(const Doubles& array, std::size_t tools) {
  const bool one = array.ndim() == 1 && tools == 1 && array.shape(0) == kPoseNumbers;
  const bool all = array.ndim() == 2 && static_cast<std::size_t>(array.shape(0)) == tools &&
                   array.shape(1) == kPoseNumbers;
  if (!one && !all) {
    throw py::value_error("expected poses of shape (" + std::to_string(tools) +
                          ", 7): x, y, z, qw, qx, qy, qz of each tool");
  }
  std::vector<Pose> poses;
  for (std::size_t tool = 0; tool < tools; ++tool) {
    poses.push_back(pose_at(array.data() + kPoseNumbers * static_cast<py::ssize_t>(tool)));
  }
  return poses;
}

Pose pose_of(const Doubles& array) {
  return poses_of(array, 1).front();
}

py::array_t<double> array_of(const Pose& pose) {
  const Vector3& p = pose.position;
  const Quaternion& q = pose.orientation;
  return filled({p[0], p[1], p[2], q[0], q[1], q[2], q[3]});
}

py::array_t<double> array_of(const Wrench& wrench) {
  const Vector3& f = wrench.force;
  const Vector3& t = wrench.torque;
  return filled({f[0], f[1], f[2], t[0], t[1], t[2]});
}

py::array_t<double> array_of(const Vector3& vector) {
  return filled({vector[0], vector[1], vector[2]});
}

Vector3 vector_of(const Doubles& array) {
  if (array.ndim() != 1 || array.shape(0) != 3) {
    throw py::value_error("expected three numbers");
  }
  return {array.data()[0], array.data()[1], array.data()[2]};
}

Mesh mesh_of(const Doubles& vertices, const py::array_t<std::uint32_t>& triangles) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 3 || triangles.ndim() != 2 ||
      triangles.shape(1) != 3) {
    throw py::value_error("expected vertices of shape (n, 3) and triangles of shape (m, 3)");
  }
  Mesh mesh;
  const auto points = vertices.unchecked<2>();
  for (py::ssize_t i = 0; i < points.shape(0); ++i) {
    mesh.vertices.push_back({points(i, 0), points(i, 1), points(i, 2)});
  }
  const auto corners = triangles.unchecked<2>();
  for (py::ssize_t i = 0; i < corners.shape(0); ++i) {
    const std::array<std::uint32_t, 3> t{corners(i, 0), corners(i, 1), corners(i, 2)};
    if (std::ranges::max(t) >= mesh.vertices.size()) {
      throw py::value_error("triangle " + std::to_string(i) + " has a row of " +
                            std::to_string(std::ranges::max(t)) + ", expected less than the " +
                            std::to_string(mesh.vertices.size()) + " vertices");
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace torsion::python
