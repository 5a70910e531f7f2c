#pragma once

#include "app/report/reference_case.hpp"

namespace torsion::engine {

/// A ball that rolls over a half-space with spin: what friction and couple come to steadily.
/// @param quick  fewer steps between the points of a path
ReferenceCase rolling_case(bool quick);

}  // namespace torsion::engine
