#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace torsion::engine {

/// What finite elements gave for one case on one mesh, or on the finest of several.
struct ElementCurve {
  struct Row {
    double depth = 0.0;           // m
    double turn = 0.0;            // rad: the tool's
    double force = 0.0;           // N
    double torque = 0.0;          // N m
    double contact_radius = 0.0;  // m
  };
  struct FieldRow {
    double radius = 0.0;  // m, from the axis
    double twist = 0.0;   // rad: the surface's
  };
  int divisions = 0;  // elements to a contact radius
  std::vector<Row> rows;
  std::vector<FieldRow> field;  // at the largest turn of the tool; empty where there is none
  // Between this mesh and the next coarser one, over the largest value; nullopt with one mesh only.
  std::optional<double> force_error;
  std::optional<double> torque_error;
};

/// Names of the cases that are embedded, each once, sorted.
std::vector<std::string_view> element_case_names();

/// The finest mesh of a case. @pre the name is one of element_case_names()
ElementCurve finest_curve(std::string_view name);

/// The field's twist at `radius`, linear between the rows.
double field_twist(const ElementCurve& curve, double radius);

}  // namespace torsion::engine
