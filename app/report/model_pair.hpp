#pragma once

#include <vector>

#include "app/report/reference_case.hpp"

namespace torsion::engine {

/// What one run of a case runs with.
struct ModelPair {
  ContactModel contact = ContactModel::kPaper;
  BodyModel body = BodyModel::kNone;
  std::uint32_t grid_side = 16;
};

/// All pairs of models, contact model patch with several grids. Where the body is a half-space,
/// body models other than none have nothing to say.
/// @param quick  fewer grids
std::vector<ModelPair> model_pairs(const ReferenceCase& reference_case, bool quick);

/// "patch 12² + skeleton": models with the grid's side where it is chosen.
std::string label_of(const ModelPair& models);

}  // namespace torsion::engine
