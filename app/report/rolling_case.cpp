#include "app/report/rolling_case.hpp"

#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "app/report/embedded_results.hpp"
#include "app/report/paper_ball.hpp"
#include "app/report/sphere_on_half_space.hpp"

namespace torsion::engine {
namespace {

constexpr double kRadii = 8.0;      // contact radii with each spin: steady after six
constexpr int kPoints = 16;         // of each
constexpr int kSteadyPoints = 4;    // the last ones, which are compared
constexpr int kStepsBetween = 5;    // times SphereOnHalfSpace::steps
constexpr double kFriction = 0.75;  // that of Friction{}

/// A row of tests/reference/boundary_elements/steady_rolling.csv.
struct SteadyRolling {
  double friction = 0.0;
  double along = 0.0;  // creepages
  double across = 0.0;
  double spin = 0.0;         // 1/m
  double along_load = 0.0;   // N
  double across_load = 0.0;  // N
  double couple = 0.0;       // N m
};

/// Those of spin alone.
std::vector<SteadyRolling> spins() {
  std::vector<SteadyRolling> found;
  for (const EmbeddedFile& file : boundary_element_results()) {
    if (file.name != "steady_rolling") {
      continue;
    }
    std::istringstream stream{std::string(file.text)};
    std::string line;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
      std::istringstream fields(line);
      char comma = ',';
      SteadyRolling row;
      fields >> row.friction >> comma >> row.along >> comma >> row.across >> comma >> row.spin >>
          comma >> row.along_load >> comma >> row.across_load >> comma >> row.couple;
      if (row.friction == kFriction && row.along == 0.0 && row.across == 0.0 && row.spin > 0.0) {
        found.push_back(row);
      }
    }
  }
  return found;
}

}  // namespace

ReferenceCase rolling_case(bool quick) {
  const SphereOnHalfSpace sphere = sphere_on_half_space(quick);
  ReferenceCase result;
  result.name = "sphere_rolling";
  result.title = "Ball on a half-space, rolling with spin";
  result.description =
      sphere_text(sphere) +
      fmt::format(
          " Then it rolls along x without creepage and turns about the normal by 2, 8 and 20 rad a "
          "metre of way, {:.0f} contact radii with each; steady friction across the way and couple "
          "are compared over the last {:.0f}.",
          kRadii, kRadii * kSteadyPoints / kPoints);
  result.reference =
      "Steady rolling by boundary elements with a semismooth Newton method, extrapolated from two "
      "grids to within 0.2 % of \u03bcF and 0.04 % of \u03bcFa.";
  result.force_meaning = "friction across the way";
  result.torque_meaning = "couple about the normal";
  result.scene = scene_of(sphere);
  result.path = press(sphere, false);
  result.force_axis = {0.0, 0.0, 1.0};
  const double way = kRadii * sphere.hertz.radius / kPoints;
  Pose pose = pose_at(kPaperBallDepth, 0.0, 0.0);
  double gone = 0.0;
  for (const SteadyRolling& rolling : spins()) {
    const glm::dvec3 turn(0.0, rolling.spin * way, -way / kPaperBallRadius);
    for (int i = 1; i <= kPoints; ++i) {
      gone += way;
      pose.position.x += way;
      pose.rotation = glm::angleAxis(glm::length(turn), glm::normalize(turn)) * pose.rotation;
      const bool steady = i > kPoints - kSteadyPoints;
      result.path.push_back({pose, kStepsBetween * sphere.steps, Leg::kLoad, gone,
                             steady ? rolling.across_load : kNoReference,
                             steady ? rolling.couple : kNoReference});
    }
  }
  result.connected = false;
  result.x = {PlotAxis::Quantity::kAbscissa, "way rolled (mm)", 1e3};
  result.y = {PlotAxis::Quantity::kTorque, "couple (mN m)", 1e3};
  return result;
}

}  // namespace torsion::engine
