// SPDX-License-Identifier: Apache-2.0
// From a folder of photographs of a board to a calibration, and on to a true ruler.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "calibration/camera/boards.h"
#include "calibration/camera/markers.h"
#include "calibration/run/calibrate_camera.h"
#include "capture/raw/decode_raw.h"
#include "core/image_io/image_io.h"
#include "material/run/rectify.h"
#include "simulator/camera/dng_writer.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "solve/run/solve_session.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using calibration::calibrate_camera;
using calibration::CalibrateCameraOptions;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kThickness_mm = 3;

/// A rig with a barrel lens and a camera half a degree off, 640 x 420 pixels, with a tag on its table.
simulator::Scene rig_scene() {
  simulator::Scene scene;
  scene.camera.width = 640;
  scene.camera.height = 420;
  scene.camera.mm_per_pixel = 0.3;
  scene.camera.f_number = 5.6;
  scene.camera.pose = {.tilt_deg = 0.5, .azimuth_deg = 35};
  scene.camera.lens = {.k1 = -0.1, .k2 = 0.05, .offset_x_px = 5, .offset_y_px = 3};
  scene.camera.blur = {.defocus_px = 0.8, .spread_px = 0.6};
  scene.material.albedo = {0.2, 0.2, 0.2};
  scene.effects.near_light = scene.effects.distortion = scene.effects.defocus = scene.effects.noise = true;
  simulator::TargetSettings tag;
  tag.pattern = simulator::TagSettings{.id = 5, .side_mm = 16, .margin_mm = 3};
  tag.centre_mm = {-82, 50, 0.001};
  scene.targets.push_back(tag);
  return scene;
}

/// The board in one of its poses, 0 being flat on the table.
simulator::Scene photograph_scene(int pose) {
  simulator::Scene scene = rig_scene();
  scene.seed = pose + 1;
  scene.lights.leds.resize(1);
  scene.lights.leds[0].position_mm = {120, 90, 560};
  simulator::TargetSettings board;
  board.pattern = simulator::CharucoSettings{11, 8, 12, 0.7, "DICT_5X5_100", 4};
  board.centre_mm = {0, 0, kThickness_mm};
  if (pose > 0) {
    board.centre_mm = {7.0 * (pose % 3 - 1), 4.0 * (pose % 4 - 1.5), 40};
    board.tilt_deg = 20 + 6 * (pose % 4);
    board.azimuth_deg = std::fmod(137.5 * pose, 360);
    board.rotation_deg = 4.0 * (pose % 5) - 8;
  }
  scene.targets.push_back(board);
  return scene;
}

class CalibrateCamera : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(input_);
    put_bytes(input_ / "board.toml",
              "kind = \"charuco\"\nsquares_x = 11\nsquares_y = 8\nsquare_mm = 12\nmarker_share = 0.7\n"
              "dictionary = \"DICT_5X5_100\"\nthickness_mm = 3\n");
  }
  void photograph(const std::string& name, const simulator::Scene& scene) const {
    const Result<void> taken = simulator::simulate_frame(scene, 1, input_ / name, {});
    ASSERT_TRUE(taken) << taken.error().message();
  }
  /// `count` good photographs, the first of the table.
  void photograph_boards(int count) const {
    for (int i = 0; i < count; ++i)
      photograph(i == 0 ? "table01.dng" : "board" + std::to_string(10 + i) + ".dng", photograph_scene(i));
  }
  CalibrateCameraOptions options() const {
    CalibrateCameraOptions options;
    options.input = input_;
    options.output = output_;
    options.rig = "test rig";
    return options;
  }
  void expect_refused(const CalibrateCameraOptions& options, const std::string& words,
                      const std::string& more = "") const {
    const auto outcome = calibrate_camera(options, {});
    ASSERT_FALSE(outcome);
    EXPECT_THAT(outcome.error().message(), AllOf(HasSubstr(words), HasSubstr(more)));
    EXPECT_FALSE(fs::exists(output_));
  }

  Workspace work_;
  const fs::path input_ = work_ / "camera";
  const fs::path output_ = work_ / "calibration";
};

/// How far two cameras put a pixel of the frame apart on the table, rms.
double rms_mm(const CameraModel& a, const CameraModel& b) {
  double sum = 0, n = 0;
  for (int x = 0; x < a.size.width; x += 71) {
    for (int y = 0; y < a.size.height; y += 59, ++n)
      sum += std::pow(length(point_on_plane(a, x, y, 0) - point_on_plane(b, x, y, 0)), 2);
  }
  return std::sqrt(sum / n);
}

/// A ruler grid of 12 mm under the rig's camera, solved and put on the table's grid by a calibration.
void expect_true_ruler(const Workspace& work, const fs::path& measured) {
  simulator::Scene ruler = rig_scene();
  ruler.targets.resize(1);
  ruler.targets[0].pattern = simulator::CheckerboardSettings{14, 9, 12, 4};
  ruler.targets[0].centre_mm = {0, 0, 0.001};
  ASSERT_TRUE(simulator::simulate_session(ruler, work / "ruler.weft", {}));
  solve::SolveOptions solve;
  solve.method = "fast";
  solve.previews = false;
  ASSERT_TRUE(
      solve::solve_session({.folder = work / "ruler.weft", .calibration = {}, .leds = {}}, solve, {}));
  material::RectifyOptions rectify;
  rectify.session = work / "ruler.weft";
  rectify.calibration = measured;
  const auto maps = material::rectify_session(rectify, {});
  ASSERT_TRUE(maps) << maps.error().message();
  const Result<LoadedImage> albedo = read_image(maps->folder / "albedo.exr");
  ASSERT_TRUE(albedo);
  const std::vector<View<const float>> rgb = {albedo->planes.plane(0), albedo->planes.plane(1),
                                              albedo->planes.plane(2)};
  const auto board = calibration::find_board(
      calibration::grey_picture(rgb).plane(),
      {.kind = calibration::BoardKind::kCheckerboard, .squares_x = 14, .squares_y = 9, .square_mm = 12});
  ASSERT_EQ(board.fault, calibration::BoardFault::kNone) << board.why;
  const double mm_per_pixel = maps->facts.mm_per_pixel;
  double most_mm = 0;
  for (const auto& a : board.corners) {
    for (const auto& b : board.corners) {
      if (std::abs(std::hypot(a.u_mm - b.u_mm, a.v_mm - b.v_mm) - 12) > 0.1) continue;
      most_mm = std::max(most_mm, std::abs(mm_per_pixel * std::hypot(a.px.x - b.px.x, a.px.y - b.px.y) - 12));
    }
  }
  EXPECT_LT(most_mm, 0.05);
}

TEST_F(CalibrateCamera, NamesTwoBlurredPhotographsOfFifteenAndMakesARulerTrueWithTheRest) {
  photograph_boards(15);
  simulator::Scene soft = photograph_scene(4), shaken = photograph_scene(9);
  soft.camera.blur.defocus_px = 7;
  shaken.camera.blur.spread_px = 3;
  fs::remove(input_ / "board14.dng");
  fs::remove(input_ / "board19.dng");
  photograph("board14.dng", soft);
  photograph("board19.dng", shaken);

  const auto outcome = calibrate_camera(options(), {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->warnings,
              testing::UnorderedElementsAre(AllOf(HasSubstr("board14.dng"), HasSubstr("blurred")),
                                            AllOf(HasSubstr("board19.dng"), HasSubstr("blurred"))));
  const Json& numbers = outcome->report.numbers;
  const auto used = std::count_if(numbers["photographs"].begin(), numbers["photographs"].end(),
                                  [](const Json& p) { return p["used"].get<bool>(); });
  EXPECT_EQ(used, 13);
  EXPECT_LT(numbers["rms_px"].get<double>(), 0.08);

  const CameraModel truth = simulator::rig_of(rig_scene())->camera;
  const Result<Calibration> written = read_calibration(output_);
  ASSERT_TRUE(written) << written.error().message();
  const double predicted_mm = numbers["table_sigma_mm"].get<double>();
  EXPECT_LT(rms_mm(*written->camera, truth), 2.5 * predicted_mm);
  EXPECT_LT(predicted_mm, 0.03);
  EXPECT_NEAR(written->camera->fx / truth.fx, 1, 0.002);
  ASSERT_EQ(written->fiducials.size(), 1U);
  EXPECT_EQ(written->fiducials[0].id, 5);
  EXPECT_LT(length(written->fiducials[0].corners_mm[0] - Vec3{-90, 58, 0}), 0.06);
  EXPECT_TRUE(fs::exists(output_ / "report" / "camera.html"));
  EXPECT_TRUE(fs::exists(output_ / "report" / "camera.json"));
  expect_true_ruler(work_, output_);
}

TEST_F(CalibrateCamera, NamesPhotographsOfAnotherCameraSizeApertureAndFocalLengthAndFilesThatAreNone) {
  photograph_boards(7);
  simulator::Scene other_body = photograph_scene(2), other_size = photograph_scene(3),
                   other_aperture = photograph_scene(4);
  other_body.camera.body = simulator::Body::kD5100;
  other_size.camera.width = 600;
  other_aperture.camera.f_number = 11;
  photograph("other_body.dng", other_body);
  photograph("other_size.dng", other_size);
  photograph("other_aperture.dng", other_aperture);
  Result<RawFrame> zoomed = capture::decode_raw(input_ / "board12.dng");
  ASSERT_TRUE(zoomed) << zoomed.error().message();
  zoomed->shot.focal_mm = 55;
  ASSERT_TRUE(simulator::write_dng(input_ / "zoomed.dng", *zoomed));
  Result<RawFrame> bright = capture::decode_raw(input_ / "board13.dng");
  ASSERT_TRUE(bright) << bright.error().message();
  for (int y = 0; y < bright->counts.height(); ++y) {
    for (int x = 0; x < bright->counts.width(); ++x)
      bright->counts(x, y) =
          static_cast<std::uint16_t>(std::min(3 * bright->counts(x, y), static_cast<int>(bright->white)));
  }
  ASSERT_TRUE(simulator::write_dng(input_ / "bright.dng", *bright));
  photograph("empty.dng", rig_scene());
  const std::string whole = bytes_of(input_ / "board12.dng");
  put_bytes(input_ / "half.dng", whole.substr(0, whole.size() / 2));
  put_bytes(input_ / "words.dng", "no photograph");
  const auto outcome = calibrate_camera(options(), {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  for (const auto& [name, why] : {std::pair{"other_body.dng", "was taken with"},
                                  {"other_size.dng", "600 x 420"},
                                  {"other_aperture.dng", "f/11"},
                                  {"zoomed.dng", "focal length 55 mm, not 50: turn the zoom back"},
                                  {"bright.dng", "too bright"},
                                  {"empty.dng", "no board found"},
                                  {"half.dng", "half.dng"},
                                  {"words.dng", "words.dng"}}) {
    EXPECT_THAT(outcome->warnings, testing::Contains(AllOf(HasSubstr(name), HasSubstr(why))));
  }
  EXPECT_EQ(outcome->calibration.subject.focal_length_mm, 50);
}

TEST_F(CalibrateCamera, RefusesPhotographsOfAnotherSizeThanTheCalibratedCameras) {
  photograph_boards(6);
  simulator::Scene before = rig_scene();
  before.camera.width = 600;
  const Result<simulator::SceneRig> rig = simulator::rig_of(before);
  ASSERT_TRUE(rig);
  ASSERT_TRUE(write_calibration(work_ / "old", simulator::exact_calibration(before, *rig)));
  CalibrateCameraOptions with_old = options();
  with_old.from = work_ / "old";
  expect_refused(with_old, "table01.dng: it has 640 x 420 pixels, the calibrated camera 600 x 420");
  // Those that have it are used, though fewer.
  simulator::Scene right = photograph_scene(0);
  right.camera.width = 600;
  photograph("table02.dng", right);
  expect_refused(with_old, "1 can be used", "board11.dng: it has 640 x 420");
}

TEST_F(CalibrateCamera, RefusesWhatCannotBeUsedAndWritesNothing) {
  photograph_boards(4);
  expect_refused(options(), "too few photographs", "4 can be used");
  CalibrateCameraOptions wrong = options();
  wrong.board.squares_x = 12;
  expect_refused(wrong, "table01.dng", "wrong number of squares");
  wrong = options();
  wrong.board.kind = "circles";
  expect_refused(wrong, "circles");
  fs::rename(input_ / "table01.dng", input_ / "board10.dng");
  expect_refused(options(), "no photograph shows the board on the table", "table");
  put_bytes(input_ / "board.toml", "squares = 11\n");
  expect_refused(options(), "board.toml", "squares");
  put_bytes(input_ / "board.toml", "squares_x = \"many\"\n");
  expect_refused(options(), "board.toml", "squares_x");
  wrong = options();
  wrong.input = work_ / "nothing";
  wrong.board = {{}, 11, 8, 12, 0.7, 3, "DICT_5X5_100"};
  expect_refused(wrong, "nothing", "the folder is not there");
}

TEST_F(CalibrateCamera, KeepsTheOtherPartsAndSaysThatTheLightsAreOfAnotherFrame) {
  photograph_boards(8);
  simulator::Scene before = rig_scene();
  before.camera.pose = {.tilt_deg = 1.5, .azimuth_deg = 35};
  const Result<simulator::SceneRig> rig = simulator::rig_of(before);
  ASSERT_TRUE(rig);
  const auto old = write_calibration(work_ / "old", simulator::exact_calibration(before, *rig));
  ASSERT_TRUE(old) << old.error().message();
  const auto contents = contents_of(work_ / "old");
  CalibrateCameraOptions with_old = options();
  with_old.from = work_ / "old";
  const auto outcome = calibrate_camera(with_old, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_TRUE(outcome->calibration.lights && outcome->calibration.response);
  EXPECT_EQ(bytes_of(output_ / "lights.json"), bytes_of(work_ / "old" / "lights.json"));
  EXPECT_THAT(outcome->report.verdicts,
              testing::Contains(testing::Field(&Verdict::name, "LIGHTS_OF_ANOTHER_FRAME")));
  EXPECT_EQ(contents_of(work_ / "old"), contents);
  const auto again = calibrate_camera(with_old, {});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate);
}

TEST_F(CalibrateCamera, LeavesOutWhatIsNotTrueOfItsOwnTable) {
  photograph_boards(8);
  // A second photograph of the table, whose tag lies elsewhere, and old patches.
  simulator::Scene moved = photograph_scene(0);
  moved.targets[0].centre_mm.y -= 5;
  photograph("table02.dng", moved);
  const Result<simulator::SceneRig> rig = simulator::rig_of(rig_scene());
  ASSERT_TRUE(rig);
  Calibration before = simulator::exact_calibration(rig_scene(), *rig);
  before.patches = {{{{10, 10}, {30, 10}, {30, 30}}, {0.88, 0.88, 0.88}}};
  ASSERT_TRUE(write_calibration(work_ / "old", before));
  CalibrateCameraOptions with_old = options();
  with_old.from = work_ / "old";
  const auto outcome = calibrate_camera(with_old, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->calibration.fiducials, testing::IsEmpty());
  EXPECT_THAT(outcome->warnings, testing::Contains(HasSubstr("tag 5")));
  EXPECT_THAT(outcome->calibration.patches, testing::IsEmpty());
  EXPECT_THAT(outcome->warnings, testing::Contains(HasSubstr("weft calibrate patches")));
  EXPECT_TRUE(outcome->calibration.lights);
}

// Photographs of Bouguet's calibration toolbox; its page gives these values and uncertainties for them.
TEST(RealBoards, GiveThePublishedLensFromTwentyPhotographsOfACheckerboard) {
  const char* shared = std::getenv("WEFT_SHARED_DATA");
  if (shared == nullptr) GTEST_SKIP() << "WEFT_SHARED_DATA is not set";
  const fs::path photographs = fs::path(shared) / "bouguet_boards";
  if (!fs::exists(photographs)) GTEST_SKIP() << photographs << " is not there";
  const Workspace work;
  CalibrateCameraOptions options;
  options.input = photographs;
  options.output = work / "new";
  const auto outcome = calibrate_camera(options, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  int used = 0;
  for (const Json& photograph : outcome->report.numbers["photographs"])
    used += photograph["left_out"].get<std::string>().empty() ? 1 : 0;
  EXPECT_EQ(used, 20) << testing::PrintToString(outcome->warnings);
  const CameraModel& camera = *outcome->calibration.camera;
  EXPECT_NEAR(camera.fx, 657.463, 3 * 0.318);
  EXPECT_NEAR(camera.fy, 657.947, 3 * 0.340);
  EXPECT_NEAR(camera.cx, 303.137, 3 * 0.647);
  EXPECT_NEAR(camera.cy, 242.569, 3 * 0.592);
}

}  // namespace
}  // namespace weft::test
