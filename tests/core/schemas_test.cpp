// SPDX-License-Identifier: Apache-2.0
// Today's readers on what stored documents say, which are kept for ever.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "core/solve/solve_record.h"
#include "tests/core/places.h"

namespace weft {
namespace {

const std::filesystem::path kSchemas = source_folder() / "testdata/schemas";
const std::filesystem::path kGolden = source_folder() / "testdata/golden";

TEST(Schemas, Session1) {
  const Result<Session> session = read_session(kSchemas / "weft.session-1");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->fabric, "linen 1/1");
  EXPECT_EQ(session->cloth_height_mm, 0.4);
  EXPECT_EQ(session->rig, "rig A");
  EXPECT_EQ(session->calibration_id, "9e1ed071c12a8ac2b162e23c795a48d10c009741f26d678017da91b2788425fd");
  EXPECT_EQ(session->state, "complete");
  ASSERT_EQ(session->shots.size(), 6U);
  EXPECT_EQ(session->lit().size(), 3U);
  EXPECT_EQ(session->lit()[2]->file, "raw/02_led03.dng");
  ASSERT_NE(session->dark(), nullptr);
  EXPECT_EQ(session->dark()->exposure_us, 16364);
  EXPECT_EQ(session->shots[4].role, ShotRole::kRepeat);
  EXPECT_EQ(session->shots[5].role, ShotRole::kBracket);
  EXPECT_EQ(session->shots[5].exposure_us, 1000);
  EXPECT_EQ(session->shots[0].iso, 100);
  EXPECT_EQ(session->shots[0].f_number, 8);
  EXPECT_EQ(session->shots[0].time, "2026-01-31T12:00:00Z");
  EXPECT_EQ(session->shots[0].sha256, "93ae1d12b3e6656802b0dd674caa63041dafc2c5baa13ade4a50f1c4eaaac7e7");
}

TEST(Schemas, Session1_1OfAScan) {
  const Result<Session> session = read_session(kSchemas / "weft.session-1.1");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->state, "complete");
  EXPECT_EQ(session->document["plan"],
            Json::parse(R"({"leds": [1, 4, 7], "repeat": true, "bracket": 0.25})"));
  EXPECT_EQ(session->document["exposure"]["from"], "meter");
  EXPECT_EQ(session->document["exposure"]["bracket_us"], session->shots.back().exposure_us);
  EXPECT_EQ(session->document["metadata"]["weight"], "180 g/m2");
  ASSERT_EQ(session->shots.size(), 8U);
  EXPECT_EQ(session->lit().size(), 3U);
  EXPECT_EQ(session->shots[2].document["image_number"], 6);
  EXPECT_NEAR(session->shots[2].document["level"].get<double>(), 0.9881240742034876, 1e-9);
}

TEST(Schemas, Session1_3ThroughFilms) {
  const Result<Session> session = read_session(kSchemas / "weft.session-1.3");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->films, (Films{.leak = 0.004, .scattered = 0.23}));
  EXPECT_EQ(session->lit(Polariser::kCrossed).size(), 3U);
  EXPECT_EQ(session->lit(Polariser::kParallel).size(), 3U);
  const Result<Session> before = read_session(kSchemas / "weft.session-1.2");
  ASSERT_TRUE(before) << before.error().message();
  EXPECT_EQ(before->films, Films()) << "nobody said";
}

TEST(Schemas, Session1_4OfATiltedCloth) {
  const Result<Session> session = read_session(kSchemas / "weft.session-1.4");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->pose, (ClothPose{.tilt_deg = 20, .downhill_deg = -45}));
  const Result<Session> before = read_session(kSchemas / "weft.session-1.3");
  ASSERT_TRUE(before) << before.error().message();
  EXPECT_TRUE(before->pose.is_level()) << "nobody said";
}

TEST(Schemas, Session1_5OfAnImport) {
  const Result<Session> session = read_session(kSchemas / "weft.session-1.5");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->document["imported"]["by"], "numbers in names");
  ASSERT_EQ(session->shots.size(), 4U);
  EXPECT_EQ(session->shots[1].document["source"], "tray 7/satin_01.NEF");
  ASSERT_NE(session->dark(), nullptr);
  EXPECT_EQ(session->dark()->index, 0);
}

TEST(Schemas, Session1_8OfABlade) {
  const Result<Session> session = read_session(kSchemas / "weft.session-1.8");
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_EQ(session->shots.size(), 4U);
  EXPECT_EQ(session->shots[3].role, ShotRole::kBlade);
  EXPECT_EQ(session->shots[3].led, 4);
  EXPECT_EQ(session->lit().size(), 3U) << "it is no lit shot";
}

TEST(Schemas, Calibration1WithCameraResponseAndNearLights) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, "9e1ed071c12a8ac2b162e23c795a48d10c009741f26d678017da91b2788425fd");
  EXPECT_EQ(calibration->subject.rig, "rig A");
  EXPECT_EQ(calibration->subject.camera_model, "NIKON D5100");
  EXPECT_EQ(calibration->subject.camera_serial, "6012345");
  EXPECT_EQ(calibration->subject.f_number, 8);
  EXPECT_EQ(calibration->subject.albedo_scale, AlbedoScale::kAbsolute);

  ASSERT_TRUE(calibration->camera);
  const CameraModel& camera = *calibration->camera;
  EXPECT_EQ(camera.size, (Size{4928, 3264}));
  EXPECT_EQ(camera.fx, 7322.5);
  EXPECT_EQ(camera.fy, 7323.25);
  EXPECT_EQ(camera.cx, 2463.5);
  EXPECT_EQ(camera.cy, 1631.5);
  EXPECT_EQ(camera.k1, -0.1);
  EXPECT_EQ(camera.k2, 0.05);
  EXPECT_EQ(camera.k3, -0.01);
  EXPECT_EQ(camera.p1, 0.0003);
  EXPECT_EQ(camera.p2, -0.0002);
  EXPECT_EQ(camera.camera_from_rig_rotation, (Mat3{{{0.96, 0.28, 0}, {0.28, -0.96, 0}, {0, 0, -1}}}));
  EXPECT_EQ(camera.camera_from_rig_translation_mm, (Vec3{0.5, -1.25, 602}));

  ASSERT_TRUE(calibration->response);
  EXPECT_EQ(calibration->response->electrons_per_count, 2.5);
  EXPECT_EQ(calibration->response->read_noise_counts, 1.75);
  EXPECT_EQ(calibration->response->linearity[2], (std::array<double, 2>{0.003, -0.004}));

  ASSERT_TRUE(calibration->lights && std::holds_alternative<NearLights>(*calibration->lights));
  const auto& lights = std::get<NearLights>(*calibration->lights);
  ASSERT_EQ(lights.leds.size(), 3U);
  EXPECT_EQ(lights.leds[1].position_mm, (Vec3{-150, 260, 490}));
  EXPECT_EQ(lights.leds[1].aim, (Vec3{0.36, -0.48, -0.8}));
  EXPECT_EQ(lights.leds[1].mu, 1.2);
  EXPECT_EQ(lights.leds[1].flux_rgb, (std::array<double, 3>{100'000, 200'000, 136'000}));
  EXPECT_EQ(lights.leds[1].log_gain_quadratic,
            (std::array<double, 6>{0.01, -0.02, 0.03, -0.04, 0.05, -0.06}));
  EXPECT_EQ(lights.log_gain_rgb[1].columns, 5);
  EXPECT_EQ(lights.log_gain_rgb[1].rows, 4);
  ASSERT_EQ(lights.log_gain_rgb[1].coefficients.size(), 20U);
  EXPECT_EQ(lights.log_gain_rgb[1].coefficients[7], -0.07);
  EXPECT_TRUE(lights.log_gain_rgb[0].empty());
}

TEST(Schemas, Calibration12) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1.2");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->subject.measured, "2026-01-31T12:00:00Z");
  EXPECT_EQ(calibration->subject.focal_length_mm, 35);
  const Result<Calibration> before = read_calibration(kSchemas / "weft.calibration-1");
  ASSERT_TRUE(before) << before.error().message();
  EXPECT_EQ(before->subject.focal_length_mm, 0) << "nobody said";
}

TEST(Schemas, Calibration1WithResponse11AndLights11) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1.1");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, "4c10af3c39579e3834cc77fd306812679c588d69094c49e5e9acb8a9ea95843d");
  ASSERT_TRUE(calibration->response);
  EXPECT_EQ(calibration->response->exposure_ratios, (std::vector<ExposureRatio>{{4000, 16364, 0.2471}}));
  ASSERT_EQ(calibration->patches.size(), 1U);
  EXPECT_EQ(calibration->patches[0].polygon_px[2], (std::array{398.0, 300.25}));
  EXPECT_EQ(calibration->patches[0].reflectance_rgb, (std::array{0.88, 0.9, 0.91}));
  EXPECT_EQ(calibration->patches[0].delta, 0) << "nobody said";
  EXPECT_FALSE(calibration->patches[0].height_mm);
  ASSERT_TRUE(calibration->light_covariance);
  EXPECT_EQ(calibration->light_covariance->parameters,
            (std::vector<std::string>{"led01.position_mm.x", "led01.mu", "led03.log_flux"}));
  EXPECT_EQ(calibration->light_covariance->matrix,
            (std::vector<double>{0.25, 0.001, 0, 0.001, 0.0004, 0, 0, 0, 0.0001}));
  EXPECT_EQ(calibration->hot_picture, kSchemas / "weft.calibration-1.1" / "hot.png");
}

TEST(Schemas, Calibration11WithCamera11Response12AndColor1) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1.1-measured");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, "7fd117105c5f1cb9739ebed77157a1bb6a3e6880736a6ae7b439e476e5f0d708");
  EXPECT_EQ(calibration->subject.measured, "2026-02-14T09:30:00Z");
  EXPECT_EQ(calibration->subject.focal_length_mm, 0) << "nobody said";
  ASSERT_TRUE(calibration->camera_covariance);
  EXPECT_EQ(calibration->camera_covariance->parameters, (std::vector<std::string>{"fx", "fy"}));
  EXPECT_EQ(calibration->camera_covariance->matrix, (std::vector<double>{0.04, 0.01, 0.01, 0.09}));
  EXPECT_EQ(calibration->fiducials,
            (std::vector<Fiducial>{
                {"DICT_APRILTAG_36h11", 3, {{{1, 2, 0}, {3, 2, 0}, {3, 0.5, 0}, {1, 0.5, 0}}}}}));
  ASSERT_TRUE(calibration->response);
  EXPECT_EQ(calibration->response->black_counts, 600.25);
  EXPECT_FALSE(calibration->response->iso);
  ASSERT_TRUE(calibration->color && calibration->color->curve);
  EXPECT_EQ(calibration->color->rec709_from_camera[2], (std::array{0.0, -0.5, 1.5}));
  EXPECT_TRUE(calibration->color->covariance.empty());
  EXPECT_EQ(calibration->color->curve->before[3], 0.125);
  EXPECT_EQ(calibration->color->curve->cubic[7], -0.125);
  EXPECT_EQ(calibration->color->curve->after[0], 0.9375);
}

TEST(Schemas, Calibration12OfAMeasuredRig) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1.2-measured");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, "a8a2599596fda3f4db95ce6551f97125f4a438185f23adc607cf4a14b4372742");
  EXPECT_EQ(calibration->subject.focal_length_mm, 50);
  EXPECT_EQ(calibration->fiducials.size(), 4U);
  ASSERT_TRUE(calibration->camera_covariance);
  EXPECT_EQ(calibration->camera_covariance->parameters.size(), 12U);
  ASSERT_TRUE(calibration->response);
  EXPECT_EQ(calibration->response->iso, 100);
  EXPECT_EQ(calibration->response->exposure_ratios.size(), 6U);
  ASSERT_TRUE(calibration->color);
  EXPECT_EQ(calibration->color->covariance.size(), 81U);
  EXPECT_TRUE(calibration->hot_picture);
}

TEST(Schemas, Calibration1WithDistantLights) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1-distant");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->id, "8f6c2fe7e4518f3a55bd2aaab5d3d10f39dc1cdcaacffec45e0da5d5ad18531d");
  EXPECT_FALSE(calibration->camera || calibration->response);
  ASSERT_TRUE(calibration->lights && std::holds_alternative<DistantLights>(*calibration->lights));
  const auto& lights = std::get<DistantLights>(*calibration->lights).lights;
  ASSERT_EQ(lights.size(), 3U);
  EXPECT_EQ(lights[1].direction, (Vec3{0.36, -0.48, 0.8}));
  EXPECT_EQ(lights[1].irradiance_rgb, (std::array<double, 3>{1, 1.5, 2}));
}

TEST(Schemas, Response1_5) {
  const Result<Calibration> calibration = read_calibration(kSchemas / "weft.calibration-1.2-levels");
  ASSERT_TRUE(calibration) << calibration.error().message();
  const CountLevels& levels = calibration->response.value().levels.value();
  EXPECT_EQ(levels.black, (std::array<double, 4>{600, 600, 600, 600}));
  EXPECT_EQ(levels.white, 16383);
  EXPECT_EQ(levels.dark_rgb, (std::array<double, 3>{600, 601, 600}));
  EXPECT_EQ(levels.full_rgb, (std::vector<double>{0, 15520, 15840}));
}

TEST(Schemas, Solve1) {
  const Result<Json> document = read_json(kSchemas / "weft.solve-1/solve.json", "weft.solve", 1);
  ASSERT_TRUE(document) << document.error().message();
  JsonFields fields(*document, "solve.json");
  EXPECT_EQ(fields.text("id").size(), 16U);
  EXPECT_GE(fields.integer("solver_version"), 1);
  EXPECT_EQ(fields.text("method"), "fast");
  EXPECT_EQ(fields.text("compression"), "none");
  EXPECT_EQ(fields.integer("lights"), 10);
  EXPECT_EQ(fields.integer("width"), 256);
  EXPECT_EQ(fields.integer("height"), 256);
  EXPECT_EQ(fields.text("albedo_scale"), "absolute");
  EXPECT_EQ(fields.integer("pixels"), 256 * 256);
  EXPECT_FALSE(fields.list("pictures").empty());

  JsonFields input(fields.object("input"), "input");
  EXPECT_EQ(input.text("session"), "golden twill");
  EXPECT_EQ(input.text("calibration").size(), 64U);
  EXPECT_EQ(input.number("cloth_height_mm"), 0);
  EXPECT_EQ(input.list("shots").size(), 11U);
  EXPECT_TRUE(input.status()) << input.status().error().message();

  JsonFields status(fields.object("status"), "status");
  for (const StatusName& bit : kStatusNames) {
    if (bit.bit & kHowSolved) continue;
    EXPECT_GE(status.integer(bit.name), 0);
  }
  EXPECT_TRUE(status.status()) << status.status().error().message();

  JsonFields error(fields.object("error"), "error");
  EXPECT_GT(error.number("mean_deg"), 0);
  EXPECT_GT(error.number("max_deg"), error.number("p95_deg"));
  EXPECT_GT(error.number("p95_deg"), error.number("median_deg"));
  EXPECT_TRUE(error.status()) << error.status().error().message();
  EXPECT_TRUE(fields.status()) << fields.status().error().message();
}

TEST(Schemas, Rectified1) {
  const auto found = list_products({"weft.rectified", "rectify.json", "set of rectified maps", ""},
                                   kGolden / "satin.weft/rectified");
  ASSERT_EQ(found.size(), 1U);
  const Result<Json> document = read_json(found[0].folder / "rectify.json", "weft.rectified", 1);
  ASSERT_TRUE(document) << document.error().message();
  JsonFields fields(*document, "rectify.json");
  EXPECT_EQ(fields.text("id"), found[0].id);
  const Result<Product> solve = find_solve(kGolden / "satin.weft", fields.text("solve"));
  EXPECT_TRUE(solve) << solve.error().message();
  EXPECT_EQ(fields.integer("width"), 16);
  EXPECT_EQ(fields.integer("height"), 11);
  EXPECT_EQ(fields.number("mm_per_pixel"), 12);
  EXPECT_EQ(fields.list("first_pixel_mm"), Json({-90.0, 60.0}));
  EXPECT_EQ(fields.integer("pixels"), 16 * 11);
  EXPECT_TRUE(fields.status()) << fields.status().error().message();
}

TEST(Schemas, CalibrationReport1) {
  const Result<Json> document =
      read_json(kSchemas / "weft.calibration-1.2-measured/report/camera.json", "weft.calibration-report", 1);
  ASSERT_TRUE(document) << document.error().message();
  JsonFields fields(*document, "camera.json");
  EXPECT_EQ(fields.text("part"), "camera");
  EXPECT_EQ(fields.text("title"), "Camera of virtual rig");
  EXPECT_FALSE(fields.text("summary").empty() || fields.object("numbers").empty());
  ASSERT_EQ(fields.list("verdicts").size(), 1U);
  EXPECT_EQ(fields.list("verdicts")[0].value("name", ""), "LIGHTS_OF_ANOTHER_FRAME");
  EXPECT_TRUE(fields.status()) << fields.status().error().message();
}

TEST(Schemas, CalibrationCheck1) {
  const Result<Json> document =
      read_json(kSchemas / "weft.calibration-check-1/result.json", "weft.calibration-check", 1);
  ASSERT_TRUE(document) << document.error().message();
  JsonFields fields(*document, "result.json");
  EXPECT_EQ(fields.text("date"), "2026-11-22T15:51:02Z");
  EXPECT_EQ(fields.text("of"), "session");
  EXPECT_EQ(fields.text("calibration"), read_calibration(kSchemas / "weft.calibration-1.2-measured")->id);
  EXPECT_EQ((*document)["passed"], true);
  EXPECT_FALSE(fields.object("numbers").empty());
  EXPECT_TRUE(fields.status()) << fields.status().error().message();
}

TEST(Schemas, SolveReport1) {
  const Result<Json> document =
      read_json(kSchemas / "weft.solve-report-1/report.json", "weft.solve-report", 1);
  ASSERT_TRUE(document) << document.error().message();
  JsonFields fields(*document, "report.json");
  EXPECT_EQ(fields.text("of"), "session");
  EXPECT_EQ(fields.text("title"), "golden twill");
  EXPECT_EQ(fields.list("lights").size(), 10U);
  EXPECT_GT(fields.number("residual"), 0);
  EXPECT_GT(fields.integer("looked_at"), 0);
  ASSERT_EQ(fields.list("faults").size(), 1U);
  ASSERT_EQ(fields.list("warnings").size(), 1U);
  ASSERT_FALSE(fields.list("budget").empty());

  JsonFields fault(fields.list("faults")[0], "faults[0]");
  EXPECT_EQ(fault.text("kind"), "exchanged");
  EXPECT_EQ(fault.list("lights"), Json({3, 4}));
  EXPECT_EQ(fault.list("shown_by"), Json({4, 3}));
  EXPECT_LT(fault.number("residual_after"), fault.number("residual_before"));
  EXPECT_TRUE(fault.status()) << fault.status().error().message();

  JsonFields warning(fields.list("warnings")[0], "warnings[0]");
  EXPECT_EQ(warning.text("name"), "LEDS_EXCHANGED");
  EXPECT_FALSE(warning.text("text").empty() || warning.text("remedy").empty());
  EXPECT_TRUE(warning.status()) << warning.status().error().message();

  JsonFields light(fields.list("lights")[2], "lights[2]");
  EXPECT_EQ(light.integer("light"), 3);
  for (const char* field : {"residual_rms", "residual_median", "residual_mean", "gain", "gain_range",
                            "saturated", "shadowed", "missing", "outlier", "gradient", "gradient_share"}) {
    light.number(field);
  }
  EXPECT_TRUE(light.status()) << light.status().error().message();

  JsonFields sigma(fields.object("sigma_normal_deg"), "sigma_normal_deg");
  EXPECT_EQ(sigma.list("grid").size(),
            static_cast<std::size_t>(sigma.integer("columns") * sigma.integer("rows")));
  EXPECT_GT(sigma.number("p95"), sigma.number("median"));
  EXPECT_TRUE(sigma.status()) << sigma.status().error().message();
  EXPECT_TRUE(fields.has("seconds"));
  EXPECT_TRUE(fields.status()) << fields.status().error().message();
}

}  // namespace
}  // namespace weft
