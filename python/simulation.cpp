#include <cstring>

#include "python/module.hpp"

namespace torsion::python {
namespace {

/// One tool in one step, as Simulation.run() gives it.
struct TraceRow {
  double time;       // s
  double force[3];   // N
  double torque[3];  // N m, about the tool's frame
  double normal_force;
  double couple;  // N m, about the normals: the sum of the regions'
  double stick_share;
  double work;  // J
  std::uint32_t regions;
  std::uint32_t faults;
};

struct RegionRow {
  std::uint64_t id;
  std::uint64_t body;
  std::uint64_t tool;
  double point[3];
  double normal[3];
  double area;
  double radius;
  double depth;
  double normal_force;
  double mean_pressure;
  double friction[3];
  double couple;
  double turn;
  double stick_share;
  double stick_radius;
};

struct CellRow {
  double point[3];
  double area;
  double pressure;
  double traction[3];
  std::uint32_t sticks;
  std::uint32_t padding;
};

void copy(const Vector3& from, double* to) {
  std::memcpy(to, from.data(), sizeof from);
}

TraceRow trace_row(const Simulation& simulation, std::size_t tool, double time) {
  TraceRow row{};
  row.time = time;
  const Wrench wrench = simulation.wrench(tool);
  copy(wrench.force, row.force);
  copy(wrench.torque, row.torque);
  double area = 0.0;
  for (std::size_t k = 0; k < simulation.region_count(); ++k) {
    const Region region = simulation.region(k);
    if (region.tool == tool) {
      row.normal_force += region.normal_force;
      row.couple += region.couple;
      row.stick_share += region.area * region.stick_share;
      area += region.area;
      ++row.regions;
    }
  }
  row.stick_share = area > 0.0 ? row.stick_share / area : 0.0;
  row.work = simulation.work(tool);
  row.faults = simulation.faults();
  return row;
}

/// Steps through poses of (steps, tools, 7) without the interpreter.
py::array_t<TraceRow> run(Simulation& simulation, const Doubles& poses) {
  const std::size_t tools = simulation.model().tool_count();
  if (poses.ndim() != 3 || static_cast<std::size_t>(poses.shape(1)) != tools ||
      poses.shape(2) != kPoseNumbers) {
    throw py::value_error("expected poses of shape (steps, " + std::to_string(tools) +
                          ", 7): x, y, z, qw, qx, qy, qz of each tool in each step");
  }
  const py::ssize_t steps = poses.shape(0);
  py::array_t<TraceRow> trace({steps, poses.shape(1)});
  TraceRow* row = trace.mutable_data();
  const double* numbers = poses.data();
  const py::gil_scoped_release without_interpreter;
  std::vector<Pose> at(tools);
  for (py::ssize_t step = 0; step < steps; ++step) {
    for (Pose& pose : at) {
      std::memcpy(pose.position.data(), numbers, sizeof pose.position);
      std::memcpy(pose.orientation.data(), numbers + 3, sizeof pose.orientation);
      numbers += kPoseNumbers;
    }
    const double time = simulation.time();
    simulation.step(at);
    for (std::size_t tool = 0; tool < tools; ++tool) {
      *row++ = trace_row(simulation, tool, time);
    }
  }
  return trace;
}

std::unique_ptr<OwnedSimulation> copy_of(const Simulation& simulation) {
  return std::make_unique<OwnedSimulation>(simulation);
}

void step_once(Simulation& simulation, const Doubles& poses) {
  const std::vector<Pose> at = poses_of(poses, simulation.model().tool_count());
  const py::gil_scoped_release without_interpreter;
  simulation.step(at);
}

RegionRow row_of(const Region& region) {
  RegionRow row{};
  row.id = region.id;
  row.body = region.body;
  row.tool = region.tool;
  copy(region.point, row.point);
  copy(region.normal, row.normal);
  row.area = region.area;
  row.radius = region.radius;
  row.depth = region.depth;
  row.normal_force = region.normal_force;
  row.mean_pressure = region.mean_pressure;
  copy(region.friction, row.friction);
  row.couple = region.couple;
  row.turn = region.turn;
  row.stick_share = region.stick_share;
  row.stick_radius = region.stick_radius;
  return row;
}

py::array_t<RegionRow> regions_of(const Simulation& simulation) {
  py::array_t<RegionRow> rows(static_cast<py::ssize_t>(simulation.region_count()));
  for (std::size_t k = 0; k < simulation.region_count(); ++k) {
    rows.mutable_data()[k] = row_of(simulation.region(k));
  }
  return rows;
}

py::array_t<CellRow> cells_of(const Simulation& simulation, std::size_t region) {
  if (region >= simulation.region_count()) {
    throw py::index_error("there is no region " + std::to_string(region));
  }
  const std::vector<Cell> cells = simulation.cells(region);
  py::array_t<CellRow> rows(static_cast<py::ssize_t>(cells.size()));
  CellRow* row = rows.mutable_data();
  for (const Cell& cell : cells) {
    CellRow made{};
    copy(cell.point, made.point);
    made.area = cell.area;
    made.pressure = cell.pressure;
    copy(cell.traction, made.traction);
    made.sticks = cell.sticks ? 1 : 0;
    *row++ = made;
  }
  return rows;
}

std::size_t tool_of(const Simulation& simulation, std::size_t tool) {
  if (tool >= simulation.model().tool_count()) {
    throw py::index_error("there is no tool " + std::to_string(tool));
  }
  return tool;
}

py::array_t<double> wrench_of(const Simulation& simulation, std::size_t tool,
                              const std::optional<Doubles>& about) {
  tool_of(simulation, tool);
  return array_of(about ? simulation.wrench(tool, vector_of(*about)) : simulation.wrench(tool));
}

py::dict load_parts_of(const Simulation& simulation, std::size_t tool,
                       const std::optional<Doubles>& about) {
  tool_of(simulation, tool);
  const LoadParts parts =
      simulation.load_parts(tool, about ? vector_of(*about) : simulation.pose(tool).position);
  py::dict made;
  made["normal_force"] = array_of(parts.normal_force);
  made["friction"] = array_of(parts.friction);
  made["couple"] = array_of(parts.couple);
  made["lever_torque"] = array_of(parts.lever_torque);
  return made;
}

py::array_t<double> stiffness_of(const Simulation& simulation, std::size_t tool) {
  const Matrix6 stiffness = simulation.stiffness(tool_of(simulation, tool));
  py::array_t<double> array({6, 6});
  std::memcpy(array.mutable_data(), stiffness.data(), sizeof stiffness);
  return array;
}

std::shared_ptr<const Model> build_model(const Scene& scene, double rate,
                                         const std::string& contact_model,
                                         const std::string& body_model, std::uint32_t grid_side,
                                         std::uint32_t iterations, bool use_cache,
                                         std::uint32_t threads) {
  Options options;
  options.rate = rate;
  options.contact_model = contact_model;
  options.body_model = body_model;
  options.grid_side = grid_side;
  options.iterations = iterations;
  options.use_cache = use_cache;
  options.threads = threads;
  Result<std::shared_ptr<const Model>> model = [&] {
    const py::gil_scoped_release without_interpreter;
    return build(scene, options);
  }();
  return value_or_raise(std::move(model));
}

void add_model(py::module_& module) {
  // pybind11 knows no holder of constants; nothing of a Model can be changed.
  py::class_<Model, std::shared_ptr<Model>>(module, "Model",
                                            "A scene, prepared: immutable, for any number of "
                                            "simulations.")
      .def_property_readonly("bodies", &Model::body_count, "How many bodies there are.")
      .def_property_readonly("tools", &Model::tool_count, "How many tools there are.")
      .def_property_readonly("step_time", &Model::step_time, "s.")
      .def("contact_model", &Model::contact_model, py::arg("body") = 0)
      .def("body_model", &Model::body_model, py::arg("body") = 0)
      .def("why", &Model::why, "Why these models, in words.", py::arg("body") = 0);
  module.def(
      "build",
      [](const Scene& scene, double rate, const std::string& contact_model,
         const std::string& body_model, std::uint32_t grid_side, std::uint32_t iterations,
         bool use_cache, std::uint32_t threads) {
        return std::const_pointer_cast<Model>(build_model(
            scene, rate, contact_model, body_model, grid_side, iterations, use_cache, threads));
      },
      "Prepares a scene. Raises ValueError with all that is wrong with it.", py::arg("scene"),
      py::arg("rate") = 1000.0, py::arg("contact_model") = "", py::arg("body_model") = "",
      py::arg("grid_side") = 0, py::arg("iterations") = 2, py::arg("use_cache") = false,
      py::arg("threads") = 1);
}

}  // namespace

void add_simulation(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(TraceRow, time, force, torque, normal_force, couple, stick_share, work,
                       regions, faults);
  PYBIND11_NUMPY_DTYPE(RegionRow, id, body, tool, point, normal, area, radius, depth, normal_force,
                       mean_pressure, friction, couple, turn, stick_share, stick_radius);
  PYBIND11_NUMPY_DTYPE(CellRow, point, area, pressure, traction, sticks);
  add_model(module);
  const auto tool = py::arg("tool") = 0;
  const auto about = py::arg("about") = py::none();
  py::class_<OwnedSimulation>(module, "Simulation", "What steps change. A copy goes on by itself.")
      .def(py::init([](std::shared_ptr<Model> model) {
             return std::make_unique<OwnedSimulation>(Simulation(std::move(model)));
           }),
           py::arg("model").none(false))
      .def("copy", exclusive(copy_of))
      .def("__copy__", exclusive(copy_of))
      .def("step", exclusive(step_once),
           "One step with the tools at these poses: (tools, 7), or (7) for one tool.",
           py::arg("poses"))
      .def("run", exclusive(run),
           "Steps through poses of (steps, tools, 7); gives a structured array of (steps, tools).",
           py::arg("poses"))
      .def("reset", exclusive(+[](Simulation& simulation) { simulation.reset(); }),
           "Goes back to before the first step.")
      .def_property_readonly(
          "time", exclusive(+[](const Simulation& simulation) { return simulation.time(); }),
          "s, of the next step.")
      .def_property_readonly(
          "faults", exclusive(+[](const Simulation& simulation) { return simulation.faults(); }),
          "Bits, of the last step.")
      .def_property_readonly(
          "hash", exclusive(+[](const Simulation& simulation) { return simulation.hash(); }))
      .def("pose", exclusive(+[](const Simulation& simulation, std::size_t row) {
             return array_of(simulation.pose(tool_of(simulation, row)));
           }),
           "x, y, z, qw, qx, qy, qz.", tool)
      .def("wrench", exclusive(wrench_of),
           "Force [N] and torque [N m] on the tool, about its frame or a point: (6).", tool, about)
      .def("load_parts", exclusive(load_parts_of),
           "The load in parts: the contact couple apart from r x F, about the tool's frame or a "
           "point.",
           tool, about)
      .def("stiffness", exclusive(stiffness_of),
           "6 x 6, about the mass centre: shifts, then turns.", tool)
      .def("work", exclusive(+[](const Simulation& simulation, std::size_t row) {
             return simulation.work(tool_of(simulation, row));
           }),
           "J, done by the tool's holder.", tool)
      .def("regions", exclusive(regions_of), "A structured array, one row a contact.")
      .def("cells", exclusive(cells_of), "A structured array, one row a cell with pressure.",
           py::arg("region") = 0);
  module.def("describe_faults", describe_faults, "The faults in words, one a line.",
             py::arg("faults"));
}

}  // namespace torsion::python
