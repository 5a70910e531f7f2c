#include "render/device_choice.hpp"

#include <array>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

const std::array<DeviceFacts, 4> kDevices = {{
    {"llvmpipe (LLVM 15.0.6, 256 bits)", GpuKind::kProcessor, {}},
    {"Old Card 100", GpuKind::kDiscrete, {"Vulkan 1.3"}},
    {"Built-in Graphics", GpuKind::kIntegrated, {}},
    {"New Card 900", GpuKind::kDiscrete, {}},
}};

TEST(DeviceChoiceTest, PrefersACardThatLacksNothing) {
  EXPECT_EQ(choose_device(kDevices, "").value(), 3U);
}

TEST(DeviceChoiceTest, TakesTheProcessorWhereNothingElseIsAble) {
  EXPECT_EQ(choose_device(std::span(kDevices).first(2), "").value(), 0U);
}

TEST(DeviceChoiceTest, FindsANamedDeviceInUpperOrLowerCase) {
  EXPECT_EQ(choose_device(kDevices, "LLVMpipe").value(), 0U);
  EXPECT_EQ(choose_device(kDevices, "built-in").value(), 2U);
}

TEST(DeviceChoiceTest, TakesTheFirstOfEqualKind) {
  const std::array<DeviceFacts, 2> twins = {
      {{"Card A", GpuKind::kDiscrete, {}}, {"Card B", GpuKind::kDiscrete, {}}}};
  EXPECT_EQ(choose_device(twins, "card").value(), 0U);
}

TEST(DeviceChoiceTest, ListsAllDevicesWhenNoneHasTheName) {
  const Result<std::size_t> chosen = choose_device(kDevices, "quantum");
  ASSERT_FALSE(chosen.ok());
  const std::string& text = chosen.error().text;
  EXPECT_NE(text.find("\"quantum\""), std::string::npos) << text;
  EXPECT_NE(text.find("TORSION_GPU"), std::string::npos) << text;
  for (const DeviceFacts& device : kDevices) {
    EXPECT_NE(text.find(device.name), std::string::npos) << text;
  }
}

TEST(DeviceChoiceTest, SaysWhatTheNamedDeviceLacks) {
  const Result<std::size_t> chosen = choose_device(kDevices, "old card");
  ASSERT_FALSE(chosen.ok());
  EXPECT_NE(chosen.error().text.find("lacks Vulkan 1.3"), std::string::npos) << chosen.error().text;
}

TEST(DeviceChoiceTest, NamesTheDriverToInstallWhenThereIsNoDevice) {
  const Result<std::size_t> chosen = choose_device({}, "");
  ASSERT_FALSE(chosen.ok());
  EXPECT_NE(chosen.error().text.find("mesa-vulkan-drivers"), std::string::npos);
}

}  // namespace
}  // namespace torsion::engine
