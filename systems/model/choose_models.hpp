#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ecs/model.hpp"
#include "systems/model/options.hpp"

namespace torsion::engine {

/// What the tools will do to a body, as far as their expected poses tell.
struct ExpectedContact {
  bool known = false;       // false: the tools are moved by hand, so everything is possible
  bool any = false;         // a tool touches the body at all
  bool single = true;       // one region at a time
  bool smooth = true;       // touched by exact shapes without edges only: mdr knows their curvature
  bool round = true;        // by spheres only, and the body is no ellipsoid, cylinder or capsule
  bool slides = false;      // while it turns about the normal
  double rolled = 0.0;      // over the radius: how far it rolls since it began, the farthest
  double elongation = 1.0;  // length over width, of those with edges that are long: the largest
  double depth = 0.0;       // m, largest
  double radius = 0.0;      // m: largest of the overlap
  double body_depth = 0.0;  // m: from the contact to what holds the body, the least
  Bounds touched;           // m, body: around all points that are touched, where there are any
};

/// Looks where the samples of all tools come to lie in `body` on their expected poses.
/// @param model  shapes, samples, tools and bodies are there
/// @param poses  (times) of (tools); empty: unknown
ExpectedContact expect_contact(const Model& model, std::uint32_t body,
                               std::span<const std::vector<Pose>> poses);

/// What contact model mdr misses of the torque, over its largest, on such a contact of a body with
/// body model compliance, as measured. @pre known, any and smooth
double mdr_error(const ExpectedContact& contact, double poisson_ratio);

/// The largest known error of the torque, over its largest, of the chosen contact model at such
/// contacts and the cells that it is given; nothing where it was not measured: of `paper`, and of
/// mdr where a contact has edges.
/// @pre known and any
std::optional<double> model_error(const ModelChoice& choice, const ExpectedContact& contact,
                                  double poisson_ratio);

/// What runs for a body: what `options` insist on, else what the scene says, else the cheapest
/// models whose known errors (docs/models.md) are within the body's tolerance.
ModelChoice choose_models(const BodyModels& scene, const PrepareOptions& options,
                          const ExpectedContact& contact, double poisson_ratio);

/// Cells along a side of a region's grid for models of this tolerance where the user leaves it
/// open: as few as keep the error of `patch` within it, and 16 for `paper`.
std::uint32_t choose_grid_side(std::span<const ModelChoice> choices);

}  // namespace torsion::engine
