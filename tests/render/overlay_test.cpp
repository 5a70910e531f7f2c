#include "render/overlay.hpp"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

namespace torsion::engine {
namespace {

OverlayContent full_content() {
  OverlayContent content;
  content.lines = {"ball_on_cube", "time 1.000 s", "force 12 N"};
  content.heat_map = HeatMap::kTwist;
  content.heat_limit = 0.5 * std::numbers::pi;
  content.full_force = 50.0;
  content.full_torque = 0.1;
  content.banner = "a fault";
  return content;
}

TEST(OverlayFontTest, WiderTextIsWider) {
  const OverlayFont font(20.0);
  EXPECT_GT(font.width_of("force"), font.width_of("for"));
  EXPECT_GT(font.width_of("W"), font.width_of("i"));
  EXPECT_EQ(font.width_of(""), 0.0);
  // The degree sign is one narrow letter, not two.
  EXPECT_LT(font.width_of("\xC2\xB0"), font.width_of("WW"));
}

TEST(OverlayFontTest, EveryLetterHasInk) {
  const OverlayFont font(20.0);
  OverlayDrawList list;
  font.append_text(list, "Ag1[\xC2\xB0]", 0.0, 0.0, 0xFFFFFFFF);
  const OverlayAtlas& atlas = font.atlas();
  ASSERT_EQ(list.vertices.size(), 6U * 4U);
  for (std::size_t letter = 0; letter < 6; ++letter) {
    const OverlayVertex& low = list.vertices[4 * letter];
    const OverlayVertex& high = list.vertices[4 * letter + 2];
    std::uint8_t most = 0;
    for (auto y = static_cast<std::uint32_t>(low.v * static_cast<float>(atlas.height));
         y < static_cast<std::uint32_t>(high.v * static_cast<float>(atlas.height)); ++y) {
      for (auto x = static_cast<std::uint32_t>(low.u * static_cast<float>(atlas.width));
           x < static_cast<std::uint32_t>(high.u * static_cast<float>(atlas.width)); ++x) {
        most = std::max(most, atlas.rgba[4 * (y * atlas.width + x) + 3]);
      }
    }
    EXPECT_GT(most, 128) << letter;
  }
}

TEST(OverlayFontTest, TextThatIsNotUtf8DoesNoHarm) {
  const OverlayFont font(20.0);
  OverlayDrawList list;
  font.append_text(list, "\xC2", 0.0, 0.0, 0xFFFFFFFF);
  font.append_text(list, "\xFF\xFE\xE2\x82", 0.0, 0.0, 0xFFFFFFFF);
  EXPECT_FALSE(list.vertices.empty());
}

class OverlaySizeTest : public testing::TestWithParam<std::pair<std::uint32_t, std::uint32_t>> {};

TEST_P(OverlaySizeTest, NothingIsClipped) {
  const auto [width, height] = GetParam();
  const OverlayFont font(overlay_text_height(height));
  const OverlayDrawList list = draw_overlay(font, full_content(), width, height);
  ASSERT_FALSE(list.vertices.empty());
  for (const OverlayVertex& vertex : list.vertices) {
    EXPECT_GE(vertex.x, -1.0F);
    EXPECT_GE(vertex.y, -1.0F);
    EXPECT_LE(vertex.x, static_cast<float>(width) + 1.0F);
    EXPECT_LE(vertex.y, static_cast<float>(height) + 1.0F);
  }
  const std::uint32_t last = *std::ranges::max_element(list.indices);
  EXPECT_LT(last, list.vertices.size());
}

INSTANTIATE_TEST_SUITE_P(Sizes, OverlaySizeTest,
                         testing::Values(std::pair{1280U, 720U}, std::pair{640U, 360U},
                                         std::pair{1920U, 1080U}, std::pair{800U, 800U}));

TEST(OverlayTest, EmptyContentDrawsNothing) {
  const OverlayFont font(20.0);
  EXPECT_TRUE(draw_overlay(font, {}, 640, 360).vertices.empty());
}

}  // namespace
}  // namespace torsion::engine
