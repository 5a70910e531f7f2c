#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "ecs/scene_description.hpp"
#include "systems/mdr/places.hpp"
#include "systems/model/options.hpp"
#include "systems/step.hpp"

namespace torsion::engine {

/// A scene with values over what it says, without what is drawn, and its simulation before the
/// first step.
struct SceneVariant {
  SceneDescription scene;
  Simulation simulation;  // without snapshot tables
};

/// Makes simulations of one scene with many values over it, for studies and fits. What does not
/// depend on a value is prepared once: of Young's modulus, density, friction and mass, all but a
/// copy. Several threads may ask at the same time; the same settings give the same bits as
/// open_session.
class SceneVariants {
 public:
  SceneVariants(SceneDescription scene, PrepareOptions options);
  ~SceneVariants();
  SceneVariants(const SceneVariants&) = delete;
  SceneVariants& operator=(const SceneVariants&) = delete;
  SceneVariants(SceneVariants&&) = delete;
  SceneVariants& operator=(SceneVariants&&) = delete;

  [[nodiscard]] const SceneDescription& scene() const { return scene_; }

  /// @param settings  NODE.KEY=VALUE (app/scene_settings.hpp). Fails where they cannot be, or the
  /// scene cannot be prepared with them
  Result<SceneVariant> make(std::span<const std::string> settings) const;

 private:
  struct Prepared;
  std::shared_ptr<Prepared> prepared_for(const std::string& identity) const;

  SceneDescription scene_;
  PrepareOptions options_;
  MdrTables mdr_tables_;
  // By the settings that tables depend on; the oldest go when there are many.
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::shared_ptr<Prepared>> prepared_;
  mutable std::uint64_t uses_ = 0;
};

}  // namespace torsion::engine
