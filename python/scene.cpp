#include <cmath>

#include "python/module.hpp"

namespace torsion::python {
namespace {

Body& body_named(Scene& scene, const std::string& name) {
  Body* const body = scene.body(name);
  if (body == nullptr) {
    throw py::key_error("there is no body \"" + name + '"');
  }
  return *body;
}

/// Poses of the file's animations at the steps of a run: (steps, tools, 7).
py::array_t<double> animation(const Scene& scene, double rate, std::optional<double> seconds) {
  if (!(rate > 0.0)) {
    throw py::value_error("rate: expected a number above 0 (Hz)");
  }
  const auto steps =
      static_cast<py::ssize_t>(std::llround(seconds.value_or(scene.duration) * rate));
  const auto tools = static_cast<py::ssize_t>(scene.tools.size());
  py::array_t<double> poses({steps, tools, kPoseNumbers});
  auto rows = poses.mutable_unchecked<3>();
  for (py::ssize_t step = 0; step < steps; ++step) {
    for (py::ssize_t tool = 0; tool < tools; ++tool) {
      const Pose pose =
          animated_pose(scene, static_cast<std::size_t>(tool), static_cast<double>(step) / rate);
      for (py::ssize_t k = 0; k < 3; ++k) {
        rows(step, tool, k) = pose.position[static_cast<std::size_t>(k)];
      }
      for (py::ssize_t k = 0; k < 4; ++k) {
        rows(step, tool, 3 + k) = pose.orientation[static_cast<std::size_t>(k)];
      }
    }
  }
  return poses;
}

void add_parts(py::module_& module) {
  py::class_<Part>(module, "Part", "One closed solid of a body or tool.");
  const auto pose = py::arg("pose") = py::none();
  const auto placed = [](const std::optional<Doubles>& at) {
    return at ? pose_of(*at) : Pose{};
  };
  module.def(
      "box",
      [placed](const Vector3& size, const std::optional<Doubles>& at) {
        return make_box(size, placed(at));
      },
      "A box of full extents x, y, z [m].", py::arg("size"), pose);
  module.def(
      "sphere",
      [placed](double radius, const std::optional<Doubles>& at) {
        return make_sphere(radius, placed(at));
      },
      "A sphere [m].", py::arg("radius"), pose);
  module.def(
      "ellipsoid",
      [placed](const Vector3& size, const std::optional<Doubles>& at) {
        return make_ellipsoid(size, placed(at));
      },
      "An ellipsoid of full extents x, y, z [m].", py::arg("size"), pose);
  module.def(
      "cylinder",
      [placed](double radius, double height, const std::optional<Doubles>& at) {
        return make_cylinder(radius, height, placed(at));
      },
      "A cylinder along y [m].", py::arg("radius"), py::arg("height"), pose);
  module.def(
      "capsule",
      [placed](double radius, double height, const std::optional<Doubles>& at) {
        return make_capsule(radius, height, placed(at));
      },
      "A capsule along y, whose height includes its caps [m].", py::arg("radius"),
      py::arg("height"), pose);
  module.def(
      "mesh",
      [placed](const Doubles& vertices, const py::array_t<std::uint32_t>& triangles,
               const std::optional<Doubles>& at) {
        return make_mesh(mesh_of(vertices, triangles), placed(at));
      },
      "A closed mesh: vertices (n, 3) [m], triangles (m, 3).", py::arg("vertices"),
      py::arg("triangles"), pose);
}

/// A body's material is part of the body here: scene["cube"].youngs_modulus = 2e4.
template <double Material::*Number>
void add_number(py::class_<Body>& body, const char* name, const char* text) {
  body.def_property(
      name, [](const Body& from) { return from.material.*Number; },
      [](Body& to, double value) { to.material.*Number = value; }, text);
}

void add_body(py::module_& module) {
  py::enum_<Fixed>(module, "Fixed", "What holds a body.")
      .value("as_in_file", Fixed::kAsInFile)
      .value("bottom_center", Fixed::kBottomCenter)
      .value("bottom_face", Fixed::kBottomFace)
      .value("point", Fixed::kPoint);
  py::class_<Body> body(module, "Body", "An elastic body that is fixed somewhere.");
  body.def(py::init([](std::string name, std::vector<Part> parts) {
             Body made;
             made.name = std::move(name);
             made.parts = std::move(parts);
             return made;
           }),
           py::arg("name"), py::arg("parts"));
  body.def_readwrite("name", &Body::name);
  body.def_property(
      "pose", [](const Body& from) { return array_of(from.pose); },
      [](Body& to, const Doubles& pose) { to.pose = pose_of(pose); },
      "The body's frame in the world: x, y, z, qw, qx, qy, qz.");
  add_number<&Material::youngs_modulus>(body, "youngs_modulus", "E, Pa.");
  add_number<&Material::poisson_ratio>(body, "poisson_ratio", "0 to 0.5.");
  add_number<&Material::density>(body, "density", "kg/m^3.");
  add_number<&Material::static_friction>(body, "static_friction", "At least dynamic_friction.");
  add_number<&Material::dynamic_friction>(body, "dynamic_friction", "At least 0.");
  body.def_readwrite("fixed", &Body::fixed);
  body.def_readwrite("fixed_point", &Body::fixed_point, "m, body: for Fixed.point.");
  body.def_readwrite("contact_model", &Body::contact_model);
  body.def_readwrite("body_model", &Body::body_model);
  body.def_readwrite("tolerance", &Body::tolerance,
                     "Relative error of the torque that 'auto' may choose.");
  body.def("__repr__", [](const Body& from) { return "<torsion.Body '" + from.name + "'>"; });
}

}  // namespace

void add_scene(py::module_& module) {
  add_parts(module);
  add_body(module);
  py::class_<Tool>(module, "Tool", "A rigid tool.")
      .def(py::init([](std::string name, std::vector<Part> parts, double mass) {
             Tool made;
             made.name = std::move(name);
             made.parts = std::move(parts);
             made.mass = mass;
             return made;
           }),
           py::arg("name"), py::arg("parts"), py::arg("mass") = 1.0)
      .def_readwrite("name", &Tool::name)
      .def_readwrite("mass", &Tool::mass, "kg.")
      .def_readwrite("mass_center", &Tool::mass_center, "m, tool; None: the parts' centroid.")
      .def("__repr__", [](const Tool& from) { return "<torsion.Tool '" + from.name + "'>"; });
  py::class_<Scene>(module, "Scene", "Elastic bodies and rigid tools.")
      .def(py::init([](std::vector<Body> bodies, std::vector<Tool> tools) {
             Scene made;
             made.bodies = std::move(bodies);
             made.tools = std::move(tools);
             return made;
           }),
           py::arg("bodies"), py::arg("tools"))
      .def_property_readonly(
          "bodies",
          [](const Scene& scene) {
            std::vector<std::string> names;
            for (const Body& body : scene.bodies) {
              names.push_back(body.name);
            }
            return names;
          },
          "The bodies' names.")
      .def_property_readonly(
          "tools",
          [](const Scene& scene) {
            std::vector<std::string> names;
            for (const Tool& tool : scene.tools) {
              names.push_back(tool.name);
            }
            return names;
          },
          "The tools' names.")
      .def("__getitem__", body_named, py::return_value_policy::reference_internal,
           "The body of that name.")
      .def_readonly("path", &Scene::path, "Of the file; empty for a scene made by code.")
      .def_readonly("duration", &Scene::duration, "s: the end of the file's animations.")
      .def("animation", animation, "Poses of the file's animations, one a step: (steps, tools, 7).",
           py::arg("rate") = 1000.0, py::arg("seconds") = py::none())
      .def("copy", [](const Scene& scene) { return scene; });
  module.def(
      "load", [](const std::string& path) { return value_or_raise(load_scene(path)); },
      "A scene from a .gltf or .glb. Raises ValueError with all that is wrong with the file.",
      py::arg("path"));
}

}  // namespace torsion::python
