#pragma once

#include "app/live/live_session.hpp"
#include "app/view/view_state.hpp"

namespace torsion::engine {

/// Everything that is written over the scene: the panel on the left, what the mouse does at the
/// bottom, faults and errors across the top. Between Gui::begin() and end().
/// @param now  s, of the window's clock
void draw_panels(ViewState& state, LiveSession& session, double now);

/// Marks in the scene: regions, cells that stick or slip, anchors, what is fixed; and what colours
/// and arrows stand for.
void draw_marks(const ViewState& state, LiveSession& session, const Camera& camera,
                const glm::dvec2& picture);

}  // namespace torsion::engine
