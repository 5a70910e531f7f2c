#pragma once

// What is chosen for a run, by its user and by the program.

#include <functional>
#include <string>
#include <vector>

#include "ecs/model.hpp"
#include "systems/model/expected_rolling.hpp"

namespace torsion::engine {

/// Models of one body and why these, in words that follow "contact model patch (".
struct ModelChoice {
  BodyModels models;  // never kAuto
  std::string contact_why;
  std::string body_why;
  bool body_is_auto = false;
  bool long_contact = false;  // with edges, expected: contact model patch needs more cells for it
  ExpectedPlace place;        // of its contacts
};

/// What may be chosen for a run besides what the scene says; kAuto: as the scene says.
struct PrepareOptions {
  ContactModel contact_model = ContactModel::kAuto;
  BodyModel body_model = BodyModel::kAuto;
  double rate = 1000.0;                           // Hz
  Settings settings;                              // grid_side 0: as the chosen models need
  std::vector<std::vector<Pose>> expected_poses;  // (times) of (tools): what the run will bring as
                                                  // far as that is known, for kAuto; empty: unknown
  std::uint32_t threads = 0;  // of what is prepared; 0: as many as there are cores
  bool use_cache = true;      // distance fields and beam sections from the user's cache folder
  // Called with 0 to 1, never falling, while bodies' compliances are found that no cache has; if
  // set.
  std::function<void(double)> progress;
};

}  // namespace torsion::engine
