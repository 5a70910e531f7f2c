#include "systems/contact/tool_load.hpp"

#include "systems/contact/world_region.hpp"
#include "systems/math/frames.hpp"
#include "systems/math/wrenches.hpp"

namespace torsion::engine {

ToolLoad tool_load(const State& state, std::uint32_t tool, const glm::dvec3& about) {
  ToolLoad load;
  double largest = 0.0;
  for (std::uint32_t row = 0; row < state.regions.size(); ++row) {
    if (state.regions.at<RegionIdentity>(row).tool != tool) {
      continue;
    }
    const WorldRegion region(state, row, state.regions.at<RegionSupport>(row));
    const RegionFrame& frame = state.regions.at<RegionFrame>(row);
    const RegionFriction& tangential = state.regions.at<RegionFriction>(row);
    const double force = state.regions.at<RegionNormal>(row).force;
    const glm::dvec3 normal = region.direction(frame.normal);
    const glm::dvec3 friction = region.direction(tangent_to_body(frame, tangential.force));
    const glm::dvec3 arm = region.place(state.regions.at<Contact>(row).equivalent_point) - about;
    load.normal_sum += force;
    load.normal = load.normal + Wrench{force * normal, glm::cross(arm, force * normal)};
    load.friction = load.friction + Wrench{friction, glm::cross(arm, friction)};
    load.couple += tangential.couple * normal;
    if (load.regions == 0 || force > largest) {
      largest = force;
      load.main_region = row;
    }
    ++load.regions;
  }
  return load;
}

}  // namespace torsion::engine
