#pragma once

#include <glm/vec2.hpp>

#include "app/view/view_state.hpp"

namespace torsion::engine {

/// What colours, arrows and dots stand for, at the upper right of the scene.
/// @param picture  pixels of the window
void draw_legend(const ViewState& state, const glm::dvec2& picture);

}  // namespace torsion::engine
