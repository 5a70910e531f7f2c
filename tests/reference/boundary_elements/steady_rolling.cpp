// Makes steady_rolling.csv: friction and couple of a rigid ball that rolls over an elastic
// half-space, incompressible, at the same creepage and spin for ever. Shares no code with what is
// tested: the steady state is found directly, not by rolling up to it.
//
// Hertz' pressure stays as it is: nu = 0.5, so friction does not change it. In the frame that goes
// with the contact along x, material flows along -x through a grid of squares (Cerruti's solution,
// integrated over each: Love, Phil. Trans. R. Soc. A 228 (1929) 377). While it goes on by a square,
// the ball slips over it by s = c dx - (u(x) - u(x + dx)) with c the creepages, c = (along - spin
// y, across + spin x), and u the displacement of the material. A square sticks, s = 0, or has the
// traction mu p along s: q = P(q + s / B) with P onto the disc of radius mu p and B > 0 anything,
// which a semismooth Newton method solves (Alart and Curnier, Computer Methods in Applied Mechanics
// and Engineering 92 (1991) 353), until q and the right side differ by 1e-9 of the largest
// traction. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, 4.3.2.
//
// R = 50 mm, E = 3 MPa, F = 10 N; x, y and the normal into the ball make a right-handed frame. Of
// 24 and 48 squares to the diameter the values at no size of squares are extrapolated (their error
// goes with their size: 32 and 56 come to within 0.2 % of mu F and 0.04 % of mu F a of that); the
// column `grid` is how far those of 48 are from it, over mu F and mu F a. First two rows: so much
// friction that nothing slips, as Kalker's coefficients have it.
//
//   steady_rolling > steady_rolling.csv

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace {

using std::numbers::pi;

constexpr double kBallRadius = 0.05;   // m
constexpr double kShearModulus = 1e6;  // Pa
constexpr double kPoissonRatio = 0.5;
constexpr double kForce = 10.0;  // N
constexpr int kMostSteps = 60;

/// Displacements at a place by unit tractions on a square about the origin, m/Pa.
struct Influence {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// log(v + rho) with rho^2 = v^2 + other^2, without cancellation for v < 0.
double log_sum(double v, double other) {
  const double rho = std::hypot(v, other);
  return v < 0.0 ? std::log(other * other / (rho - v)) : std::log(v + rho);
}

/// The function's sum over the corners of a square of half side h about (x, y), with signs.
template <class F>
double over_corners(const F& f, double x, double y, double h) {
  return f(x + h, y + h) - f(x - h, y + h) - f(x + h, y - h) + f(x - h, y - h);
}

Influence influence_at(double x, double y, double h) {
  // Integrals of x^2, y^2 and x y over rho^3.
  const double x2 = over_corners([](double u, double v) { return v * log_sum(u, v); }, x, y, h);
  const double y2 = over_corners([](double u, double v) { return u * log_sum(v, u); }, x, y, h);
  const double xy = over_corners([](double u, double v) { return -std::hypot(u, v); }, x, y, h);
  const double scale = 1.0 / (2.0 * pi * kShearModulus);
  return {scale * (x2 + (1.0 - kPoissonRatio) * y2), scale * kPoissonRatio * xy,
          scale * (y2 + (1.0 - kPoissonRatio) * x2)};
}

struct Cell {
  int i = 0, j = 0;         // column along x, row
  double x = 0.0, y = 0.0;  // m
  double limit = 0.0;       // Pa: mu p, mean over the square
};

struct Load {
  double along = 0.0;   // N, on the half-space
  double across = 0.0;  // N
  double couple = 0.0;  // N m
};

struct Rolling {
  double friction = 0.0;
  double along = 0.0;  // creepages
  double across = 0.0;
  double spin = 0.0;  // 1/m
};

double hertz_radius() {
  const double modulus = 2.0 * kShearModulus / (1.0 - kPoissonRatio);  // E / (1 - nu^2)
  return std::cbrt(0.75 * kForce * kBallRadius / modulus);
}

double mean_pressure(double radius, const Cell& cell, double h) {
  constexpr int kParts = 16;
  double sum = 0.0;
  for (int j = 0; j < kParts; ++j) {
    for (int i = 0; i < kParts; ++i) {
      const double x = cell.x + h * ((2 * i + 1.0) / kParts - 1.0);
      const double y = cell.y + h * ((2 * j + 1.0) / kParts - 1.0);
      sum += std::sqrt(std::max(1.0 - (x * x + y * y) / (radius * radius), 0.0));
    }
  }
  return 1.5 * kForce / (pi * radius * radius) * sum / (kParts * kParts);
}

/// A disc's squares, from the front rim to the rear one.
std::vector<Cell> make_cells(const Rolling& rolling, int side) {
  const double radius = hertz_radius();
  const double h = radius / side;
  std::vector<Cell> cells;
  for (int i = side - 1; i >= 0; --i) {
    for (int j = 0; j < side; ++j) {
      Cell cell{i, j, (2 * i + 1) * h - radius, (2 * j + 1) * h - radius};
      cell.limit = rolling.friction * mean_pressure(radius, cell, h);
      if (cell.limit > 0.0) {
        cells.push_back(cell);
      }
    }
  }
  return cells;
}

/// u(x) - u(x + dx) by unit tractions, for squares apart by columns and rows.
class PassingInfluences {
 public:
  PassingInfluences(int side, double h) : side_(side) {
    for (int j = -side; j <= side; ++j) {
      for (int i = -side; i <= side; ++i) {
        const Influence here = influence_at(2.0 * h * i, 2.0 * h * j, h);
        const Influence before = influence_at(2.0 * h * (i + 1), 2.0 * h * j, h);
        values_.push_back({here.xx - before.xx, here.xy - before.xy, here.yy - before.yy});
      }
    }
  }
  [[nodiscard]] const Influence& of(const Cell& at, const Cell& from) const {
    return values_[static_cast<std::size_t>((at.j - from.j + side_) * (2 * side_ + 1) +
                                            (at.i - from.i + side_))];
  }

 private:
  int side_;
  std::vector<Influence> values_;
};

/// The slips, m, of all squares are `rigid` - `by_tractions` q: two rows a square.
struct Equations {
  Eigen::VectorXd rigid;
  Eigen::MatrixXd by_tractions;
  double scale = 0.0;  // Pa/m: 1 / B
};

Equations make_equations(const Rolling& rolling, const std::vector<Cell>& cells, int side) {
  const double dx = 2.0 * hertz_radius() / side;
  const PassingInfluences influences(side, 0.5 * dx);
  const auto count = static_cast<Eigen::Index>(cells.size());
  Equations made{Eigen::VectorXd(2 * count), Eigen::MatrixXd(2 * count, 2 * count), 0.0};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Cell& at = cells[static_cast<std::size_t>(k)];
    made.rigid[2 * k] = dx * (rolling.along - rolling.spin * at.y);
    made.rigid[2 * k + 1] = dx * (rolling.across + rolling.spin * at.x);
    for (Eigen::Index l = 0; l < count; ++l) {
      const Influence& influence = influences.of(at, cells[static_cast<std::size_t>(l)]);
      made.by_tractions.block<2, 2>(2 * k, 2 * l) << influence.xx, influence.xy, influence.xy,
          influence.yy;
    }
  }
  made.scale = 1.0 / made.by_tractions(0, 0);
  return made;
}

/// q - P(q + s / B) and its derivative by q.
double lacking(const Equations& equations, const std::vector<Cell>& cells,
               const Eigen::VectorXd& tractions, Eigen::VectorXd& value,
               Eigen::MatrixXd* derivative) {
  const Eigen::VectorXd asked =
      tractions + equations.scale * (equations.rigid - equations.by_tractions * tractions);
  if (derivative != nullptr) {
    derivative->setIdentity(asked.size(), asked.size());
  }
  value = tractions;
  for (Eigen::Index k = 0; k < asked.size() / 2; ++k) {
    const double limit = cells[static_cast<std::size_t>(k)].limit;
    const Eigen::Vector2d here = asked.segment<2>(2 * k);
    const double length = here.norm();
    Eigen::Matrix2d share = Eigen::Matrix2d::Identity();  // of P
    if (length > limit) {
      const Eigen::Vector2d along = here / length;
      share = limit / length * (Eigen::Matrix2d::Identity() - along * along.transpose());
      value.segment<2>(2 * k) -= limit * along;
    } else {
      value.segment<2>(2 * k) -= here;
    }
    if (derivative != nullptr) {
      derivative->block<2, 2>(2 * k, 2 * k) -= share;
      derivative->middleRows<2>(2 * k) +=
          equations.scale * share * equations.by_tractions.middleRows<2>(2 * k);
    }
  }
  return value.norm();
}

Load solve(const Rolling& rolling, int side) {
  const std::vector<Cell> cells = make_cells(rolling, side);
  const Equations equations = make_equations(rolling, cells, side);
  Eigen::VectorXd tractions = Eigen::VectorXd::Zero(equations.rigid.size());
  Eigen::VectorXd value;
  Eigen::MatrixXd derivative;
  bool found = false;
  for (int k = 0; k < kMostSteps && !found; ++k) {
    const double before = lacking(equations, cells, tractions, value, &derivative);
    const Eigen::VectorXd step = derivative.partialPivLu().solve(value);
    double share = 1.0;
    Eigen::VectorXd ignored;
    while (share > 1e-3 && lacking(equations, cells, tractions - share * step, ignored, nullptr) >
                               (1.0 - 1e-4 * share) * before) {
      share *= 0.5;
    }
    tractions -= share * step;
    found = lacking(equations, cells, tractions, value, nullptr) <= 1e-9 * tractions.norm();
  }
  if (!found) {
    std::fprintf(stderr, "steady_rolling: no steady state found at %d squares a side\n", side);
    std::exit(EXIT_FAILURE);
  }
  const double area = std::pow(2.0 * hertz_radius() / side, 2);
  Load load;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Eigen::Vector2d q = area * tractions.segment<2>(static_cast<Eigen::Index>(2 * k));
    load.along += q.x();
    load.across += q.y();
    load.couple += cells[k].x * q.y() - cells[k].y * q.x();
  }
  return load;
}

void print(const Rolling& rolling) {
  constexpr int kSide = 48;
  const Load coarse = solve(rolling, kSide / 2);
  const Load fine = solve(rolling, kSide);
  const double along = fine.along - coarse.along;
  const double across = fine.across - coarse.across;
  const double couple = fine.couple - coarse.couple;
  const double force = rolling.friction * kForce;
  const double grid = std::max({std::abs(along) / force, std::abs(across) / force,
                                std::abs(couple) / (force * hertz_radius())});
  std::printf("%g,%g,%g,%g,%.5f,%.5f,%.6f,%.2g\n", rolling.friction, rolling.along, rolling.across,
              rolling.spin, fine.along + along, fine.across + across, fine.couple + couple, grid);
}

}  // namespace

int main() {
  std::printf("friction,along,across,spin_per_m,along_N,across_N,couple_Nm,grid\n");
  print({1e6, 1e-3, 0.0, 0.0});
  print({1e6, 0.0, 1e-3, 0.0});
  for (const double along : {0.005, 0.01, 0.02, 0.05}) {
    print({0.75, along, 0.0, 0.0});
  }
  for (const double spin : {2.0, 8.0, 20.0}) {
    print({0.75, 0.0, 0.0, spin});
  }
  print({0.75, 0.0, 0.02, 0.0});
  print({0.75, 0.01, 0.01, 8.0});
  return EXIT_SUCCESS;
}
