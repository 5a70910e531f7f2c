#include "torsion/simulation.hpp"

#include <cmath>

#include "ecs/assert.hpp"
#include "ecs/hash.hpp"
#include "library/convert.hpp"
#include "library/model_data.hpp"
#include "library/simulation_data.hpp"
#include "systems/contact/tool_load.hpp"
#include "systems/contact/world_region.hpp"
#include "systems/hold/tool_hold.hpp"
#include "systems/math/frames.hpp"

namespace torsion {
namespace {

/// A pose whose quaternion a host may have rounded to float.
engine::Pose unit_pose(const Pose& pose) {
  constexpr double kRounded = 1e-12;  // less is left as it is, to the bit
  engine::Pose made = to_engine(pose);
  const double square = glm::dot(made.rotation, made.rotation);
  if (std::abs(square - 1.0) > kRounded) {
    made.rotation = made.rotation * (1.0 / std::sqrt(square));
  }
  return made;
}

std::unique_ptr<Simulation::Data> make_data(const Model& model, const engine::State& state) {
  auto data = std::make_unique<Simulation::Data>();
  data->state = state;
  data->scratch.reserve(model.data().model(), data->state, &model.data().prepared.scratch->mdr);
  data->poses.resize(model.tool_count());
  return data;
}

/// As the body has moved the region's material by the end of the step.
engine::WorldRegion world_region(const engine::State& state, std::uint32_t row) {
  return {state, row, state.regions.at<engine::RegionSupport>(row)};
}

std::uint32_t row_of(std::size_t row) {
  return static_cast<std::uint32_t>(row);
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  TORSION_ASSERT(model_ != nullptr);
  data_ = make_data(*model_, model_->data().prepared.world.state);
}
Simulation::Simulation(const Simulation& other)
    : model_(other.model_), data_(make_data(*other.model_, other.data_->state)) {}
Simulation& Simulation::operator=(const Simulation& other) {
  if (this != &other) {
    if (model_ == other.model_ && data_ != nullptr) {
      data_->state = other.data_->state;
    } else {
      data_ = make_data(*other.model_, other.data_->state);
    }
    model_ = other.model_;
  }
  return *this;
}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

void Simulation::step(std::span<const Pose> poses) noexcept {
  TORSION_ASSERT(poses.size() == data_->poses.size());
  for (std::size_t tool = 0; tool < poses.size(); ++tool) {
    data_->poses[tool] = unit_pose(poses[tool]);
  }
  engine::step(model_->data().model(), data_->state, data_->poses, data_->scratch);
}

void Simulation::reset() {
  data_->state = model_->data().prepared.world.state;
}

std::uint64_t Simulation::step_count() const noexcept {
  return data_->state.clock.step;
}

double Simulation::time() const noexcept {
  return static_cast<double>(data_->state.clock.step) * model_->step_time();
}

std::uint32_t Simulation::faults() const noexcept {
  return data_->state.clock.faults;
}

std::uint32_t Simulation::faults_ever() const noexcept {
  return data_->state.clock.faults_ever;
}

Pose Simulation::pose(std::size_t tool) const noexcept {
  TORSION_ASSERT(tool < model_->tool_count());
  return from_engine(data_->state.tools.at<engine::ToolPose>(row_of(tool)).now);
}

Wrench Simulation::wrench(std::size_t tool) const noexcept {
  TORSION_ASSERT(tool < model_->tool_count());
  return from_engine(engine::wrench_about_frame(data_->state, row_of(tool)));
}

Wrench Simulation::wrench(std::size_t tool, const Vector3& point) const noexcept {
  TORSION_ASSERT(tool < model_->tool_count());
  const engine::Wrench& total = data_->state.tools.at<engine::ToolWrench>(row_of(tool)).total;
  const glm::dvec3 arm =
      data_->state.tools.at<engine::ToolMotion>(row_of(tool)).mass_center - to_engine(point);
  return {from_engine(total.force), from_engine(total.torque + glm::cross(arm, total.force))};
}

LoadParts Simulation::load_parts(std::size_t tool, const Vector3& point) const noexcept {
  TORSION_ASSERT(tool < model_->tool_count());
  const engine::ToolLoad load = engine::tool_load(data_->state, row_of(tool), to_engine(point));
  return {from_engine(load.normal.force), from_engine(load.friction.force),
          from_engine(load.couple), from_engine(load.normal.torque + load.friction.torque)};
}

Matrix6 Simulation::stiffness(std::size_t tool) const noexcept {
  TORSION_ASSERT(tool < model_->tool_count());
  const engine::ToolBalance balance =
      engine::balance_of(model_->data().model(), data_->state, row_of(tool), {},
                         data_->state.tools.at<engine::ToolPose>(row_of(tool)).now);
  Matrix6 stiffness{};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      stiffness[row][column] =
          balance.stiffness(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    }
  }
  return stiffness;
}

double Simulation::work(std::size_t tool) const noexcept {
  TORSION_ASSERT(tool < model_->tool_count());
  return data_->state.tools.at<engine::ToolWrench>(row_of(tool)).work;
}

std::size_t Simulation::region_count() const noexcept {
  return data_->state.regions.size();
}

Region Simulation::region(std::size_t region) const noexcept {
  TORSION_ASSERT(region < region_count());
  const engine::State& state = data_->state;
  const std::uint32_t row = row_of(region);
  const engine::WorldRegion at = world_region(state, row);
  const engine::RegionIdentity& identity = state.regions.at<engine::RegionIdentity>(row);
  const engine::RegionFrame& frame = state.regions.at<engine::RegionFrame>(row);
  const engine::Contact& contact = state.regions.at<engine::Contact>(row);
  const engine::RegionFriction& friction = state.regions.at<engine::RegionFriction>(row);
  Region made;
  made.id = identity.order;
  made.body = identity.body;
  made.tool = identity.tool;
  made.point = from_engine(at.place(contact.equivalent_point));
  made.normal = from_engine(at.direction(frame.normal));
  made.area = contact.area;
  made.radius = contact.radius;
  made.depth = contact.depth;
  made.normal_force = state.regions.at<engine::RegionNormal>(row).force;
  made.mean_pressure = contact.area > 0.0 ? made.normal_force / contact.area : 0.0;
  made.friction = from_engine(at.direction(engine::tangent_to_body(frame, friction.force)));
  made.couple = friction.couple;
  made.turn = state.regions.at<engine::RegionMotion>(row).turn;
  made.stick_share = friction.stick_share;
  made.stick_radius = friction.stick_radius;
  made.output = from_engine(state.regions.at<engine::RegionWrench>(row).on_tool);
  return made;
}

std::vector<Region> Simulation::regions() const {
  std::vector<Region> made;
  for (std::size_t row = 0; row < region_count(); ++row) {
    made.push_back(region(row));
  }
  return made;
}

std::vector<Cell> Simulation::cells(std::size_t region) const {
  TORSION_ASSERT(region < region_count());
  const engine::State& state = data_->state;
  const engine::WorldRegion at = world_region(state, row_of(region));
  const engine::RegionIdentity& identity = state.regions.at<engine::RegionIdentity>(row_of(region));
  const engine::RegionFrame& frame = state.regions.at<engine::RegionFrame>(row_of(region));
  const std::uint32_t side = model_->data().model().settings.grid_side;
  const auto tractions = state.cells.rows<engine::CellTraction>(identity.cells);
  const auto geometry = state.cells.rows<engine::CellGeometry>(identity.cells);
  const double area = engine::cell_area(frame, side);
  std::vector<Cell> made;
  for (std::uint32_t i = 0; i < tractions.size(); ++i) {
    if (tractions[i].pressure > 0.0) {
      const glm::dvec2 center = engine::cell_center(frame, side, i % side, i / side);
      made.push_back(
          {from_engine(at.place(engine::grid_to_body(frame, {center, geometry[i].height}))),
           area * tractions[i].coverage, tractions[i].pressure,
           from_engine(at.direction(engine::tangent_to_body(frame, tractions[i].traction))),
           tractions[i].sticks != 0});
    }
  }
  return made;
}

std::uint64_t Simulation::hash() const noexcept {
  return engine::hash(data_->state);
}

}  // namespace torsion
