#pragma once

#include <optional>
#include <string>

#include "tests/fuzz/random_scene.hpp"

namespace torsion::engine::test {

/// Runs the scene along its tools' ways, which are smooth in time, and says which of these does not
/// hold: every wrench is finite; no fault; no step's force stands out of its ten neighbours' median
/// by more than half of the run's; held still, nothing changes; the closed path takes work and
/// gives none; turned as a whole, all of it turns with it.
/// @return nothing where all hold, or the scene cannot be prepared, which is said in its own words
std::optional<std::string> broken_property(const RandomScene& random);

/// Says how much it is another force where the same ways are gone in twice as many steps at twice
/// the rate, so as fast. Not where friction with mu > 1 loads a contact too much for linear
/// elasticity (systems/contact/strain.hpp).
/// @return nothing where it is the same, or the scene cannot be prepared
std::optional<std::string> depends_on_steps(const RandomScene& random);

}  // namespace torsion::engine::test
