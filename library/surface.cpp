#include "torsion/surface.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "ecs/assert.hpp"
#include "library/convert.hpp"
#include "library/model_data.hpp"
#include "library/simulation_data.hpp"
#include "systems/surface/surface_field.hpp"
#include "systems/surface/take_snapshot.hpp"

namespace torsion {

struct Snapshot::Data {
  std::shared_ptr<const Model> model;
  engine::Snapshot snapshot;
};

Snapshot::Snapshot(const Simulation& simulation) : data_(std::make_unique<Data>()) {
  data_->model = simulation.shared_model();
  data_->snapshot.reserve(data_->model->data().model(), simulation.data().state);
  take(simulation);
}
Snapshot::Snapshot(const Snapshot& other) : data_(std::make_unique<Data>(*other.data_)) {}
Snapshot& Snapshot::operator=(const Snapshot& other) {
  *data_ = *other.data_;
  return *this;
}
Snapshot::Snapshot(Snapshot&&) noexcept = default;
Snapshot& Snapshot::operator=(Snapshot&&) noexcept = default;
Snapshot::~Snapshot() = default;

void Snapshot::take(const Simulation& simulation) noexcept {
  TORSION_ASSERT(simulation.shared_model() == data_->model);
  const Model::Data& model = data_->model->data();
  engine::take_snapshot(model.model(), simulation.data().state, *model.prepared.snapshot_tables,
                        data_->snapshot);
}

double Snapshot::time() const noexcept {
  return data_->snapshot.clock.time;
}

Pose Snapshot::pose(std::size_t tool) const noexcept {
  TORSION_ASSERT(tool < data_->model->tool_count());
  return from_engine(
      data_->snapshot.tools.at<engine::ToolPose>(static_cast<std::uint32_t>(tool)).now);
}

struct Surface::Data {
  std::shared_ptr<const Model> model;
  std::uint32_t body = 0;
  engine::FrameWorld frame;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<glm::vec4> deformed;
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;
  std::vector<float> twist;

  /// From the triangles around each vertex, weighted with their areas.
  void find_normals() {
    std::vector<glm::vec3> sums(positions.size(), glm::vec3(0.0F));
    for (const std::array<std::uint32_t, 3>& t : triangles) {
      const glm::vec3 a(deformed[t[0]]);
      const glm::vec3 twice_area =
          glm::cross(glm::vec3(deformed[t[1]]) - a, glm::vec3(deformed[t[2]]) - a);
      for (const std::uint32_t corner : t) {
        sums[corner] += twice_area;
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const float length = glm::length(sums[i]);
      const glm::vec3 normal = length > 0.0F ? sums[i] / length : glm::vec3(0.0F);
      normals[i] = {normal.x, normal.y, normal.z};
    }
  }
};

Surface::Surface(std::shared_ptr<const Model> model, std::size_t body, const Mesh& mesh)
    : data_(std::make_unique<Data>()) {
  TORSION_ASSERT(body < model->body_count());
  data_->body = static_cast<std::uint32_t>(body);
  data_->triangles = mesh.triangles;
  // The frame of a scene in which this mesh alone is drawn.
  engine::SceneDescription description = model->data().description;
  for (engine::BodyDescription& each : description.bodies) {
    each.draw = {};
  }
  for (engine::ToolDescription& each : description.tools) {
    each.draw = {};
  }
  engine::DrawMesh& draw = description.bodies[body].draw;
  for (const Vector3& vertex : mesh.vertices) {
    draw.positions.emplace_back(to_engine(vertex));
    draw.normals.emplace_back(0.0F, 1.0F, 0.0F);
    draw.fixed.push_back(false);
  }
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    TORSION_ASSERT(std::max({t[0], t[1], t[2]}) < mesh.vertices.size());
    draw.triangles.emplace_back(t[0], t[1], t[2]);
  }
  const engine::Simulation& prepared = model->data().prepared;
  data_->frame = engine::prepare_frame(description, prepared.world.model, prepared.world.state);
  data_->deformed.resize(mesh.vertices.size());
  data_->positions.resize(mesh.vertices.size());
  data_->normals.resize(mesh.vertices.size());
  data_->twist.resize(mesh.vertices.size());
  data_->model = std::move(model);
}
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;
Surface::~Surface() = default;

void Surface::update(const Snapshot& snapshot) {
  TORSION_ASSERT(snapshot.data().model == data_->model);
  engine::surface_field(data_->model->data().model(), snapshot.data().snapshot, data_->frame);
  engine::deform_vertices(data_->frame, data_->body, data_->deformed);
  for (std::size_t i = 0; i < data_->deformed.size(); ++i) {
    const glm::vec4& at = data_->deformed[i];
    data_->positions[i] = {at.x, at.y, at.z};
    data_->twist[i] = at.w;
  }
  data_->find_normals();
}

std::span<const std::array<float, 3>> Surface::positions() const noexcept {
  return data_->positions;
}

std::span<const std::array<float, 3>> Surface::normals() const noexcept {
  return data_->normals;
}

std::span<const float> Surface::twist() const noexcept {
  return data_->twist;
}

}  // namespace torsion
