#include "python/module.hpp"

namespace torsion::python {
namespace {

/// A mesh that deforms with a body; its arrays are views of memory that an update overwrites.
class DeformedMesh {
 public:
  DeformedMesh(const Simulation& simulation, std::size_t body, const Mesh& mesh)
      : snapshot_(simulation), surface_(simulation.shared_model(), body, mesh) {}

  void update(OwnedSimulation& simulation) {
    const Exclusive use(in_use_);
    {
      const Exclusive use_of_simulation(simulation.in_use);
      snapshot_.take(simulation.simulation);
    }
    const py::gil_scoped_release without_interpreter;
    surface_.update(snapshot_);
  }
  [[nodiscard]] const Surface& surface() const { return surface_; }

 private:
  Snapshot snapshot_;
  Surface surface_;
  std::atomic<bool> in_use_{false};
};

py::array_t<float> view_of(std::span<const std::array<float, 3>> rows, const py::object& owner) {
  py::array_t<float> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}},
                           rows.empty() ? nullptr : rows.front().data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace

void add_surface(py::module_& module) {
  py::class_<DeformedMesh>(module, "Surface", "A mesh that deforms with a body.")
      .def(py::init([](OwnedSimulation& owned, const Doubles& vertices,
                       const py::array_t<std::uint32_t>& triangles, std::size_t body) {
             const Exclusive use(owned.in_use);
             const Simulation& simulation = owned.simulation;
             if (body >= simulation.model().body_count()) {
               throw py::index_error("there is no body " + std::to_string(body));
             }
             return std::make_unique<DeformedMesh>(simulation, body, mesh_of(vertices, triangles));
           }),
           "vertices: (n, 3) [m, body frame]; triangles: (m, 3).", py::arg("simulation"),
           py::arg("vertices"), py::arg("triangles"), py::arg("body") = 0)
      .def("update", &DeformedMesh::update, "Deforms the mesh as of the simulation's last step.",
           py::arg("simulation"))
      .def_property_readonly(
          "positions",
          [](const py::object& self) {
            return view_of(self.cast<const DeformedMesh&>().surface().positions(), self);
          },
          "(n, 3) [m, body frame]; a view, overwritten by update().")
      .def_property_readonly(
          "normals",
          [](const py::object& self) {
            return view_of(self.cast<const DeformedMesh&>().surface().normals(), self);
          },
          "(n, 3); a view.")
      .def_property_readonly(
          "twist",
          [](const py::object& self) {
            const std::span<const float> twist = self.cast<const DeformedMesh&>().surface().twist();
            py::array_t<float> array(static_cast<py::ssize_t>(twist.size()), twist.data(), self);
            array.attr("flags").attr("writeable") = false;
            return array;
          },
          "(n) [rad]; a view.");
}

}  // namespace torsion::python
