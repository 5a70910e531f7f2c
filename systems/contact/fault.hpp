#pragma once

#include <string_view>

#include "ecs/state.hpp"

namespace torsion {

inline void raise(Clock& clock, Fault fault) {
  clock.faults |= static_cast<std::uint32_t>(fault);
}

inline bool raised(std::uint32_t faults, Fault fault) {
  return (faults & static_cast<std::uint32_t>(fault)) != 0;
}

/// What a fault means and what to do about it, one sentence.
std::string_view fault_text(Fault fault);

inline constexpr Fault kAllFaults[] = {Fault::kPoseNotFinite,   Fault::kPoseJumped,
                                       Fault::kTooDeep,         Fault::kRegionsFull,
                                       Fault::kResultNotFinite, Fault::kForceTooLarge};

}  // namespace torsion
