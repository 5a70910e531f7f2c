#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "systems/contact/support/contact_load.hpp"
#include "systems/contact/support/footing.hpp"

namespace torsion {

/// A region on a body with body model compliance.
struct Stand {
  std::uint32_t region = 0;
  std::uint32_t block = 0;  // of cells, and row of its footing
  ContactLoad load;
  Vector6 motion = Vector6::Zero();  // at the footing's centre, by this region's own load
  bool solved = false;               // its contact model knows what that is: contact model patch
};

/// One body at work.
struct CompliantBody {
  const Model& model;
  State& state;
  std::uint32_t row;
  PortCompliance ports;
  std::array<Stand, kMaxRegionsPerBody> stands{};
  std::size_t count = 0;
};

Footing& footing_of(const CompliantBody& body, const Stand& stand);

/// Square root of the stiffness of a contact that sticks against motions at its footing's centre,
/// 6 x 6, body axes, and its inverse.
struct StiffnessRoot {
  Matrix6 root;
  Matrix6 inverse;
};
StiffnessRoot stiffness_root(const CompliantBody& body, const Stand& stand);

/// Lays the region's footing, and finds what its own wrench does to it.
void lay_stand(const CompliantBody& body, const Stand& stand, const ContactEllipse& contact);

/// Takes the regions of the body, lays footings, and moves the regions by their own loads. That a
/// step has a bounded cost, of the footings that no longer fit one is laid anew in a step, that
/// which was laid first; the others serve a step longer. A new region's is laid at once.
void find_stands(CompliantBody& body);

}  // namespace torsion
