// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/per_pixel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/oracles/paper_oracle.h"

namespace weft::calibration {
namespace {

using test::PaperCaptures;
using test::PaperErrors;
using test::PaperRig;
using testing::HasSubstr;

constexpr int kCellColumns = 20, kCellRows = 13;

// Poses and paper are known, as after a fit; LEDs are `off_mm` from where they are.
PaperCaptures captures_of(const PaperRig& rig, double off_mm, double noise) {
  PaperErrors errors;
  errors.turn_deg = errors.shift_mm = 0;
  errors.tape_mm = off_mm;
  errors.noise = noise;
  PaperCaptures captures = test::captures_of(rig, errors, kCellColumns, kCellRows);
  captures.start.paper.log_albedo = rig.log_albedo;
  captures.start.paper.delta = rig.delta;
  return captures;
}

// A rig of point lights without gains.
PaperRig point_lights() {
  PaperRig rig = test::common_rig();
  for (NearLight& led : rig.lights.leds) led.log_gain_quadratic = {};
  rig.vignette = 0;
  return rig;
}

double worst_deg(const PerPixelLights& lights, const PaperRig& rig, const CameraModel& camera) {
  double worst = 0;
  for (std::size_t k = 0; k < lights.maps.size(); ++k) {
    for (std::size_t cell = 0; cell < lights.grid.cells(); ++cell) {
      const auto [x, y] = lights.grid.centre_px(cell);
      const Vec3 truth = rig.lights.leds[k].position_mm - point_on_plane(camera, x, y, 0);
      if (lights.maps[k].intensity_rgb[cell][0] > 0)
        worst = std::max(worst, angle_deg(lights.maps[k].direction[cell], truth));
    }
  }
  return worst;
}

TEST(PerPixelLights, FindDirectionsAndIntensitiesFromATapeTenMillimetresWrong) {
  const PaperRig rig = point_lights();
  const PaperCaptures captures = captures_of(rig, 10, 0);
  const CellGrid grid = {captures.start.camera.size, kCellColumns, kCellRows};
  const auto lights = solve_per_pixel(captures.start, captures.readings, grid);
  ASSERT_TRUE(lights) << lights.error().message();
  EXPECT_LT(worst_deg(*lights, rig, captures.start.camera), 0.03);
  EXPECT_LT(test::position_error_mm(lights->model, rig.lights), 1)
      << "a hundredth of a degree a round is near enough";
  EXPECT_LT(lights->changes_deg.back(), 0.01);
  EXPECT_TRUE(lights->parted().empty());
  const auto truth =
      light_on_table(captures.start.camera, rig.lights, 4, grid.centre_px(30)[0], grid.centre_px(30)[1]);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(lights->maps[4].intensity_rgb[30][c] / truth->intensity_rgb[c], 1, 1e-3);
}

TEST(PerPixelLights, SmoothNoiseAway) {
  const PaperRig rig = point_lights();
  const PaperCaptures captures = captures_of(rig, 10, 0.002);
  const auto lights = solve_per_pixel(captures.start, captures.readings,
                                      {captures.start.camera.size, kCellColumns, kCellRows});
  ASSERT_TRUE(lights) << lights.error().message();
  // One cell alone: 0.002 / (sqrt(2 * 3) sin 20 degrees), or 0.14 degrees an axis.
  EXPECT_LT(worst_deg(*lights, rig, captures.start.camera), 0.25);
}

TEST(PerPixelLights, SayWhereALedIsNoPointLight) {
  // Seen from the right of the frame LED 4 stands elsewhere than from the left, as a strip or a mirror would.
  const PaperRig rig = point_lights();
  PaperCaptures captures = captures_of(rig, 0, 0);
  PaperRig other = rig;
  other.lights.leds[3].position_mm = other.lights.leds[3].position_mm + Vec3{0, 25, 0};
  for (PaperReading& r : captures.readings) {
    if (r.led != 3) continue;
    const double share = r.x_px / rig.width_px;
    for (std::size_t c = 0; c < 3; ++c)
      r.reading_rgb[c] =
          (1 - share) * r.reading_rgb[c] + share * other.reading(r.sheet, 3, c, r.x_px, r.y_px);
  }
  captures.start.lights = rig.lights;
  const auto lights = solve_per_pixel(captures.start, captures.readings,
                                      {captures.start.camera.size, kCellColumns, kCellRows});
  ASSERT_TRUE(lights) << lights.error().message();
  EXPECT_EQ(lights->parted(), std::vector<std::size_t>{3});
}

TEST(PerPixelLights, NeedSheetsThatLieInThreeDirections) {
  PaperRig rig = point_lights();
  rig.sheets.resize(3);
  rig.sheets[2] = {20, 180, 0, {}};  // flat and tilted about one axis: nothing about the other
  const PaperCaptures captures = captures_of(rig, 0, 0);
  const CellGrid grid = {captures.start.camera.size, kCellColumns, kCellRows};
  const auto lights = solve_per_pixel(captures.start, captures.readings, grid);
  ASSERT_FALSE(lights);
  EXPECT_THAT(lights.error().message(), HasSubstr("three unknowns"));

  const PaperCaptures small = captures_of(point_lights(), 0, 0);
  std::vector<PaperReading> corner = small.readings;
  std::erase_if(corner, [](const PaperReading& r) { return r.x_px > 300; });
  const auto few = solve_per_pixel(small.start, corner, grid);
  ASSERT_FALSE(few);
  EXPECT_THAT(few.error().message(), HasSubstr("LED 1"));
}

}  // namespace
}  // namespace weft::calibration
