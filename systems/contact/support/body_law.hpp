#pragma once

// What a body model is to contacts. systems/laws.cpp has the list of them.

#include <cstdint>

#include "ecs/state.hpp"

namespace torsion {

/// One body model: how the material under a region has been moved by what presses on the body.
struct BodyLaw {
  BodyModel model = BodyModel::kAuto;
  /// The body as a whole deflects under its contacts, and moves the material under each
  /// (RegionSupport).
  bool moves_as_a_whole = false;

  // What it knows of a region when that begins, splits off or ends; null: nothing.
  /// Where a region that begins finds the material: moved by what the body's other regions do to it
  /// now. Without it the first solution would press on the body at rest, and the others would feel
  /// that.
  void (*begin)(const Model& model, State& state, std::uint32_t region) = nullptr;
  /// The same of a region that splits off another one: where that one has it. Of a contact law by
  /// cells `split` has the rest to do, of others the load is shared out by the discs' areas.
  void (*begin_split)(const Model& model, State& state, std::uint32_t from,
                      std::uint32_t region) = nullptr;
  /// A region that has taken a part of another's load: to each of the two what the other one's part
  /// does to it is by another region from now on. For contact laws by cells.
  void (*split)(const Model& model, State& state, std::uint32_t from,
                std::uint32_t region) = nullptr;
  /// A region that has taken over another one's tractions, which that still has, too: what they do
  /// here is by its own load from now on. For contact laws by cells.
  void (*join)(const Model& model, State& state, std::uint32_t ended, std::uint32_t heir) = nullptr;
};

/// @pre model is not kAuto
const BodyLaw& body_law(BodyModel model);

inline const BodyLaw& body_law_of(const Model& model, std::uint32_t body) {
  return body_law(model.bodies.at<BodyModels>(body).body);
}

}  // namespace torsion
