#pragma once

#include "app/live/live_session.hpp"
#include "app/view/view_state.hpp"

namespace torsion::engine {

/// Headers to unfold: model and material, moves of the tool, what is shown, keys, timing.
void draw_settings(ViewState& state, LiveSession& session);

}  // namespace torsion::engine
