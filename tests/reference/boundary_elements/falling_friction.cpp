// Makes falling_friction.csv: the couple of a round contact under Hertz' pressure that is twisted
// about its normal, with friction that falls from mu_s to mu_d where it slips, by boundary
// elements. Shares no code with what is tested.
//
// Radius 1, G = 1, mu_d times the largest pressure = 1, nu = 0.5; the pressure stays as it is. A
// cell's coefficient is mu_d + (mu_s - mu_d) exp(-s / d) with s the way it has slipped since it
// last stuck, d 5 % of (2 - nu) mu_s F / (8 G a), the displacement of a disc at its friction limit:
// the law of docs/models.md. Cells are uniform squares (Cerruti's solution, integrated over each:
// Love, Phil. Trans. R. Soc. A 228 (1929) 377). Steps are so short that none slips by more than a
// tenth of d; in each Gauss-Seidel sweeps as in elliptic_twist.cpp.
//
//   falling_friction > falling_friction.csv

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

namespace {

using std::numbers::pi;

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
  double pressure = 0.0;          // mean over the cell; `limit` goes with what friction there is
  double slipped = 0.0;           // way since it last stuck
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

/// @param fall  mu_s / mu_d
void twist(double fall) {
  constexpr int kAcross = 28;
  constexpr double kNu = 0.5;
  constexpr double kLargest = 3.0;  // turn
  constexpr int kSteps = 1200;
  constexpr int kPrintEvery = 12;
  const double h = 1.0 / kAcross;
  std::vector<Cell> cells = make_cells(1.0, kAcross, kAcross);
  for (Cell& cell : cells) {
    cell.pressure = cell.limit;
  }
  const Influences influences = make_influences(cells, kNu, h, h);
  const double force = 2.0 / 3.0 * pi;
  const double decay = 0.05 * (2.0 - kNu) * fall * force / 8.0;
  for (int step = 1; step <= kSteps; ++step) {
    const double turn = kLargest / kSteps;
    for (Cell& cell : cells) {
      cell.to_x = cell.ux - turn * cell.y;
      cell.to_y = cell.uy + turn * cell.x;
      cell.limit = cell.pressure * (1.0 + (fall - 1.0) * std::exp(-cell.slipped / decay));
    }
    for (int k = 0; k < kMostSweeps && sweep(cells, influences, k % 2 == 1) >= 2e-5; ++k) {
    }
    double couple = 0.0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      Cell& cell = cells[k];
      displacement(cells, influences, k, cell.ux, cell.uy);
      couple += 4.0 * h * h * (cell.x * cell.qy - cell.y * cell.qx);
      const double slip = std::hypot(cell.to_x - cell.ux, cell.to_y - cell.uy);
      cell.slipped = slip > 1e-6 ? cell.slipped + slip : 0.0;
    }
    if (step % kPrintEvery == 0) {
      std::printf("%g,%.7g,%.6g\n", fall, turn * step, couple);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main() {
  std::printf("fall,turn_rad,couple\n");
  for (const double fall : {1.0, 1.25}) {
    twist(fall);
  }
  return EXIT_SUCCESS;
}
