#pragma once

#include "app/view/view_state.hpp"

namespace torsion::engine {

/// The panel on the right: what a tool feels, as curves over time and over its turn.
void draw_felt_panel(ViewState& state, LiveSession& session);

}  // namespace torsion::engine
