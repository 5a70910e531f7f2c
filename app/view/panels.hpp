#pragma once

#include "app/live/live_session.hpp"
#include "app/view/view_state.hpp"

namespace torsion::engine {

/// Everything that is written over the scene: state and controls on the left, plots on the right,
/// keys at the bottom, faults and errors across the top. Between Gui::begin() and end().
/// @param now  s, of the window's clock
void draw_panels(ViewState& state, LiveSession& session, double now);

/// Marks in the scene: regions, cells that stick or slip, anchors, what is fixed.
void draw_marks(const ViewState& state, LiveSession& session, const glm::dvec2& picture);

}  // namespace torsion::engine
