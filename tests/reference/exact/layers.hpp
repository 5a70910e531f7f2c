#pragma once

namespace torsion::engine::reference {

/// An elastic layer of constant thickness without end, on a rigid base, as dual integral equations
/// reduced to Fredholm equations of the second kind and solved by Nystrom's method on
/// Gauss-Legendre nodes. Source: Lebedev and Ufliand, J. Appl. Math. Mech. 22 (1958) 442; Dhaliwal,
/// Int. J. Eng. Sci. 8 (1970) 273; Gladwell, Contact Problems in the Classical Theory of
/// Elasticity, 1980.
enum class LayerBase {
  kBonded,
  kFrictionless,
};

struct Layer {
  LayerBase base;
  double thickness;  // h, m
  double poisson;    // 0 <= nu <= 0.5; without effect on a frictionless base
  double modulus;    // E* = E / (1 - nu^2), Pa
};

/// Torque of a bonded disc of radius a on a bonded layer, over that on a half-space (16/3) G a^3
/// phi. Error: relative under 1e-9 for h/a >= 0.02 (measured by doubling the nodes).
double layer_torsion_ratio(double thickness_over_radius);

/// L(u), u = k h: surface displacement under a pressure cos(k x) on the layer over that on a
/// half-space. 0 for a thin layer (but for incompressible ones only as u^3), 1 for a thick one.
/// Error: relative under 1e-13 for u > 0.01.
double layer_compliance_ratio(LayerBase base, double poisson, double u);

/// Normal contact of a rigid sphere (paraboloid) without friction.
struct LayerContact {
  double radius;       // a, m
  double depth;        // delta, m
  double force;        // F, N
  double hertz_ratio;  // force over that of a half-space at the same depth
  double stiffness;    // dF / d delta, N/m: that of a flat punch of the radius a
};

/// Error: relative under 1e-8 for h/a >= 0.05 (measured by doubling the nodes), the paraboloid's
/// own apart.
LayerContact layer_sphere_at_radius(const Layer& layer, double sphere_radius, double radius);

/// The same for a depth > 0, by a bracketed secant search to 1e-12 of the radius.
LayerContact layer_sphere_at_depth(const Layer& layer, double sphere_radius, double depth);

}  // namespace torsion::engine::reference
