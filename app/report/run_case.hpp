#pragma once

#include "app/report/model_pair.hpp"
#include "app/report/reference_case.hpp"
#include "ecs/result.hpp"
#include "systems/step.hpp"

namespace torsion::engine {

/// What a case gave with one choice of models.
struct CaseRun {
  ModelPair models;
  std::vector<double> forces;   // N, one a point of the path
  std::vector<double> torques;  // N m, likewise
  std::vector<double> twists;   // rad, one a radius of the case's field
  std::uint32_t cells = 0;      // of one region's grid
  std::uint32_t anchors = 0;
  double step_us_median = 0.0;  // of the steps in contact
  double step_us_p99 = 0.0;
  std::size_t memory_bytes = 0;   // of the world's tables
  std::uint32_t faults_ever = 0;  // bits of Fault
};

/// Drives the case's scene along its path, without a scene file, and times each step. Fails where
/// the scene cannot be prepared.
Result<CaseRun> run_case(const ReferenceCase& reference_case, const ModelPair& models);

/// The simulation of a case before its path.
Result<Simulation> prepare_case(const ReferenceCase& reference_case, const ModelPair& models);

/// Drives it from the point of the path before `point` to that.
void move_case(Simulation& simulation, const ReferenceCase& reference_case, std::size_t point);

/// The simulation of a case after the point `point` of its path.
Result<Simulation> simulate_to(const ReferenceCase& reference_case, const ModelPair& models,
                               std::size_t point);

}  // namespace torsion::engine
