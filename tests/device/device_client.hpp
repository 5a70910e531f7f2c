#pragma once

#include "device/drivers/driver.hpp"

namespace torsion::engine::test {

/// Who holds the devices in a test: wants one wrench while they are live, and remembers.
struct DeviceClient {
  Wrench wanted{{0.0, -2.0, 0.0}, {0.0, 0.05, 0.0}};
  DeviceSample last;
  std::uint64_t calls = 0;

  static Wrench on_sample(void* context, const DeviceSample& sample) {
    auto& client = *static_cast<DeviceClient*>(context);
    client.last = sample;
    client.calls += 1;
    return client.wanted;
  }
  SampleSink sink() { return {this, on_sample}; }
};

}  // namespace torsion::engine::test
