#pragma once

#include "systems/contact/step_context.hpp"

namespace torsion::engine {

/// Finds the points of every tool's surface that lie inside a body's rest shape (section II.B of
/// the paper): samples found through the tool's tree of balls, and, between samples, the deepest
/// points that a descent along the surface reaches, so that a contact is seen when it begins and
/// not when it has grown to a sample. A tool's first contact is sought where other tools have moved
/// the body's material (moved_surface.hpp). Fills ContactScratch::pairs and ContactScratch::points.
/// The cost grows with the samples near the body, not with the meshes.
void detect_contacts(StepContext& context);

}  // namespace torsion::engine
