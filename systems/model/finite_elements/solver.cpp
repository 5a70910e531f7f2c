#include "systems/model/finite_elements/solver.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include "systems/math/dense_cholesky.hpp"
#include "systems/model/finite_elements/grid.hpp"

namespace torsion::engine {
namespace {

constexpr int kModes = 18;
using Modes = Eigen::Matrix<double, 6, kModes>;  // rows xx, yy, zz, xy, yz, zx
using Strains = Eigen::Matrix<double, 6, 24>;    // engineering shear strains
using Compliance = Eigen::Matrix<double, 6, 6>;

/// a b', symmetrised, as a stress.
Eigen::Matrix<double, 6, 1> dyad(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.x * b.x,
          a.y * b.y,
          a.z * b.z,
          0.5 * (a.x * b.y + a.y * b.x),
          0.5 * (a.y * b.z + a.z * b.y),
          0.5 * (a.z * b.x + a.x * b.z)};
}

/// Constant stresses; and for each of the element's axes the direct stress along it, which varies
/// with the two other coordinates and their product, and the shear in their plane, which varies
/// along it.
Modes stress_modes(const glm::dmat3& axes, const glm::dvec3& local) {
  Modes modes = Modes::Zero();
  modes.leftCols<6>().setIdentity();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const Eigen::Matrix<double, 6, 1> direct = dyad(axes[k], axes[k]);
    modes.col(6 + 4 * k) = direct * local[i];
    modes.col(7 + 4 * k) = direct * local[j];
    modes.col(8 + 4 * k) = direct * (local[i] * local[j]);
    modes.col(9 + 4 * k) = dyad(axes[i], axes[j]) * local[k];
  }
  return modes;
}

Strains strains_of_corners(const glm::dmat3& jacobian, const glm::dvec3& local) {
  const std::array<glm::dvec3, 8> slopes = corner_slopes(jacobian, local);
  Strains strains = Strains::Zero();
  for (std::uint32_t c = 0; c < 8; ++c) {
    const glm::dvec3& slope = slopes[c];
    const Eigen::Index first = 3 * Eigen::Index{c};
    strains(0, first) = slope.x;
    strains(1, first + 1) = slope.y;
    strains(2, first + 2) = slope.z;
    strains(3, first) = slope.y;
    strains(3, first + 1) = slope.x;
    strains(4, first + 1) = slope.z;
    strains(4, first + 2) = slope.y;
    strains(5, first) = slope.z;
    strains(5, first + 2) = slope.x;
  }
  return strains;
}

}  // namespace

ElementStiffness element_stiffness(const std::array<glm::dvec3, 8>& corners, double bulk_modulus) {
  Compliance compliance = Compliance::Zero();
  compliance.topLeftCorner<3, 3>().setConstant(1.0 / (9.0 * bulk_modulus) - 1.0 / 6.0);
  compliance.diagonal().head<3>().array() += 0.5;
  compliance.diagonal().tail<3>().setOnes();

  // The modes at all points below each other, and beside them what they are multiplied by: the
  // strains of the modes, and those of the corners. Negative, since products are subtracted.
  constexpr std::size_t kPoints = 8;
  constexpr std::size_t kRows = 6 * kPoints;
  constexpr std::size_t kWidth = 48;
  constexpr Eigen::Index kLeverage = 24;  // its first column
  Eigen::Matrix<double, kRows, kModes, Eigen::RowMajor> modes;
  Eigen::Matrix<double, kRows, kWidth, Eigen::RowMajor> strains =
      Eigen::Matrix<double, kRows, kWidth, Eigen::RowMajor>::Zero();
  constexpr double kGauss = 0.5773502691896258;
  const glm::dmat3 axes = element_jacobian(corners, glm::dvec3(0.0));
  const double length = 1.0 / std::cbrt(glm::determinant(axes));
  for (std::uint32_t c = 0; c < kPoints; ++c) {
    const glm::dvec3 local(c & 1U ? kGauss : -kGauss, c & 2U ? kGauss : -kGauss,
                           c & 4U ? kGauss : -kGauss);
    const glm::dmat3 jacobian = element_jacobian(corners, local);
    const double volume = glm::determinant(jacobian);
    const Modes here = stress_modes(axes * length, local);
    const Eigen::Index row = 6 * Eigen::Index{c};
    modes.middleRows<6>(row) = here;
    strains.block<6, kModes>(row, 0) = -volume * compliance.lazyProduct(here);
    strains.block<6, 24>(row, kLeverage) = -volume * strains_of_corners(jacobian, local);
  }
  // Flexibility and, from kLeverage on, leverage of the modes.
  Eigen::Matrix<double, kModes, kWidth, Eigen::RowMajor> sums =
      Eigen::Matrix<double, kModes, kWidth, Eigen::RowMajor>::Zero();
  subtract_product(kModes, kRows, kWidth, {modes.data(), 1, kModes}, {strains.data(), kWidth},
                   {sums.data(), kWidth});
  ElementStiffness stiffness = ElementStiffness::Zero();
  double* const leverage = sums.data() + kLeverage;
  if (!factor_cholesky(kModes, sums.data(), kWidth)) {
    stiffness.setConstant(std::numeric_limits<double>::quiet_NaN());
    return stiffness;  // which no factor is found of
  }
  solve_lower(kModes, sums.data(), kWidth, 24, {leverage, kWidth});
  subtract_product(24, kModes, 24, {leverage, 1, kWidth}, {leverage, kWidth},
                   {stiffness.data(), 24});
  return -stiffness;
}

namespace {

constexpr std::size_t kLeafNodes = 24;  // fewer make more fronts than they save arithmetic

/// Orders `nodes` behind those ordered before: both sides of a plane of the lattice, then the plane
/// itself. Returns the rows of the fronts at the top of this tree.
std::vector<std::uint32_t> dissect(const SolidGrid& grid, std::vector<std::uint32_t> nodes,
                                   StiffnessFactor& factor) {
  if (nodes.empty()) {
    return {};
  }
  glm::uvec3 lowest = grid.lattice[nodes.front()];
  glm::uvec3 highest = lowest;
  for (const std::uint32_t node : nodes) {
    lowest = glm::min(lowest, grid.lattice[node]);
    highest = glm::max(highest, grid.lattice[node]);
  }
  const glm::uvec3 extent = highest - lowest;
  StiffnessFront front;
  if (nodes.size() > kLeafNodes) {
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      axis = extent[k] > extent[axis] ? k : axis;
    }
    const std::uint32_t plane = (lowest[axis] + highest[axis] + 1) / 2;
    std::vector<std::uint32_t> before;
    std::vector<std::uint32_t> after;
    std::vector<std::uint32_t> within;
    for (const std::uint32_t node : nodes) {
      const std::uint32_t at = grid.lattice[node][axis];
      (at < plane ? before : at > plane ? after : within).push_back(node);
    }
    front.children = dissect(grid, std::move(before), factor);
    const std::vector<std::uint32_t> more = dissect(grid, std::move(after), factor);
    front.children.insert(front.children.end(), more.begin(), more.end());
    nodes = std::move(within);
    if (nodes.empty()) {
      return front.children;
    }
  }
  front.first = factor.free_nodes;
  front.count = static_cast<std::uint32_t>(nodes.size());
  for (const std::uint32_t node : nodes) {
    factor.order[node] = factor.free_nodes++;
  }
  factor.fronts.push_back(std::move(front));
  return {static_cast<std::uint32_t>(factor.fronts.size() - 1)};
}

/// For each front, the elements whose first eliminated node is its own.
std::vector<std::vector<std::uint32_t>> elements_of_fronts(const SolidGrid& grid,
                                                           const StiffnessFactor& factor) {
  std::vector<std::uint32_t> front_of(factor.free_nodes);
  for (std::size_t f = 0; f < factor.fronts.size(); ++f) {
    const StiffnessFront& front = factor.fronts[f];
    std::fill_n(front_of.begin() + front.first, front.count, static_cast<std::uint32_t>(f));
  }
  std::vector<std::vector<std::uint32_t>> elements(factor.fronts.size());
  for (std::size_t element = 0; element < grid.elements.size(); ++element) {
    std::uint32_t earliest = kNoRow;
    for (const std::uint32_t node : grid.elements[element]) {
      earliest = std::min(earliest, factor.order[node]);
    }
    if (earliest != kNoRow) {
      elements[front_of[earliest]].push_back(static_cast<std::uint32_t>(element));
    }
  }
  return elements;
}

void find_boundary(const SolidGrid& grid, const std::vector<std::uint32_t>& elements,
                   StiffnessFactor& factor, StiffnessFront& front) {
  const std::uint32_t end = front.first + front.count;
  std::vector<std::uint32_t>& boundary = front.boundary;
  for (const std::uint32_t element : elements) {
    for (const std::uint32_t node : grid.elements[element]) {
      if (factor.order[node] != kNoRow && factor.order[node] >= end) {
        boundary.push_back(factor.order[node]);
      }
    }
  }
  for (const std::uint32_t child : front.children) {
    std::copy_if(factor.fronts[child].boundary.begin(), factor.fronts[child].boundary.end(),
                 std::back_inserter(boundary), [&](std::uint32_t node) { return node >= end; });
  }
  std::sort(boundary.begin(), boundary.end());
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
}

/// The place of a node in a front's matrix.
std::uint32_t place_in(const StiffnessFront& front, std::uint32_t node) {
  if (node < front.first + front.count) {
    return node - front.first;
  }
  const auto found = std::lower_bound(front.boundary.begin(), front.boundary.end(), node);
  return front.count + static_cast<std::uint32_t>(found - front.boundary.begin());
}

/// Adds the 3 x 3 blocks of `part` to the lower triangle of `matrix` at `places`.
template <class Part>
void add_blocks(const Part& part, const std::vector<std::uint32_t>& places,
                Eigen::MatrixXd& matrix) {
  for (std::size_t j = 0; j < places.size(); ++j) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[j] == kNoRow || places[i] == kNoRow || places[i] < places[j]) {
        continue;
      }
      matrix.block<3, 3>(rows_of(places[i]), rows_of(places[j])) +=
          part.template block<3, 3>(rows_of(i), rows_of(j));
    }
  }
}

/// Eliminates a front's own nodes, and leaves the Schur complement on its boundary in the lower
/// triangle of `rest`. False if a pivot is not positive.
bool eliminate(Eigen::MatrixXd& matrix, StiffnessFront& front, Eigen::MatrixXd& rest) {
  const Eigen::Index own = rows_of(front.count);
  const Eigen::Index outer = rows_of(front.boundary.size());
  const auto size = static_cast<std::size_t>(matrix.rows());
  const auto own_rows = static_cast<std::size_t>(own);
  const auto outer_rows = static_cast<std::size_t>(outer);
  if (!factor_cholesky(own_rows, matrix.data(), size)) {
    return false;
  }
  if (outer > 0) {
    double* const below = matrix.data() + own;
    // Stored by columns, `below` is stored by rows as its transpose, of which L^-1 is to be taken.
    solve_lower(own_rows, matrix.data(), size, outer_rows, {below, size});
    subtract_square(outer_rows, own_rows, below, below + own * matrix.rows(), size);
  }
  front.diagonal = matrix.topLeftCorner(own, own);
  front.below = matrix.bottomLeftCorner(outer, own);
  rest = matrix.bottomRightCorner(outer, outer);
  return true;
}

}  // namespace

Result<StiffnessFactor> factor_stiffness(
    const SolidGrid& grid, const std::function<ElementStiffness(std::size_t row)>& stiffness,
    const std::function<void(double)>& progress) {
  StiffnessFactor factor;
  factor.order.assign(grid.nodes.size(), kNoRow);
  std::vector<std::uint32_t> free;
  for (std::size_t node = 0; node < grid.nodes.size(); ++node) {
    if (grid.clamped[node] == 0) {
      free.push_back(static_cast<std::uint32_t>(node));
    }
  }
  dissect(grid, std::move(free), factor);
  const std::vector<std::vector<std::uint32_t>> elements = elements_of_fronts(grid, factor);

  std::vector<Eigen::MatrixXd> rests(factor.fronts.size());
  std::vector<std::uint32_t> places;
  for (std::size_t f = 0; f < factor.fronts.size(); ++f) {
    StiffnessFront& front = factor.fronts[f];
    find_boundary(grid, elements[f], factor, front);
    const Eigen::Index size = rows_of(front.count + front.boundary.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    for (const std::uint32_t element : elements[f]) {
      places.clear();
      for (const std::uint32_t node : grid.elements[element]) {
        const std::uint32_t at = factor.order[node];
        places.push_back(at == kNoRow ? kNoRow : place_in(front, at));
      }
      add_blocks(stiffness(element), places, matrix);
    }
    for (const std::uint32_t child : front.children) {
      places.clear();
      for (const std::uint32_t at : factor.fronts[child].boundary) {
        places.push_back(place_in(front, at));
      }
      add_blocks(rests[child], places, matrix);
      rests[child].resize(0, 0);
    }
    if (!eliminate(matrix, front, rests[f])) {
      return Error{
          "the body's stiffness is singular: a part of it hangs on by an edge only, or "
          "nothing holds it"};
    }
    if (progress) {
      progress(static_cast<double>(f + 1) / static_cast<double>(factor.fronts.size()));
    }
  }
  return factor;
}

void solve_stiffness(const StiffnessFactor& factor, NodeColumns& columns) {
  const auto width = static_cast<std::size_t>(columns.cols());
  const auto rows_from = [&](std::size_t node) {
    return RowsPlace{columns.data() + 3 * node * width, width};
  };
  NodeColumns outer;
  for (const StiffnessFront& front : factor.fronts) {
    const std::size_t own_rows = 3 * std::size_t{front.count};
    const std::size_t outer_rows = 3 * front.boundary.size();
    const RowsPlace own = rows_from(front.first);
    solve_lower(own_rows, front.diagonal.data(), own_rows, width, own);
    outer.setZero(rows_of(front.boundary.size()), columns.cols());
    subtract_product(outer_rows, own_rows, width, {front.below.data(), 1, outer_rows}, own,
                     {outer.data(), width});
    for (std::size_t k = 0; k < front.boundary.size(); ++k) {
      columns.middleRows<3>(rows_of(front.boundary[k])) += outer.middleRows<3>(rows_of(k));
    }
  }
  for (std::size_t f = factor.fronts.size(); f-- > 0;) {
    const StiffnessFront& front = factor.fronts[f];
    const std::size_t own_rows = 3 * std::size_t{front.count};
    const std::size_t outer_rows = 3 * front.boundary.size();
    const RowsPlace own = rows_from(front.first);
    outer.resize(rows_of(front.boundary.size()), columns.cols());
    for (std::size_t k = 0; k < front.boundary.size(); ++k) {
      outer.middleRows<3>(rows_of(k)) = columns.middleRows<3>(rows_of(front.boundary[k]));
    }
    subtract_product(own_rows, outer_rows, width, {front.below.data(), outer_rows, 1},
                     {outer.data(), width}, own);
    solve_lower_transposed(own_rows, front.diagonal.data(), own_rows, width, own);
  }
}

}  // namespace torsion::engine
