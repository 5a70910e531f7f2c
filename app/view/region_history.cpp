#include "app/view/region_history.hpp"

namespace torsion::engine {

void RegionHistory::add(const Snapshot& snapshot, std::uint32_t tool) {
  const double time = snapshot.clock.time;
  if (size_ > 0 && time < (*this)[size_ - 1].time) {
    size_ = 0;  // the session began anew
  }
  if (size_ > 0 && time < (*this)[size_ - 1].time + 0.999 * kPeriod) {
    return;
  }
  Moment& moment = moments_[(first_ + size_) % kMoments];
  moment.time = time;
  moment.count = 0;
  for (std::uint32_t row = 0; row < snapshot.regions.size() && moment.count < kMost; ++row) {
    const RegionIdentity& identity = snapshot.regions.at<RegionIdentity>(row);
    if (identity.tool == tool) {
      const RegionFriction& friction = snapshot.regions.at<RegionFriction>(row);
      moment.regions[moment.count++] = {identity.order,
                                        snapshot.regions.at<RegionNormal>(row).force,
                                        friction.couple, friction.stick_share};
    }
  }
  if (size_ < kMoments) {
    ++size_;
  } else {
    first_ = (first_ + 1) % kMoments;
  }
}

}  // namespace torsion::engine
