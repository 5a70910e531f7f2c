#include <algorithm>

#include "device/scripted_motion.hpp"
#include "ecs/assert.hpp"
#include "ecs/model_names.hpp"
#include "library/convert.hpp"
#include "library/describe_scene.hpp"
#include "library/model_data.hpp"
#include "systems/contact/region_wrenches.hpp"

namespace torsion {
namespace {

/// The engine's options, or what is wrong with those.
Result<engine::PrepareOptions> prepare_options(const Options& options,
                                               const engine::SceneDescription& description) {
  engine::PrepareOptions made;
  made.rate = options.rate;
  const auto contact =
      engine::contact_model_named(options.contact_model.empty() ? "auto" : options.contact_model);
  const auto body =
      engine::body_model_named(options.body_model.empty() ? "auto" : options.body_model);
  if (!contact || !body) {
    return Error{"options: " +
                 (contact ? "body_model is \"" + options.body_model
                          : "contact_model is \"" + options.contact_model) +
                 "\", expected the name of a model or nothing"};
  }
  made.contact_model = *contact;
  made.body_model = *body;
  made.settings.grid_side = options.grid_side;
  made.settings.iterations = options.iterations;
  made.use_cache = options.use_cache;
  made.threads = options.threads;
  made.progress = options.progress;
  made.expected_poses = engine::expected_poses(description);
  if (!options.expected_poses.empty()) {
    made.expected_poses.clear();
  }
  for (const std::vector<Pose>& poses : options.expected_poses) {
    if (poses.size() != description.tools.size()) {
      return Error{"options: expected_poses has a time with " + std::to_string(poses.size()) +
                   " poses, expected one for each of the " +
                   std::to_string(description.tools.size()) + " tools"};
    }
    std::vector<engine::Pose>& at_time = made.expected_poses.emplace_back();
    std::ranges::transform(poses, std::back_inserter(at_time),
                           [](const Pose& pose) { return to_engine(pose); });
  }
  return made;
}

template <class Rows>
std::size_t row_named(const Rows& rows, std::string_view name) {
  const auto found =
      std::ranges::find_if(rows, [name](const auto& row) { return row.name == name; });
  return static_cast<std::size_t>(found - rows.begin());
}

}  // namespace

Model::Model(std::unique_ptr<const Data> data) noexcept : data_(std::move(data)) {}
Model::~Model() = default;

std::size_t Model::body_count() const noexcept {
  return data_->scene.bodies.size();
}

std::size_t Model::tool_count() const noexcept {
  return data_->scene.tools.size();
}

std::size_t Model::body(std::string_view name) const noexcept {
  return row_named(data_->scene.bodies, name);
}

std::size_t Model::tool(std::string_view name) const noexcept {
  return row_named(data_->scene.tools, name);
}

double Model::step_time() const noexcept {
  return data_->model().dt;
}

std::string Model::contact_model(std::size_t body) const {
  TORSION_ASSERT(body < body_count());
  return std::string(engine::name_of(data_->prepared.choices[body].models.contact));
}

std::string Model::body_model(std::size_t body) const {
  TORSION_ASSERT(body < body_count());
  return std::string(engine::name_of(data_->prepared.choices[body].models.body));
}

std::string Model::why(std::size_t body) const {
  TORSION_ASSERT(body < body_count());
  const engine::ModelChoice& choice = data_->prepared.choices[body];
  return choice.contact_why + "; " + choice.body_why;
}

const Scene& Model::scene() const noexcept {
  return data_->scene;
}

Result<std::shared_ptr<const Model>> build(const Scene& scene, const Options& options) {
  Result<engine::SceneDescription> description = describe(scene);
  if (!description) {
    return description.error();
  }
  const Result<engine::PrepareOptions> made = prepare_options(options, description.value());
  if (!made) {
    return made.error();
  }
  auto data = std::make_unique<Model::Data>();
  engine::Result<engine::Simulation> prepared = engine::prepare(description.value(), made.value());
  if (!prepared) {
    return Error{prepared.error().text};
  }
  data->scene = scene;
  data->description = std::move(description).value();
  data->prepared = std::move(prepared).value();
  return std::make_shared<const Model>(std::move(data));
}

std::string describe_faults(std::uint32_t faults) {
  return engine::faults_text(faults);
}

}  // namespace torsion
