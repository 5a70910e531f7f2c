// What --device says.

#include "app/live/device_choice.hpp"

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

std::uint32_t bit_of(DeviceKind kind) {
  return 1U << static_cast<std::uint32_t>(kind);
}

TEST(DeviceChoiceTest, KindsAreNamedWithPlusBetween) {
  EXPECT_EQ(kinds_of("usb").value(), kUsualDevices);
  EXPECT_EQ(kinds_of("usb:falcon+wheel").value(),
            bit_of(DeviceKind::kFalcon) | bit_of(DeviceKind::kWheel));
  for (const char* const wrong :
       {"", "usb:", "usb:mouse", "usb:falcon+", "usb:falcon++odrive", "falcon", "usbfalcon"}) {
    EXPECT_FALSE(kinds_of(wrong)) << wrong;
  }
}

TEST(DeviceChoiceTest, AGatewayMayBeJoinedByKnobs) {
  EXPECT_EQ(gateway_choice("gateway").value().knobs, 0U);
  const GatewayChoice port = gateway_choice("gateway:7750+wheel+odrive").value();
  EXPECT_EQ(port.gateway, "gateway:7750");
  EXPECT_EQ(port.knobs, bit_of(DeviceKind::kWheel) | bit_of(DeviceKind::kOdrive));
  const GatewayChoice path = gateway_choice("gateway:/tmp/a+b.sock+moteus").value();
  EXPECT_EQ(path.gateway, "gateway:/tmp/a+b.sock");
  EXPECT_EQ(path.knobs, bit_of(DeviceKind::kMoteus));
  EXPECT_FALSE(gateway_choice("gateway+falcon"));  // two that move
  EXPECT_FALSE(gateway_choice("gateway:7750+knob"));
}

}  // namespace
}  // namespace torsion::engine
