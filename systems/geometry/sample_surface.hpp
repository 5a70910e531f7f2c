#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ecs/scene_description.hpp"

namespace torsion {

/// The rows of one tool: samples of its surface and the tree of balls over them, in the tool's
/// frame.
struct SampledSurface {
  std::vector<SurfaceSample> samples;
  std::vector<SurfaceBall> balls;  // depth first; a leaf's centre is its sample
};

/// Load time: spreads `target_count` samples evenly over the surface of the union of `parts`,
/// however finely their meshes are cut; a crease or a thin wall has samples on both sides. Samples
/// of an exact shape lie on the exact surface, and surface inside another part has none. Every
/// point of the union's surface lies in the ball of a leaf and of all that leaf's ancestors.
/// Depends on nothing but its arguments. Fewer samples only where parts have no area. Empty for no
/// parts.
SampledSurface sample_surface(std::span<const PartDescription> parts, std::uint32_t target_count);

}  // namespace torsion
