// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_response.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "bench/oracles/virtual_sensor.h"
#include "calibration/response/neutral_scale.h"
#include "calibration/response/superposition.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "simulator/camera/dng_writer.h"
#include "tests/system/workspace.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::contents_of;
using test::VirtualSensor;
using test::Workspace;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Size kSize = {192, 128};
constexpr std::array<int, 6> kExposures_us = {1000, 4000, 16000, 40000, 80000, 160000};

// Frames of two LEDs over stripes of grey; 100 ms fill green by both LEDs.
struct Frames {
  VirtualSensor sensor = VirtualSensor::of(simulator::Body::kOffset);
  std::function<void(RawFrame&)> change = [](RawFrame&) {};
  int take = 0;

  void add(const fs::path& folder, const std::string& name, double first, double second, int exposure_us,
           int frames = 2) {
    fs::create_directories(folder / name);
    for (int i = 0; i < frames; ++i) {
      RawFrame frame = sensor.frame(kSize, ++take, exposure_us, [&](int x, int y, int c) {
        const double albedo = (y / 32) % 2 != 0 ? 0.9 : 0.35;
        const double shade = 0.8 + 0.2 * x / kSize.width;
        const double channel = c == 1 ? 1.0 : c == 0 ? 0.55 : 0.7;
        return exposure_us / 1e5 * 0.55 * channel * albedo * (first * shade + second * (1.8 - shade));
      });
      for (const auto [x, y] : {std::array{40, 50}, std::array{101, 77}}) {
        frame.counts(x, y) = static_cast<std::uint16_t>(std::min(frame.counts(x, y) + 3000, 15520));
      }
      change(frame);
      const auto written =
          simulator::write_dng(folder / name / fmt::format("{:06}_{}.dng", exposure_us, i), frame);
      ASSERT_TRUE(written) << written.error().message();
    }
  }

  void add_all(const fs::path& folder) {
    add(folder, "dark", 0, 0, kExposures_us[3], 3);
    for (const int exposure_us : kExposures_us) {
      add(folder, "led01", 1, 0, exposure_us);
      add(folder, "led02", 0, 1, exposure_us);
      add(folder, "led01+led02", 1, 1, exposure_us);
    }
  }
};

Result<calibration::CalibrateOutcome> calibrate(const Workspace& work, const fs::path& from = {}) {
  calibration::CalibrateResponseOptions options;
  options.input = work / "response";
  options.from = from;
  options.output = work / "new";
  options.rig = "rig A";
  return calibration::calibrate_response(options, {});
}

std::string refusal(const Workspace& work, const fs::path& from = {}) {
  const auto before = contents_of(work.path());
  const auto outcome = calibrate(work, from);
  EXPECT_EQ(contents_of(work.path()), before) << "nothing is written";
  return outcome ? "accepted" : outcome.error().message();
}

TEST(CalibrateResponse, MeasuresASensorFromItsFrames) {
  const Workspace work;
  Frames frames;
  frames.sensor.linearity = {0.017, 0.0085};
  frames.add_all(work / "response");
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  const auto read = read_calibration(work / "new");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->id, outcome->calibration.id);
  EXPECT_EQ(read->subject.rig, "rig A");
  EXPECT_EQ(read->subject.camera_serial, "virtual");

  const Response truth = response_of(frames.sensor.sensor);
  const Response& response = *read->response;
  EXPECT_NEAR(response.electrons_per_count, truth.electrons_per_count, 0.03 * truth.electrons_per_count);
  EXPECT_NEAR(response.read_noise_counts, truth.read_noise_counts, 0.05 * truth.read_noise_counts);
  EXPECT_FALSE(response.black_counts) << "the file's is right";
  EXPECT_EQ(response.iso, 100);
  EXPECT_NEAR(outcome->report.numbers["black_counts"].get<double>(), 600, 0.1);
  for (const auto& [a, b] : response.linearity) {
    EXPECT_LT(calibration::departure_from_line({a - 0.017, b - 0.0085}), 0.001);
  }
  EXPECT_NEAR(*response.exposure_ratio(80000, 16000), 5, 0.005);
  EXPECT_EQ(outcome->report.numbers["hot"], 2);
  EXPECT_THAT(outcome->warnings, IsEmpty());
  EXPECT_NEAR(outcome->report.numbers["white_balance"][0]["light_rgb"][0].get<double>() /
                  outcome->report.numbers["white_balance"][0]["light_rgb"][1].get<double>(),
              0.55, 0.002);

  const auto hot = read_image(work / "new" / "hot.png");
  ASSERT_TRUE(hot) << hot.error().message();
  EXPECT_EQ(hot->planes(40, 50), 1.0F);
  EXPECT_EQ(hot->planes(41, 50), 0.0F);
  const std::string page = bytes_of(work / "new" / "report" / "response.html");
  EXPECT_THAT(page, HasSubstr("Photon transfer"));
  EXPECT_THAT(page, HasSubstr("\\u003csvg"));
}

TEST(CalibrateResponse, KeepsPhotositesThatAreHotOnlyInLongExposures) {
  const Workspace work;
  Frames frames;
  frames.add_all(work / "response");
  frames.add(work / "response", "dark", 0, 0, kExposures_us[0], 3);
  frames.change = [](RawFrame& frame) { frame.counts(60, 20) = 4000; };
  frames.add(work / "response", "dark", 0, 0, kExposures_us[5], 3);
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->report.numbers["hot"], 3);
  const auto hot = read_image(work / "new" / "hot.png");
  ASSERT_TRUE(hot) << hot.error().message();
  EXPECT_EQ(hot->planes(60, 20), 1.0F);
}

TEST(CalibrateResponse, FindsTheBlackLevelOfABodyThatClipsIt) {
  const Workspace work;
  Frames frames;
  frames.sensor = VirtualSensor::of(simulator::Body::kD5100);
  // The body has subtracted 9 counts too many before it clipped at 0.
  frames.change = [](RawFrame& frame) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        frame.counts(x, y) = static_cast<std::uint16_t>(std::max(frame.counts(x, y) - 9, 0));
      }
    }
  };
  frames.add_all(work / "response");
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_TRUE(outcome->calibration.response->black_counts);
  EXPECT_NEAR(*outcome->calibration.response->black_counts, -9, 1)
      << "a hundredth of a percent is 1.6 counts";
  EXPECT_EQ(outcome->report.numbers["black_from"], "sums of light");
  const Response truth = response_of(frames.sensor.sensor);
  EXPECT_NEAR(outcome->calibration.response->read_noise_counts, truth.read_noise_counts,
              0.1 * truth.read_noise_counts);
}

TEST(CalibrateResponse, KeepsTheOtherPartsOfTheCalibrationBefore) {
  const Workspace work;
  Calibration before;
  before.subject = {"rig B", "virtual camera", "virtual", 8, AlbedoScale::kAbsolute};
  before.camera = overhead_camera(kSize, 600, 0.1);
  ASSERT_TRUE(write_calibration(work / "old", before));
  const auto old = contents_of(work / "old");
  Frames().add_all(work / "response");
  const auto outcome = calibrate(work, work / "old");
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->calibration.camera, before.camera);
  EXPECT_EQ(outcome->calibration.subject.rig, "rig B");
  EXPECT_EQ(contents_of(work / "old"), old);
  EXPECT_EQ(bytes_of(work / "new" / "camera.json"), bytes_of(work / "old" / "camera.json"));
}

TEST(CalibrateResponse, ChecksThePatchesOfAGreyScale) {
  const Workspace work;
  Frames frames;
  frames.add_all(work / "response");
  const auto scale = calibration::munsell_scale();
  fs::create_directories(work / "response" / "scale");
  const RawFrame frame = frames.sensor.frame(kSize, 900, 40000, [&](int x, int y, int) {
    const int patch = (x - 6) / 20;
    const bool inside = x >= 6 && patch < 9 && (x - 6) % 20 < 18 && y >= 50 && y < 68;
    return inside ? 0.8 * scale[static_cast<std::size_t>(patch)].reflectance : 0.7;
  });
  ASSERT_TRUE(simulator::write_dng(work / "response" / "scale" / "scale.dng", frame));
  const auto without = calibrate(work);
  ASSERT_TRUE(without);
  ASSERT_THAT(without->warnings, SizeIs(1));
  EXPECT_THAT(without->warnings[0], HasSubstr("corners_px"));
  fs::remove_all(work / "new");
  ASSERT_TRUE(write_file(work / "response" / "scale" / "scale.toml",
                         "corners_px = [[6, 50], [184, 50], [184, 68], [6, 68]]\n"));
  const auto with = calibrate(work);
  ASSERT_TRUE(with) << with.error().message();
  EXPECT_LT(with->report.numbers["scale"]["rms_percent"].get<double>(), 1);
  EXPECT_NEAR(with->report.numbers["scale"]["v_of_white"][1].get<double>(), 0.8, 0.01);
  // The white patch of another photograph is full.
  fs::remove_all(work / "new");
  const RawFrame brighter = frames.sensor.frame(kSize, 901, 40000, [&](int x, int y, int) {
    const int patch = (x - 6) / 20;
    const bool inside = x >= 6 && patch < 9 && (x - 6) % 20 < 18 && y >= 50 && y < 68;
    return inside ? 1.2 * scale[static_cast<std::size_t>(patch)].reflectance : 0.7;
  });
  ASSERT_TRUE(simulator::write_dng(work / "response" / "scale" / "brighter.dng", brighter));
  const auto both = calibrate(work);
  ASSERT_TRUE(both) << both.error().message();
  EXPECT_LT(both->report.numbers["scale"]["rms_percent"].get<double>(), 1);
  EXPECT_NEAR(both->report.numbers["scale"]["v_of_white"][1].get<double>(), 1, 0.01);
  fs::remove_all(work / "new");
  ASSERT_TRUE(write_file(work / "response" / "scale" / "scale.toml", "reflectance = [1, 2]\n"));
  fs::remove_all(work / "response" / "dark");
  fs::remove_all(work / "response" / "led01");
  EXPECT_THAT(refusal(work), HasSubstr("reflectance: there is no such key"))
      << "before any frame is looked at";
}

TEST(CalibrateResponse, CountsFramesThatAreFull) {
  const Workspace work;
  Frames frames;
  frames.add_all(work / "response");
  frames.add(work / "response", "led01", 1, 0, 9000000);
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->report.numbers["full_frames"], SizeIs(2));
  EXPECT_THAT(outcome->report.verdicts.back().text, HasSubstr("2 frames were full"));
}

TEST(CalibrateResponse, RefusesFramesOfAnotherBodyIsoApertureOrFocalLength) {
  struct Case {
    std::function<void(RawFrame&)> change;
    const char* word;
  };
  const std::array<Case, 5> cases = {
      {{[](RawFrame& f) { f.shot.serial = "6012345"; }, "serial number is 6012345"},
       {[](RawFrame& f) { f.shot.iso = 400; }, "ISO is 400"},
       {[](RawFrame& f) { f.shot.f_number = 5.6; }, "aperture is f/5.6"},
       {[](RawFrame& f) { f.shot.focal_mm = 1.1 * f.shot.focal_mm; }, "focal length 38.5 mm, not 35"},
       {[](RawFrame& f) { f.shot.model = "other"; }, "camera is"}}};
  for (const Case& c : cases) {
    const Workspace work;
    Frames frames;
    frames.add(work / "response", "led01", 1, 0, 1000);
    frames.change = c.change;
    frames.add(work / "response", "led01", 1, 0, 4000, 1);
    const std::string message = refusal(work);
    EXPECT_THAT(message, HasSubstr(c.word));
    EXPECT_THAT(message, HasSubstr("004000_0.dng"));
  }
  const Workspace work;
  Frames().add(work / "response", "led01", 1, 0, 1000);
  Calibration before;
  before.subject = {"rig B", "virtual camera", "another", 8, AlbedoScale::kAbsolute};
  before.response = Response();
  ASSERT_TRUE(write_calibration(work / "old", before));
  EXPECT_THAT(refusal(work, work / "old"), HasSubstr("serial number another, the frame of virtual"));
  before.subject.camera_serial.clear();
  before.camera = overhead_camera({kSize.width + 16, kSize.height}, 600, 0.1);
  ASSERT_TRUE(write_calibration(work / "larger", before));
  EXPECT_THAT(refusal(work, work / "larger"),
              HasSubstr("192 x 128 pixels, the calibration's camera 208 x 128"));
}

TEST(CalibrateResponse, LooksAtItsOutputBeforeItsFrames) {
  const Workspace work;
  fs::create_directories(work / "new");
  const auto outcome = calibrate(work);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::kCannotCreate);
}

TEST(CalibrateResponse, TakesAnOutputWithASlashAtItsEnd) {
  const Workspace work;
  Frames().add_all(work / "response");
  calibration::CalibrateResponseOptions options;
  options.input = work / "response/";
  options.output = work / "new/";
  const auto outcome = calibration::calibrate_response(options, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_TRUE(is_there(work / "new" / "hot.png"));
}

TEST(CalibrateResponse, RefusesALedThatDidNotLight) {
  const Workspace work;
  Frames frames;
  for (const int exposure_us : kExposures_us) {
    frames.add(work / "response", "led01", 1, 0, exposure_us);
    frames.add(work / "response", "led02", 0, 0.001, exposure_us);
  }
  const std::string message = refusal(work);
  EXPECT_THAT(message, HasSubstr("a LED did not light"));
  EXPECT_THAT(message, HasSubstr("led02"));
}

TEST(CalibrateResponse, RefusesAPairOfWhichOneDidNotLight) {
  const Workspace work;
  Frames frames;
  for (const int exposure_us : kExposures_us) {
    frames.add(work / "response", "led01", 1, 0, exposure_us);
    frames.add(work / "response", "led02", 0, 1, exposure_us);
    frames.add(work / "response", "led01+led02", 1, 0, exposure_us);
  }
  const std::string message = refusal(work);
  EXPECT_THAT(message, HasSubstr("light does not add up"));
  EXPECT_THAT(message, HasSubstr("led01+led02"));
}

TEST(CalibrateResponse, RefusesTooFewLevels) {
  const Workspace work;
  Frames frames;
  frames.add(work / "response", "led01", 1, 0, 40000);
  frames.add(work / "response", "led01", 1, 0, 80000);
  frames.add(work / "response", "led01", 1, 0, 16000, 1);
  EXPECT_THAT(refusal(work), HasSubstr("2 exposures of a LED have two frames or more"));
}

TEST(CalibrateResponse, SaysWhatItDidWithoutPairsOfLedsAndDarkFrames) {
  const Workspace work;
  Frames frames;
  for (const int exposure_us : kExposures_us) frames.add(work / "response", "led01", 1, 0, exposure_us);
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_EQ(outcome->report.numbers["black_from"], "exposure times");
  EXPECT_EQ(outcome->report.verdicts.at(0).name, "LINEARITY_UNKNOWN");
  EXPECT_FALSE(outcome->calibration.hot_picture);
}

TEST(CalibrateResponse, RefusesAFolderWithoutFramesAndPicturesThatWereDeveloped) {
  const Workspace work;
  EXPECT_THAT(refusal(work), HasSubstr("no such folder"));
  fs::create_directories(work / "response" / "led01");
  EXPECT_THAT(refusal(work), HasSubstr("no frames of a lit scene"));
  test::put_bytes(work / "response" / "led01" / "a.jpg", "jpeg");
  EXPECT_THAT(refusal(work), HasSubstr("developed picture"));
  fs::remove(work / "response" / "led01" / "a.jpg");
  test::put_bytes(work / "response" / "led01" / "a.dng", "II*");
  EXPECT_THAT(refusal(work), HasSubstr("a.dng"));
}

TEST(CalibrateResponse, NamesFoldersThatMeanNothing) {
  const Workspace work;
  Frames frames;
  for (const int exposure_us : kExposures_us) frames.add(work / "response", "led01", 1, 0, exposure_us);
  fs::create_directories(work / "response" / "led1x");
  fs::create_directories(work / "response" / "led02+led02");
  fs::create_directories(work / "response" / "led02");
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->warnings, SizeIs(3));
}

TEST(CalibrateResponse, MeasuresTheVeilOfALensInABlackTrap) {
  const Workspace work;
  Frames frames;
  frames.add_all(work / "response");
  fs::create_directories(work / "response" / "trap");
  for (int i = 0; i < 2; ++i) {
    const RawFrame frame = frames.sensor.frame(kSize, ++frames.take, kExposures_us[2], [](int x, int y, int) {
      const bool in_trap = std::abs(x - 96) < 20 && std::abs(y - 64) < 20;
      return in_trap ? 0.6 * 0.008
                     : 0.6 * 1.008;  // of even light a lens that spreads far adds the same everywhere
    });
    ASSERT_TRUE(simulator::write_dng(work / "response" / "trap" / fmt::format("{}.dng", i), frame));
  }
  const auto outcome = calibrate(work);
  ASSERT_TRUE(outcome) << outcome.error().message();
  // A twelfth of the sheet is the trap, which sends nothing.
  const Veil veil = *outcome->calibration.response->veil;
  EXPECT_NEAR(veil.share, 0.0085, 0.0003);
  EXPECT_LT(veil.sigma_share, 0.0003);
  EXPECT_THAT(outcome->report.summary, HasSubstr("a veil of 0.8"));
  EXPECT_EQ(read_calibration(work / "new")->response->veil, veil);

  fs::create_directories(work / "set");
  fs::rename(work / "response" / "trap", work / "set" / "trap");
  calibration::CalibrateResponseOptions beside = {work / "response", {}, work / "beside", {}};
  beside.trap = work / "set";
  const auto from_set = calibration::calibrate_response(beside, {});
  ASSERT_TRUE(from_set) << from_set.error().message();
  EXPECT_EQ(from_set->calibration.response->veil, veil) << "the same photographs in a set of their own";
  beside.trap = work / "response";
  beside.output = work / "nowhere";
  const auto none = calibration::calibrate_response(beside, {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("no photograph of a trap"));

  calibration::CalibrateResponseOptions again = {work / "response", work / "new", work / "again", {}};
  const auto kept = calibration::calibrate_response(again, {});
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_EQ(kept->calibration.response->veil, veil) << "what was not photographed again stays";
}

TEST(CalibrateResponse, MeasuresWhereACameraStopsBelowWhatItsFilesCallFullAndWhatDarkIs) {
  const Workspace work;
  Frames frames;
  frames.change = [](RawFrame& frame) {
    for (int y = 0; y < frame.counts.height(); ++y) {
      for (int x = 0; x < frame.counts.width(); ++x)
        frame.counts(x, y) = std::min<std::uint16_t>(frame.counts(x, y), 12'000);
    }
  };
  frames.add_all(work / "response");
  const auto measured = calibration::calibrate_response({work / "response", {}, work / "new", {}}, {});
  ASSERT_TRUE(measured) << measured.error().message();
  const CountLevels& levels = measured->calibration.response->levels.value();
  EXPECT_EQ(levels.full_rgb, (std::vector<double>{12'000, 12'000, 12'000}));
  for (const double dark : levels.dark_rgb) EXPECT_NEAR(dark, 600, 1);
  EXPECT_EQ(levels.white, 15520);
}

TEST(CalibrateResponse, SaysNothingOfFullWhereNothingStops) {
  const Workspace work;
  Frames frames;
  frames.add(work / "response", "dark", 0, 0, kExposures_us[3], 3);
  for (const int exposure_us : kExposures_us) frames.add(work / "response", "led01", 0.5, 0, exposure_us);
  const auto measured = calibration::calibrate_response({work / "response", {}, work / "new", {}}, {});
  ASSERT_TRUE(measured) << measured.error().message();
  EXPECT_TRUE(measured->calibration.response->levels.value().full_rgb.empty());
}

TEST(CalibrateResponse, RefusesATrapThatIsNotThere) {
  const Workspace work;
  Frames frames;
  frames.add_all(work / "response");
  frames.add(work / "response", "trap", 1, 0, kExposures_us[3]);
  EXPECT_THAT(refusal(work), HasSubstr("no black trap was found"));
}

}  // namespace
}  // namespace weft::app
