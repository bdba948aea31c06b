// SPDX-License-Identifier: Apache-2.0
// The same link through libgphoto2's usb1 driver, with no cable: libusb-1.0 is stood in for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "tests/capture/camera/usb_bench.h"

namespace weft::capture {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(CameraUsb, TakesPhotographs) {
  UsbBench bench("plain");
  CameraLink& link = bench.ready();
  for (std::uint32_t i = 1; i <= 3; ++i) {
    const auto taken = link.take(bench.raw(static_cast<int>(i)), [] {});
    ASSERT_TRUE(taken) << taken.error().message();
    EXPECT_EQ(wrong_with(*taken, i), "");
  }
}

TEST(CameraUsb, ShowsItsFinderBetweenPhotographs) {
  UsbBench bench("finder");
  CameraLink& link = bench.ready();
  std::uint8_t last = 0;
  for (std::uint32_t i = 1; i <= 2; ++i) {
    for (int look = 0; look < 3; ++look) {
      const Result<std::string> picture = link.look();
      ASSERT_TRUE(picture) << picture.error().message();
      EXPECT_GT(static_cast<std::uint8_t>((*picture)[2]), last);
      last = static_cast<std::uint8_t>((*picture)[2]);
    }
    const auto taken = link.take(bench.raw(static_cast<int>(i)), [] {});
    ASSERT_TRUE(taken) << taken.error().message();
    EXPECT_EQ(wrong_with(*taken, i), "");
  }
}

TEST(CameraUsb, FindsTheRigsCameraAmongOthersByItsSerialNumber) {
  UsbBench first("first", "6000011"), second("second", "6000022");
  second.use_usb(first.socket() + ":" + second.socket());
  for (const char* serial : {"6000022", "6000011"}) {
    second.drop_link();
    second.LinkBench::options().serial = serial;
    const auto facts = second.link().connect();
    ASSERT_TRUE(facts) << facts.error().message();
    EXPECT_EQ(facts->serial, serial);
    EXPECT_THAT(facts->port, StartsWith("usb:"));
  }
  second.drop_link();
  second.LinkBench::options().serial = "6000033";
  const auto absent = second.link().connect();
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::kBadData) << absent.error().message();
  EXPECT_THAT(absent.error().message(), HasSubstr("6000011"));
}

TEST(CameraUsb, AsksWhichOfTwoCamerasIsTheRigs) {
  UsbBench first("either", "6000011"), second("other", "6000022");
  second.use_usb(first.socket() + ":" + second.socket());
  const auto facts = second.link().connect();
  ASSERT_FALSE(facts) << facts->serial << " was taken";
  EXPECT_EQ(facts.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(facts.error().message(), HasSubstr("6000011, 6000022"));
  EXPECT_THAT(facts.error().remedy, HasSubstr("serial = "));
}

TEST(CameraUsb, TakesNoneOfTwoCamerasBecauseTheOtherIsHeld) {
  UsbBench held("held", "6000011"), free("free", "6000022");
  ASSERT_TRUE(held.camera().inject({"usb_claimed", 1}));
  free.use_usb(held.socket() + ":" + free.socket());
  const auto facts = free.link().connect();
  ASSERT_FALSE(facts) << facts->serial << " was taken";
  EXPECT_THAT(facts.error().message(), HasSubstr("2 cameras"));
  EXPECT_THAT(facts.error().message(), HasSubstr(", 6000022"));
}

TEST(CameraUsb, ResetsABodyThatDoesNotOpenASession) {
  UsbBench bench("silent");
  ASSERT_TRUE(bench.camera().inject({"open_session_silent", 1}));
  const auto facts = bench.link().connect();
  ASSERT_TRUE(facts) << facts.error().message();
  const auto taken = bench.link().take(bench.raw(1), [] {});
  ASSERT_TRUE(taken) << taken.error().message();
  EXPECT_EQ(wrong_with(*taken, 1), "");
}

TEST(CameraUsb, FindsTheCameraAgainUnderANewAddress) {
  UsbBench bench("replug");
  CameraLink& link = bench.ready();
  const std::string before = link.connect()->port;
  ASSERT_TRUE(bench.camera().inject({"usb_replug", 1}));
  ASSERT_TRUE(link.recover() || link.recover() || link.recover() || link.recover());
  const auto taken = bench.take_patiently(1);
  ASSERT_TRUE(taken) << taken.error().message();
  EXPECT_NE(link.recover()->port, before);
}

TEST(CameraUsb, SaysThatNoCameraIsPluggedIn) {
  UsbBench bench("none");
  bench.use_usb(socket_path("nobody"));
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kNoDevice) << facts.error().message();
  EXPECT_THAT(facts.error().message(), HasSubstr("D5100"));
}

TEST(CameraUsb, NamesWhatMendsACameraThatAnotherProgramHolds) {
  UsbBench bench("claimed");
  ASSERT_TRUE(bench.camera().inject({"usb_claimed", 1}));
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kNoDevice) << facts.error().message();
  EXPECT_THAT(facts.error().remedy, HasSubstr("gio mount -s gphoto2"));
}

TEST(CameraUsb, OpensASessionThatAKilledWorkerLeftOpen) {
  UsbBench bench("stale");
  bench.ready();
  for (int i = 1; i <= 3; ++i) {
    ::kill(bench.link().worker_pid(), SIGKILL);
    const auto taken = bench.take_patiently(i);
    ASSERT_TRUE(taken) << taken.error().message();
    EXPECT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "");
  }
}

TEST(CameraUsb, LosesNothingToFaultsOfTheCable) {
  for (const char* fault : {"drop_in_exposure", "drop_in_data", "usb_timeout", "usb_stale_session"}) {
    UsbBench bench(fault);
    bench.ready();
    ASSERT_TRUE(bench.camera().inject({fault, 1}));
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 1; i <= 2; ++i) {
      const auto taken = bench.take_patiently(i);
      ASSERT_TRUE(taken) << fault << ": " << taken.error().message();
      EXPECT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "") << fault;
    }
    EXPECT_LT(seconds_since(begin), 12) << fault << ": " << bench.last_error().message();
    EXPECT_LE(bench.retakes(), 1) << fault;
  }
}

}  // namespace
}  // namespace weft::capture
