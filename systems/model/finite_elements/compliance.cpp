#include "systems/model/finite_elements/compliance.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <glm/geometric.hpp>

#include "systems/math/linear_algebra.hpp"
#include "systems/math/wide_lanes.hpp"
#include "systems/model/cache.hpp"
#include "systems/model/finite_elements/grid.hpp"
#include "systems/model/finite_elements/loads.hpp"
#include "systems/model/finite_elements/solver.hpp"

namespace torsion::engine {
namespace {

constexpr std::uint32_t kVersion = 7;  // raise it when the same solid and ports give other numbers

std::uint32_t width_of(const SmoothComplianceOptions& options) {
  return options.couples ? 6 : 3;
}

CacheKey key_of(const ElasticSolid& solid, std::span<const std::byte> identity,
                std::span<const Port> ports, const SmoothComplianceOptions& options) {
  static_assert(sizeof(Port) == 6 * sizeof(double), "ports are hashed as bytes");
  const std::uint32_t width = width_of(options);
  const std::array<std::span<const std::byte>, 6> content{
      identity,
      std::as_bytes(std::span(&solid.bounds, 1)),
      std::as_bytes(ports),
      std::as_bytes(std::span(&solid.elasticity.poisson_ratio, 1)),
      std::as_bytes(std::span(&options.elements, 1)),
      std::as_bytes(std::span(&width, 1))};
  return cache_key("smooth_compliance", kVersion, content);
}

std::span<const std::byte> bytes_of(const Eigen::MatrixXd& matrix) {
  return std::as_bytes(std::span(matrix.data(), static_cast<std::size_t>(matrix.size())));
}

/// The matrices, then the asymmetry.
std::vector<std::byte> to_bytes(const SmoothCompliance& compliance) {
  std::vector<std::byte> bytes;
  for (const std::span<const std::byte> part :
       {bytes_of(compliance.matrix), bytes_of(compliance.turns),
        std::as_bytes(std::span(&compliance.relative_asymmetry, 1))}) {
    bytes.insert(bytes.end(), part.begin(), part.end());
  }
  return bytes;
}

/// nullopt if the bytes are no matrices with so many rows.
std::optional<SmoothCompliance> from_bytes(std::span<const std::byte> bytes, std::size_t rows,
                                           bool couples) {
  const std::size_t matrix_bytes = rows * rows * sizeof(double);
  const std::size_t turns_bytes = couples ? 0 : matrix_bytes;
  if (bytes.size() != matrix_bytes + turns_bytes + sizeof(double)) {
    return std::nullopt;
  }
  const auto side = static_cast<Eigen::Index>(rows);
  const Eigen::Index turns_side = couples ? 0 : side;
  SmoothCompliance compliance{Eigen::MatrixXd(side, side), Eigen::MatrixXd(turns_side, turns_side),
                              0.0};
  std::memcpy(compliance.matrix.data(), bytes.data(), matrix_bytes);
  if (turns_bytes > 0) {
    std::memcpy(compliance.turns.data(), bytes.data() + matrix_bytes, turns_bytes);
  }
  std::memcpy(&compliance.relative_asymmetry, bytes.data() + matrix_bytes + turns_bytes,
              sizeof(double));
  return compliance;
}

}  // namespace

Result<SmoothCompliance> load_or_build_smooth_compliance(const ElasticSolid& solid,
                                                         std::span<const std::byte> identity,
                                                         std::span<const Port> ports,
                                                         const SmoothComplianceOptions& options) {
  const double youngs_modulus = solid.elasticity.youngs_modulus;
  if (!(youngs_modulus > 0.0)) {
    return build_smooth_compliance(solid, ports, options);
  }
  const CacheKey key = key_of(solid, identity, ports, options);
  std::optional<SmoothCompliance> found;
  if (const std::optional<std::vector<std::byte>> cached = load_cached(key)) {
    found = from_bytes(*cached, width_of(options) * ports.size(), options.couples);
  }
  if (!found) {
    // For a modulus of 1 Pa, so that the bits are the same whether cached or not.
    ElasticSolid unit = solid;
    unit.elasticity.youngs_modulus = 1.0;
    Result<SmoothCompliance> built = build_smooth_compliance(unit, ports, options);
    if (!built) {
      return built.error();
    }
    found = std::move(built).value();
    // a cache that cannot be written only costs time
    store_cached(key, to_bytes(*found));
  }
  found->matrix /= youngs_modulus;
  found->turns /= youngs_modulus;
  return *std::move(found);
}

namespace {

/// Of the shear modulus: keeps nu = 0.5 solvable. Changes of volume are then a ten-thousandth of
/// changes of shape.
constexpr double kLargestBulkModulus = 1e4;
constexpr std::size_t kPortsAtOnce = 8;  // solved together: enough for the matrix products' speed
constexpr double kShareOfFactor = 0.3;   // of the time, roughly, for the progress

double bulk_modulus(double poisson_ratio) {
  const double softness = 1.5 * (1.0 - 2.0 * poisson_ratio) / (1.0 + poisson_ratio);
  return softness * kLargestBulkModulus > 1.0 ? 1.0 / softness : kLargestBulkModulus;
}

/// An element with some of its nodes clamped.
struct ClampedElement {
  std::array<std::uint32_t, 8> nodes;
  ElementStiffness stiffness;
};

std::vector<ClampedElement> clamped_elements(const SolidGrid& grid, double bulk_modulus) {
  std::vector<ClampedElement> found;
  for (std::size_t e = 0; e < grid.elements.size(); ++e) {
    const std::array<std::uint32_t, 8>& nodes = grid.elements[e];
    const auto clamped = std::count_if(nodes.begin(), nodes.end(),
                                       [&](std::uint32_t node) { return grid.clamped[node] != 0; });
    if (clamped > 0 && clamped < 8) {
      found.push_back({nodes, element_stiffness(element_corners(grid, e), bulk_modulus)});
    }
  }
  return found;
}

/// What all ports share. The shear modulus is 1.
struct Problem {
  const SolidGrid& grid;
  const StiffnessFactor& factor;
  const std::vector<ClampedElement>& clamped;
  std::span<const Port> ports;
  const std::vector<MotionFit>& fits;
  Elasticity elasticity;
  double longest_side;   // m
  double shortest_side;  // m
  int width;             // rows and columns of a port: 3 without torques and rotations, else 6
};

/// Moves the prescribed displacements of clamped nodes to the loads on the free ones.
void add_held(const Problem& problem, const PortLoads& loads, Eigen::Ref<Eigen::MatrixXd> forces) {
  Eigen::MatrixXd held(24, loads.held.cols());
  Eigen::MatrixXd reaction(24, loads.held.cols());
  for (const ClampedElement& element : problem.clamped) {
    for (std::size_t c = 0; c < 8; ++c) {
      held.middleRows<3>(rows_of(c)) = loads.held.middleRows<3>(rows_of(element.nodes[c]));
    }
    reaction.noalias() = element.stiffness * held;
    for (std::size_t c = 0; c < 8; ++c) {
      forces.middleRows<3>(rows_of(element.nodes[c])) -= reaction.middleRows<3>(rows_of(c));
    }
  }
}

/// Translation and rotation at a port for each column of nodal displacements. The surface there is
/// free of shear, so the tangential rotation is the slope of the normal displacement: only
/// derivatives along the surface are needed, which elements give best. Free of shear is the whole
/// field, not its smooth part alone: add_shear() corrects for that.
void add_motion(const MotionFit& fit, const glm::dvec3& normal, const NodeColumns& motion,
                Eigen::Ref<Eigen::MatrixXd> rows) {
  const Eigen::Vector3d n(normal.x, normal.y, normal.z);
  for (std::size_t k = 0; k < fit.nodes.size(); ++k) {
    const Eigen::MatrixXd at = motion.middleRows<3>(rows_of(fit.nodes[k]));
    const Eigen::Vector4d w = fit.weights.col(static_cast<Eigen::Index>(k));
    const Eigen::Vector3d slope = w.tail<3>();
    const Eigen::Vector3d tilt = slope.cross(n);        // of the normal displacement
    const Eigen::Vector3d turn = 0.5 * n.cross(slope);  // about n: n . curl / 2
    rows.topRows<3>() += w[0] * at;
    rows.bottomRows<3>() += tilt * (n.transpose() * at);
    rows.bottomRows<3>() += n * (turn.transpose() * at);
  }
}

/// Half the shear strain that each unit wrench's half-space field at `load` has at `port`, as a
/// rotation.
void add_shear(const Problem& problem, const Port& load, const Port& port,
               Eigen::Ref<Eigen::MatrixXd> rows) {
  for (int column = 0; column < problem.width; ++column) {
    const glm::dvec3 traction =
        half_space_stress(load, problem.elasticity, unit_wrench(column), port.position) *
        port.normal;
    const glm::dvec3 turn = -0.5 * glm::cross(port.normal, traction);  // shear modulus 1
    rows.block<3, 1>(3, column) += Eigen::Vector3d(turn.x, turn.y, turn.z);
  }
}

/// Fills the matrix's columns of ports `first` and following.
void solve_ports(const Problem& problem, std::size_t first, std::size_t count,
                 Eigen::MatrixXd& matrix) {
  const std::size_t nodes = problem.grid.nodes.size();
  const Eigen::Index each = problem.width;
  const Eigen::Index width = each * static_cast<Eigen::Index>(count);
  // Whole vectors, which the products are fastest with.
  NodeColumns columns =
      NodeColumns::Zero(rows_of(problem.factor.free_nodes),
                        static_cast<Eigen::Index>(whole_lanes(static_cast<std::size_t>(width))));
  NodeColumns motion(rows_of(nodes), width);
  for (std::size_t p = 0; p < count; ++p) {
    PortLoads loads = loads_of_port(problem.grid, problem.elasticity, problem.ports[first + p],
                                    problem.shortest_side, problem.width);
    add_held(problem, loads, loads.forces);
    const Eigen::Index column = each * static_cast<Eigen::Index>(p);
    for (std::size_t node = 0; node < nodes; ++node) {
      const std::uint32_t at = problem.factor.order[node];
      if (at == kNoRow) {
        motion.block(rows_of(node), column, 3, each) = loads.held.middleRows<3>(rows_of(node));
      } else {
        columns.block(rows_of(at), column, 3, each) = loads.forces.middleRows<3>(rows_of(node));
      }
    }
  }
  solve_stiffness(problem.factor, columns);
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::uint32_t at = problem.factor.order[node];
    if (at != kNoRow) {
      motion.middleRows<3>(rows_of(node)) = columns.block(rows_of(at), 0, 3, width);
    }
  }
  const Eigen::Index left = each * static_cast<Eigen::Index>(first);
  for (std::size_t i = 0; i < problem.fits.size(); ++i) {
    const Eigen::Index top = 6 * static_cast<Eigen::Index>(i);
    add_motion(problem.fits[i], problem.ports[i].normal, motion, matrix.block(top, left, 6, width));
    for (std::size_t p = 0; p < count; ++p) {
      if (first + p != i) {
        add_shear(problem, problem.ports[first + p], problem.ports[i],
                  matrix.block(top, left + each * static_cast<Eigen::Index>(p), 6, each));
      }
    }
  }
}

/// All columns, port by port, in the given number of threads; six rows a port.
Eigen::MatrixXd solve_all(const Problem& problem, const SmoothComplianceOptions& options) {
  const auto ports = static_cast<Eigen::Index>(problem.ports.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6 * ports, problem.width * ports);
  std::atomic<std::size_t> next{0};
  const auto work = [&](bool reports) {
    for (std::size_t first = next.fetch_add(kPortsAtOnce); first < problem.ports.size();
         first = next.fetch_add(kPortsAtOnce)) {
      solve_ports(problem, first, std::min(kPortsAtOnce, problem.ports.size() - first), matrix);
      if (reports && options.progress) {
        const double done = static_cast<double>(std::min(next.load(), problem.ports.size())) /
                            static_cast<double>(problem.ports.size());
        options.progress(kShareOfFactor + (1.0 - kShareOfFactor) * done);
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::uint32_t helper = 1; helper < options.threads; ++helper) {
      helpers.emplace_back(work, false);
    }
    work(true);
  }
  return matrix;
}

/// Three of each port's six rows, from `first` on.
Eigen::MatrixXd rows_of_ports(const Eigen::MatrixXd& rows, Eigen::Index first) {
  Eigen::MatrixXd chosen(rows.rows() / 2, rows.cols());
  for (Eigen::Index port = 0; 6 * port < rows.rows(); ++port) {
    chosen.middleRows<3>(3 * port) = rows.middleRows<3>(6 * port + first);
  }
  return chosen;
}

/// How far the whole compliance between the ports, including the half-spaces', is from symmetric.
double asymmetry_of(const Problem& problem, const Eigen::MatrixXd& smooth) {
  const Eigen::Index each = problem.width;
  Eigen::MatrixXd whole = smooth;
  for (std::size_t i = 0; i < problem.ports.size(); ++i) {
    for (std::size_t j = 0; j < problem.ports.size(); ++j) {
      if (i != j) {
        whole.block(each * static_cast<Eigen::Index>(i), each * static_cast<Eigen::Index>(j), each,
                    each) +=
            half_space_response(problem.ports[i], problem.ports[j], problem.elasticity)
                .topLeftCorner(each, each);
      }
    }
  }
  Eigen::VectorXd scale(whole.rows());
  for (Eigen::Index row = 0; row < whole.rows(); ++row) {
    scale[row] = row % each < 3 ? 1.0 : 0.5 * problem.longest_side;
  }
  whole = (scale.asDiagonal() * whole * scale.asDiagonal()).eval();
  const double norm = whole.norm();
  return norm > 0.0 ? (whole - whole.transpose()).norm() / norm : 0.0;
}

}  // namespace

Result<SmoothCompliance> build_smooth_compliance(const ElasticSolid& solid,
                                                 std::span<const Port> ports,
                                                 const SmoothComplianceOptions& options) {
  const glm::dvec3 extent = solid.bounds.highest - solid.bounds.lowest;
  const double poisson_ratio = solid.elasticity.poisson_ratio;
  if (!(std::min({extent.x, extent.y, extent.z}) > 0.0)) {
    return Error{"the body has no extent"};
  }
  if (!(solid.elasticity.youngs_modulus > 0.0) || !(poisson_ratio > -1.0) ||
      !(poisson_ratio <= 0.5)) {
    return Error{
        "the body's material needs a Young's modulus above 0 and a Poisson's ratio above "
        "-1 and at most 0.5"};
  }
  Result<SolidGrid> grid = build_solid_grid(solid, std::clamp(options.elements, 8U, 64U));
  if (!grid) {
    return grid.error();
  }
  const double bulk = bulk_modulus(poisson_ratio);
  Result<StiffnessFactor> factor = factor_stiffness(
      grid.value(),
      [&](std::size_t element) {
        return element_stiffness(element_corners(grid.value(), element), bulk);
      },
      [&](double done) {
        if (options.progress) {
          options.progress(kShareOfFactor * done);
        }
      });
  if (!factor) {
    return factor.error();
  }
  std::vector<MotionFit> fits;
  for (const Port& port : ports) {
    fits.push_back(fit_motion(grid.value(), port.position));
  }
  // With G = 1 the matrix is the same for all moduli; it scales with 1/G.
  const std::vector<ClampedElement> clamped = clamped_elements(grid.value(), bulk);
  const Problem problem{grid.value(),
                        factor.value(),
                        clamped,
                        ports,
                        fits,
                        {2.0 * (1.0 + poisson_ratio), poisson_ratio, solid.elasticity.density},
                        std::max({extent.x, extent.y, extent.z}),
                        std::min({extent.x, extent.y, extent.z}),
                        options.couples ? 6 : 3};
  const double modulus = solid.elasticity.shear_modulus();
  Eigen::MatrixXd smooth = solve_all(problem, options);
  SmoothCompliance compliance;
  if (!options.couples) {
    compliance.turns = rows_of_ports(smooth, 3) / modulus;
    smooth = rows_of_ports(smooth, 0);
  }
  compliance.relative_asymmetry = asymmetry_of(problem, smooth);
  compliance.matrix = 0.5 / modulus * (smooth + smooth.transpose());
  return compliance;
}

}  // namespace torsion::engine
