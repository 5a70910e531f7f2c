#include "systems/patch/disc_projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "systems/math/lanes.hpp"
#include "systems/math/wide_lanes.hpp"
#include "systems/patch/passes.hpp"

namespace torsion::engine {
namespace {

constexpr int kMostNewtonPasses = 16;  // of Newton's method: two or three as a rule, ten seen
constexpr int kMostLengths = 12;       // of one of its steps
constexpr double kBalanced = 1e-6;     // of what friction moves a cell by on its own
constexpr double kRounding = 1e-14;    // of the motions
constexpr double kUphill = 0.5;        // of the slope downhill: then a step was too long
constexpr double kTiny = 1e-300;       // keeps 0 / 0 away

template <class Wide>
TORSION_LANES void find_load(std::size_t count, const double* place_x, const double* place_y,
                             const double* x, const double* y, SurfaceLoad& load) {
  std::array<Wide, 3> sums{};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Wide along_x = lanes_at<Wide>(x + k);
    const Wide along_y = lanes_at<Wide>(y + k);
    sums[0] += along_x;
    sums[1] += along_y;
    sums[2] += lanes_at<Wide>(place_x + k) * along_y - lanes_at<Wide>(place_y + k) * along_x;
  }
  load = {sum_of(sums[0]), sum_of(sums[1]), sum_of(sums[2])};
}

TORSION_WIDEST
void take_off(std::size_t count, const SurfaceMotion& motion, const double* __restrict place_x,
              const double* __restrict place_y, const double* __restrict from_x,
              const double* __restrict from_y, double* __restrict x, double* __restrict y) {
  const SurfaceMotion by = motion;
  for (std::size_t k = 0; k < count; ++k) {
    x[k] = from_x[k] - (by.x - by.z * place_y[k]);
    y[k] = from_y[k] - (by.y + by.z * place_x[k]);
  }
}

TORSION_WIDEST
void project(std::size_t count, const SurfaceMotion& motion, const double* __restrict place_x,
             const double* __restrict place_y, const double* __restrict stiffness,
             const double* __restrict limits, const double* __restrict trial_x,
             const double* __restrict trial_y, double* __restrict result_x,
             double* __restrict result_y, double* __restrict answer_xx,
             double* __restrict answer_xy, double* __restrict answer_yy) {
  const SurfaceMotion by = motion;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = trial_x[k] - stiffness[k] * (by.x - by.z * place_y[k]);
    const double y = trial_y[k] - stiffness[k] * (by.y + by.z * place_x[k]);
    const double limit = limits[k];
    const double square = x * x + y * y;
    const double inverse = 1.0 / std::sqrt(larger(square, kTiny));
    const bool outside = square > limit * limit;
    const double share = outside ? limit * inverse : 1.0;
    const double out_x = outside ? x * inverse : 0.0;
    const double out_y = outside ? y * inverse : 0.0;
    const double answer = stiffness[k] * share;
    result_x[k] = share * x;
    result_y[k] = share * y;
    // On the disc's rim a cell responds only along the rim.
    answer_xx[k] = answer * (1.0 - out_x * out_x);
    answer_xy[k] = -answer * out_x * out_y;
    answer_yy[k] = answer * (1.0 - out_y * out_y);
  }
}

/// Sums of the cells' responses to the motions x, y and turning: xx, xy, yy, xt, yt, tt.
template <class Wide>
TORSION_LANES void add_answers(const DiscColumns& columns, std::array<double, 6>& totals) {
  std::array<Wide, 6> sums{};
  for (std::size_t k = 0; k < columns.place_x.size(); k += kLanes) {
    const Wide x = lanes_at<Wide>(&columns.place_x[k]);
    const Wide y = lanes_at<Wide>(&columns.place_y[k]);
    const Wide xx = lanes_at<Wide>(&columns.answer_xx[k]);
    const Wide xy = lanes_at<Wide>(&columns.answer_xy[k]);
    const Wide yy = lanes_at<Wide>(&columns.answer_yy[k]);
    const Wide turn_x = xy * x - xx * y;
    const Wide turn_y = yy * x - xy * y;
    sums[0] += xx;
    sums[1] += xy;
    sums[2] += yy;
    sums[3] += turn_x;
    sums[4] += turn_y;
    sums[5] += x * turn_y - y * turn_x;
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    totals[k] = sum_of(sums[k]);
  }
}

glm::dmat3 answers_of(const DiscColumns& columns) {
  std::array<double, 6> totals{};
  TORSION_IN_WIDEST(add_answers, columns, totals);
  const auto [xx, xy, yy, xt, yt, tt] = totals;
  return {xx, xy, xt, xy, yy, yt, xt, yt, tt};
}

/// Solves matrix x = right, with pivots: a body may be compliant along one motion alone, and a
/// million times more than the cells.
glm::dvec3 solved(const glm::dmat3& matrix, const glm::dvec3& right) {
  const Eigen::Map<const Eigen::Matrix3d> columns(&matrix[0][0]);
  const Eigen::Vector3d x =
      columns.partialPivLu().solve(Eigen::Vector3d(right.x, right.y, right.z));
  return {x[0], x[1], x[2]};
}

/// The largest displacement of a cell by a motion, m.
double farthest(const DiscColumns& columns, const SurfaceMotion& motion) {
  // The first cell lies at the grid's corner.
  const double reach = std::abs(columns.place_x.front()) + std::abs(columns.place_y.front());
  return std::abs(motion.x) + std::abs(motion.y) + reach * std::abs(motion.z);
}

/// The state of the search.
struct NewtonSearch {
  BodyAnswer answer;
  // The body's whole motion and the load that causes it, less those of the cells' results.
  SurfaceMotion lacking{0.0};
  SurfaceLoad lacking_load{0.0};  // the function's gradient
};

void go_to(const BodyAnswer& answer, const BodyInBalance& body, const double* limit,
           DiscColumns& columns, NewtonSearch& search) {
  project(columns.place_x.size(), answer.motion, columns.place_x.data(), columns.place_y.data(),
          columns.stiffness.data(), limit, columns.trial_x.data(), columns.trial_y.data(),
          columns.result_x.data(), columns.result_y.data(), columns.answer_xx.data(),
          columns.answer_xy.data(), columns.answer_yy.data());
  const SurfaceLoad found =
      load_of(columns, columns.result_x.data(), columns.result_y.data()) - body.before;
  search = {answer, answer.motion + body.yields * (body.known - found), answer.load - found};
}

/// A step of Newton's method, shortened while the function rises at its end.
void take_newton_step(const BodyInBalance& body, const double* limit, DiscColumns& columns,
                      NewtonSearch& search) {
  const NewtonSearch from = search;
  const glm::dmat3 answers = answers_of(columns);
  const SurfaceMotion way = -solved(glm::dmat3(1.0) + body.yields * answers, from.lacking);
  const SurfaceLoad by_load = -(from.lacking_load + answers * way);  // which makes that way
  const double downhill = glm::dot(way, from.lacking_load);
  double length = 1.0;
  for (int k = 0; k < kMostLengths; ++k) {
    go_to({from.answer.motion + length * way, from.answer.load + length * by_load}, body, limit,
          columns, search);
    const double slope = glm::dot(way, search.lacking_load);
    if (!(slope > kUphill * std::abs(downhill))) {
      return;
    }
    // To where the slope would be 0 if it changed linearly.
    length *= std::clamp(downhill / (downhill - slope), 0.1, 0.9);
  }
}

}  // namespace

void DiscColumns::reserve(std::size_t count) {
  for (std::vector<double>* each : {&place_x, &place_y, &stiffness, &trial_x, &trial_y, &result_x,
                                    &result_y, &answer_xx, &answer_xy, &answer_yy}) {
    each->assign(count, 0.0);
  }
}

SurfaceLoad load_of(const DiscColumns& columns, const double* x, const double* y) {
  SurfaceLoad load(0.0);
  TORSION_IN_WIDEST(find_load, columns.place_x.size(), columns.place_x.data(),
                    columns.place_y.data(), x, y, load);
  return load;
}

void take_off_motion(const DiscColumns& columns, const SurfaceMotion& motion, const double* from_x,
                     const double* from_y, double* x, double* y) {
  take_off(columns.place_x.size(), motion, columns.place_x.data(), columns.place_y.data(), from_x,
           from_y, x, y);
}

BodyAnswer project_in_balance(const BodyInBalance& body, const double* limit,
                              DiscColumns& columns) {
  const std::size_t count = columns.place_x.size();
  const double by_friction = largest(count, limit) / largest(count, columns.stiffness.data());  // m
  const double close =
      kBalanced * by_friction + kRounding * (farthest(columns, body.yields * body.known) +
                                             farthest(columns, body.yields * body.before));
  NewtonSearch search;
  go_to({SurfaceMotion(0.0), body.known}, body, limit, columns, search);
  for (int pass = 0; pass < kMostNewtonPasses && farthest(columns, search.lacking) > close;
       ++pass) {
    take_newton_step(body, limit, columns, search);
  }
  return {search.answer.motion, search.answer.load - search.lacking_load};
}

}  // namespace torsion::engine
