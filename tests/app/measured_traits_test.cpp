// What was measured of a device is kept for the sessions that follow.

#include "app/live/measured_traits.hpp"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "app/live/device_link.hpp"
#include "tests/app/program.hpp"

namespace torsion::engine {
namespace {

namespace fs = std::filesystem;

/// A home of its own.
class MeasuredTraitsTest : public testing::Test {
 protected:
  void SetUp() override { ::setenv("XDG_DATA_HOME", (folder_ / "").c_str(), 1); }
  void TearDown() override { ::unsetenv("XDG_DATA_HOME"); }

  test::Folder folder_;
};

TEST_F(MeasuredTraitsTest, AreReadAsTheyWereWritten) {
  EXPECT_EQ(load_measured_traits().value()[0].mass, 0.0);  // nothing was measured yet
  const MeasuredTraits traits{0.148, 0.9, 0.0, 0.0, 1.25e-3, 1.4};
  ASSERT_TRUE(save_measured_traits(DeviceKind::kFalcon, traits));
  const auto all = load_measured_traits();
  ASSERT_TRUE(all) << all.error().text;
  const MeasuredTraits& read = all.value()[static_cast<std::size_t>(DeviceKind::kFalcon)];
  EXPECT_EQ(read.mass, 0.148);
  EXPECT_EQ(read.damping, 0.9);
  EXPECT_EQ(read.delay, 1.25e-3);
  EXPECT_EQ(read.weight, 1.4);
  EXPECT_EQ(all.value()[static_cast<std::size_t>(DeviceKind::kOdrive)].inertia, 0.0);
}

TEST_F(MeasuredTraitsTest, AFileThatIsNoneIsNamedAndNothingBegins) {
  const fs::path path = measured_traits_file(DeviceKind::kFalcon);
  fs::create_directories(path.parent_path());
  for (const auto& [text, said] : {std::pair{"{\"mass_kg\": -1}", "mass_kg is -1"},
                                   std::pair{"{\"delay_s\": \"soon\"}", "delay_s is \"soon\""},
                                   std::pair{"[1, 2", "is no JSON object"}}) {
    std::ofstream(path) << text;
    const auto all = load_measured_traits();
    ASSERT_FALSE(all);
    EXPECT_NE(all.error().text.find(path.string() + ": "), std::string::npos) << all.error().text;
    EXPECT_NE(all.error().text.find(said), std::string::npos) << all.error().text;
    DeviceChoice choice;
    choice.what = "usb";
    EXPECT_FALSE(DeviceLink::open(choice, Pose{}));
  }
}

}  // namespace
}  // namespace torsion::engine
