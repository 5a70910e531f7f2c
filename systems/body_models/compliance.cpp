#include "systems/body_models/compliance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "systems/body_models/half_space_fields.hpp"
#include "systems/body_models/smooth_compliance.hpp"
#include "systems/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t kNearPorts = 4;

/// A region between the ports nearest to it: a mean with weights that go to zero where another port
/// takes a port's place.
struct Footing {
  std::uint32_t region = 0;
  glm::dvec3 point{0.0};   // m, body
  glm::dvec3 normal{0.0};  // body, unit
  std::array<std::uint32_t, kNearPorts> ports{};
  std::array<double, kNearPorts> weights{};
  Vector6 wrench = Vector6::Zero();  // on the material: N, N m about `point`
  double radius = 0.0;               // m
  double reach = 0.0;                // m: to the nearest port that has no weight
};

/// One body at work.
struct CompliantBody {
  World& world;
  std::uint32_t row;
  std::span<const AnchorRest> ports;
  std::span<const ComplianceValue> values;
  std::array<Footing, kMaxRegionsPerBody> footings{};
  std::size_t count = 0;
};

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Eigen::Matrix3d cross_matrix(const glm::dvec3& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0;
  return m;
}

/// Modified Shepard weights of the nearest ports; a port whose surface faces away counts as far.
void find_ports(std::span<const AnchorRest> ports, Footing& footing) {
  std::array<std::pair<double, std::uint32_t>, kNearPorts + 1> nearest;
  nearest.fill({1e300, 0});
  for (std::uint32_t port = 0; port < ports.size(); ++port) {
    const double facing = glm::dot(ports[port].normal, footing.normal);
    const double distance =
        glm::distance(ports[port].position, footing.point) / std::max(0.05, facing);
    if (distance < nearest.back().first) {
      nearest.back() = {distance, port};
      for (std::size_t i = kNearPorts; i > 0 && nearest[i].first < nearest[i - 1].first; --i) {
        std::swap(nearest[i], nearest[i - 1]);
      }
    }
  }
  const double reach = nearest.back().first;
  footing.reach = reach;
  double sum = 0.0;
  for (std::size_t i = 0; i < kNearPorts; ++i) {
    const double distance = std::max(nearest[i].first, 1e-6 * reach);
    const double weight = std::max(1.0 / distance - 1.0 / reach, 0.0);
    footing.ports[i] = nearest[i].second;
    footing.weights[i] = weight * weight;
    sum += footing.weights[i];
  }
  for (double& weight : footing.weights) {
    weight /= sum;
  }
}

void find_footings(CompliantBody& body) {
  const World& world = body.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    if (world.regions.at<RegionIdentity>(region).body != body.row) {
      continue;
    }
    const RegionFrame& frame = world.regions.at<RegionFrame>(region);
    const RegionGeometry& geometry = world.regions.at<RegionGeometry>(region);
    const RegionFriction& friction = world.regions.at<RegionFriction>(region);
    Footing& footing = body.footings[body.count++];
    footing.region = region;
    footing.point = geometry.rest_point;
    footing.normal = frame.normal;
    footing.radius = geometry.radius;
    const glm::dvec3 force = frame.normal * world.regions.at<RegionNormal>(region).force +
                             tangent_to_body(frame, friction.force);
    footing.wrench << -eigen(force), -eigen(frame.normal * friction.couple);
    find_ports(body.ports, footing);
  }
}

Matrix6 block(const CompliantBody& body, std::uint32_t to, std::uint32_t from) {
  const std::size_t side = 6 * body.ports.size();
  Matrix6 result;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      result(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
          body.values[(6 * std::size_t{to} + row) * side + 6 * std::size_t{from} + column].value;
    }
  }
  return result;
}

/// Motion at `point` of what moves rigidly with `port`; its transpose takes a wrench from the point
/// to the port.
Matrix6 from_port(const CompliantBody& body, std::uint32_t port, const glm::dvec3& point) {
  Matrix6 move = Matrix6::Identity();
  move.topRightCorner<3, 3>() = -cross_matrix(point - body.ports[port].position);
  return move;
}

/// What a wrench at `from` does to the material at `to`, beyond the contact's own half-space.
Matrix6 compliance_between(const CompliantBody& body, const Footing& to, const Footing& from) {
  Matrix6 sum = Matrix6::Zero();
  for (std::size_t i = 0; i < kNearPorts; ++i) {
    Matrix6 row = Matrix6::Zero();
    for (std::size_t j = 0; j < kNearPorts; ++j) {
      row += from.weights[j] * block(body, to.ports[i], from.ports[j]) *
             from_port(body, from.ports[j], from.point).transpose();
    }
    sum += to.weights[i] * from_port(body, to.ports[i], to.point) * row;
  }
  if (&to != &from && to.point != from.point) {
    sum += half_space_coupling({to.point, to.normal}, {from.point, from.normal},
                               body.world.bodies.at<Elasticity>(body.row));
  }
  return sum;
}

/// How little of a region's own compliance its neighbouring ports know: 1 where the body is a layer
/// on a fixed face, thinner than the ports are apart.
double layer_share(const CompliantBody& body, const Footing& footing) {
  const FixedRegion& fixed = body.world.bodies.at<FixedRegion>(body.row);
  if (fixed.kind != FixedKind::kFace || glm::dot(footing.normal, fixed.normal) < 0.5) {
    return 0.0;
  }
  const double thickness = glm::dot(footing.point - fixed.point, fixed.normal);
  const double t = std::clamp((footing.reach / thickness - 0.5) / 0.5, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The smallest eigenvalue that K^(1/2) C K^(1/2) may have: -1 would leave no compliance at all,
/// and interpolation between ports could bring it below.
constexpr double kStiffest = -0.75;

/// Compliance, and its part that yields. Where the rest of the body stiffens the half-space (a
/// layer) Newton's method would overshoot as soon as the contact slips, and plain iteration
/// converges.
struct SplitCompliance {
  Matrix6 whole;
  Matrix6 yielding;
};

/// A region's own compliance: between ports close to each other a mean over pairs of them, which
/// is exact for rigid motion; on a layer a mean of the ports' own.
SplitCompliance own_compliance(const CompliantBody& body, const Footing& footing,
                               const Vector6& root_stiffness_in_frame, const Matrix6& to_frame) {
  const double layer = layer_share(body, footing);
  Matrix6 sum = Matrix6::Zero();
  if (layer < 1.0) {
    sum += (1.0 - layer) * compliance_between(body, footing, footing);
  }
  for (std::size_t i = 0; i < kNearPorts && layer > 0.0; ++i) {
    sum += layer * footing.weights[i] * block(body, footing.ports[i], footing.ports[i]);
  }
  const auto root = root_stiffness_in_frame.asDiagonal();
  const Matrix6 scaled = root * (to_frame * sum * to_frame.transpose()) * root;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(0.5 * (scaled + scaled.transpose()));
  if (solver.eigenvalues()[0] >= 0.0) {
    return {sum, sum};
  }
  const auto inverse = root_stiffness_in_frame.cwiseInverse().asDiagonal();
  const auto with = [&](double least) -> Matrix6 {
    const Vector6 kept = solver.eigenvalues().cwiseMax(least);
    const Matrix6 mended =
        solver.eigenvectors() * kept.asDiagonal() * solver.eigenvectors().transpose();
    return to_frame.transpose() * (inverse * mended * inverse) * to_frame;
  };
  return {with(kStiffest), with(0.0)};
}

SplitCompliance both_alike(const Matrix6& compliance) {
  return {compliance, compliance};
}

/// Stiffness of a contact that sticks, about its point, along tangents and normal. Source: Johnson,
/// 1985; Reissner & Sagoci, 1944.
Vector6 contact_stiffness(const Footing& footing, const Elasticity& elasticity) {
  const double g = elasticity.shear_modulus();
  const double nu = elasticity.poisson_ratio;
  const double a = footing.radius;
  const double drag = 8.0 * g * a / (2.0 - nu);
  const double tilt = 8.0 * g * a * a * a / (3.0 * (1.0 - nu));
  Vector6 stiffness;
  stiffness << drag, drag, 4.0 * g * a / (1.0 - nu), tilt, tilt, 16.0 / 3.0 * g * a * a * a;
  return stiffness;
}

/// From the body's axes to tangents and normal of a region.
Matrix6 to_region(const RegionFrame& frame) {
  Eigen::Matrix3d rotation;
  rotation << frame.tangent_x.x, frame.tangent_x.y, frame.tangent_x.z, frame.tangent_y.x,
      frame.tangent_y.y, frame.tangent_y.z, frame.normal.x, frame.normal.y, frame.normal.z;
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = rotation;
  both.bottomRightCorner<3, 3>() = rotation;
  return both;
}

/// Gauss' elimination with row pivots, in place: `matrix` x = `right`, x in `right`.
void solve_in_place(Eigen::Map<RowMatrix>& matrix, Eigen::Map<Eigen::VectorXd>& right) {
  const Eigen::Index n = right.size();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    matrix.col(k).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    pivot += k;
    if (pivot != k) {
      matrix.row(k).swap(matrix.row(pivot));
      std::swap(right[k], right[pivot]);
    }
    for (Eigen::Index row = k + 1; row < n; ++row) {
      const double factor = matrix(row, k) / matrix(k, k);
      matrix.row(row).tail(n - k) -= factor * matrix.row(k).tail(n - k);
      right[row] -= factor * right[k];
    }
  }
  for (Eigen::Index k = n; k-- > 0;) {
    right[k] -= matrix.row(k).tail(n - k - 1).dot(right.tail(n - k - 1));
    right[k] /= matrix(k, k);
  }
}

/// The material's motion at `point` as the region's support has it.
Vector6 support_at(const RegionSupport& support, const glm::dvec3& point) {
  Vector6 motion;
  motion << eigen(support.translation + glm::cross(support.rotation, point - support.about)),
      eigen(support.rotation);
  return motion;
}

void move_supports(const CompliantBody& body, const Eigen::Map<Eigen::VectorXd>& change) {
  for (std::size_t i = 0; i < body.count; ++i) {
    const Footing& footing = body.footings[i];
    RegionSupport& support = body.world.regions.at<RegionSupport>(footing.region);
    const Vector6 before = support_at(support, footing.point);
    const Vector6 step = change.segment<6>(static_cast<Eigen::Index>(6 * i));
    const Vector6 after = before + step;
    support.about = footing.point;
    support.translation = {after[0], after[1], after[2]};
    support.rotation = {after[3], after[4], after[5]};
    support.translation_step = {step[0], step[1], step[2]};
    support.rotation_step = {step[3], step[4], step[5]};
  }
}

/// What each region does to the anchors through the body, summed, and how each turns them about its
/// normal.
void move_anchors(const CompliantBody& body, std::span<AnchorMotion> anchors) {
  for (AnchorMotion& anchor : anchors) {
    anchor.displacement = glm::dvec3(0.0);
  }
  for (std::size_t i = 0; i < body.count; ++i) {
    const Footing& footing = body.footings[i];
    const Eigen::Vector3d normal = eigen(footing.normal);
    AnchorTurns& turns = body.world.regions.at<AnchorTurns>(footing.region);
    turns = AnchorTurns{};
    for (std::size_t j = 0; j < kNearPorts; ++j) {
      const Vector6 wrench = footing.weights[j] *
                             from_port(body, footing.ports[j], footing.point).transpose() *
                             footing.wrench;
      for (std::uint32_t anchor = 0; anchor < anchors.size(); ++anchor) {
        const Vector6 motion = block(body, anchor, footing.ports[j]) * wrench;
        anchors[anchor].displacement += glm::dvec3(motion[0], motion[1], motion[2]);
        turns.turn[anchor] += normal.dot(motion.tail<3>());
      }
    }
  }
}

CompliantBody compliant_body(World& world, std::uint32_t row) {
  const OwnedRows& owned = world.bodies.at<OwnedRows>(row);
  CompliantBody body{world, row, world.anchors.rows<AnchorRest>(owned.anchors),
                     world.compliance.rows<ComplianceValue>(owned.compliance)};
  find_footings(body);
  return body;
}

void deform_body(StepContext& context, std::uint32_t row) {
  World& world = context.world;
  const CompliantBody body = compliant_body(world, row);
  const auto size = static_cast<Eigen::Index>(6 * body.count);
  Eigen::Map<RowMatrix> matrix(context.scratch.compliance_matrix.data(), size, size);
  Eigen::Map<Eigen::VectorXd> change(context.scratch.compliance_residuals.data(), size);
  change.setZero();
  const Elasticity& elasticity = world.bodies.at<Elasticity>(row);
  for (std::size_t j = 0; j < body.count; ++j) {
    const Footing& from = body.footings[j];
    const Vector6 stiffness = contact_stiffness(from, elasticity);
    const Matrix6 to_frame = to_region(world.regions.at<RegionFrame>(from.region));
    const Matrix6 in_body = to_frame.transpose() * stiffness.asDiagonal() * to_frame;
    for (std::size_t i = 0; i < body.count; ++i) {
      const Footing& to = body.footings[i];
      const auto at = static_cast<Eigen::Index>(6 * i);
      const SplitCompliance between =
          i == j ? own_compliance(body, from, stiffness.cwiseSqrt(), to_frame)
                 : both_alike(compliance_between(body, to, from));
      matrix.block<6, 6>(at, static_cast<Eigen::Index>(6 * j)) = between.yielding * in_body;
      change.segment<6>(at) += between.whole * from.wrench;
    }
  }
  for (std::size_t i = 0; i < body.count; ++i) {
    const auto at = static_cast<Eigen::Index>(6 * i);
    const Footing& footing = body.footings[i];
    matrix.block<6, 6>(at, at) += Matrix6::Identity();
    change.segment<6>(at) -=
        support_at(world.regions.at<RegionSupport>(footing.region), footing.point);
  }
  solve_in_place(matrix, change);
  move_supports(body, change);
}

}  // namespace

void compliance(StepContext& context) {
  for (std::uint32_t body = 0; body < context.world.bodies.size(); ++body) {
    if (context.world.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      deform_body(context, body);
    }
  }
}

void anchor_motions(StepContext& context) {
  World& world = context.world;
  for (std::uint32_t body = 0; body < world.bodies.size(); ++body) {
    if (world.bodies.at<BodyModels>(body).body == BodyModel::kCompliance) {
      move_anchors(compliant_body(world, body),
                   world.anchors.rows<AnchorMotion>(world.bodies.at<OwnedRows>(body).anchors));
    }
  }
}

}  // namespace torsion
