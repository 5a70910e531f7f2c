#pragma once

#include <string>

#include "app/deformed_scene.hpp"

namespace torsion::engine {

/// One page of HTML that plays a run in three dimensions: bodies in the colours of their twist,
/// tools with the force on them, and force and torque over time. All that it needs is inside,
/// three.js too; nothing is fetched.
/// @param session  of the run, for what the scene says of itself
/// @pre the run has a moment
std::string run_page(const Session& session, const DeformedRun& run);

/// For a page that shows several runs, each in a frame of its own: what all of them need, as JSON
/// that may stand in a script element: {page, three, orbit, view}. A frame's text is `page` with
/// what stands for each name between percent signs.
std::string run_page_parts();

/// What a frame has of its own for %DATA%, likewise.
std::string run_page_data(const Session& session, const DeformedRun& run);

}  // namespace torsion::engine
