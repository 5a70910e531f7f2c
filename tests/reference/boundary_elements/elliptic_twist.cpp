// Makes elliptic_twist.csv: the couple of an elliptic contact under Hertz' pressure that is twisted
// about its normal, from boundary elements with Coulomb friction and history. Shares no code with
// what is tested.
//
// Half axes 1 and b, G = 1, mu times the largest pressure = 1; the pressure stays as it is. Cells
// are uniform rectangles (Cerruti's solution, integrated over each: Love, Phil. Trans. R. Soc. A
// 228 (1929) 377). In each of 24 steps every cell goes with the turn where that takes no more than
// mu p, else slips against its displacement so far: Gauss-Seidel sweeps until no traction changes
// by 2e-5. 300 to 900 cells; a disc of 344 cells is within 0.5 % of Lubkin's solution.
//
//   elliptic_twist > elliptic_twist.csv

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

namespace {

using std::numbers::pi;

constexpr int kSteps = 24;
constexpr int kMostSweeps = 400;

/// log(v + rho) with rho^2 = v^2 + other^2, without cancellation for v < 0.
double log_sum(double v, double other) {
  const double rho = std::hypot(v, other);
  return v < 0.0 ? std::log(other * other / (rho - v)) : std::log(v + rho);
}

/// The function's sum over the corners of a rectangle of half sides hx, hy about (x, y), with
/// signs.
template <class F>
double over_corners(const F& f, double x, double y, double hx, double hy) {
  return f(x + hx, y + hy) - f(x - hx, y + hy) - f(x + hx, y - hy) + f(x - hx, y - hy);
}

struct Cell {
  double x = 0.0, y = 0.0;
  double limit = 0.0;             // mu p, mean over the cell
  double qx = 0.0, qy = 0.0;      // traction on the body
  double ux = 0.0, uy = 0.0;      // displacement of the last step
  double to_x = 0.0, to_y = 0.0;  // displacement if it sticks
};

/// Displacement along and across for unit tractions, rows of cells (n x n).
struct Influences {
  std::vector<double> xx, xy, yy;
};

double mean_pressure(double b, const Cell& cell, double hx, double hy) {
  constexpr int kParts = 8;
  double sum = 0.0;
  for (int j = 0; j < kParts; ++j) {
    for (int i = 0; i < kParts; ++i) {
      const double x = cell.x + hx * ((2 * i + 1.0) / kParts - 1.0);
      const double y = cell.y + hy * ((2 * j + 1.0) / kParts - 1.0);
      sum += std::sqrt(std::max(1.0 - x * x - y * y / (b * b), 0.0));
    }
  }
  return sum / (kParts * kParts);
}

std::vector<Cell> make_cells(double b, int across, int along) {
  const double hx = 1.0 / along;
  const double hy = b / across;
  std::vector<Cell> cells;
  for (int j = 0; j < across; ++j) {
    for (int i = 0; i < along; ++i) {
      Cell cell;
      cell.x = (2 * i + 1) * hx - 1.0;
      cell.y = (2 * j + 1) * hy - b;
      cell.limit = mean_pressure(b, cell, hx, hy);
      if (cell.limit > 0.0) {
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

Influences make_influences(const std::vector<Cell>& cells, double nu, double hx, double hy) {
  Influences made;
  for (const Cell& at : cells) {
    for (const Cell& of : cells) {
      const double x = at.x - of.x;
      const double y = at.y - of.y;
      // Integrals of x^2, y^2 and x y over rho^3.
      const double x2 =
          over_corners([](double u, double v) { return v * log_sum(u, v); }, x, y, hx, hy);
      const double y2 =
          over_corners([](double u, double v) { return u * log_sum(v, u); }, x, y, hx, hy);
      const double xy =
          over_corners([](double u, double v) { return -std::hypot(u, v); }, x, y, hx, hy);
      made.xx.push_back((x2 + (1.0 - nu) * y2) / (2.0 * pi));
      made.yy.push_back((y2 + (1.0 - nu) * x2) / (2.0 * pi));
      made.xy.push_back(nu * xy / (2.0 * pi));
    }
  }
  return made;
}

void displacement(const std::vector<Cell>& cells, const Influences& influences, std::size_t k,
                  double& ux, double& uy) {
  ux = 0.0;
  uy = 0.0;
  const std::size_t row = k * cells.size();
  for (std::size_t l = 0; l < cells.size(); ++l) {
    ux += influences.xx[row + l] * cells[l].qx + influences.xy[row + l] * cells[l].qy;
    uy += influences.xy[row + l] * cells[l].qx + influences.yy[row + l] * cells[l].qy;
  }
}

/// One sweep; the largest change of a traction.
double sweep(std::vector<Cell>& cells, const Influences& influences, bool backwards) {
  const double stiffness = 1.0 / std::max(influences.xx[0], influences.yy[0]);
  double change = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t k = backwards ? cells.size() - 1 - i : i;
    Cell& cell = cells[k];
    double ux = 0.0;
    double uy = 0.0;
    displacement(cells, influences, k, ux, uy);
    double qx = cell.qx + stiffness * (cell.to_x - ux);
    double qy = cell.qy + stiffness * (cell.to_y - uy);
    const double share = std::min(1.0, cell.limit / std::max(std::hypot(qx, qy), 1e-300));
    qx *= share;
    qy *= share;
    change = std::max(change, std::hypot(qx - cell.qx, qy - cell.qy));
    cell.qx = qx;
    cell.qy = qy;
  }
  return change;
}

void twist(double b, double nu) {
  // Slender cells where the ellipse is slender.
  const int across = b < 0.3 ? 16 : b < 0.6 ? 20 : 24;
  const double slender = b < 0.4 ? 2.0 : 1.3;
  const int along = static_cast<int>(std::ceil(across / (b * slender)));
  const double hx = 1.0 / along;
  const double hy = b / across;
  std::vector<Cell> cells = make_cells(b, across, along);
  const Influences influences = make_influences(cells, nu, hx, hy);
  const double largest = 2.0 + 0.8 * (1.0 - b);
  double turn = 0.0;
  for (int step = 1; step <= kSteps; ++step) {
    const double next = largest * std::pow(static_cast<double>(step) / kSteps, 1.6);
    for (Cell& cell : cells) {
      cell.to_x = cell.ux - (next - turn) * cell.y;
      cell.to_y = cell.uy + (next - turn) * cell.x;
    }
    turn = next;
    for (int k = 0; k < kMostSweeps && sweep(cells, influences, k % 2 == 1) >= 2e-5; ++k) {
    }
    double couple = 0.0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      Cell& cell = cells[k];
      displacement(cells, influences, k, cell.ux, cell.uy);
      couple += 4.0 * hx * hy * (cell.x * cell.qy - cell.y * cell.qx);
    }
    std::printf("%g,%g,%.7g,%.6g\n", b, nu, turn, couple);
  }
}

}  // namespace

int main() {
  std::printf("axes,poisson_ratio,turn_rad,couple\n");
  for (const double b : {0.7, 0.5, 0.35, 0.25, 0.15}) {
    for (const double nu : {0.3, 0.5}) {
      twist(b, nu);
    }
  }
  return EXIT_SUCCESS;
}
