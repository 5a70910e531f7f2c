#include "device/protocols/hid_descriptor.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/device/space_mouse_descriptor.hpp"

namespace torsion::engine {
namespace {

using test::kSpaceMouseDescriptor;

TEST(HidDescriptorTest, FindsFieldsWhereTheDescriptorPutsThem) {
  const auto reports = parse_hid_descriptor(kSpaceMouseDescriptor);
  ASSERT_TRUE(reports);
  EXPECT_TRUE(reports->numbered);
  ASSERT_EQ(reports->fields.size(), 9U);  // axes, buttons and the light; not what is padding
  for (std::uint32_t axis = 0; axis < 6; ++axis) {
    const HidField& field = reports->fields[axis];
    EXPECT_EQ(field.usage, kHidX + axis);
    EXPECT_EQ(field.application, kHidMultiAxisController);
    EXPECT_EQ(field.report_id, axis < 3 ? 1 : 2);
    EXPECT_EQ(field.bit_offset, 16 * (axis % 3));
    EXPECT_EQ(field.bit_size, 16U);
    EXPECT_EQ(field.logical_min, -350);
    EXPECT_EQ(field.logical_max, 350);
  }
  EXPECT_EQ(reports->fields[7].usage, 0x0009'0002U);
  EXPECT_EQ(reports->fields[7].bit_offset, 1U);
  EXPECT_EQ(reports->fields[7].logical_max, 1);
}

TEST(HidDescriptorTest, ReadsValuesAcrossBytesWithTheirSign) {
  const HidField field{kHidX, 0, 7, 4, 12, -2048, 2047};
  const std::array<std::uint8_t, 3> report = {7, 0xF5, 0x80};  // bits 4 to 15 of 0x80F5: 0x80F
  EXPECT_EQ(hid_value(field, true, report), 0x80F - 4096);
  HidField positive = field;
  positive.logical_min = 0;
  EXPECT_EQ(hid_value(positive, true, report), 0x80F);
}

TEST(HidDescriptorTest, WritesWhatItReadsAndNothingBeside) {
  const HidField field{kHidX, 0, 7, 4, 12, -2048, 2047};
  std::array<std::uint8_t, 4> report = {7, 0x05, 0x00, 0xA5};
  ASSERT_TRUE(put_hid_value(field, true, -1000, report));
  EXPECT_EQ(hid_value(field, true, report), -1000);
  EXPECT_EQ(report[1] & 0x0FU, 0x05U);
  EXPECT_EQ(report[3], 0xA5);
  const auto before = report;
  EXPECT_FALSE(put_hid_value(field, true, 1, std::span(report).first(2)));  // too short
  report[0] = 6;
  EXPECT_FALSE(put_hid_value(field, true, 1, report));  // another
  report[0] = 7;
  EXPECT_EQ(report, before);
}

TEST(HidDescriptorTest, HasNoValueInAnotherOrAShortReport) {
  const HidField field{kHidX, 0, 7, 4, 12, -2048, 2047};
  EXPECT_FALSE(hid_value(field, true, std::array<std::uint8_t, 3>{6, 0, 0}));
  EXPECT_FALSE(hid_value(field, true, std::array<std::uint8_t, 2>{7, 0}));
  EXPECT_FALSE(hid_value(field, true, {}));
  EXPECT_TRUE(hid_value(field, false, std::array<std::uint8_t, 2>{0, 0}));
}

TEST(HidDescriptorTest, TakesAMaximumForUnsignedWhereTheMinimumIsNotNegative) {
  // usage page 1, usage X, minimum 0, maximum 255 in one byte, 8 bits, one
  const std::array<std::uint8_t, 14> descriptor = {0x05, 0x01, 0x09, 0x30, 0x15, 0x00, 0x25,
                                                   0xFF, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02};
  const auto reports = parse_hid_descriptor(descriptor);
  ASSERT_TRUE(reports);
  ASSERT_EQ(reports->fields.size(), 1U);
  EXPECT_EQ(reports->fields[0].logical_max, 255);
  EXPECT_FALSE(reports->numbered);
}

TEST(HidDescriptorTest, RefusesWhatIsCutOffOrDoesNotNest) {
  // from within the item that opens the first collection
  for (std::size_t size = 5; size < kSpaceMouseDescriptor.size(); ++size) {
    EXPECT_FALSE(parse_hid_descriptor(Bytes(kSpaceMouseDescriptor).first(size))) << size;
  }
  EXPECT_FALSE(parse_hid_descriptor(std::array<std::uint8_t, 1>{0xC0}));        // an end alone
  EXPECT_FALSE(parse_hid_descriptor(std::array<std::uint8_t, 1>{0xB4}));        // a pop alone
  EXPECT_FALSE(parse_hid_descriptor(std::array<std::uint8_t, 2>{0x85, 0x00}));  // report id 0
  // 2^31 values of 32 bits
  EXPECT_FALSE(parse_hid_descriptor(
      std::array<std::uint8_t, 9>{0x75, 0x20, 0x97, 0x00, 0x00, 0x00, 0x80, 0x81, 0x02}));
}

TEST(HidDescriptorTest, UsagesMayEndWithTheLargest) {
  // usages 0xFFFFFFFE to 0xFFFFFFFF, two values of 8 bits; once this never ended
  const std::array<std::uint8_t, 16> descriptor = {0x1B, 0xFE, 0xFF, 0xFF, 0xFF, 0x2B, 0xFF, 0xFF,
                                                   0xFF, 0xFF, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02};
  const auto reports = parse_hid_descriptor(descriptor);
  ASSERT_TRUE(reports);
  ASSERT_EQ(reports->fields.size(), 2U);
  EXPECT_EQ(reports->fields[0].usage, 0xFFFFFFFEU);
  EXPECT_EQ(reports->fields[1].usage, 0xFFFFFFFFU);
}

TEST(HidDescriptorTest, SurvivesAnyBytes) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> bytes(kSpaceMouseDescriptor.begin(), kSpaceMouseDescriptor.end());
    const auto changes = random() % 8;
    for (unsigned change = 0; change < changes; ++change) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    const auto reports = parse_hid_descriptor(bytes);
    for (const HidField& field : reports ? reports->fields : std::vector<HidField>{}) {
      std::array<std::uint8_t, 8> report{};
      report[0] = field.report_id;
      const auto value = hid_value(field, reports->numbered, report);
      EXPECT_TRUE(!value || *value == 0 || !reports->numbered || field.report_id == 0);
    }
  }
}

}  // namespace
}  // namespace torsion::engine
