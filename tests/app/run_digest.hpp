#pragma once

// What a run has come to, in 16 digits: a tripwire for changes that were not meant to change a
// result. Only what a step promises to its users counts, not how the tables are laid out.

#include <cstdint>
#include <string>
#include <vector>

#include "ecs/world.hpp"

namespace torsion::engine::test {

/// A chain of hashes (XXH3), a link a step: of every tool the pose, the wrench and the work, of
/// every region its place in the order of formation, its pair, and what it exerts and where.
class RunDigest {
 public:
  /// @param world  after a step
  void add(const World& world);
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
  std::vector<double> row_;
};

/// One pinned run: a shipped scene with a pair of models, along its animation or in a hand.
struct PinnedRun {
  std::string scene;  // path in scenes/
  ContactModel contact = ContactModel::kAuto;
  BodyModel body = BodyModel::kAuto;
  bool held = false;
};

/// "SCENE animation|held CONTACT_MODEL BODY_MODEL".
std::string name_of(const PinnedRun& run);

/// All nine scenes with three contact models and three body models, and in a hand with the models
/// that `auto` takes.
std::vector<PinnedRun> pinned_runs();

/// What the run comes to on this machine.
std::uint64_t digest_of(const PinnedRun& run);

/// What results may depend on besides the program and the scene: x86_64_fma or other. AVX2
/// and AVX-512 sum in the same order, with the same fused multiply-adds (docs/architecture.md,
/// Determinism).
std::string instruction_set();

/// A line of the file of pinned results: instruction set, run, digest.
std::string pinned_line(const PinnedRun& run, std::uint64_t digest);

/// tests/app/pinned_results.txt; `./dev pin` renews it.
std::string pinned_file();

}  // namespace torsion::engine::test
