#include "app/scene_variants.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "app/scene_settings.hpp"
#include "systems/model/prepare.hpp"

namespace torsion::engine {
namespace {

constexpr std::size_t kMostPrepared = 8;  // each has the tables of a whole scene, up to 100 MB

/// Keys that no table is made of (world_of_materials).
constexpr std::array kMaterialKeys = {"youngs_modulus",   "density",  "static_friction",
                                      "dynamic_friction", "friction", "mass"};

bool is_material(const std::string& setting) {
  const std::string name = setting.substr(0, setting.find('='));
  const std::string_view key = std::string_view(name).substr(name.rfind('.') + 1);
  return std::ranges::find(kMaterialKeys, key) != kMaterialKeys.end();
}

/// The settings that tables are made of, in their order.
std::string identity_of_tables(std::span<const std::string> settings) {
  std::string identity;
  for (const std::string& setting : settings) {
    identity += is_material(setting) ? "" : setting + "\n";
  }
  return identity;
}

}  // namespace

/// A scene prepared for some settings, or why it could not be.
struct SceneVariants::Prepared {
  std::once_flag once;
  std::optional<Result<PreparedWorld>> world;
  std::uint64_t last_use = 0;
};

SceneVariants::SceneVariants(SceneDescription scene, PrepareOptions options)
    : scene_(std::move(scene)), options_(std::move(options)), mdr_tables_(make_mdr_tables()) {
  // Every variant has a copy of the scene, and nobody draws them.
  for (BodyDescription& body : scene_.bodies) {
    body.draw = {};
  }
  for (ToolDescription& tool : scene_.tools) {
    tool.draw = {};
  }
}

SceneVariants::~SceneVariants() = default;

std::shared_ptr<SceneVariants::Prepared> SceneVariants::prepared_for(
    const std::string& identity) const {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Prepared>& entry = prepared_[identity];
  if (entry == nullptr) {
    entry = std::make_shared<Prepared>();
  }
  entry->last_use = ++uses_;
  std::shared_ptr<Prepared> found = entry;
  if (prepared_.size() > kMostPrepared) {
    prepared_.erase(std::ranges::min_element(
        prepared_, {}, [](const auto& each) { return each.second->last_use; }));
  }
  return found;
}

Result<SceneVariant> SceneVariants::make(std::span<const std::string> settings) const {
  SceneVariant variant{scene_, {}};
  if (const Result<Done> done = apply_settings(settings, variant.scene); !done) {
    return done.error();
  }
  const std::shared_ptr<Prepared> prepared = prepared_for(identity_of_tables(settings));
  std::call_once(prepared->once,
                 [&] { prepared->world = prepare_unit_world(variant.scene, options_); });
  const Result<PreparedWorld>& world = *prepared->world;
  if (!world) {
    return Error{scene_.path + ": " + world.error().text};
  }
  variant.simulation = simulation_of_materials(world.value(), variant.scene, mdr_tables_);
  return variant;
}

}  // namespace torsion::engine
