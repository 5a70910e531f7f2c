#pragma once

#include <limits>
#include <string>
#include <vector>

#include "ecs/scene_description.hpp"

namespace torsion::engine {

inline constexpr double kNoReference = std::numeric_limits<double>::quiet_NaN();

/// Parts of a path, so that a plot can tell them apart.
enum class Leg { kApproach, kLoad, kUnload, kReload };

/// A pose that the tool passes, and what the reference says there.
struct PathPoint {
  Pose tool;      // world
  int steps = 1;  // from the point before, evenly
  Leg leg = Leg::kApproach;
  double abscissa = 0.0;         // what the tool is moved by: rad or m
  double force = kNoReference;   // N
  double torque = kNoReference;  // N m
};

/// The twist of the surface along a ray from the axis, at one point of the path.
struct ReferenceField {
  std::size_t point = 0;        // row of the path
  double tool_turn = 0.0;       // rad
  std::vector<double> radii;    // m, ascending
  std::vector<double> twists;   // rad: how far it has gone around the axis
  double contact_radius = 0.0;  // m
};

/// What a plot of a case shows along one of its axes.
struct PlotAxis {
  enum class Quantity { kAbscissa, kForce, kTorque };
  Quantity quantity = Quantity::kAbscissa;
  std::string label;   // with its unit
  double scale = 1.0;  // from SI to that unit
};

inline constexpr double kStartClearance = 1e-5;  // m: how far above the body a path begins

/// One scene with a path and a solution that is known otherwise.
struct ReferenceCase {
  std::string name;         // in report.csv
  std::string title;        // of a section
  std::string description;  // body, tool, path: one paragraph
  std::string reference;    // whose solution, and how wrong it may be itself
  std::string force_meaning;
  std::string torque_meaning;  // empty: not compared
  SceneDescription scene;      // one body, one tool; drawn meshes for the picture
  bool finite_body = false;    // false: a body so large that only the contact deforms it
  std::vector<PathPoint> path;
  glm::dvec3 force_axis{0.0, 1.0, 0.0};    // world, unit: F is the force on the tool along it
  glm::dvec3 torque_axis{0.0, -1.0, 0.0};  // world, unit: T is the torque on the tool along it
  PlotAxis x;
  PlotAxis y;
  bool connected = true;  // false: the path's points are no curve of x and y
  ReferenceField field;   // without radii: none
};

}  // namespace torsion::engine
