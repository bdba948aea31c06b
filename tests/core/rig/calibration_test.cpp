// SPDX-License-Identifier: Apache-2.0
#include "core/rig/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "core/base/sha256.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/places.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Every field away from its default, by numbers that no short decimal holds.
Calibration full_calibration() {
  Calibration calibration;
  calibration.subject = {"rig A", "D5100", "6 012 345", 5.6, AlbedoScale::kAbsolute};
  CameraModel camera;
  camera.size = {4928, 3264};
  camera.fx = 7322.1 / 3, camera.fy = 7322.7 / 3, camera.cx = 2463.4, camera.cy = 1631.9;
  camera.k1 = -0.1, camera.k2 = 1.0 / 7, camera.k3 = 1e-17, camera.p1 = 3e-4, camera.p2 = -2e-4;
  camera.camera_from_rig_rotation = {{{0.8, 0.6, 0}, {0.6, -0.8, 0}, {0, 0, -1}}};
  camera.camera_from_rig_translation_mm = {0.1, -1.0 / 3, 602.7};
  calibration.camera = camera;
  calibration.response = Response{3.1, 1.0 / 9, {{{0.01, -0.02}, {0.03, -0.04}, {0.05, -0.06}}}};
  NearLights lights;
  for (int k = 0; k < 3; ++k) {
    const double a = k + 0.1;
    lights.leds.push_back({.position_mm = {100 * a, -90 * a, 500 + a},
                           .aim = normalized({-a, 0.9 * a, -5}),
                           .mu = a,
                           .flux_rgb = {1e5 + a, 2e5 + a, 3e5 + a},
                           .log_gain_quadratic = {0.1 * a, 0.2 * a, 0.3 * a, -0.4 * a, 0.5 * a, -0.6 * a}});
  }
  lights.log_gain_rgb[0] = {4, 5, std::vector<double>(20, 0.1)};
  lights.log_gain_rgb[0].coefficients[7] = -1.0 / 3;
  lights.log_gain_rgb[2] = {6, 4, std::vector<double>(24, 0.01)};
  calibration.lights = lights;
  return calibration;
}

Calibration distant_calibration() {
  Calibration calibration;
  calibration.subject = {"dome", "a camera", "", 8, AlbedoScale::kRelative};
  calibration.lights = DistantLights{{{normalized({1, 2, 3}), {0.1, 0.2, 0.3}}, {{0, 0, 1}, {1, 2, 3}}}};
  return calibration;
}

Calibration must_read(const fs::path& folder) {
  Result<Calibration> read = read_calibration(folder);
  EXPECT_TRUE(read) << read.error().message();
  return read ? std::move(*read) : Calibration();
}

std::string must_write(const fs::path& folder, const Calibration& calibration) {
  const Result<Calibration> written = write_calibration(folder, calibration);
  EXPECT_TRUE(written) << written.error().message();
  return written ? written->id : "";
}

std::string why_refused(const fs::path& folder) {
  const Result<Calibration> read = read_calibration(folder);
  return read ? "read" : read.error().message();
}

Json json_of(const fs::path& file) {
  return Json::parse(bytes_of(file));
}

// Changes one part and the digest that calibration.json has of it.
void rewrite_part(const fs::path& folder, const std::string& part, const std::function<void(Json&)>& change) {
  Json json = json_of(folder / part);
  change(json);
  put_bytes(folder / part, json.dump());
  Json document = json_of(folder / "calibration.json");
  document["parts"][part] = sha256_of(json.dump());
  put_bytes(folder / "calibration.json", document.dump());
}

TEST(Calibration, ReturnsEveryFieldThatWasWritten) {
  const ScratchFolder folder;
  const Calibration written = full_calibration();
  const std::string id = must_write(folder / "c", written);
  const Calibration read = must_read(folder / "c");
  EXPECT_EQ(read.id, id);
  EXPECT_EQ(id.size(), 64U);
  EXPECT_EQ(read.subject.rig, "rig A");
  EXPECT_EQ(read.subject.camera_model, "D5100");
  EXPECT_EQ(read.subject.camera_serial, "6 012 345");
  EXPECT_EQ(read.subject.f_number, 5.6);
  EXPECT_EQ(read.subject.albedo_scale, AlbedoScale::kAbsolute);
  EXPECT_TRUE(read.camera == written.camera) << bytes_of(folder / "c/camera.json");
  EXPECT_TRUE(read.response == written.response) << bytes_of(folder / "c/response.json");
  ASSERT_TRUE(read.lights && std::holds_alternative<NearLights>(*read.lights));
  const auto& now = std::get<NearLights>(*read.lights);
  const auto& before = std::get<NearLights>(*written.lights);
  ASSERT_EQ(now.leds.size(), before.leds.size());
  for (std::size_t k = 0; k < now.leds.size(); ++k) {
    EXPECT_EQ(now.leds[k].position_mm, before.leds[k].position_mm) << "LED " << k + 1;
    EXPECT_EQ(now.leds[k].aim, before.leds[k].aim) << "LED " << k + 1;
    EXPECT_EQ(now.leds[k].mu, before.leds[k].mu) << "LED " << k + 1;
    EXPECT_EQ(now.leds[k].flux_rgb, before.leds[k].flux_rgb) << "LED " << k + 1;
    EXPECT_EQ(now.leds[k].log_gain_quadratic, before.leds[k].log_gain_quadratic) << "LED " << k + 1;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(now.log_gain_rgb[c].columns, before.log_gain_rgb[c].columns) << "channel " << c;
    EXPECT_EQ(now.log_gain_rgb[c].rows, before.log_gain_rgb[c].rows) << "channel " << c;
    EXPECT_EQ(now.log_gain_rgb[c].coefficients, before.log_gain_rgb[c].coefficients) << "channel " << c;
  }
}

TEST(Calibration, ReturnsRatiosPatchesCovarianceAndHotPicture) {
  const ScratchFolder folder;
  Calibration written = full_calibration();
  written.response->exposure_ratios = {{4000, 16000, 0.2512}, {64000, 16000, 4.03}};
  written.patches = {{{{1, 2.5}, {30, 2}, {15, 40}}, {0.88, 0.9, 0.91}, 0.04, 0.8}};
  written.light_covariance = ParameterCovariance{{"led01.mu", "led02.log_flux"}, {4e-4, -1e-6, -1e-6, 1e-4}};
  put_bytes(folder / "bad.png", "bytes of a picture");
  written.hot_picture = folder / "bad.png";
  const std::string id = must_write(folder / "c", written);
  const Calibration read = must_read(folder / "c");
  EXPECT_EQ(read.id, id);
  EXPECT_EQ(read.response, written.response);
  ASSERT_EQ(read.patches.size(), 1U);
  EXPECT_EQ(read.patches[0].polygon_px, written.patches[0].polygon_px);
  EXPECT_EQ(read.patches[0].reflectance_rgb, written.patches[0].reflectance_rgb);
  EXPECT_EQ(read.patches[0].delta, 0.04);
  EXPECT_EQ(read.patches[0].height_mm, 0.8);
  ASSERT_TRUE(read.light_covariance);
  EXPECT_EQ(read.light_covariance->parameters, written.light_covariance->parameters);
  EXPECT_EQ(read.light_covariance->matrix, written.light_covariance->matrix);
  EXPECT_EQ(read.hot_picture, folder / "c/hot.png");
  EXPECT_EQ(bytes_of(folder / "c/hot.png"), "bytes of a picture");
  put_bytes(folder / "c/hot.png", "bytes of another");
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("was changed after it was measured"));

  const Response& response = *read.response;
  EXPECT_EQ(response.exposure_ratio(4000, 16000), 0.2512);
  EXPECT_EQ(response.exposure_ratio(16000, 4000), 1 / 0.2512);
  EXPECT_EQ(response.exposure_ratio(64001, 16000), 4.03);
  EXPECT_FALSE(response.exposure_ratio(4000, 64000)) << "was not measured";
  EXPECT_EQ(response.exposures_beside(16001), (std::vector<double>{4000, 64000}));
  EXPECT_EQ(response.exposures_beside(64000), (std::vector<double>{16000}));
  EXPECT_EQ(response.exposures_beside(8000), (std::vector<double>{}));
}

TEST(Calibration, ReturnsColorFiducialsBlackAndTheCameraCovariance) {
  const ScratchFolder folder;
  Calibration written = full_calibration();
  written.subject.measured = "2026-01-31T12:00:00Z";
  written.response->black_counts = 600.25;
  written.response->iso = 400;
  written.camera_covariance = ParameterCovariance{{"fx", "fy"}, {0.04, 0.01, 0.01, 0.09}};
  written.spread = PointSpread{{0.5, 0.4, 0.625}};
  written.lateral = LateralColor{{-1e-4, 3e-4, 2e-6, 1e-5}, {2e-4, 0, 2e-6, 0}};
  written.fiducials = {{"DICT_APRILTAG_36h11", 3, {{{1, 2, 0}, {3, 2, 0}, {3, 0.1, 0}, {1, 0.1, 0}}}}};
  written.color = ColorTransform{{{{1.5, -0.4, -0.1}, {-0.2, 1.3, -0.1}, {0, -1.0 / 3, 4.0 / 3}}},
                                 std::vector<double>(81, 1e-6),
                                 ColorCurve{}};
  written.color->curve->cubic[7] = 0.1;
  must_write(folder / "c", written);
  const Calibration read = must_read(folder / "c");
  EXPECT_EQ(read.subject.measured, written.subject.measured);
  EXPECT_EQ(read.response, written.response);
  EXPECT_EQ(read.fiducials, written.fiducials);
  EXPECT_EQ(read.spread, written.spread);
  EXPECT_EQ(read.lateral, written.lateral);
  EXPECT_EQ(read.color, written.color);
  ASSERT_TRUE(read.camera_covariance);
  EXPECT_EQ(read.camera_covariance->parameters, written.camera_covariance->parameters);
  EXPECT_EQ(read.camera_covariance->matrix, written.camera_covariance->matrix);
}

TEST(Calibration, SaysTheFocalLengthInItsNewestSchemaAndElseKeepsToTheOldest) {
  const ScratchFolder folder;
  Calibration written = full_calibration();
  must_write(folder / "old", written);
  EXPECT_EQ(json_of(folder / "old/calibration.json")["schema"], "weft.calibration/1");
  EXPECT_EQ(must_read(folder / "old").subject.focal_length_mm, 0);
  written.subject.focal_length_mm = 35.5;
  must_write(folder / "c", written);
  Json document = json_of(folder / "c/calibration.json");
  EXPECT_EQ(document["schema"], "weft.calibration/1.2");
  EXPECT_EQ(must_read(folder / "c").subject.focal_length_mm, 35.5);
  document["focal_length_mm"] = -35;
  put_bytes(folder / "c/calibration.json", document.dump());
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("focal_length_mm"));
}

TEST(Calibration, RefusesAnAlbedoScaleOfAnotherName) {
  const ScratchFolder folder;
  must_write(folder / "c", full_calibration());
  Json document = json_of(folder / "c/calibration.json");
  document["albedo_scale"] = "absolut";
  put_bytes(folder / "c/calibration.json", document.dump());
  EXPECT_THAT(why_refused(folder / "c"),
              HasSubstr("\"albedo_scale\" is \"absolut\"; relative or absolute was expected"));
}

TEST(Calibration, RefusesColorsThatDoNotKeepWhite) {
  const ScratchFolder folder;
  Calibration calibration = full_calibration();
  calibration.color.emplace();
  must_write(folder / "c", calibration);
  rewrite_part(folder / "c", "color.json", [](Json& json) { json["rec709_from_camera"][1][1] = 1.1; });
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("three rows of three numbers that sum to 1"));
}

TEST(DerivedCalibration, ReplacesItsPartsAndCopiesTheOthersByteByByte) {
  const ScratchFolder folder;
  must_write(folder / "a", full_calibration());
  rewrite_part(folder / "a", "camera.json", [](Json& json) { json["of_a_newer_version"] = 1; });
  Calibration change;
  change.subject = full_calibration().subject;
  change.response = Response{2.5, 0.5, {}};
  const NamedFile page = {"response.html", "<p>a page</p>"};
  const Result<Calibration> derived = derive_calibration(folder / "a", change, folder / "b", {&page, 1});
  ASSERT_TRUE(derived) << derived.error().message();
  EXPECT_EQ(bytes_of(folder / "b/camera.json"), bytes_of(folder / "a/camera.json"));
  EXPECT_EQ(bytes_of(folder / "b/lights.json"), bytes_of(folder / "a/lights.json"));
  EXPECT_EQ(derived->response, change.response);
  EXPECT_EQ(bytes_of(folder / "b/report/response.html"), page.bytes);
  EXPECT_EQ(derived->subject.measured.size(), 20U) << derived->subject.measured;
  EXPECT_NE(derived->id, must_read(folder / "a").id);

  const NamedFile other = {"lights.html", "<p>another</p>"};
  const Result<Calibration> next = derive_calibration(folder / "b", change, folder / "c", {&other, 1});
  ASSERT_TRUE(next) << next.error().message();
  EXPECT_EQ(bytes_of(folder / "c/report/response.html"), page.bytes) << "of the earlier step";
  EXPECT_EQ(bytes_of(folder / "c/report/lights.html"), other.bytes);
}

TEST(DerivedCalibration, KeepsMapsOfLedsUntilTheLightsAreNew) {
  const ScratchFolder folder;
  must_write(folder / "a", full_calibration());
  Calibration change;
  change.subject = full_calibration().subject;
  const std::vector<NamedFile> maps = {{"lights.json", "{}"}, {"led01_direction.exr", "a map"}},
                               response = {{"response.json", "{}"}}, lights = {{"lights.json", "{ }"}};
  ASSERT_TRUE(derive_calibration(folder / "a", change, folder / "b", maps));
  ASSERT_TRUE(derive_calibration(folder / "b", change, folder / "c", response));
  ASSERT_TRUE(derive_calibration(folder / "c", change, folder / "d", lights));
  EXPECT_EQ(bytes_of(folder / "c/report/led01_direction.exr"), maps[1].bytes);
  EXPECT_FALSE(fs::exists(folder / "d/report/led01_direction.exr")) << "it is not of these lights";
  EXPECT_TRUE(fs::exists(folder / "d/report/response.json"));
}

TEST(DerivedCalibration, LeavesNothingWhereItFails) {
  const ScratchFolder folder;
  must_write(folder / "a", full_calibration());
  put_bytes(folder / "a/camera.json", "{}");
  Calibration change;
  change.response = Response{};
  const Result<Calibration> derived = derive_calibration(folder / "a", change, folder / "new/b", {});
  ASSERT_FALSE(derived);
  EXPECT_THAT(derived.error().message(), HasSubstr("was changed after it was measured"));
  EXPECT_FALSE(fs::exists(folder / "new"));
  const Result<Calibration> over = derive_calibration({}, change, folder / "a", {});
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().kind, ErrorKind::kCannotCreate);
}

TEST(Calibration, ReturnsDistantLightsAndOnlyThePartsThereAre) {
  const ScratchFolder folder;
  must_write(folder / "c", distant_calibration());
  const Calibration read = must_read(folder / "c");
  EXPECT_FALSE(read.camera || read.response);
  ASSERT_TRUE(read.lights && std::holds_alternative<DistantLights>(*read.lights));
  const auto& lights = std::get<DistantLights>(*read.lights).lights;
  ASSERT_EQ(lights.size(), 2U);
  EXPECT_EQ(lights[0].direction, normalized({1, 2, 3}));
  EXPECT_EQ(lights[1].irradiance_rgb, (std::array<double, 3>{1, 2, 3}));
}

TEST(Calibration, IsNeverWrittenOver) {
  const ScratchFolder folder;
  must_write(folder / "c", full_calibration());
  const std::string before = bytes_of(folder / "c/calibration.json");
  const Result<Calibration> again = write_calibration(folder / "c", distant_calibration());
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(bytes_of(folder / "c/calibration.json"), before);
}

TEST(Calibration, ThatCannotBeWrittenIsReported) {
  const ScratchFolder folder;
  put_bytes(folder / "file", "no folder");
  for (const std::string& name : {std::string("file"), std::string("file/c"), std::string(300, 'n')}) {
    int kind = -1;
    EXPECT_NO_THROW({
      const Result<Calibration> written = write_calibration(folder / name, distant_calibration());
      if (!written) kind = static_cast<int>(written.error().kind);
    });
    EXPECT_EQ(kind, static_cast<int>(ErrorKind::kCannotCreate)) << name;
  }
}

TEST(CalibrationId, IsThatOfTheContent) {
  const ScratchFolder folder;
  const std::string id = must_write(folder / "a", full_calibration());
  EXPECT_EQ(must_write(folder / "b", full_calibration()), id) << "the same content in another folder";
  std::set<std::string> ids = {id};
  const auto id_after = [&](const std::function<void(Calibration&)>& change) {
    Calibration calibration = full_calibration();
    change(calibration);
    ids.insert(must_write(folder / std::to_string(ids.size()), calibration));
  };
  id_after([](Calibration& c) { c.subject.rig = "rig B"; });
  id_after([](Calibration& c) { c.camera.reset(); });
  id_after([](Calibration& c) { std::get<NearLights>(*c.lights).log_gain_rgb[2].coefficients[23] += 1e-15; });
  EXPECT_EQ(ids.size(), 4U);
}

TEST(CalibrationId, IsTheDigestOfTheSortedListOfParts) {
  const ScratchFolder folder;
  const std::string id = must_write(folder / "c", full_calibration());
  std::string list;
  for (const char* name : {"calibration.json", "camera.json", "lights.json", "response.json"}) {
    list += std::string(name) + ' ' + sha256_of(bytes_of(folder / "c" / name)) + '\n';
  }
  EXPECT_EQ(id, sha256_of(list));
}

TEST(CalibrationId, IsWhatTheScriptOfTheDocumentationSays) {
  const ScratchFolder folder;
  put_bytes(folder / "hot.png", "not looked at");
  Calibration calibration = full_calibration();
  calibration.color = ColorTransform();  // sorts after calibration.json and before hot.png
  calibration.hot_picture = folder / "hot.png";
  const std::string id = must_write(folder / "c", calibration);
  fs::create_directory(folder / "c" / "report");
  put_bytes(folder / "c" / "report" / "lights.json", "{}");

  const std::string page = bytes_of(source_folder() / "docs" / "formats.md");
  const std::string fence = "```sh\n";
  const std::size_t begin = page.find(fence) + fence.size();
  const std::string script = page.substr(begin, page.find("```", begin) - begin);
  ASSERT_THAT(script, HasSubstr("sha256sum"));
  put_bytes(folder / "id.sh", script);
  const std::string said = (folder / "said").string();
  const std::string command =
      "cd '" + (folder / "c").string() + "' && sh '" + (folder / "id.sh").string() + "' > '" + said + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  EXPECT_EQ(bytes_of(said), id + "  -\n");
}

TEST(CalibrationId, ChangesWithAnyByteOrThePartIsRefused) {
  const ScratchFolder folder;
  Calibration calibration = full_calibration();
  std::get<NearLights>(*calibration.lights).leds.resize(1);
  const std::string id = must_write(folder / "c", calibration);
  for (const char* name : {"calibration.json", "camera.json", "lights.json", "response.json"}) {
    const std::string bytes = bytes_of(folder / "c" / name);
    for (std::size_t i = 0; i < bytes.size(); i += 61) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ 1);
      put_bytes(folder / "c" / name, changed);
      const Result<Calibration> read = read_calibration(folder / "c");
      EXPECT_TRUE(!read || read->id != id) << "byte " << i << " of " << name;
    }
    put_bytes(folder / "c" / name, bytes);
  }
  EXPECT_EQ(must_read(folder / "c").id, id);
}

TEST(Calibration, WithAChangedPartIsRefused) {
  const ScratchFolder folder;
  must_write(folder / "c", full_calibration());
  for (const char* part : {"camera.json", "lights.json", "response.json"}) {
    const std::string bytes = bytes_of(folder / "c" / part);
    put_bytes(folder / "c" / part, bytes + " ");
    const Result<Calibration> read = read_calibration(folder / "c");
    ASSERT_FALSE(read) << part;
    EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(read.error().where, (folder / "c" / part).string());
    EXPECT_THAT(read.error().what, HasSubstr("was changed after it was measured"));
    put_bytes(folder / "c" / part, bytes);
  }
}

TEST(Calibration, WithAMissingPartIsRefused) {
  const ScratchFolder folder;
  must_write(folder / "c", full_calibration());
  for (const char* part : {"camera.json", "lights.json", "response.json"}) {
    fs::rename(folder / "c" / part, folder / part);
    const Result<Calibration> read = read_calibration(folder / "c");
    ASSERT_FALSE(read) << part;
    EXPECT_EQ(read.error().kind, ErrorKind::kNoInput) << read.error().message();
    EXPECT_EQ(read.error().where, (folder / "c" / part).string());
    fs::rename(folder / part, folder / "c" / part);
  }
  EXPECT_EQ(read_calibration(folder / "missing").error().kind, ErrorKind::kNoInput);
}

TEST(Calibration, OfANewerMinorVersionIsReadAndItsNewFieldsAndPartsAreLeftAlone) {
  const ScratchFolder folder;
  const std::string id = must_write(folder / "c", full_calibration());
  for (const char* part : {"camera.json", "lights.json", "response.json"}) {
    rewrite_part(folder / "c", part, [](Json& json) {
      json["schema"] = json["schema"].get<std::string>() + ".4";
      json["new"] = {1, 2};
    });
  }
  Json document = json_of(folder / "c/calibration.json");
  document["schema"] = "weft.calibration/1.4";
  document["new"] = "field";
  document["parts"]["polariser.json"] = std::string(64, '0');
  put_bytes(folder / "c/calibration.json", document.dump());
  const Calibration read = must_read(folder / "c");
  EXPECT_NE(read.id, id);
  EXPECT_TRUE(read.camera == full_calibration().camera);
  EXPECT_TRUE(read.response == full_calibration().response);
  ASSERT_TRUE(read.lights);
  EXPECT_EQ(light_count(*read.lights), 3U);
}

TEST(Calibration, OfANewerMajorVersionIsRefusedByTheVersionItNeeds) {
  const ScratchFolder folder;
  must_write(folder / "c", full_calibration());
  rewrite_part(folder / "c", "lights.json", [](Json& json) { json["schema"] = "weft.lights/3"; });
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("use a version of weft that reads weft.lights/3."));
}

// What is wrong with a part, and what must be said of it.
struct Wrong {
  const char* part;
  std::function<void(Json&)> change;
  const char* said;
};

std::function<void(Json&)> set(const char* path, Json value) {
  return [path, value = std::move(value)](Json& json) { json[Json::json_pointer(path)] = value; };
}

const std::vector<Wrong>& all_wrong() {
  static const std::vector<Wrong> all = {
      {"camera.json", set("/width", 0), "\"width\""},
      {"camera.json", set("/height", -3), "\"height\""},
      {"camera.json", set("/fx", 0), "\"fx\""},
      {"camera.json", set("/fy", -7000), "\"fy\""},
      {"camera.json", set("/k1", nullptr), "\"k1\" is null"},
      {"camera.json", set("/camera_from_rig_rotation/2/2", -0.9),
       "\"camera_from_rig_rotation\" must be a rotation"},
      {"camera.json", set("/camera_from_rig_rotation/2/2", 1),
       "\"camera_from_rig_rotation\" must be a rotation"},
      {"camera.json", set("/camera_from_rig_rotation/0", {0, 0, -1}),
       "\"camera_from_rig_rotation\" must be a rotation"},
      {"camera.json", set("/camera_from_rig_rotation", {{1, 0, 0}, {0, -1, 0}}), "camera_from_rig_rotation"},
      {"camera.json", [](Json& j) { j.erase("camera_from_rig_rotation"); }, "camera_from_rig_rotation"},
      {"camera.json", set("/camera_from_rig_translation_mm", {1, 2}), "\"camera_from_rig_translation_mm\""},
      {"response.json", set("/electrons_per_count", 0), "\"electrons_per_count\" must be"},
      {"response.json", set("/read_noise_counts", -1),
       "\"read_noise_counts\" must be a number of at least 0"},
      {"response.json", set("/linearity", {{0, 0}, {0, 0}}), "3 lists of 2 numbers were expected"},
      {"response.json", set("/linearity/1", {0, 0, 0}), "3 lists of 2 numbers were expected"},
      {"response.json", set("/linearity/1/0", "a"), "3 lists of 2 numbers were expected"},
      {"lights.json", set("/kind", "far"), "near or distant was expected"},
      {"lights.json", set("/leds/1/aim", {0, 0, -1.01}), "led 2: \"aim\" must have unit length"},
      {"lights.json", set("/leds/1/aim", {0, 0, 0}), "led 2: \"aim\" must have unit length"},
      {"lights.json", set("/leds/2/flux_rgb", {1, 0, 1}), "led 3: \"flux_rgb\" must be above 0"},
      {"lights.json", set("/leds/0/flux_rgb", {1, 1, -1}), "led 1: \"flux_rgb\" must be above 0"},
      {"lights.json", set("/leds/0/mu", -0.1), "led 1: \"mu\" must be a number of at least 0"},
      {"lights.json", set("/leds/0/position_mm", {1, 2, "3"}), "led 1: \"position_mm\""},
      {"lights.json", set("/leds/0/log_gain_quadratic", {1, 2, 3}),
       "led 1: \"log_gain_quadratic\" is [1,2,3]; 6 numbers"},
      {"lights.json", set("/leds/0", 3), "led 1: \"position_mm\" is missing"},
      {"lights.json", set("/log_gain_rgb", Json::array()), "\"log_gain_rgb\" must be three splines"},
      {"lights.json", set("/log_gain_rgb/0/columns", 3), "log_gain_rgb 1: \"coefficients\""},
      {"lights.json", set("/log_gain_rgb/2/rows", 2147483647), "log_gain_rgb 3: \"coefficients\""},
      {"lights.json", set("/log_gain_rgb/2/coefficients/5", "a"),
       "\"coefficients\" is \"a\"; a number was expected"},
      {"lights.json", set("/log_gain_rgb/2/coefficients", {1, 2}), "log_gain_rgb 3: \"coefficients\""},
      {"lights.json", set("/leds/1/flux_rgb", {1, nullptr, 1}), "led 2: \"flux_rgb\""},
      {"response.json",
       set("/exposure_ratios", Json::parse(R"([{"exposure_us": 1, "to_exposure_us": 2, "ratio": 0}])")),
       "exposure_ratio 1: \"ratio\" must be"},
      {"response.json", set("/exposure_ratios", 3), "\"exposure_ratios\""},
      {"lights.json", set("/patches", "here"), "\"patches\""},
      {"lights.json",
       set("/patches", Json::parse(R"([{"polygon_px": [[1, 2], [3, 4]], "reflectance_rgb": [1, 1, 1]}])")),
       "patch 1: \"polygon_px\" must have three corners"},
      {"lights.json",
       set("/patches",
           Json::parse(R"([{"polygon_px": [[1, 2], [3, 4], [5]], "reflectance_rgb": [1, 1, 1]}])")),
       "patch 1: \"polygon_px\" is [[1,2],[3,4],[5]]; lists of 2"},
      {"lights.json",
       set("/patches",
           Json::parse(R"([{"polygon_px": [[1, 2], [3, 4], [5, 9]], "reflectance_rgb": [1, 0, 1]}])")),
       "patch 1: \"reflectance_rgb\" must be above 0"},
      {"lights.json", set("/covariance", Json::parse(R"({"parameters": ["led01.mu"], "matrix": [[1, 2]]})")),
       "covariance: \"matrix\" must be symmetric"},
      {"lights.json",
       set("/covariance",
           Json::parse(R"({"parameters": ["led01.mu", "led02.mu"], "matrix": [[1, 0.1], [0.2, 1]]})")),
       "covariance: \"matrix\" must be symmetric"},
      {"lights.json", set("/covariance", Json::parse(R"({"parameters": ["led01.mu"], "matrix": [[-1]]})")),
       "covariance: \"matrix\" must be symmetric"}};
  return all;
}

TEST(Calibration, WithNumbersThatNoRigHasIsRefused) {
  const ScratchFolder folder;
  const std::vector<Wrong>& all = all_wrong();
  must_write(folder / "good", full_calibration());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const fs::path here = folder / std::to_string(i);
    fs::copy(folder / "good", here, fs::copy_options::recursive);
    rewrite_part(here, all[i].part, all[i].change);
    const Result<Calibration> read = read_calibration(here);
    EXPECT_FALSE(read) << "change " << i << " of " << all[i].part << ": " << all[i].said;
    if (read) continue;
    EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(read.error().message(), HasSubstr(all[i].part));
    EXPECT_THAT(read.error().message(), HasSubstr(all[i].said));
  }
}

TEST(Calibration, WithDistantLightsThatDoNotShineIsRefused) {
  const ScratchFolder folder;
  must_write(folder / "c", distant_calibration());
  rewrite_part(folder / "c", "lights.json", [](Json& json) { json["lights"][1]["direction"] = {0, 0, 1.1}; });
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("light 2: \"direction\" must have unit length"));
  rewrite_part(folder / "c", "lights.json", [](Json& json) {
    json["lights"][1]["direction"] = {0, 0, 1};
    json["lights"][0]["irradiance_rgb"] = {1, 1, 0};
  });
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("light 1: \"irradiance_rgb\" must be above 0"));
}

TEST(Calibration, WithPartsThatAreNoDigestsIsRefused) {
  const ScratchFolder folder;
  must_write(folder / "c", full_calibration());
  Json document = json_of(folder / "c/calibration.json");
  document["parts"]["camera.json"] = 3;
  put_bytes(folder / "c/calibration.json", document.dump());
  EXPECT_THAT(why_refused(folder / "c"), HasSubstr("\"parts\" must name a SHA-256 for each part"));
}

}  // namespace
}  // namespace weft
