#include "systems/body/compliance/slip.hpp"

#include <algorithm>
#include <limits>

#include "systems/contact/scratch.hpp"
#include "systems/contact/tool_motion.hpp"
#include "systems/math/linear_algebra.hpp"

namespace torsion::engine {
namespace {

/// Forces along the two tangents and the couple about the normal, or motions along them.
using Tangential = Eigen::Vector3d;
constexpr std::array<Eigen::Index, 3> kTangential{0, 1, 5};
constexpr Eigen::Index kNormal = 2;

Tangential tangential(const Vector6& all) {
  return {all[kTangential[0]], all[kTangential[1]], all[kTangential[2]]};
}

/// What friction holds of a contact, along the contact's axes and scaled as motions are. The tool
/// is taken to go on as it did in this step: where it slides, the contact holds the material
/// against no more than the turn of the friction by what is added to the slide.
struct FrictionLimit {
  Vector6 load;         // K^(-1/2) w
  Tangential ahead;     // its tangential part, were the tool to go on and the contact to stick
  Tangential held;      // what friction holds of that
  Tangential weight;    // N: of such loads, as forces at the limit count
  double along_normal;  // N: likewise
  double coefficient;   // the limit over the normal force
};

/// @param motion  of the material
double pressing_force(const FrictionLimit& limit, const Vector6& motion) {
  return std::max(0.0, limit.along_normal * (motion[kNormal] - limit.load[kNormal]));
}

/// The share of a load that is brought back radially onto the limit.
double held_share(const FrictionLimit& limit, const Tangential& load, double pressing) {
  const double force = load.cwiseProduct(limit.weight).norm();
  const double most = limit.coefficient * pressing;
  constexpr double kLimitRounding = 1e-9;
  return force > most * (1.0 + kLimitRounding) ? most / force : 1.0;
}

/// The limit surface (Goyal, Ruina and Papadopoulos, Wear 143, 1991) is taken for an ellipsoid of
/// the two forces and the couple about the normal (Howe and Cutkosky, Int. J. Robotics Research 15,
/// 1996); under Hertz' pressure the couple alone is 3 pi / 16 mu N a.
FrictionLimit friction_limit(const CompliantBody& body, const SupportedRegion& supported,
                             const StiffnessRoot& root) {
  constexpr double kArm = 0.589;  // of the radius
  const SupportFit& support_fit = support_fit_of(body, supported);
  FrictionLimit limit;
  limit.load = (root.axes * supported.load.wrench).cwiseQuotient(root.along);
  limit.weight = tangential(root.along);
  limit.weight[2] /= kArm * support_fit.radius;
  limit.along_normal = root.along[kNormal];
  const Friction& friction = body.model.bodies.at<Friction>(body.row);
  const double pressing = pressing_force(limit, Vector6::Zero());
  const double force = tangential(limit.load).cwiseProduct(limit.weight).norm();
  // A contact may hold a little more than the ellipsoid has, and with static friction much more.
  constexpr double kRough = 1.05;
  const bool holds_more = force > kRough * friction.dynamic_friction * pressing;
  limit.coefficient = holds_more ? friction.static_friction : friction.dynamic_friction;
  if (pressing > 0.0) {
    limit.coefficient = std::max(limit.coefficient, force / pressing);
  }
  MotionOverBody tool = motion_over_body(body.state, supported.region);
  tool.carried_by = tool.carried_turn = glm::dvec3(0.0);
  Vector6 way;
  way << eigen(shift_at(tool, support_fit.center)), eigen(tool.turn);
  limit.ahead = tangential(limit.load + root.along.cwiseProduct(root.axes * way));
  limit.held = held_share(limit, limit.ahead, pressing) * limit.ahead;
  return limit;
}

RegionSlip slip_of(const FrictionLimit& limit, const StiffnessRoot& root, const Vector6& motion) {
  RegionSlip slip;
  slip.slipped.setZero();
  const Vector6 moved = root.axes * motion;
  const Tangential stuck = limit.ahead - tangential(moved);
  const double pressing = pressing_force(limit, moved);
  const double share = held_share(limit, stuck, pressing);
  slip.any = share < 1.0 || limit.held != limit.ahead;
  if (!slip.any) {
    return slip;
  }
  const Tangential slipped = tangential(moved) - (limit.held - share * stuck);
  Eigen::Matrix3d by_tangential = Eigen::Matrix3d::Zero();
  Tangential by_normal = Tangential::Zero();
  if (share < 1.0) {
    // share = most / force, and `stuck` changes by -dy.
    const Tangential forces = stuck.cwiseProduct(limit.weight);
    const double force = forces.norm();
    by_tangential =
        (1.0 - share) * Eigen::Matrix3d::Identity() +
        share * stuck * (forces.cwiseProduct(limit.weight) / (force * force)).transpose();
    by_normal = (pressing > 0.0 ? limit.coefficient * limit.along_normal / force : 0.0) * stuck;
  }
  Vector6 along = Vector6::Zero();
  Matrix6 change = Matrix6::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index row = kTangential[static_cast<std::size_t>(i)];
    along[row] = slipped[i];
    change(row, kNormal) = by_normal[i];
    for (Eigen::Index j = 0; j < 3; ++j) {
      change(row, kTangential[static_cast<std::size_t>(j)]) = by_tangential(i, j);
    }
  }
  slip.slipped = root.axes.transpose() * along;
  slip.change = root.axes.transpose() * change * root.axes;
  return slip;
}

/// How a scaled load of region j moves region i: a block of K^(1/2) C K^(1/2).
Matrix6 coupling(const Eigen::Map<RowMatrix>& upper, std::size_t i, std::size_t j) {
  const auto at = static_cast<Eigen::Index>(6 * i);
  const auto there = static_cast<Eigen::Index>(6 * j);
  if (i < j) {
    return upper.block<6, 6>(at, there);
  }
  if (i > j) {
    return upper.block<6, 6>(there, at).transpose();
  }
  return Matrix6(upper.block<6, 6>(at, at).selfadjointView<Eigen::Upper>()) - Matrix6::Identity();
}

}  // namespace

void let_slip(const CompliantBody& body, const StiffnessRoots& roots,
              const StuckEquations& equations, Eigen::Map<RowMatrix>& jacobian, Vector& motion,
              Slips& slips) {
  constexpr int kMostSlipSteps = 6;
  constexpr double kSolved = 1e-3;  // of the right side; the next step of the world goes on from it
  std::array<FrictionLimit, kMaxRegionsPerBody> limits;
  for (std::size_t i = 0; i < body.count; ++i) {
    limits[i] = friction_limit(body, body.regions[i], roots[i]);
  }
  const auto find_slips = [&] {
    bool any = false;
    for (std::size_t i = 0; i < body.count; ++i) {
      slips[i] = slip_of(limits[i], roots[i], motion.segment<6>(static_cast<Eigen::Index>(6 * i)));
      any = any || slips[i].any;
    }
    return any;
  };
  if (!find_slips()) {
    return;
  }
  Vector best = motion;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= kMostSlipSteps; ++k) {
    Vector residual(motion.size());
    residual.noalias() = equations.matrix.lazyProduct(motion);
    residual -= equations.right;
    jacobian = equations.matrix;
    for (std::size_t j = 0; j < body.count; ++j) {
      for (std::size_t i = 0; slips[j].any && i < body.count; ++i) {
        const Matrix6 moved = coupling(equations.couplings, i, j);
        const auto at = static_cast<Eigen::Index>(6 * i);
        residual.segment<6>(at) -= moved * slips[j].slipped;
        jacobian.block<6, 6>(at, static_cast<Eigen::Index>(6 * j)) -= moved * slips[j].change;
      }
    }
    const double size = residual.norm();
    if (size < least) {
      least = size;
      best = motion;
    }
    if (!(size > kSolved * equations.right.norm()) || k == kMostSlipSteps) {
      break;
    }
    solve_general(static_cast<std::size_t>(residual.size()), jacobian.data(), residual.data());
    motion -= residual;
    find_slips();
  }
  motion = best;
  find_slips();
}

}  // namespace torsion::engine
