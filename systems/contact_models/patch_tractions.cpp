// The tangential tractions of the contact model `patch`.

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "systems/contact_models/local_inverse.hpp"
#include "systems/contact_models/patch_sums.hpp"

namespace torsion {
namespace {

constexpr double kInside = 1.0 + 1e-9;  // of a limit's square
constexpr double kCalm = 0.6;    // of what is asked, where there is no telling how far to go: the
                                 // local inverse asks for too much of what is smooth
constexpr double kShort = 0.05;  // of a step: so bent that it leads nowhere

struct Inverses {
  LocalInverse x;
  LocalInverse y;
  double stiffness = 0.0;  // Pa/m of a cell on its own
};

/// What one sweep finds.
struct Sweep {
  double square = 0.0;   // of the residual under the preconditioner
  double slope = 0.0;    // Pa m: of the energy, downhill
  bool slips = false;    // somewhere
  bool clipped = false;  // a cell that has stuck
};

/// Where a cell is at its limit, of what is left of its way only the part across its friction turns
/// it. That part is held back by the slip that there is, |s| / (mu p), on top of the cell's own
/// compliance: the curvature of the disc (Newton's method on the disc's rim).
void soften_slip(const PatchColumns& columns, double stiffness, std::uint32_t cell,
                 const glm::dvec2& left, const glm::dvec2& trial, PatchWork& work,
                 glm::dvec2& residual) {
  const double limit = work.limit[cell];
  const glm::dvec2 traction(columns.traction_x[cell], columns.traction_y[cell]);
  const double square = glm::dot(traction, traction);
  const glm::dvec2 along =
      square > 0.25 * limit * limit ? traction / std::sqrt(square) : glm::normalize(trial);
  const double slip = std::max(0.0, glm::dot(left, along));
  const double softened = limit > 0.0 ? 1.0 / std::sqrt(1.0 + slip * stiffness / limit) : 0.0;
  const double across = (along.x * left.y - along.y * left.x) * softened;
  residual = across * glm::dvec2(-along.y, along.x);
  work.along_x[cell] = along.x;
  work.along_y[cell] = along.y;
  work.softened[cell] = softened;
}

/// Of a displacement the part that a cell answers: all of it, or what is across its friction.
glm::dvec2 answered(const PatchColumns& columns, const PatchWork& work, std::uint32_t cell,
                    const glm::dvec2& displacement) {
  if (columns.slips[cell] == 0.0) {
    return displacement;
  }
  const glm::dvec2 across(-work.along_y[cell], work.along_x[cell]);
  return across * (work.softened[cell] * glm::dot(across, displacement));
}

/// As for the pressures (patch_pressures.cpp): to sliding along x and y, and turning.
void yield_to_rigid_motions(const PatchProblem& problem, const PatchColumns& columns,
                            const Inverses& inverses, PatchWork& work) {
  const std::uint32_t side = problem.influences.side;
  std::ranges::fill(work.rigid_x, 0.0);
  std::ranges::fill(work.rigid_y, 0.0);
  const auto motion = [&problem](int k, std::uint32_t cell) {
    return k == 0   ? glm::dvec2(1.0, 0.0)
           : k == 1 ? glm::dvec2(0.0, 1.0)
                    : glm::dvec2(-problem.support.place_y[cell], problem.support.place_x[cell]);
  };
  glm::dmat3 stiffness(0.0);
  glm::dvec3 asked(0.0);
  for (int k = 0; k < 3; ++k) {
    std::vector<double>& asks_x = work.rigid_asks_x[static_cast<std::size_t>(k)];
    std::vector<double>& asks_y = work.rigid_asks_y[static_cast<std::size_t>(k)];
    for (std::size_t c = 0; c < work.cells.size(); ++c) {
      const std::uint32_t cell = work.cells[c];
      const glm::dvec2 moved = answered(columns, work, cell, motion(k, cell));
      work.rigid_x[work.bordered[c]] = moved.x;
      work.rigid_y[work.bordered[c]] = moved.y;
    }
    apply_local_inverse(inverses.x, 1.0 / problem.compliance, side, work.rigid_x, asks_x);
    apply_local_inverse(inverses.y, 1.0 / problem.compliance, side, work.rigid_y, asks_y);
    for (std::size_t c = 0; c < work.cells.size(); ++c) {
      const std::uint32_t cell = work.cells[c];
      const std::uint32_t at = work.bordered[c];
      const glm::dvec2 asks = answered(columns, work, cell, glm::dvec2(asks_x[cell], asks_y[cell]));
      asked[k] += asks_x[cell] * work.residual_x[at] + asks_y[cell] * work.residual_y[at];
      for (int other = 0; other < 3; ++other) {
        stiffness[k][other] += glm::dot(asks, motion(other, cell));
      }
    }
  }
  const glm::dmat3& yields = problem.support.slides;
  const glm::dvec3 back = glm::inverse(glm::dmat3(1.0) + yields * stiffness) * (yields * asked);
  for (const std::uint32_t cell : work.cells) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = back[static_cast<int>(k)];
      work.asked_x[cell] -= share * work.rigid_asks_x[k][cell];
      work.asked_y[cell] -= share * work.rigid_asks_y[k][cell];
    }
  }
}

/// What is left of every loaded cell's way, and what it asks for.
Sweep ask(const PatchProblem& problem, const PatchColumns& columns, const Inverses& inverses,
          PatchWork& work) {
  Sweep sweep;
  const std::uint32_t side = problem.influences.side;
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    const std::uint32_t cell = work.cells[k];
    const glm::dvec2 left(columns.target_x[cell] - columns.moved_x[cell],
                          columns.target_y[cell] - columns.moved_y[cell]);
    const glm::dvec2 trial =
        glm::dvec2(columns.traction_x[cell], columns.traction_y[cell]) + inverses.stiffness * left;
    glm::dvec2 residual = left;
    const bool slips = glm::dot(trial, trial) > work.limit[cell] * work.limit[cell];
    columns.slips[cell] = slips ? 1.0 : 0.0;
    work.softened[cell] = 1.0;
    if (slips) {
      soften_slip(columns, inverses.stiffness, cell, left, trial, work, residual);
      sweep.slips = true;
    }
    const std::uint32_t at = work.bordered[k];
    work.residual_x[at] = residual.x;
    work.residual_y[at] = residual.y;
  }
  apply_local_inverse(inverses.x, 1.0 / problem.compliance, side, work.residual_x, work.asked_x);
  apply_local_inverse(inverses.y, 1.0 / problem.compliance, side, work.residual_y, work.asked_y);
  if (problem.support.soft) {
    yield_to_rigid_motions(problem, columns, inverses, work);
  }
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    const std::uint32_t cell = work.cells[k];
    const std::uint32_t at = work.bordered[k];
    sweep.square +=
        work.residual_x[at] * work.asked_x[cell] + work.residual_y[at] * work.asked_y[cell];
  }
  return sweep;
}

/// What every cell asks for if its neighbours stay.
void ask_alone(const Inverses& inverses, PatchWork& work) {
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    work.asked_x[work.cells[k]] = inverses.stiffness * work.residual_x[work.bordered[k]];
    work.asked_y[work.cells[k]] = inverses.stiffness * work.residual_y[work.bordered[k]];
  }
}

/// Shares of what is asked and of the last step.
struct Mix {
  double asked = 1.0;
  double kept = 0.0;
};

/// Turns what is asked and kept into a step that ends within the discs.
void take_step(const PatchColumns& columns, const Mix& mix, PatchWork& work, Sweep& sweep) {
  for (const std::uint32_t cell : work.cells) {
    const double limit = work.limit[cell];
    const glm::dvec2 traction(columns.traction_x[cell], columns.traction_y[cell]);
    glm::dvec2 from = traction;
    const glm::dvec2 last(work.step_x[cell], work.step_y[cell]);
    glm::dvec2 step = mix.asked * glm::dvec2(work.asked_x[cell], work.asked_y[cell]);
    if (columns.slips[cell] != 0.0) {
      const glm::dvec2 along(work.along_x[cell], work.along_y[cell]);
      from = limit * along;
      const glm::dvec2 across(-work.along_y[cell], work.along_x[cell]);
      step = across *
             (work.softened[cell] * glm::dot(step, across) + mix.kept * glm::dot(last, across));
    } else {
      step += mix.kept * last;
    }
    glm::dvec2 to = from + step;
    const double square = glm::dot(to, to);
    if (columns.slips[cell] != 0.0 || square > limit * limit) {
      to *= square > 0.0 ? limit / std::sqrt(square) : 0.0;
      sweep.clipped = sweep.clipped || columns.slips[cell] == 0.0;
      sweep.slips = true;
    }
    step = to - traction;
    work.step_x[cell] = step.x;
    work.step_y[cell] = step.y;
    sweep.slope += (columns.target_x[cell] - columns.moved_x[cell]) * step.x +
                   (columns.target_y[cell] - columns.moved_y[cell]) * step.y;
  }
}

SweepChange go(const PatchColumns& columns, double length, PatchWork& work) {
  SweepChange change;
  for (const std::uint32_t cell : work.cells) {
    work.step_x[cell] *= length;
    work.step_y[cell] *= length;
    columns.traction_x[cell] += work.step_x[cell];
    columns.traction_y[cell] += work.step_y[cell];
    const double x = std::abs(work.step_x[cell]);
    const double y = std::abs(work.step_y[cell]);
    change.largest = std::max({change.largest, x, y});
    change.sum += x + y;
  }
  for (std::size_t cell = 0; cell < columns.moved_x.size(); ++cell) {
    columns.moved_x[cell] += length * work.moves_x[cell];
    columns.moved_y[cell] += length * work.moves_y[cell];
  }
  return change;
}

/// Lists the cells that carry a load or have to lose one.
/// @return true when a traction lies outside its disc
bool list_cells(const PatchColumns& columns, std::uint32_t side, PatchWork& work) {
  bool outside = false;
  work.cells.clear();
  std::ranges::fill(work.residual_x, 0.0);
  std::ranges::fill(work.residual_y, 0.0);
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i, ++cell) {
      work.limit[cell] = columns.friction[cell] * columns.pressure[cell];
      work.step_x[cell] = 0.0;
      work.step_y[cell] = 0.0;
      columns.slips[cell] = 1.0;
      if (work.limit[cell] > 0.0 || columns.traction_x[cell] != 0.0 ||
          columns.traction_y[cell] != 0.0) {
        work.bordered[work.cells.size()] = (j + 1) * (side + 2) + i + 1;
        work.cells.push_back(cell);
        const double square = columns.traction_x[cell] * columns.traction_x[cell] +
                              columns.traction_y[cell] * columns.traction_y[cell];
        outside = outside || square > kInside * work.limit[cell] * work.limit[cell];
      }
    }
  }
  return outside;
}

}  // namespace

PatchOutcome relax_tractions(const PatchProblem& problem, const PatchColumns& columns,
                             PatchWork& work) {
  const InfluenceTables& tables = problem.influences;
  const double softest = std::max(tables.self(InfluenceKind::kXX), tables.self(InfluenceKind::kYY));
  const Inverses inverses{local_inverse(tables, InfluenceKind::kXX),
                          local_inverse(tables, InfluenceKind::kYY),
                          1.0 / (softest * problem.compliance)};
  bool outside = list_cells(columns, tables.side, work);
  PatchOutcome outcome;
  double before = 0.0;  // the residual's square, 0: no direction to keep
  double whole = problem.foreseen_traction;
  bool alone = false;
  while (outcome.sweeps < problem.sweeps) {
    Sweep sweep = ask(problem, columns, inverses, work);
    const double kept = before > 0.0 ? sweep.square / before : 0.0;
    take_step(columns, {outside ? kCalm : 1.0, kept}, work, sweep);
    if (!outside && (alone || sweep.slope <= 0.0)) {
      // Beside cells that slip the neighbours' share may lead uphill; each cell's own does not.
      ask_alone(inverses, work);
      sweep.slope = 0.0;
      take_step(columns, {1.0, 0.0}, work, sweep);
    }
    move_by_traction(problem, work);
    double stiffness = 0.0;
    for (const std::uint32_t cell : work.cells) {
      stiffness += work.step_x[cell] * work.moves_x[cell] + work.step_y[cell] * work.moves_y[cell];
    }
    if (stiffness <= 0.0) {
      outcome.residual = 0.0;
      break;
    }
    // A first step brings all tractions into their discs, so it goes all the way. Where something
    // slips, a step ends on the discs' rims: no farther.
    const double best = outside ? 1.0 : sweep.slope / stiffness;
    const double length = sweep.slips ? std::clamp(best, 0.0, 1.0) : best;
    alone = length < kShort;
    outside = false;
    const SweepChange change = go(columns, length, work);
    before = sweep.clipped ? 0.0 : sweep.square;
    whole = std::max(whole, change.sum);
    outcome.residual = change.largest / problem.reference;
    ++outcome.sweeps;
    if (!alone && ends(problem, change, whole)) {
      break;
    }
  }
  return outcome;
}

}  // namespace torsion
