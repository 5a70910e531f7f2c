#pragma once

#include "app/live/live_session.hpp"
#include "app/view/view_state.hpp"

namespace torsion::engine {

/// What a tool feels, as curves over time and over its turn.
void draw_felt(ViewState& state, const LiveSession& session);

/// How the physics thread keeps its clock, and a device its rate.
void draw_timing_plots(ViewState& state, const LiveSession& session);

}  // namespace torsion::engine
