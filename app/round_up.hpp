#pragma once

namespace torsion::engine {

/// The next of 1, 2, 5, 10, 20, ... times a power of ten; 1 where nothing is above 0. Ends of
/// scales.
double round_up(double value);

}  // namespace torsion::engine
