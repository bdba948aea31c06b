// SPDX-License-Identifier: Apache-2.0
// A rig without printed tags: its lights are calibrated, then scans are held against marks on its table.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "calibration/run/calibrate_lights.h"
#include "calibration/run/rig_look.h"
#include "core/base/files.h"
#include "simulator/bare_rig.h"
#include "simulator/captures_layout.h"
#include "simulator/simulate.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using simulator::Scene;
using simulator::TargetSettings;
using testing::HasSubstr;

TargetSettings paper_of(double width_mm, double height_mm, Vec3 centre_mm, double white) {
  TargetSettings paper;
  paper.pattern = simulator::PaperSettings{width_mm, height_mm};
  paper.centre_mm = centre_mm;
  paper.white = white;
  return paper;
}

/// 768 x 512 pixels over 200 mm of dark table; along its edges scraps of duller paper, none like the other.
Scene table() {
  Scene scene;
  scene.fabric = "grey card";
  scene.camera.width = 768;
  scene.camera.height = 512;
  scene.camera.mm_per_pixel = 200.0 / 768;
  scene.material.albedo.fill(0.08);
  scene.effects.near_light = scene.effects.noise = scene.effects.led_drift = true;
  for (int i = 0; i < 14; ++i) {
    const int column = i / 2;
    const double x = 26.0 * column - 78 + 3 * (i % 3), y = (i % 2 == 0 ? 57 : -57) + i % 4 - 1.5;
    TargetSettings& scrap = scene.targets.emplace_back(
        paper_of(2.5 + 0.25 * (i % 5), 4 - 0.3 * (i % 4), {x, y, 0.1}, 0.2 + 0.02 * i));
    scrap.rotation_deg = 23.0 * i;
  }
  return scene;
}

class TaglessRig : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = fs::path(testing::TempDir()) / fmt::format("weft_tagless_rig_{}", getpid());
    // A sheet that leaves a rim of the table in sight.
    Scene within = table();
    within.camera.width = 608, within.camera.height = 384;
    const auto bare = simulator::BareRig::of(within);
    ASSERT_TRUE(bare) << bare.error().message();
    const simulator::SheetLayout layout = bare->sheet();
    fs::create_directories(root_ / "sheets");
    ASSERT_TRUE(write_file(root_ / "sheets" / "sheet.toml", bare->sheet_toml()));
    int seed = 1;
    for (const simulator::CapturePose& pose : simulator::five_poses()) {
      Scene scene = table();
      scene.seed = seed;
      for (TargetSettings& thing : laid(layout, pose, bare->paper())) scene.targets.push_back(thing);
      simulate(scene, fmt::format("sheets/sheet{}.weft", seed++), {});
    }
    const auto lights = calibration::calibrate_lights({.input = root_ / "sheets",
                                                       .from = root_ / "sheets/sheet1.weft/calibration",
                                                       .output = root_ / "calibration",
                                                       .tape_sigma_mm = 1},
                                                      {});
    ASSERT_TRUE(lights) << lights.error().message();
    says_ = lights->report.summary;
    calibration_ = lights->calibration;
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }

  static void simulate(const Scene& scene, const std::string& name, std::optional<Calibration> calibration) {
    simulator::SimulateOptions options;
    options.truth = false;
    options.calibration = std::move(calibration);
    const auto report = simulate_session(scene, root_ / name, options);
    ASSERT_TRUE(report) << report.error().message();
  }

  /// A cloth of coarse grain in the middle, after what `change` did.
  static calibration::RigLook scanned(int seed, const std::function<void(Scene&)>& change) {
    Scene scene = table();
    scene.seed = 100 + seed;
    TargetSettings& cloth = scene.targets.emplace_back(paper_of(130, 80, {0, 0, 0.5}, 0.4));
    cloth.sheet = {.waviness_deg = 2, .wavelength_mm = 5, .grain_percent = 15, .grain_deg = 5, .grain_mm = 1};
    change(scene);
    const std::string name = fmt::format("scan{}.weft", seed);
    simulate(scene, name, calibration_);
    auto look = calibration::look_at_scan(*read_session(root_ / name), {});
    EXPECT_TRUE(look) << look.error().message();
    if (!look) return {};
    const auto kept = calibration::kept_look(*read_session(root_ / name));
    EXPECT_TRUE(kept);
    EXPECT_EQ(kept ? kept->seen.points.size() : 0, look->seen.points.size());
    return *look;
  }
  static void cover(Scene& scene, double x0, double x1, double y0, double y1) {
    TargetSettings& cloth =
        scene.targets.emplace_back(paper_of(x1 - x0, y1 - y0, {(x0 + x1) / 2, (y0 + y1) / 2, 1}, 0.35));
    cloth.sheet = {.waviness_deg = 2, .wavelength_mm = 5, .grain_percent = 15, .grain_deg = 5, .grain_mm = 1};
  }
  static void knock(Scene& scene, double x_mm, double y_mm, double roll_deg) {
    scene.camera.pose.x_mm += x_mm;
    scene.camera.pose.y_mm += y_mm;
    scene.camera.pose.roll_deg += roll_deg;
  }
  /// What scanning on costs after a knock, noise-free, by the calibration's own lights.
  static double true_cost_deg(double x_mm, double y_mm, double roll_deg) {
    Scene scene = table();
    knock(scene, x_mm, y_mm, roll_deg);
    const NearLights& lights = std::get<NearLights>(*calibration_.lights);
    const CameraModel before = rig_of(table())->camera, after = rig_of(scene)->camera;
    return calibration::cost_of(before, lights, after, lights).mean_deg;
  }

  static inline fs::path root_;
  static inline std::string says_;
  static inline Calibration calibration_;
};

TEST_F(TaglessRig, FindsFixedPointsBesideTheSheetAndSaysHowMany) {
  EXPECT_GE(calibration_.points.size(), 8U) << says_;
  EXPECT_THAT(says_,
              HasSubstr(fmt::format(" {} fixed points beside the sheet.", calibration_.points.size())));
  EXPECT_EQ(read_calibration(root_ / "calibration")->points, calibration_.points);
}

TEST_F(TaglessRig, ThatStoodStillIsNotCalledMoved) {
  for (int seed = 1; seed <= 3; ++seed) {
    const calibration::RigLook look = scanned(seed, [](Scene&) {});
    EXPECT_EQ(look.state, RigPlace::kInPlace) << look.says;
    EXPECT_THAT(look.says, testing::MatchesRegex("in place by [0-9]+ fixed points, its LEDs not seen.*"));
    EXPECT_LT(look.chi_square, 1.5);
    // A quarter of them are something else that looks like them.
    calibration::RigSightings strange = look.seen;
    for (std::size_t i = 0; i < strange.points.size(); i += 4) strange.points[i].x_px += 9;
    const calibration::RigLook again = calibration::look_by(calibration_, strange);
    EXPECT_EQ(again.state, RigPlace::kInPlace) << again.says;
  }
}

TEST_F(TaglessRig, TellsHowItsCameraWasKnocked) {
  const struct { double x_mm, y_mm, roll_deg; } kKnocks[] = {{0.8, 0.6, 0}, {-1.5, 2, 0.2}, {3, -4, -0.3}};
  int seed = 20;
  for (const auto& [x, y, roll] : kKnocks) {
    const calibration::RigLook look = scanned(seed++, [&](Scene& scene) { knock(scene, x, y, roll); });
    EXPECT_EQ(look.state, RigPlace::kMoved) << look.says;
    EXPECT_THAT(look.says, HasSubstr("fixed points"));
    const double truth = true_cost_deg(x, y, roll);
    EXPECT_LT(std::min(std::abs(look.cost.mean_deg - truth), std::abs(look.least_deg - truth)), 0.02)
        << look.says << ", truth " << truth << ", or " << look.least_deg;
  }
}

TEST_F(TaglessRig, IsKnownByHalfOfItsPointsAndUnseenUnderACloth) {
  const auto half = scanned(30, [](Scene& scene) {
    cover(scene, 0, 101, -68, 68);
    knock(scene, 1.5, -1, 0);
  });
  EXPECT_EQ(half.state, RigPlace::kMoved) << half.says;
  EXPECT_LE(half.seen.points.size(), calibration_.points.size() / 2 + 1);
  const double truth = true_cost_deg(1.5, -1, 0);
  EXPECT_LT(std::min(std::abs(half.cost.mean_deg - truth), std::abs(half.least_deg - truth)), 0.02)
      << half.says << ", truth " << truth << ", or " << half.least_deg;
  const auto still = scanned(31, [](Scene& scene) { cover(scene, -100, 0, -67, 67); });
  EXPECT_EQ(still.state, RigPlace::kInPlace) << still.says;
  const auto row = scanned(33, [](Scene& scene) { cover(scene, -101, 101, 40, 68); });
  EXPECT_EQ(row.state, RigPlace::kUnseen) << "about a row of points a camera may turn: " << row.says;
  EXPECT_GE(row.seen.points.size(), 4U);
  const auto none = scanned(32, [](Scene& scene) { cover(scene, -101, 101, -68, 68); });
  EXPECT_EQ(none.state, RigPlace::kUnseen) << none.says;
  EXPECT_THAT(none.says, HasSubstr("nothing of the rig is in sight"));
}

}  // namespace
}  // namespace weft::app
