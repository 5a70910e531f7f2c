// What --device says.

#include "app/live/device_choice.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "app/live/device_link.hpp"

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

/// A file of this text that nobody else can read.
class SecretFile {
 public:
  explicit SecretFile(const std::string& text) {
    std::ofstream(path_) << text;
    std::filesystem::permissions(path_, std::filesystem::perms::owner_read);
  }
  ~SecretFile() { std::filesystem::remove(path_); }
  SecretFile(const SecretFile&) = delete;
  SecretFile& operator=(const SecretFile&) = delete;
  SecretFile(SecretFile&&) = delete;
  SecretFile& operator=(SecretFile&&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / fmt::format("torsion_secret_{}", ::getpid());
};

bool says(const Error& error, std::string_view word) {
  return error.text.find(word) != std::string::npos;
}

TEST(GatewaySecretTest, IsTheTextOfAFileThatOnlyItsOwnerReads) {
  const std::string text = "sixteen bytes, or";
  for (const auto& [before, after] : {std::pair{"", ""}, {"", "\n"}, {" \r\n", "\t\r\n \n"}}) {
    const SecretFile file(before + text + after);
    const auto secret = load_secret(file.path());
    ASSERT_TRUE(secret.ok()) << secret.error().text;
    EXPECT_EQ(std::string(secret.value().begin(), secret.value().end()), text);
  }
  for (const auto others : {std::filesystem::perms::group_read, std::filesystem::perms::others_read,
                            std::filesystem::perms::group_write}) {
    const SecretFile file(text);
    std::filesystem::permissions(file.path(), others, std::filesystem::perm_options::add);
    const auto secret = load_secret(file.path());
    ASSERT_FALSE(secret.ok());
    EXPECT_TRUE(says(secret.error(), "chmod 600")) << secret.error().text;
  }
  for (const std::string& wrong : {std::string(), std::string(" \n"),
                                   std::string("fifteen bytes..\n"), std::string(256, 'x')}) {
    const auto secret = load_secret(SecretFile(wrong).path());
    ASSERT_FALSE(secret.ok()) << wrong;
    EXPECT_TRUE(says(secret.error(), "expected 16 to 255")) << secret.error().text;
  }
  EXPECT_TRUE(load_secret(SecretFile(std::string(255, 'x')).path()).ok());
  EXPECT_TRUE(says(load_secret("/nowhere/at/all").error(), "cannot be read"));
  EXPECT_TRUE(says(load_secret("/tmp").error(), "not a regular file"));
  EXPECT_TRUE(says(load_firmware("/tmp").error(), "not a regular file"));
}

TEST(GatewaySecretTest, GoesWithAGatewayOnly) {
  const SecretFile file("of twenty-two bytes...");
  DeviceChoice choice;
  choice.gateway_secret = file.path();
  choice.gateway_address = "0.0.0.0";
  const auto options = gateway_options(choice, "gateway:7000");
  ASSERT_TRUE(options.ok());
  EXPECT_EQ(options.value().address, "0.0.0.0");
  EXPECT_EQ(options.value().port, 7000);
  EXPECT_EQ(options.value().secret.size(), 22U);
  EXPECT_TRUE(says(gateway_options(choice, "gateway:/run/t.sock").error(), "no address"));
  choice.gateway_address = "";
  EXPECT_TRUE(gateway_options(choice, "gateway:/run/t.sock").ok());
  EXPECT_EQ(gateway_options(choice, "gateway").value().address, kLoopback);
  choice.what = "usb";
  const auto link = DeviceLink::open(choice, Pose{});
  ASSERT_FALSE(link.ok());
  EXPECT_TRUE(says(link.error(), "are for --device gateway")) << link.error().text;
}

}  // namespace
}  // namespace torsion::engine
