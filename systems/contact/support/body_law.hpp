#pragma once

// What a body model is to contacts. systems/laws.cpp has the list of them.

#include <cstdint>

#include <glm/vec3.hpp>

#include "ecs/state.hpp"

namespace torsion::engine {

/// A spot of a body's rest surface.
struct SurfaceSpot {
  glm::dvec3 point{0.0};   // m, body
  glm::dvec3 normal{0.0};  // body, unit, outward
  double radius = 0.0;     // m
};

/// One body model: how the material under a region has been moved by what presses on the body.
struct BodyLaw {
  BodyModel model = BodyModel::kAuto;
  /// The body as a whole deflects under its contacts, and moves the material under each
  /// (RegionSupport).
  bool moves_as_a_whole = false;

  /// Where the body's regions, but for a tool's, have moved the material of a spot: a point of it
  /// at rest at x is at to_outer(result, x), body. Null: nowhere.
  Pose (*motion_at)(const Model& model, State& state, std::uint32_t body, std::uint32_t tool,
                    const SurfaceSpot& spot) = nullptr;

  // What it knows of a region when that begins, splits off or ends; null: nothing.
  /// A region begins: finds where the body's other regions have moved the material under it.
  /// Without it the first solution would press on the body at rest, and the other regions would
  /// feel that.
  void (*begin)(const Model& model, State& state, std::uint32_t region) = nullptr;
  /// A region's cells have been found: where that is for the first time, finds how the body answers
  /// to its load, for contact models that know that. A body that stood still under their first
  /// solution would push back as if it were held, and then leap away.
  void (*begin_answer)(const Model& model, State& state, std::uint32_t region) = nullptr;
  /// A region splits off another one: the material is where that one has it. With a contact law by
  /// cells `split` follows; with another one the load is shared out here, by the discs' areas.
  void (*begin_split)(const Model& model, State& state, std::uint32_t from,
                      std::uint32_t region) = nullptr;
  /// A region has taken a part of another one's load: what that part does to the other one counts
  /// as done by another region from now on, and the other way round. For contact laws by cells.
  void (*split)(const Model& model, State& state, std::uint32_t from,
                std::uint32_t region) = nullptr;
  /// A region has taken over another one's tractions (that one's row still has them, too): what
  /// they do to it counts as done by its own load from now on. For contact laws by cells.
  void (*join)(const Model& model, State& state, std::uint32_t ended, std::uint32_t heir) = nullptr;
};

/// @pre model is not kAuto
const BodyLaw& body_law(BodyModel model);

inline const BodyLaw& body_law_of(const Model& model, std::uint32_t body) {
  return body_law(model.bodies.at<BodyModels>(body).body);
}

}  // namespace torsion::engine
