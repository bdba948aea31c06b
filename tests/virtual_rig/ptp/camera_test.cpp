// SPDX-License-Identifier: Apache-2.0
// The virtual camera as the real libgphoto2 meets it over PTP/IP.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"

namespace weft::virtual_rig {
namespace {

using testing::HasSubstr;

constexpr const char* kMemory = "Internal RAM";
constexpr const char* kCard = "Memory card";

/// A client that is connected and takes quick pictures.
std::unique_ptr<GphotoClient> connected(const Studio& studio, const char* target = kMemory) {
  auto client = std::make_unique<GphotoClient>(studio.network());
  EXPECT_EQ(client->init(), GP_OK);
  EXPECT_EQ(client->set("capturetarget", target), GP_OK);
  EXPECT_EQ(client->set("shutterspeed2", "1/200"), GP_OK);
  return client;
}

TEST(VirtualCamera, SaysWhatItIs) {
  Studio studio({.serial = "6012345", .battery = 0.87});
  const auto client = connected(studio);
  EXPECT_EQ(client->get("manufacturer"), "Nikon Corporation");
  EXPECT_EQ(client->get("cameramodel"), "D5100");
  EXPECT_THAT(client->get("serialnumber"), HasSubstr("6012345"));
  EXPECT_THAT(client->get("batterylevel"), HasSubstr("87"));
  EXPECT_EQ(client->get("imagequality"), "NEF (Raw)");
  EXPECT_EQ(client->get("expprogram"), "M");
  EXPECT_TRUE(client->read_only("expprogram"));
  EXPECT_EQ(client->get("focusmode2"), "MF (fixed)");
  EXPECT_EQ(client->exit(), GP_OK);
}

TEST(VirtualCamera, TakesEachSettingAndReadsItBack) {
  Studio studio;
  const auto client = connected(studio);
  const std::vector<std::pair<const char*, const char*>> settings = {
      {"shutterspeed2", "1/60"},     {"iso", "200"},           {"f-number", "f/11"},
      {"whitebalance", "Flash"},     {"isoauto", "Off"},       {"capturetarget", kCard},
      {"imagequality", "NEF (Raw)"}, {"nocfcardrelease", "On"}};
  for (const auto& [name, value] : settings) {
    EXPECT_EQ(client->set(name, value), GP_OK) << name;
    EXPECT_EQ(client->get(name), value) << name;
  }
  EXPECT_EQ(client->set("shutterspeed", "0.0400s"), GP_OK);
  client->wait(1);  // for the word that the other has changed
  EXPECT_EQ(client->get("shutterspeed2"), "1/25");
  EXPECT_EQ(client->choices("shutterspeed2").size(), 52u);
}

TEST(VirtualCamera, RefusesAValueThatItHasNot) {
  Studio studio;
  const auto client = connected(studio);
  EXPECT_LT(client->set("iso", "123"), 0);
  EXPECT_LT(client->set("shutterspeed2", "1/61"), 0);
  EXPECT_LT(client->set("nosuchsetting", "1"), 0);
  EXPECT_EQ(client->get("iso"), "100");
}

TEST(VirtualCamera, LeavesShutterAndApertureToItselfOffM) {
  Studio studio({.dial_manual = false});
  GphotoClient client(studio.network());
  ASSERT_EQ(client.init(), GP_OK);
  EXPECT_EQ(client.get("expprogram"), "P");
  EXPECT_TRUE(client.read_only("shutterspeed2"));
  EXPECT_TRUE(client.read_only("f-number"));
  EXPECT_FALSE(client.read_only("iso"));
}

TEST(VirtualCamera, SaysWhereItsRawIsOff) {
  Studio studio({.raw = false});
  const auto client = connected(studio);
  EXPECT_EQ(client->get("imagequality"), "JPEG Fine");
  const GphotoClient::Shot shot = client->shoot();
  ASSERT_TRUE(shot.whole());
  ASSERT_GE(shot.file.bytes.size(), 2u);
  EXPECT_EQ(shot.file.bytes[0], 0xff);
  EXPECT_EQ(shot.file.bytes[1], 0xd8);
  EXPECT_EQ(client->set("imagequality", "NEF (Raw)"), GP_OK);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 2u);
}

class EachTarget : public testing::TestWithParam<const char*> {};

TEST_P(EachTarget, DeliversTwentyShotsAsTheyWereDeveloped) {
  Studio studio;
  const auto client = connected(studio, GetParam());
  for (std::uint32_t number = 1; number <= 20; ++number) {
    const GphotoClient::Shot shot = client->shoot();
    ASSERT_TRUE(shot.whole()) << number << ": " << shot.triggered << ' ' << shot.waited << ' '
                              << shot.file.code;
    ASSERT_EQ(studio.number_of(shot.file.bytes), number) << number;
  }
  EXPECT_EQ(studio.camera().shots(), 20);
  EXPECT_EQ(client->exit(), GP_OK);
}

INSTANTIATE_TEST_SUITE_P(VirtualCamera, EachTarget, testing::Values(kMemory, kCard),
                         [](const auto& one) { return one.param == kMemory ? "Memory" : "Card"; });

TEST(VirtualCamera, ExposesInRealTimeForAsLongAsItIsSetTo) {
  Studio studio;
  const auto client = connected(studio);
  ASSERT_EQ(client->set("shutterspeed2", "1/4"), GP_OK);
  ASSERT_EQ(client->set("iso", "400"), GP_OK);
  ASSERT_EQ(client->set("f-number", "f/11"), GP_OK);
  const auto before = RigClock::now();
  ASSERT_GE(client->trigger(), 0);
  const auto after = RigClock::now();
  const std::vector<CameraExposure> exposures = studio.exposures();
  ASSERT_EQ(exposures.size(), 1u) << "the shutter is not shut when the trigger returns";
  EXPECT_GT(exposures[0].opened, before);
  EXPECT_LT(exposures[0].closed, after);
  EXPECT_EQ(exposures[0].closed - exposures[0].opened, std::chrono::milliseconds(250));
  EXPECT_DOUBLE_EQ(exposures[0].exposure_us, 250'000);
  EXPECT_DOUBLE_EQ(exposures[0].iso, 400);
  EXPECT_DOUBLE_EQ(exposures[0].f_number, 11);
  EXPECT_TRUE(client->next_file(5).added);
}

TEST(VirtualCamera, TakesTwiceItsTimeForALongExposureWhoseNoiseItReduces) {
  Studio studio;
  const auto client = connected(studio);
  ASSERT_EQ(client->set("shutterspeed2", "2"), GP_OK);
  studio.inject("long_exposure_noise");
  client->wait(1);
  EXPECT_EQ(client->get("longexpnr"), "On");
  const auto before = RigClock::now();
  ASSERT_GE(client->trigger(), 0);
  EXPECT_GE(RigClock::now() - before, std::chrono::milliseconds(4000));
  const CameraExposure exposure = studio.exposures().at(0);
  EXPECT_EQ(exposure.closed - exposure.opened, std::chrono::milliseconds(2000)) << "of light";
  EXPECT_TRUE(exposure.loses_its_dark);
}

TEST(VirtualCamera, HasAClockOfItsOwnThatRuns) {
  Studio studio({.clock_offset_s = -3600});
  const auto client = connected(studio);
  const auto shown = [&] { return std::atol(client->get("datetime").c_str()); };
  EXPECT_NEAR(static_cast<double>(shown() - std::time(nullptr)), -3600, 1.5);
  ASSERT_TRUE(client->shoot().whole());
  const CameraExposure exposure = studio.exposures().at(0);
  std::tm time = {};
  ASSERT_NE(strptime(exposure.date_time.c_str(), "%Y:%m:%d %H:%M:%S", &time), nullptr) << exposure.date_time;
  time.tm_isdst = -1;
  EXPECT_NEAR(static_cast<double>(std::mktime(&time) - std::time(nullptr)), -3600, 2.5);

  EXPECT_EQ(client->set("datetime", std::to_string(std::time(nullptr)).c_str()), GP_OK);
  EXPECT_NEAR(static_cast<double>(shown() - std::time(nullptr)), 0, 1.5);
}

TEST(VirtualCamera, CountsItsPicturesOverReconnects) {
  Studio studio;
  for (std::uint32_t number = 1; number <= 3; ++number) {
    const auto client = connected(studio);
    ASSERT_EQ(studio.number_of(client->shoot().file.bytes), number);
    ASSERT_EQ(client->exit(), GP_OK);
  }
  EXPECT_EQ(studio.exposures().back().image_number, 3u);
}

TEST(VirtualCamera, SeesOneHostAtATime) {
  Studio studio;
  const auto first = connected(studio);
  GphotoClient second(studio.network());
  EXPECT_LT(second.init(), 0);
  EXPECT_TRUE(first->shoot().whole());
  first->exit();
  EXPECT_EQ(second.init(), GP_OK);
}

TEST(VirtualCamera, HoldsNoAcknowledgementBack) {
  Studio studio;
  const auto client = connected(studio);
  double ms = 1e9;  // the quickest: the machine has others to serve
  for (int i = 0; i < 20; ++i) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(client->set("iso", i % 2 ? "100" : "200"), GP_OK);
    ms = std::min(
        ms, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  EXPECT_LT(ms, 20) << "an acknowledgement held back costs 40 ms";
}

}  // namespace
}  // namespace weft::virtual_rig
