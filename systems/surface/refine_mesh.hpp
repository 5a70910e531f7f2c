#pragma once

#include <cstdint>

#include "ecs/components.hpp"
#include "ecs/scene_description.hpp"

namespace torsion::engine {

/// How finely a mesh is to be drawn.
struct DrawnDetail {
  double everywhere = 0.0;  // m: the longest edge; > 0
  bool touched = false;     // somewhere
  Bounds where;             // m, the mesh's frame: there
  double there = 0.0;       // m: the longest edge there; grows by half of the distance from it; > 0
  std::size_t most_triangles = 20'000;
};

/// Cuts the triangles of a drawn mesh until their edges are as short as that, so that a body of few
/// vertices shows dent and twist. The surface stays the same, closed where it was: edges at one
/// place are cut alike, however the file splits their vertices. Where that would take more than
/// `most_triangles`, edges are longer in proportion; a mesh that has more already stays as it is.
/// Triangles are halved by their longest edges (Rivara, Int. J. Numer. Methods Eng. 20, 1984), so
/// that none gets much more slender than it was.
void refine_mesh(DrawMesh& mesh, const DrawnDetail& detail);

}  // namespace torsion::engine
