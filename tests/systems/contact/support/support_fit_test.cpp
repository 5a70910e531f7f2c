// How a region stands on a body's ports: what the fit must reproduce, whatever the ports.

#include "systems/contact/support/support_fit.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

const glm::dvec3 kNormal(0.0, 0.0, 1.0);

/// Ports on z = 0, at random places of the square of half side 1, and no compliance yet.
struct Body {
  std::vector<CompliancePort> ports;
  std::vector<ComplianceValue> values;

  explicit Body(std::size_t count) : values(9 * count * count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    for (std::size_t i = 0; i < count; ++i) {
      ports.push_back({{place(random), place(random), 0.0}, kNormal});
    }
  }

  [[nodiscard]] PortCompliance compliance() const { return {ports, values}; }
};

ContactEllipse ellipse_at(const glm::dvec3& center, double a, double b) {
  const glm::dvec3 way = glm::normalize(glm::dvec3(0.6, 0.8, 0.0));
  return {center, a * way, b * glm::cross(kNormal, way), kNormal, std::sqrt(a * b)};
}

PortVectors displacements_of(const Body& body, const SupportFit& support_fit,
                             const glm::dvec3& translation, const glm::dvec3& rotation) {
  PortVectors displacements{};
  for (std::size_t p = 0; p < support_fit.count; ++p) {
    const glm::dvec3 arm = body.ports[support_fit.ports[p]].position - support_fit.center;
    displacements[p] = translation + glm::cross(rotation, arm);
  }
  return displacements;
}

// Constants and slopes are not kept small, so least squares has them exactly, for contacts small
// and large against the ports' distance and off the middle of the ports.
TEST(SupportFitTest, RigidMotionsAreRigid) {
  const Body body(60);
  const glm::dvec3 translation(0.3, -0.2, 0.5);
  const glm::dvec3 rotation(-0.1, 0.4, 0.7);
  for (const double size : {0.01, 0.2, 0.7}) {
    SupportFit support_fit;
    fit_support(body.compliance(), ellipse_at({0.2, -0.1, 0.0}, size, 0.4 * size), support_fit);
    ASSERT_GE(support_fit.count, 6U);
    const PortVectors displacements = displacements_of(body, support_fit, translation, rotation);
    const Vector6 rigid = rigid_motion(support_fit, displacements);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(rigid[axis], translation[axis], 1e-7);
      EXPECT_NEAR(rigid[3 + axis], rotation[axis], 1e-6 / size);
    }
    for (const glm::dvec3& term : bending(support_fit, displacements, rigid).terms) {
      EXPECT_LT(glm::length(term), 1e-6);
    }
  }
}

// The forces at the ports have the force and the couple of what they stand for.
TEST(SupportFitTest, UnitForcesAtThePortsAreUnitWrenches) {
  const Body body(60);
  SupportFit support_fit;
  fit_support(body.compliance(), ellipse_at({-0.3, 0.2, 0.0}, 0.3, 0.1), support_fit);
  for (std::size_t c = 0; c < 6; ++c) {
    glm::dvec3 force(0.0);
    glm::dvec3 couple(0.0);
    for (std::size_t p = 0; p < support_fit.count; ++p) {
      force += support_fit.unit_forces[c][p];
      couple += glm::cross(body.ports[support_fit.ports[p]].position - support_fit.center,
                           support_fit.unit_forces[c][p]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<int>(axis);
      EXPECT_NEAR(force[at], c == axis ? 1.0 : 0.0, 1e-6);
      EXPECT_NEAR(couple[at], c == axis + 3 ? 1.0 : 0.0, 1e-6);
    }
  }
}

// Betti: what one region does to another is what that does to it, transposed, for any symmetric
// compliance of the ports.
TEST(SupportFitTest, WhatRegionsDoToEachOtherIsReciprocal) {
  Body body(60);
  const std::size_t side = 3 * body.ports.size();
  std::mt19937 random(5);
  std::normal_distribution<double> value;
  for (std::size_t i = 0; i < side; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      body.values[i * side + j].value = body.values[j * side + i].value = value(random);
    }
  }
  SupportFit first;
  SupportFit second;
  fit_support(body.compliance(), ellipse_at({0.5, 0.3, 0.0}, 0.2, 0.1), first);
  fit_support(body.compliance(), ellipse_at({-0.4, -0.4, 0.0}, 0.3, 0.2), second);
  const Matrix6 one = motion_between(body.compliance(), first, second);
  const Matrix6 other = motion_between(body.compliance(), second, first);
  EXPECT_LT((one - other.transpose()).norm(), 1e-12 * one.norm());
}

// A compliance that is a polynomial of the fourth degree of both places is known exactly once the
// contact is large against the ports' distance: u(x) = k(x) sum of k(y) f(y).
TEST(SupportFitTest, BendingOfAQuarticIsFound) {
  Body body(120);
  const auto quartic = [](const glm::dvec3& at) {
    return 1.0 + at.x - 2.0 * at.y * at.y + at.x * at.x * at.y + 3.0 * std::pow(at.x, 4.0);
  };
  const std::size_t side = 3 * body.ports.size();
  for (std::size_t i = 0; i < body.ports.size(); ++i) {
    for (std::size_t j = 0; j < body.ports.size(); ++j) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        body.values[(3 * i + axis) * side + 3 * j + axis].value =
            quartic(body.ports[i].position) * quartic(body.ports[j].position);
      }
    }
  }
  SupportFit support_fit;
  fit_support(body.compliance(), ellipse_at(glm::dvec3(0.0), 0.6, 0.5), support_fit);
  // Unit force at one place of the contact.
  const glm::dvec3 loaded(0.3, -0.2, 0.0);
  SupportMoments moments{};
  const auto terms = support_terms(coordinates_in(support_fit, loaded));
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    moments[k] = kNormal * terms[k];
  }
  PortVectors forces;
  PortVectors displacements;
  forces_at_ports(support_fit, moments, forces);
  displacements_at_ports(body.compliance(), support_fit, forces, displacements);
  const SupportField field = bending(support_fit, displacements, Vector6::Zero());
  for (const glm::dvec3& seen : {glm::dvec3(0.0), glm::dvec3(-0.4, 0.3, 0.0)}) {
    const auto at = support_terms(coordinates_in(support_fit, seen));
    double moved = 0.0;
    for (std::size_t k = 0; k < kSupportTerms; ++k) {
      moved += at[k] * field.terms[k].z;
    }
    EXPECT_NEAR(moved, quartic(seen) * quartic(loaded), 0.02);
  }
}

}  // namespace
}  // namespace torsion::engine
