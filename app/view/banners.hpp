#pragma once

#include "app/view/view_state.hpp"

namespace torsion::engine {

/// Faults, devices that are gone, scenes that cannot be read, what was just done: across the top.
/// @param now  s, of the window's clock
void draw_banners(const ViewState& state, const LiveSession& session, double now);

}  // namespace torsion::engine
