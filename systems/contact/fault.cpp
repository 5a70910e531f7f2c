#include "systems/contact/fault.hpp"

namespace torsion {

std::string_view fault_text(Fault fault) {
  switch (fault) {
    case Fault::kPoseNotFinite:
      return "the tool's pose is not finite; check the device or the animation's keys";
    case Fault::kPoseJumped:
      return "the tool moved faster than 20 m/s or 500 rad/s; smooth the motion or raise --rate";
    case Fault::kTooDeep:
      return "half of the tool is inside the body, or it is deeper than half the body; press less "
             "or use a larger body";
    case Fault::kRegionsFull:
      return "more than 16 contact regions on one body; raise kMaxRegionsPerBody or "
             "torsion_region_threshold";
    case Fault::kResultNotFinite:
      return "a force came out as NaN or infinity; please report the scene";
    case Fault::kForceTooLarge:
      return "a contact's force came out beyond what its depth or the tools' work allow; please "
             "report the scene";
  }
  return "unknown fault";
}

}  // namespace torsion
