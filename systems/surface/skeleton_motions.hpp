#pragma once

#include "ecs/snapshot.hpp"
#include "ecs/state.hpp"

namespace torsion {

/// Displacements of the anchors of each body whose body model is kSkeleton, summed over its regions
/// in their order of formation: bending, shear, stretch and sideways contraction of a Timoshenko
/// beam from q_f to where p_eq was at rest. Torsion about the beam is left out: the twist angles of
/// the drawn vertices carry it (systems/surface/surface_field.hpp). Source: docs/models.md, "Body
/// model skeleton".
void skeleton_motions(const Model& model, const State& state, Snapshot& snapshot);

}  // namespace torsion
