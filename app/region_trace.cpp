#include "app/region_trace.hpp"

#include <array>

#include "systems/contact/world_region.hpp"
#include "systems/math/frames.hpp"

namespace torsion::engine {
namespace {

const std::vector<std::string>& region_columns() {
  static const std::vector<std::string> columns = {
      "time_s",       "region",    "body",     "tool",      "point_x_m",      "point_y_m",
      "point_z_m",    "normal_x",  "normal_y", "normal_z",  "tangent_x",      "tangent_y",
      "tangent_z",    "depth_m",   "area_m2",  "radius_m",  "normal_force_N", "friction_1_N",
      "friction_2_N", "couple_Nm", "turn_rad", "twist_rad", "stick_share",    "stick_radius_m"};
  return columns;
}

}  // namespace

Result<RegionTrace> RegionTrace::create(const std::filesystem::path& path) {
  Result<TableFile> file = TableFile::create(path, "regions", region_columns());
  if (!file) {
    return file.error();
  }
  return RegionTrace(std::move(file).value());
}

void RegionTrace::append(const World& world) {
  const State& state = world.state;
  for (std::uint32_t row = 0; row < state.regions.size(); ++row) {
    const RegionIdentity& identity = state.regions.at<RegionIdentity>(row);
    const WorldRegion region(state, row, state.regions.at<RegionSupport>(row));
    const RegionFrame& frame = state.regions.at<RegionFrame>(row);
    const Contact& contact = state.regions.at<Contact>(row);
    const RegionFriction& friction = state.regions.at<RegionFriction>(row);
    const glm::dvec3 point = region.place(contact.equivalent_point);
    const glm::dvec3 normal = region.direction(frame.normal);
    const glm::dvec3 tangent = region.direction(frame.tangent_x);
    const std::array numbers = {state.clock.time,
                                static_cast<double>(identity.order),
                                static_cast<double>(identity.body),
                                static_cast<double>(identity.tool),
                                point.x,
                                point.y,
                                point.z,
                                normal.x,
                                normal.y,
                                normal.z,
                                tangent.x,
                                tangent.y,
                                tangent.z,
                                contact.depth,
                                contact.area,
                                contact.radius,
                                state.regions.at<RegionNormal>(row).force,
                                friction.force.x,
                                friction.force.y,
                                friction.couple,
                                state.regions.at<RegionMotion>(row).turn,
                                friction.stick_turn,
                                friction.stick_share,
                                friction.stick_radius};
    TORSION_ASSERT(numbers.size() == region_columns().size());
    file_.append(numbers);
  }
}

}  // namespace torsion::engine
