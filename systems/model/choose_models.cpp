#include "systems/model/choose_models.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ecs/model_names.hpp"
#include "systems/contact/group_points.hpp"
#include "systems/contact/law.hpp"
#include "systems/contact/region_grid.hpp"
#include "systems/geometry/distance.hpp"
#include "systems/geometry/surface_piece.hpp"
#include "systems/math/frames.hpp"
#include "systems/model/expected_rolling.hpp"

namespace torsion::engine {
namespace {

// Largest errors of the torque over its largest value as `torsion report` measures them
// (docs/models.md, "Which model"; tests/app/report_test.cpp holds the report to them).
constexpr double kMdrRoundError = 0.003;  // a round contact that slides or turns
constexpr double kMdrLongError = 0.025;   // a long one
// Of a contact that does both at once. Measured not by the report but against patch, where the
// directions of slip and turn change in turn (patch_mdr_ball_test.cpp).
constexpr double kMdrCombinedError = 0.07;
// Times the contact radii rolled, at most the whole torque: mdr's springs stay with the contact,
// while the rolling material takes its deflection along (mdr_rolling_test.cpp).
constexpr double kMdrRollingError = 0.95;
constexpr double kMdrCoupling = 0.095;    // times 1 - 2 nu: pressure moves the surface sideways
constexpr double kMdrWideError = 0.095;   // times contact radius over body depth: shape unknown
constexpr double kFiniteBodyError = 1.1;  // of the force, times contact radius over body depth
// Of contact model patch with the cells that it gets for long contacts with edges, such as a
// blade's that turns by 90 degrees. Against finer grids: 0.05 to 0.06 for 8 x 1.2 mm on gel,
// depending on rounding, against 2500 cells (long_contact_test.cpp); 0.02, 0.04 and 0.04 for 3 : 1,
// 6 : 1 and 10 : 1 on a half-space, 0.06 for 15 : 1; 0.006 to 0.03 on average.
constexpr double kLongEdgedError = 0.07;
constexpr double kSlenderEdgedError = 0.09;
constexpr double kSlender = 8.0;              // times the width
constexpr std::size_t kFewestPoints = 12;     // points that tell how long a contact is
constexpr double kSlidesWhileTurning = 0.05;  // of the radius, between two expected poses
constexpr double kTellsOfRolling = 0.02;      // of the torque: less is not worth a word
constexpr double kTurnsWhileSliding = 1e-3;   // rad between two expected poses: less is no turn

/// A contact found at one time.
struct Touch {
  std::vector<glm::dvec3> points;  // m, body: samples inside the body
  double depth = 0.0;              // m
  glm::dvec3 normal{0.0};          // body, at the deepest
  glm::dvec3 center{0.0};          // m, body: mean of the points
  bool smooth = true;              // as in ExpectedContact
  bool round = true;
  std::vector<TouchedPlace> places;
  double rolled = 0.0;  // m: the farthest of the places
};

/// The part on whose surface, or nearest to whose surface, a point of its owner's frame lies.
const ShapePart& part_at(const Model& model, Range parts, const glm::dvec3& point) {
  std::uint32_t at = parts.first;
  double nearest = 1e300;
  for (std::uint32_t row = parts.first; row < parts.first + parts.count; ++row) {
    const double distance = std::abs(signed_distance(model, {row, 1}, point).value);
    if (distance < nearest) {
      nearest = distance;
      at = row;
    }
  }
  return model.parts.at<ShapePart>(at);
}

/// Whether the body's surface has an edge that is nearer to `point` than the next sample, so that
/// it cuts the contact off.
/// @param point    m, body
/// @param spacing  m, of the samples
bool near_edge(const ShapePart& part, const glm::dvec3& point, double spacing) {
  if (part.kind != ShapeKind::kBox && part.kind != ShapeKind::kCylinder) {
    return false;
  }
  const SurfacePiece piece = piece_at(part, to_inner(part.pose, point));
  return std::ranges::any_of(
      piece.ends(), [spacing](const PieceBorder& border) { return border.distance < spacing; });
}

bool makes_long_contacts(ShapeKind kind) {
  return kind == ShapeKind::kEllipsoid || kind == ShapeKind::kCylinder ||
         kind == ShapeKind::kCapsule;
}

/// @param before  at the pose before
void touch_with_tool(const Model& model, std::uint32_t body, std::uint32_t tool, const Pose& pose,
                     std::span<const TouchedPlace> before, Touch& touch) {
  const Pose& body_pose = model.bodies.at<Pose>(body);
  const Range parts = model.bodies.at<OwnedRows>(body).parts;
  const OwnedRows& owned = model.tools.at<OwnedRows>(tool);
  std::vector<TouchingPoint> points;
  for (const SurfaceSample& sample : model.samples.rows<SurfaceSample>(owned.samples)) {
    const glm::dvec3 point = to_inner(body_pose, to_outer(pose, sample.position));
    const Distance distance = signed_distance(model, parts, point);
    if (distance.value < 0.0) {
      const ShapePart& part = part_at(model, owned.parts, sample.position);
      touch.points.push_back(point);
      points.push_back({point, sample.position, -distance.value, &part});
      if (-distance.value > touch.depth) {
        touch.depth = -distance.value;
        touch.normal = distance.gradient;
      }
      const ShapeKind kind = part.kind;
      touch.smooth = touch.smooth &&
                     !near_edge(part_at(model, parts, point), point, sample.spacing) &&
                     (kind == ShapeKind::kSphere || kind == ShapeKind::kEllipsoid ||
                      kind == ShapeKind::kCapsule);
      touch.round = touch.round && kind == ShapeKind::kSphere;
    }
  }
  const glm::dquat tool_to_body = glm::conjugate(body_pose.rotation) * pose.rotation;
  for (const TouchedPlace& place : touched_places(model, body, tool, pose, points, before)) {
    touch.rolled = std::max(touch.rolled, rolled_way(place, tool_to_body));
    touch.places.push_back(place);
  }
}

Touch touch_with_tools(const Model& model, std::uint32_t body, std::span<const Pose> poses,
                       std::span<const TouchedPlace> before) {
  Touch touch;
  for (std::uint32_t tool = 0; tool < model.tools.size(); ++tool) {
    touch_with_tool(model, body, tool, poses[tool], before, touch);
  }
  for (const glm::dvec3& point : touch.points) {
    touch.center += point / static_cast<double>(touch.points.size());
  }
  return touch;
}

/// Distance from `point` to the body's fixed part, m.
double distance_to_fixed(const Model& model, std::uint32_t body, const glm::dvec3& point) {
  const FixedRegion& fixed = model.bodies.at<FixedRegion>(body);
  return fixed.kind == FixedKind::kFace ? std::abs(glm::dot(point - fixed.point, fixed.normal))
                                        : glm::distance(point, fixed.point);
}

/// Widest half extent of the groups of points, and the number of groups.
std::pair<double, std::uint32_t> extent_of_groups(std::span<const glm::dvec3> points,
                                                  double threshold) {
  std::vector<std::uint32_t> order(points.size());
  std::vector<std::uint32_t> parent(points.size());
  std::vector<std::uint32_t> groups(points.size());
  const std::uint32_t count = group_points(points, threshold, no_links(parent), order, groups);
  double radius = 0.0;
  for (std::uint32_t group = 0; group < count; ++group) {
    glm::dvec3 lowest(1e300);
    glm::dvec3 highest(-1e300);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (groups[i] == group) {
        lowest = glm::min(lowest, points[i]);
        highest = glm::max(highest, points[i]);
      }
    }
    const glm::dvec3 half = 0.5 * (highest - lowest);
    radius = std::max(radius, std::max({half.x, half.y, half.z}));
  }
  return {radius, count};
}

/// Length over width of the contact; 1 where the points are too few to tell.
double elongation_of(const Touch& touch) {
  if (touch.points.size() < kFewestPoints) {
    return 1.0;
  }
  RegionFrame plane;
  turn_normal_to(plane, glm::normalize(touch.normal));
  SecondMoments sum;
  for (const glm::dvec3& point : touch.points) {
    const glm::dvec3 at = body_to_grid_direction(plane, point - touch.center);
    sum.xx += at.x * at.x;
    sum.xy += at.x * at.y;
    sum.yy += at.y * at.y;
  }
  return 1.0 / std::max(sum.width_over_length(), 1e-3);
}

/// Turn of a tool about `normal` from one pose to the next, rad.
double spin_between(const Pose& from, const Pose& to, const glm::dvec3& normal) {
  const glm::dquat turn = to.rotation * glm::conjugate(from.rotation);
  return 2.0 * std::abs(glm::dot(glm::dvec3(turn.x, turn.y, turn.z), normal));
}

bool slides_while_turning(const Model& model, std::uint32_t body, const Touch& before,
                          const Touch& after, double radius, std::span<const Pose> poses_before,
                          std::span<const Pose> poses_after) {
  const glm::dvec3 way = after.center - before.center;
  const double slide = glm::length(way - after.normal * glm::dot(way, after.normal));
  const glm::dvec3 axis = model.bodies.at<Pose>(body).rotation * after.normal;
  double spin = 0.0;
  for (std::size_t tool = 0; tool < poses_after.size(); ++tool) {
    spin = std::max(spin, spin_between(poses_before[tool], poses_after[tool], axis));
  }
  return slide > kSlidesWhileTurning * radius && spin > kTurnsWhileSliding;
}

std::string percent(double share) {
  char text[32];
  // With two digits; %g would write a hundred with an exponent.
  std::snprintf(text, sizeof text, share < 0.995 ? "%.2g %%" : "%.0f %%", 100.0 * share);
  return text;
}

double rolling_error(const ExpectedContact& contact) {
  return std::min(1.0, kMdrRollingError * contact.rolled);
}

/// The cheapest contact model within the tolerance.
std::pair<ContactModel, std::string> auto_contact(const ExpectedContact& contact, double tolerance,
                                                  double poisson_ratio) {
  const std::string within = ", tolerance " + percent(tolerance);
  if (!contact.known) {
    return {ContactModel::kPatch, "auto: moved by hand, so contacts of any shape" + within};
  }
  if (!contact.any) {
    return {ContactModel::kMdr, "auto: the expected motion touches it nowhere; the cheapest"};
  }
  if (contact.elongation > kLongContact) {
    const double error = contact.elongation > kSlender ? kSlenderEdgedError : kLongEdgedError;
    return {ContactModel::kPatch,
            "auto: a long contact with edges, error of patch up to " + percent(error) + within};
  }
  if (!contact.smooth) {
    return {ContactModel::kPatch, "auto: a contact with edges or of a mesh" + within};
  }
  const double error = mdr_error(contact, poisson_ratio);
  const std::string kind =
      std::string(contact.single ? "one " : "several ") +
      (contact.round ? "round contact" : "smooth contact") + (contact.single ? "" : "s") +
      (contact.slides
           ? (contact.single ? " that slides while it turns" : " that slide while they turn")
           : "") +
      (rolling_error(contact) > kTellsOfRolling ? (contact.single ? " that rolls" : " that roll")
                                                : "");
  const ContactModel model = error <= tolerance ? ContactModel::kMdr : ContactModel::kPatch;
  return {model, "auto: " + kind + ", error of mdr " + percent(error) + within};
}

std::pair<BodyModel, std::string> auto_body(const ExpectedContact& contact, double tolerance) {
  if (!contact.known) {
    return {BodyModel::kCompliance, "auto: moved by hand, so pressed as deep as the hand will"};
  }
  const double error =
      contact.any ? kFiniteBodyError * contact.radius / std::max(contact.body_depth, 1e-300) : 0.0;
  const std::string text = "auto: the body is not endless, which changes the force by about " +
                           percent(error) + ", tolerance " + percent(tolerance);
  return {error <= 0.5 * tolerance ? BodyModel::kNone : BodyModel::kCompliance, text};
}

}  // namespace

ExpectedContact expect_contact(const Model& model, std::uint32_t body,
                               std::span<const std::vector<Pose>> poses) {
  ExpectedContact contact;
  contact.known = !poses.empty();
  contact.body_depth = 1e300;
  const double threshold = model.bodies.at<BodyModels>(body).region_threshold;
  const bool body_is_long =
      std::ranges::any_of(model.parts.rows<ShapePart>(model.bodies.at<OwnedRows>(body).parts),
                          [](const ShapePart& part) { return makes_long_contacts(part.kind); });
  Touch last;
  for (std::size_t time = 0; time < poses.size(); ++time) {
    Touch touch = touch_with_tools(model, body, poses[time], last.places);
    if (!touch.points.empty()) {
      const auto [radius, regions] = extent_of_groups(touch.points, threshold);
      for (const glm::dvec3& point : touch.points) {
        contact.touched.lowest = contact.any ? glm::min(contact.touched.lowest, point) : point;
        contact.touched.highest = contact.any ? glm::max(contact.touched.highest, point) : point;
        contact.any = true;
      }
      contact.single = contact.single && regions == 1;
      contact.smooth = contact.smooth && touch.smooth;
      contact.round = contact.round && touch.round && !body_is_long;
      if (!touch.smooth && regions == 1) {
        contact.elongation = std::max(contact.elongation, elongation_of(touch));
      }
      contact.depth = std::max(contact.depth, touch.depth);
      contact.radius = std::max(contact.radius, radius);
      contact.rolled = std::max(contact.rolled, touch.rolled / radius);
      contact.body_depth =
          std::min(contact.body_depth, distance_to_fixed(model, body, touch.center));
      contact.slides = contact.slides || (!last.points.empty() &&
                                          slides_while_turning(model, body, last, touch, radius,
                                                               poses[time - 1], poses[time]));
    }
    last = std::move(touch);
  }
  return contact;
}

double mdr_error(const ExpectedContact& contact, double poisson_ratio) {
  const double kind = contact.slides  ? kMdrCombinedError
                      : contact.round ? kMdrRoundError
                                      : kMdrLongError;
  const double in_place =
      std::max({kind, kMdrCoupling * (1.0 - 2.0 * poisson_ratio),
                kMdrWideError * contact.radius / std::max(contact.body_depth, 1e-300)});
  return std::min(1.0, in_place + rolling_error(contact));
}

std::optional<double> model_error(const ModelChoice& choice, const ExpectedContact& contact,
                                  double poisson_ratio) {
  // docs/models.md, "Which model": at the 12 and at the 16 cells a side of choose_grid_side.
  constexpr double kPatchError = 0.013;
  constexpr double kFinePatchError = 0.0075;
  if (choice.models.contact == ContactModel::kMdr) {
    return contact.smooth ? std::optional(mdr_error(contact, poisson_ratio)) : std::nullopt;
  }
  if (choice.models.contact != ContactModel::kPatch) {
    return std::nullopt;
  }
  if (contact.elongation > kLongContact) {
    return contact.elongation > kSlender ? kSlenderEdgedError : kLongEdgedError;
  }
  return choice.models.tolerance < 0.02 ? kFinePatchError : kPatchError;
}

ModelChoice choose_models(const BodyModels& scene, const PrepareOptions& options,
                          const ExpectedContact& contact, double poisson_ratio) {
  ModelChoice choice;
  choice.models = scene;
  choice.contact_why = "the scene says so";
  choice.body_why = "the scene says so";
  choice.long_contact = contact.elongation > kLongContact;
  if (contact.any) {
    choice.place = {true, 0.5 * (contact.touched.lowest + contact.touched.highest),
                    0.5 * glm::distance(contact.touched.lowest, contact.touched.highest)};
  }
  if (options.contact_model != ContactModel::kAuto) {
    choice.models.contact = options.contact_model;
    choice.contact_why = "the command line says so";
  }
  if (options.body_model != BodyModel::kAuto) {
    choice.models.body = options.body_model;
    choice.body_why = "the command line says so";
  }
  if (choice.models.contact == ContactModel::kAuto) {
    std::tie(choice.models.contact, choice.contact_why) =
        auto_contact(contact, scene.tolerance, poisson_ratio);
  }
  choice.body_is_auto = choice.models.body == BodyModel::kAuto;
  if (choice.body_is_auto) {
    if (contact_law(choice.models.contact).is_of_whole_body) {
      choice.models.body = BodyModel::kNone;
      choice.body_why = "auto: the contact model has the whole body's compliance in its own";
    } else {
      std::tie(choice.models.body, choice.body_why) = auto_body(contact, scene.tolerance);
    }
  }
  return choice;
}

std::uint32_t choose_grid_side(std::span<const ModelChoice> choices) {
  // Sides whose errors are at most 2 %, 0.7 % and below.
  constexpr std::uint32_t kPatchSides[] = {12, 16, 20};
  constexpr std::uint32_t kLongSide = 20;  // steps stay within a millisecond
  std::uint32_t side = 8;
  for (const ModelChoice& choice : choices) {
    const BodyModels& models = choice.models;
    if (models.contact == ContactModel::kPatch) {
      side = std::max(
          side,
          kPatchSides[(models.tolerance < 0.02 ? 1U : 0U) + (models.tolerance < 0.007 ? 1U : 0U)]);
      side = choice.long_contact ? std::max(side, kLongSide) : side;
    } else {
      side = std::max(side, contact_law(models.contact).grid_side);
    }
  }
  return side;
}

}  // namespace torsion::engine
