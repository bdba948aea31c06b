// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/properties.h"

#include <gtest/gtest.h>

#include <chrono>

#include "virtual_rig/ptp/clock.h"
#include "virtual_rig/ptp/dataset.h"

namespace weft::virtual_rig::ptp {
namespace {

PropertyTable table() {
  return PropertyTable(0.87, true, true, 0);
}

Bytes number(std::uint32_t value) {
  return ByteWriter().put(value).take();
}

TEST(PtpStrings, ComeBackAsTheyWere) {
  for (const std::string text : {"", "a", "Nikon Corporation", "4928x3264"}) {
    ByteWriter writer;
    put_string(writer, text);
    const Bytes bytes = writer.take();
    ByteReader reader(bytes);
    EXPECT_EQ(get_string(reader), text);
    EXPECT_TRUE(reader.rest().empty());
  }
}

TEST(PtpStrings, AreRefusedIfCutOffOrNotEnded) {
  ByteWriter writer;
  put_string(writer, "D5100");
  const Bytes whole = writer.take();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ByteReader reader(BytesView(whole).first(length));
    EXPECT_FALSE(get_string(reader)) << length;
  }
  Bytes endless = whole;
  endless[endless.size() - 2] = 'x';
  ByteReader reader(endless);
  EXPECT_FALSE(get_string(reader));
}

TEST(PropertyTable, KeepsOneShutterTimeUnderTwoNames) {
  PropertyTable properties = table();
  EXPECT_EQ(properties.set(kShutterSpeed, number(1 << 16 | 60)), kOk);
  EXPECT_EQ(properties.number(kExposureTime), 166);
  EXPECT_DOUBLE_EQ(properties.exposure_us(), 1e6 / 60);
  EXPECT_EQ(properties.set(kExposureTime, number(4000)), kOk);
  EXPECT_EQ(properties.number(kShutterSpeed), 10 << 16 | 25);
  EXPECT_DOUBLE_EQ(properties.exposure_us(), 4e5);
}

TEST(PropertyTable, RefusesWhatTheBodyHasNot) {
  PropertyTable properties = table();
  EXPECT_EQ(properties.set(kShutterSpeed, number(1 << 16 | 61)), kInvalidPropValue);
  EXPECT_EQ(properties.set(kShutterSpeed, Bytes{1, 0}), kInvalidPropFormat);
  EXPECT_EQ(properties.set(kBatteryLevel, Bytes{100}), kAccessDenied);
  EXPECT_EQ(properties.set(0xd1ff, Bytes{1}), kPropertyNotSupported);
  EXPECT_EQ(properties.set(kReleaseWithoutCard, Bytes{2}), kInvalidPropValue);
  EXPECT_FALSE(properties.description(0xd1ff));
  EXPECT_DOUBLE_EQ(properties.exposure_us(), 1e5);
}

TEST(PropertyTable, TakesShutterAndApertureFromTheHostOnTheDialsMAlone) {
  PropertyTable properties = table();
  properties.turn_dial(false);
  EXPECT_EQ(properties.set(kShutterSpeed, number(1 << 16 | 60)), kAccessDenied);
  EXPECT_EQ(properties.set(kFNumber, Bytes{0x20, 0x03}), kAccessDenied);
  EXPECT_EQ(properties.set(kIso, Bytes{200, 0}), kOk);
  properties.turn_dial(true);
  EXPECT_EQ(properties.set(kShutterSpeed, number(1 << 16 | 60)), kOk);
}

TEST(PropertyTable, TakesPicturesAtFourTimesTheIsoByItself) {
  PropertyTable properties = table();
  EXPECT_EQ(properties.taken_iso(), 100);
  EXPECT_EQ(properties.set(kAutoIso, Bytes{1}), kOk);
  EXPECT_EQ(properties.number(kIsoAuto), 1) << "one switch of two names";
  EXPECT_EQ(properties.taken_iso(), 400);
  EXPECT_EQ(properties.number(kIso), 100) << "as it was set";
  properties.turn(kIso, 3200);
  EXPECT_EQ(properties.taken_iso(), 6400);
  EXPECT_EQ(properties.set(kIsoAuto, Bytes{0}), kOk);
  EXPECT_EQ(properties.taken_iso(), 3200);
}

TEST(PropertyTable, ReducesNoiseBeyondASecond) {
  PropertyTable properties = table();
  properties.turn(kShutterSpeed, 13 << 16 | 10);
  EXPECT_FALSE(properties.takes_dark_after());
  properties.turn(kLongExposureNoise, 1);
  EXPECT_TRUE(properties.takes_dark_after());
  properties.turn(kShutterSpeed, 1 << 16 | 1);
  EXPECT_FALSE(properties.takes_dark_after());
}

TEST(PropertyTable, MovesTheShutterByAStepAtBothEnds) {
  PropertyTable properties = table();
  properties.turn(kShutterSpeed, 30 << 16 | 1);
  properties.change_exposure();
  EXPECT_DOUBLE_EQ(properties.exposure_us(), 25e6);
  properties.turn(kShutterSpeed, 1 << 16 | 4000);
  properties.change_exposure();
  EXPECT_DOUBLE_EQ(properties.exposure_us(), 1e6 / 3200);
}

TEST(PropertyTable, DescribesEachPropertyWithItsValueInside) {
  const PropertyTable properties = table();
  for (const bool nikons : {false, true})
    for (const std::uint16_t code : properties.codes(nikons)) {
      const auto description = properties.description(code);
      ASSERT_TRUE(description) << code;
      ByteReader reader(*description);
      EXPECT_EQ(reader.get<std::uint16_t>(), code);
      EXPECT_TRUE(properties.value(code)) << code;
    }
}

TEST(CameraClock, RunsWithItsOffsetAndTakesATimeThatIsSet) {
  const auto now = std::chrono::system_clock::now();
  const auto later = now + std::chrono::seconds(3600);
  EXPECT_EQ(exif_time(read_clock(now, 3600)), exif_time(read_clock(later, 0)));
  const auto offset_s = offset_when_set_to(ptp_time(read_clock(now, -7000)));
  ASSERT_TRUE(offset_s);
  EXPECT_NEAR(*offset_s, -7000, 1.1);
  for (const char* const wrong : {"", "20260131", "20260131X235958", "2026013aT235958"})
    EXPECT_FALSE(offset_when_set_to(wrong)) << wrong;
}

TEST(CameraClock, CountsMillisecondsWithinTheSecond) {
  const auto when = std::chrono::system_clock::time_point(std::chrono::milliseconds(1'700'000'000'999));
  EXPECT_EQ(read_clock(when, 0).milliseconds, 999);
  EXPECT_EQ(read_clock(when, 0.002).milliseconds, 1);
  EXPECT_EQ(read_clock(when, 0.002).time.tm_sec, (read_clock(when, 0).time.tm_sec + 1) % 60);
}

}  // namespace
}  // namespace weft::virtual_rig::ptp
