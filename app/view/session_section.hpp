#pragma once

#include "app/live/live_session.hpp"
#include "app/view/view_state.hpp"

namespace torsion::engine {

/// The scenes to choose from: cards, four in a row, then lines for those without a picture.
void draw_gallery_cards(ViewState& state);

/// What is felt now, in numbers, and what holds the tool.
void draw_state_lines(const ViewState& state, const LiveSession& session);

/// Time, and what is kept of the session.
void draw_controls(ViewState& state);

}  // namespace torsion::engine
