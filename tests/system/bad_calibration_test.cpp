// SPDX-License-Identifier: Apache-2.0
// Calibrations that do not fit their session, and lights that leave a component of the normal dark.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/camera.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class BadCalibration : public SessionTest {
 protected:
  const fs::path own_ = session_ / "calibration";
  const fs::path other_ = work_ / "other";

  /// Writes the session's calibration, changed, as another one.
  void make_other(const std::function<void(Calibration&)>& change) const {
    Result<Calibration> calibration = read_calibration(own_);
    ASSERT_TRUE(calibration) << calibration.error().message();
    change(*calibration);
    const Result<Calibration> written = write_calibration(other_, *calibration);
    ASSERT_TRUE(written) << written.error().message();
  }
  void expect_other_refused(const std::vector<std::string>& words) const {
    expect_solve_refused(65, words, {"--calibration", other_.string()});
  }
  /// Puts every LED 600 mm from a point of the table, in one upright plane through it.
  void put_lights_in_a_plane_through(double x, double y) const {
    make_other([&](Calibration& c) {
      const Vec3 point = point_on_plane(*c.camera, x, y, 0);
      auto& leds = std::get<NearLights>(*c.lights).leds;
      for (std::size_t k = 0; k < leds.size(); ++k) {
        const double height = radians(35 + 12 * static_cast<double>(k)), azimuth = radians(30);
        const Vec3 to_light = {std::cos(height) * std::cos(azimuth), std::cos(height) * std::sin(azimuth),
                               std::sin(height)};
        leds[k].position_mm = point + 600.0 * to_light;
        leds[k].aim = -1.0 * to_light;
      }
    });
  }
};

TEST_F(BadCalibration, AMissingOneIsNamed) {
  fs::remove_all(own_);
  expect_solve_refused(66, {"cannot read", "calibration.json", "No such file", "check the path"});
}

TEST_F(BadCalibration, AMissingOneGivenByNameIsNamed) {
  expect_solve_refused(66, {"cannot read", "nowhere", "No such file", "check the path"},
                       {"--calibration", (work_ / "nowhere").string()});
}

TEST_F(BadCalibration, AMissingPartIsNamed) {
  fs::remove(own_ / "lights.json");
  expect_solve_refused(66, {"cannot read", "lights.json", "No such file", "check the path"});
}

TEST_F(BadCalibration, OneOfAnotherRigIsRefused) {
  make_other([](Calibration& c) { c.subject.rig = "rig two"; });
  expect_other_refused({"does not suit", session_.string(), "rig two", "virtual rig", "--calibration"});
}

TEST_F(BadCalibration, OneOfAnotherApertureIsRefused) {
  make_other([](Calibration& c) { c.subject.f_number = 11; });
  expect_other_refused({"does not suit", session_.string(), "f/11", "f/8", "calibrate the rig"});
}

TEST_F(BadCalibration, OneOfAnotherBodyIsRefused) {
  make_other([](Calibration& c) { c.subject.camera_serial = "4711"; });
  expect_other_refused({"does not suit", session_.string(), "serial number 4711", "calibrate the rig"});
}

TEST_F(BadCalibration, OneOfAnotherModelIsRefused) {
  make_other([](Calibration& c) { c.subject.camera_model = "NIKON D5100"; });
  expect_other_refused({"does not suit", session_.string(), "NIKON D5100", "calibrate the rig"});
}

TEST_F(BadCalibration, OneOfAnotherFrameSizeIsRefused) {
  make_other([](Calibration& c) { c.camera->size = {50, 32}; });
  expect_other_refused({"does not suit", session_.string(), "50 x 32", "48 x 32", "--calibration"});
}

TEST_F(BadCalibration, OneOfFewerLedsIsRefused) {
  make_other([](Calibration& c) { std::get<NearLights>(*c.lights).leds.resize(9); });
  expect_other_refused({"does not suit", session_.string(), "9 LEDs", "LED 10", "calibrate the rig"});
}

TEST_F(BadCalibration, OneWithALedOfNoIntensityIsRefusedByItsNumber) {
  const auto flux_becomes = [&](const Json& value) {
    make_other([](Calibration&) {});
    edit_json(other_ / "lights.json", [&](Json& lights) { lights["leds"][4]["flux_rgb"][1] = value; });
    edit_json(other_ / "calibration.json",
              [&](Json& c) { c["parts"]["lights.json"] = *sha256_of_file(other_ / "lights.json"); });
  };
  flux_becomes(0);
  expect_other_refused({"lights.json: led 5", "\"flux_rgb\" must be above 0 in every channel"});
  fs::remove_all(other_);
  flux_becomes(nullptr);  // what programs write for NaN
  expect_other_refused({"lights.json: led 5", "\"flux_rgb\" is [", "null"});
}

TEST_F(BadCalibration, OneWithoutLightsIsRefused) {
  make_other([](Calibration& c) { c.lights.reset(); });
  expect_other_refused({"does not suit", session_.string(), "lights.json", "calibrate the rig"});
}

TEST_F(BadCalibration, AnotherInThePlaceOfTheSessionsOwnIsRefused) {
  make_other([](Calibration& c) { c.response->read_noise_counts *= 2; });
  fs::remove_all(own_);
  fs::rename(other_, own_);
  expect_solve_refused(65, {"not the one of the session", own_.string(), "session.json names", "restore"});
}

TEST_F(BadCalibration, APartChangedByHandIsRefused) {
  edit_json(own_ / "lights.json", [](Json& lights) { lights["leds"][2]["mu"] = 1.01; });
  expect_solve_refused(65, {"changed after it was measured", "lights.json", "SHA-256", "calibrate again"});
}

TEST_F(BadCalibration, ANewerSchemaNamesTheVersionNeeded) {
  edit_json(own_ / "calibration.json", [](Json& c) { c["schema"] = "weft.calibration/2"; });
  expect_solve_refused(65, {"calibration.json", "weft.calibration/2", "newer"});
}

TEST_F(BadCalibration, LightsInAPlaneWithAPointOfTheFrameAreRefused) {
  const struct {
    double x, y;
    const char* name;
  } places[] = {{23, 15, "centre"},
                {0, 0, "top left corner"},
                {47, 0, "top right corner"},
                {0, 31, "bottom left corner"},
                {47, 31, "bottom right corner"}};
  for (const auto& place : places) {
    SCOPED_TRACE(place.name);
    put_lights_in_a_plane_through(place.x, place.y);
    expect_other_refused({"lights", place.name, "condition number", "do not lie in one plane"});
    fs::remove_all(other_);
  }
}

TEST_F(BadCalibration, LightsOnOneLineAreRefused) {
  make_other([](Calibration& c) {
    double x = -450;
    for (NearLight& led : std::get<NearLights>(*c.lights).leds) led.position_mm = {x += 90, 120, 500};
  });
  expect_other_refused({"lights", "centre", "condition number", "do not lie in one plane"});
}

TEST_F(BadCalibration, LightsBelowTheClothAreRefused) {
  make_other([](Calibration& c) { std::get<NearLights>(*c.lights).leds[6].position_mm.z = -20; });
  expect_other_refused({"LED 7", "-20", "cloth_height_mm"});
}

TEST_F(BadCalibration, LightsAtOneHeightAreSolved) {
  const Outcome run = run_weft({"solve", session_.string(), "--lights", "5,7,9", "--quiet", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_GT(run.json()["pixels"].get<int>(), 48 * 32 / 2);
}

}  // namespace
}  // namespace weft::test
