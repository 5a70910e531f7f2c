#pragma once

#include "app/live/live_session.hpp"
#include "app/view/view_state.hpp"

namespace torsion::engine {

/// Cards of the scenes to choose from, four in a row.
void draw_gallery_cards(ViewState& state);

/// What is felt now, in numbers, and what holds the tool.
void draw_state_lines(const ViewState& state, const LiveSession& session);

/// Time, and what is kept of the session.
void draw_controls(ViewState& state);

}  // namespace torsion::engine
