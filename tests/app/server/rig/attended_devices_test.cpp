// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/attended_devices.h"

#include <gtest/gtest.h>

#include <memory>

namespace weft::app {
namespace {

Error device_error(ErrorKind kind) {
  return {kind, "it did not", "the device", "", ""};
}

/// Devices that fail as often as a test says: at moments that no rig can be brought to fail at.
struct Failing {
  int lights = 0, shots = 0;   ///< that fail next
  bool comes_back = true;      ///< by recover()
  int set = 0, recovered = 0;  ///< calls
  std::vector<int> lit = {};   ///< now
  ErrorKind kind = ErrorKind::kTryAgain;
};

class FailingLamps : public capture::Lamps {
 public:
  explicit FailingLamps(Failing& script) : script_(script) {}
  int leds() const override { return 3; }
  Result<double> light(std::span<const int> leds, double) override {
    if (script_.lights > 0 && script_.lights-- > 0) return device_error(script_.kind);
    script_.lit.assign(leds.begin(), leds.end());
    return 0.0;
  }
  Result<void> recover() override {
    ++script_.recovered;
    return script_.comes_back ? Result<void>() : device_error(ErrorKind::kNoDevice);
  }
  bool has_more_outputs() const override { return false; }
  Result<void> polarise(Polariser) override { return {}; }
  Result<std::vector<double>> can_light_s() override { return std::vector<double>{40, 40, 40}; }

 private:
  Failing& script_;
};

class FailingCamera : public capture::Camera {
 public:
  explicit FailingCamera(Failing& script) : script_(script) {}
  Result<capture::CameraFacts> connect() override { return capture::CameraFacts(); }
  Result<capture::CameraFacts> set(const capture::ExposureSettings&) override {
    ++script_.set;
    return connect();
  }
  Result<std::vector<double>> shutter_times_us() override { return std::vector<double>(); }
  Result<capture::Photograph> take(const std::filesystem::path& file,
                                   const std::function<void()>& exposed) override {
    if (script_.shots > 0 && script_.shots-- > 0) return device_error(script_.kind);
    exposed();
    capture::Photograph photograph;
    photograph.file = file;
    return photograph;
  }
  Result<std::string> look() override { return device_error(script_.kind); }
  Result<void> stop_looking() override { return {}; }
  Result<capture::CameraFacts> recover() override {
    ++script_.recovered;
    return script_.comes_back ? connect() : device_error(ErrorKind::kNoDevice);
  }

 private:
  Failing& script_;
};

AttendedDevices attended(Failing& script) {
  return AttendedDevices({std::make_unique<FailingLamps>(script), std::make_unique<FailingCamera>(script)});
}

TEST(AttendedDevices, LightAgainOnceTheBoardHasRecovered) {
  Failing script = {.lights = 1};
  AttendedDevices devices = attended(script);
  EXPECT_TRUE(devices.light({2}, 1));
  EXPECT_EQ(script.lit, std::vector{2});
  EXPECT_EQ(script.recovered, 1);
  EXPECT_FALSE(devices.broken());
}

TEST(AttendedDevices, AreBrokenByABoardThatStaysAway) {
  Failing script = {.lights = 1, .comes_back = false};
  AttendedDevices devices = attended(script);
  EXPECT_FALSE(devices.light({2}, 1));
  ASSERT_TRUE(devices.broken());
  EXPECT_EQ(devices.broken()->kind, ErrorKind::kNoDevice);
}

TEST(AttendedDevices, AreNotBrokenByALedThatIsNotThere) {
  Failing script = {.lights = 1, .kind = ErrorKind::kUsage};
  AttendedDevices devices = attended(script);
  EXPECT_FALSE(devices.light({9}, 1));
  EXPECT_EQ(script.recovered, 0);
  EXPECT_FALSE(devices.broken());
}

TEST(AttendedDevices, SetAnExposureAgainOnlyAfterAShotThatFailed) {
  Failing script;
  AttendedDevices devices = attended(script);
  const auto shoot = [&](double exposure_us) {
    EXPECT_TRUE(devices.set({exposure_us, 100, 8}));
    EXPECT_TRUE(devices.light({1}, 1));
    return devices.take("shot").has_value();
  };
  EXPECT_TRUE(shoot(1000) && shoot(1000));
  EXPECT_EQ(script.set, 1);
  EXPECT_TRUE(shoot(2000));
  EXPECT_EQ(script.set, 2);
  script.shots = 1;
  EXPECT_FALSE(shoot(2000));
  EXPECT_EQ(script.lit, std::vector<int>()) << "after a shot that failed";
  EXPECT_EQ(script.recovered, 1);
  EXPECT_FALSE(devices.broken());
  EXPECT_TRUE(shoot(2000));
  EXPECT_EQ(script.set, 3);
}

TEST(AttendedDevices, AreBrokenByACameraThatStaysAway) {
  Failing script = {.comes_back = false};
  AttendedDevices devices = attended(script);
  const Result<std::string> look = devices.look();
  ASSERT_FALSE(look);
  EXPECT_EQ(look.error().kind, ErrorKind::kTryAgain) << "what the look said, not the recovery";
  ASSERT_TRUE(devices.broken());
  EXPECT_EQ(devices.broken()->kind, ErrorKind::kNoDevice);
}

}  // namespace
}  // namespace weft::app
