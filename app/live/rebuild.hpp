#pragma once

#include <vector>

#include "app/live/input_entry.hpp"
#include "app/session.hpp"

namespace torsion::engine {

/// What each body of the scene is, with what was chosen over it in `options`.
std::vector<BodyPick> picks_of(const SceneDescription& scene, const PrepareOptions& options);

/// Puts the picks into the scene. @pre as many picks as bodies
void apply_picks(const std::vector<BodyPick>& picks, SceneDescription& scene);

/// Time, tools' places and work so far of `from`, so that `to`, prepared of the same scene with
/// other materials or models, goes on where `from` was. Contacts form anew. Allocates nothing.
void carry_over(const World& from, World& to);

}  // namespace torsion::engine
