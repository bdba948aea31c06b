// SPDX-License-Identifier: Apache-2.0
// Folders that other rigs left, as a person imports them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "tests/core/places.h"
#include "tests/system/import_bench.h"
#include "tests/system/samples.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::Not;

std::string without(std::string text, const std::string& part) {
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos;) text.erase(at, part.size());
  return text;
}

using Import = ImportBench;

TEST_F(Import, MakesASessionOfNumbersInNamesThatIsSolvedAsIfScanned) {
  put_by_number("tray 7", all_leds());
  const Json plan = imported(by_number_);
  ASSERT_EQ(plan["sessions"].size(), 1U);
  EXPECT_EQ(plan["sessions"][0]["by"], "numbers in names");
  EXPECT_THAT(plan["sessions"][0]["light"].get<std::string>(), HasSubstr("agrees"));
  expect_sure(plan);

  const Session made = session("tray-7");
  EXPECT_EQ(made.fabric, "satin");
  EXPECT_EQ(made.shots.size(), 11U);
  EXPECT_EQ(made.document["schema"], "weft.session/1.5");
  EXPECT_EQ(made.shots[3].document["source"], "tray 7/satin_03.DNG");
  expect_right(made);
  for (const fs::path& session : {archive_ / "tray-7.weft", scanned_->folder}) {
    const Outcome solved =
        run_weft({"solve", session.string(), "-q", "--no-previews", "-o", (work_ / session.stem()).string()});
    ASSERT_EQ(solved.exit_code, 0) << solved.error;
  }
  const Json difference = run_weft({"compare", (work_ / "tray-7" / "normal.exr").string(),
                                    (work_ / scanned_->folder.stem() / "normal.exr").string(), "--json"})
                              .json();
  EXPECT_LT(difference["max_deg"].get<double>(), 1e-4)
      << "only the exposure is rounded, as the files have it";
}

TEST_F(Import, CountsNamesAsPeopleDoAndFindsTheDarkFrameByItsLevel) {
  // DSC_8, DSC_9, DSC_10 ...; the dark one in their midst; pairs within one second.
  put_all("roll/DSC_{}.dng", {1, 2, 3, 4, 0, 5, 6, 7, 8, 9, 10}, 0.5);
  const Json plan = imported();
  EXPECT_EQ(plan["sessions"][0]["by"], "times and names");
  const Session made = session("roll");
  EXPECT_EQ(made.shots[4].role, ShotRole::kDark);
  EXPECT_EQ(made.shots[1].time, "2026-01-30T23:00:00.000") << "the camera's clock, which names no zone";
  expect_right(made);
}

TEST_F(Import, RefusesNamesAgainstTimesUntilOneOfThemIsChosen) {
  for (int led = 1; led <= kImportLeds; ++led)
    put(fmt::format("DSC_{:04}.dng", (led + 4) % kImportLeds), led, 3 * led);
  const Json plan = refused({}, {"times and names do not agree", "--order time"});
  const Json& opinions = plan["sessions"][0]["frames"][0]["opinions"];
  EXPECT_EQ(opinions["time"], 1);
  EXPECT_EQ(opinions["names"], 6);
  EXPECT_EQ(opinions["light"], 1) << "the light was asked too";
  const Outcome table = run_weft(words({"--dry-run"}));
  EXPECT_EQ(table.exit_code, 65) << table.error;
  EXPECT_THAT(table.output,
              AllOf(HasSubstr("DSC_0005.dng"), HasSubstr("names"), HasSubstr("2026-01-30T23:00:03")));
  EXPECT_EQ(imported({"--order", "time"})["imported"], 1);
  expect_right(session("left"));
}

TEST_F(Import, FollowsTimesWhereTheCameraBeganToCountAgainAndTheLightAgrees) {
  for (int led = 0; led <= kImportLeds; ++led)
    put(fmt::format("D{:04}.DNG", (led + 9995) % 9999 + 1), led, 2 * led);
  EXPECT_THAT(imported({})["sessions"][0]["warnings"].dump(), HasSubstr("D0001.DNG follows D9999.DNG"));
  expect_right(session("left"));
}

TEST_F(Import, NamesTwoFramesThatAreOnePhotographAndThatNoneIsDark) {
  for (int led = 0; led <= kImportLeds; ++led) put(fmt::format("{:02}.DNG", led), led == 0 ? 5 : led, led);
  refused({}, {"two frames are one photograph", "00.DNG and 05.DNG", "no frame is dark"});
  put("00.DNG", 5, 0, [](RawFrame& frame) { frame.black[0][0] += 3; });
  refused({}, {"no frame is dark", "00.DNG and 05.DNG are of one light"});
}

TEST_F(Import, RefusesAnOrderThatTheLightContradictsAndTakesTheLights) {
  const std::vector<int> shuffled = {7, 2, 9, 4, 0, 1, 10, 3, 8, 5, 6};
  for (std::size_t i = 0; i < shuffled.size(); ++i) put(fmt::format("x{}.dng", i), shuffled[i]);
  refused({}, {"the light of the frames says other LEDs than names", "--order light"});
  const Json plan = imported({"--order", "light"});
  EXPECT_EQ(plan["sessions"][0]["by"], "light");
  expect_sure(plan);
  expect_right(session("left"));
}

TEST_F(Import, RefusesASessionThatLacksALedUntilItIsToldTo) {
  put_by_number("tray", {0, 1, 2, 3, 5, 6, 7, 8, 9, 10});
  refused(by_number_, {"frames are missing", "no frame of LED 4", "--missing"});
  refused({}, {"no order tells which are missing"});
  imported({"--order", "light", "--missing"});
  const Session made = session("tray");
  EXPECT_EQ(made.lit().size(), 9U);
  expect_right(made);
}

TEST_F(Import, RefusesTwoFramesOfOneLedAndLedsCountedFromZero) {
  put_by_number("tray", all_leds());
  put("tray/satin_3.DNG", 3);
  refused(by_number_, {"two frames are of LED 3", "satin_03.DNG", "satin_3.DNG"});
  fs::remove_all(source_ / "tray");
  for (int led = 1; led <= kImportLeds; ++led) put(fmt::format("tray/satin_{}.DNG", led - 1), led);
  refused(by_number_, {"satin_0.DNG says LED 0", "{index}"});
  imported({"--pattern", "{session}/{fabric}_{index}.{ext}"});
  expect_right(session("tray"));
}

TEST_F(Import, RefusesFramesOfTwoSettings) {
  const auto expect = [&](const std::function<void(ShotMetadata&)>& change, const std::string& words) {
    put("a/3.dng", 3, 6, [&](RawFrame& frame) { change(frame.shot); });
    refused({}, {"not of one session", words, "3.dng"});
  };
  put_all("a/{}.dng", all_leds());
  fs::remove(source_ / "a/11.dng");  // of LED 3
  expect([](ShotMetadata& shot) { shot.iso = 400; }, "ISO");
  expect([](ShotMetadata& shot) { shot.exposure_us *= 1.5; }, "exposure");
  expect([](ShotMetadata& shot) { shot.serial = "other"; }, "serial");
}

TEST_F(Import, RefusesFramesOfAnotherBodyThanTheCalibrations) {
  for (const int led : all_leds())
    put(fmt::format("a/{}.dng", led), led, 2 * led,
        [](RawFrame& frame) { frame.shot.model = "another body"; });
  refused({}, {"calibration does not suit", "another body", "--calibration"});
}

TEST_F(Import, DoesNothingTheSecondTimeAndNeverTouchesTheSource) {
  put_all("roll/DSC_{}.dng", all_leds());
  const auto state = [&] {
    std::map<std::string, std::string> all = contents_of(source_);
    for (const auto& entry : fs::recursive_directory_iterator(source_)) {
      all[entry.path().string()] +=
          fmt::format(" {} {}", fs::last_write_time(entry.path()).time_since_epoch().count(),
                      static_cast<int>(entry.status().permissions()));
    }
    return all;
  };
  const auto before = state();
  for (const std::string link : {"hard", "copy", "symbolic"}) {
    SCOPED_TRACE(link);
    fs::remove_all(archive_);
    EXPECT_EQ(imported({"--link", link})["imported"], 1);
    const fs::path frame = archive_ / "roll.weft" / session("roll").shots[2].file;
    EXPECT_EQ(fs::is_symlink(frame), link == "symbolic");
    EXPECT_EQ(fs::equivalent(frame, source_ / "roll/DSC_10.dng"), link != "copy");
    EXPECT_EQ(session("roll").shots[2].sha256, *sha256_of_file(source_ / "roll/DSC_10.dng"));
    const auto there = contents_of(archive_);
    const Json again = imported({"--link", link});
    EXPECT_EQ(again["imported"], 0);
    EXPECT_EQ(again["sessions"][0]["state"], "there");
    EXPECT_EQ(contents_of(archive_), there);
  }
  const Outcome solved =
      run_weft({"solve", (archive_ / "roll.weft").string(), "-q", "--quality", "preview", "--no-previews"});
  EXPECT_EQ(solved.exit_code, 0) << "through symbolic links: " << solved.error;
  EXPECT_EQ(state(), before);
}

TEST_F(Import, RefusesANameThatAnotherSessionHas) {
  put_all("roll/DSC_{}.dng", all_leds());
  imported();
  put("roll/DSC_9.dng", 1, 2, [](RawFrame& frame) { frame.counts(3, 3) = 700; });
  const auto there = contents_of(archive_);
  const Outcome run = import();
  EXPECT_EQ(run.exit_code, 73) << run.error;
  EXPECT_THAT(run.output, HasSubstr("another session of that name is there"));
  EXPECT_EQ(contents_of(archive_), there);
}

TEST_F(Import, SplitsAFlatFolderAtGapsOfTimeAndImportsTheGoodBesideTheBad) {
  put_all("flat/A{:02}.dng", all_leds(), 3, 0);
  put_all("flat/B{:02}.dng", all_leds(), 3, 400);
  put_all("flat/C{:02}.dng", all_leds(), 3, 800);
  fs::resize_file(source_ / "flat/B12.dng", 4000);
  put_bytes(source_ / "flat/B12.JPG", "\xff\xd8\xff");
  put_bytes(source_ / "flat/notes.txt", "of the tray");
  const Outcome run = import();
  EXPECT_EQ(run.exit_code, 65) << run.error;
  const Json plan = run.json();
  ASSERT_EQ(plan["sessions"].size(), 3U);
  EXPECT_EQ(plan["imported"], 2);
  EXPECT_EQ(plan["sessions"][1]["state"], "refused");
  EXPECT_THAT(plan["sessions"][1]["error"].dump(), HasSubstr("B12.dng"));
  EXPECT_THAT(plan["left_over"].dump(), AllOf(HasSubstr("B12.JPG"), HasSubstr("notes.txt")));
  for (const char* name : {"flat_01", "flat_03"}) expect_right(session(name));
  EXPECT_FALSE(fs::exists(archive_ / "flat_02.weft"));
}

TEST_F(Import, TellsAFolderWithoutTimesThatItHoldsMoreThanOneSession) {
  for (const int led : all_leds()) {
    put(fmt::format("flat/A{:02}.dng", led), led);
    put(fmt::format("flat/B{:02}.dng", led), led);
  }
  refused({}, {"more frames than LEDs", "22 frames, 10 LEDs", "--gap"});
}

TEST_F(Import, TakesWhatIsWrittenBesideThePhotographs) {
  put_all("rolls/wool/{}.dng", all_leds());
  put_bytes(source_ / "import.toml",
            "tags = [\"autumn\"]\ncloth_height_mm = 0.5\ncomposition = \"80 % wool\"\n");
  put_bytes(source_ / "rolls/wool.json", R"({"fabric": "herringbone", "barcode": "4006381333931"})");
  imported();
  const Session made = session("wool");
  EXPECT_EQ(made.fabric, "herringbone");
  EXPECT_EQ(made.cloth_height_mm, 0.5);
  EXPECT_EQ(made.document["metadata"]["id"], "4006381333931");
  EXPECT_EQ(made.document["metadata"]["tags"], Json::array({"autumn"}));
  EXPECT_EQ(made.document["metadata"]["composition"], "80 % wool");
  fs::remove_all(archive_);
  put_bytes(source_ / "import.toml", "colour = \"red\"\n");
  refused({}, {"import.toml: colour", "no such key"});
}

TEST_F(Import, MakesSessionsOfLinearTiffAndExrFrames) {
  for (const std::string ending : {".tif", ".exr"}) {
    SCOPED_TRACE(ending);
    fs::remove_all(source_);
    fs::remove_all(archive_);
    const fs::path developed = work_ / ("developed" + ending + ".weft");
    simulate_developed(coarse_scene({132, 88}), developed, ending,
                       ending == ".tif" ? SampleType::kUint16 : SampleType::kHalf);
    fs::create_directories(source_ / "tray");
    for (const auto& entry : fs::directory_iterator(developed / "raw"))
      if (entry.path().extension() == ending)
        fs::copy(entry.path(), source_ / "tray" / entry.path().filename());
    refused({"--pattern", "{any}_led{led}.{ext}"}, {"nothing says the exposure", "import.toml"});
    const Result<Session> was = read_session(developed);
    ASSERT_TRUE(was) << was.error().message();
    put_bytes(source_ / "tray/import.toml",
              fmt::format("exposure_us = {}\niso = {}\n", was->shots[0].exposure_us, was->shots[0].iso));
    calibration_ = developed / "calibration";
    const Json plan = imported({"--pattern", "{any}_led{led}.{ext}"});
    EXPECT_THAT(plan["sessions"][0]["light"].get<std::string>(), HasSubstr("agrees"));
    const Outcome solved =
        run_weft({"solve", (archive_ / "tray.weft").string(), "-q", "--json", "--no-previews"});
    ASSERT_EQ(solved.exit_code, 0) << solved.error;
    EXPECT_EQ(solved.json()["pixels"], 132 * 88);
  }
}

TEST_F(Import, RefusesARingThatTwoAssignmentsFitAlikeAndShowsBoth) {
  PhotographSample sample;
  sample.size = {96, 64};
  sample.lights = PhotographSample::six_lights();
  for (DistantLight& light : sample.lights) light.irradiance_rgb = {1, 1, 1};
  sample.write(work_ / "photographs");
  fs::create_directories(source_ / "ring");
  for (std::size_t k = 0; k < 6; ++k)
    fs::copy(work_ / "photographs" / sample.name_of(k), source_ / "ring" / sample.name_of(k));
  put_bytes(source_ / "import.toml", "exposure_us = 1e6\niso = 100\n");
  Calibration ring;
  ring.subject = {.rig = "ring", .camera_model = "", .camera_serial = "", .f_number = 8};
  ring.camera = overhead_camera(sample.size, 500, 1);
  ring.response = Response();
  ring.lights = DistantLights{sample.lights};
  calibration_ = work_ / "ring calibration";
  const auto written = write_calibration(calibration_, ring);
  ASSERT_TRUE(written) << written.error().message();

  const Json plan = refused({"--order", "light"}, {"two assignments", "alike", "--order time or name"});
  for (const Json& frame : plan["sessions"][0]["frames"]) {
    EXPECT_TRUE(frame["opinions"]["light"].is_number_integer());
    EXPECT_TRUE(frame["opinions"]["light, second"].is_number_integer());
  }
  const Json taken = imported({"--order", "name"});
  EXPECT_THAT(taken["sessions"][0]["light"].get<std::string>(),
              testing::AnyOf(HasSubstr("explains it as well"), HasSubstr("does not object")));
}

TEST_F(Import, MakesSessionsOfPhotographsThatAreSolvedAsTheyAreAlone) {
  PhotographSample sample;
  sample.write(source_ / "buddha");
  fs::create_directories(source_ / "coin/images");
  std::string lights = "6\n";
  for (std::size_t k = 0; k < 6; ++k) {
    fs::copy(source_ / "buddha" / sample.name_of(k), source_ / "coin/images" / sample.name_of(k));
    const Vec3 l = sample.lights[k].direction;
    lights += fmt::format("images/{} {} {} {}\n", sample.name_of(k), l.x, l.y, l.z);
  }
  put_bytes(source_ / "coin/coin.lp", lights);
  put_bytes(source_ / "coin/import.toml", "fabric = \"old coin\"\ntags = [\"metal\"]\n");
  const Json plan = imported();
  EXPECT_EQ(plan["imported"], 2);
  ASSERT_EQ(plan["left_over"].size(), 2U) << plan["left_over"];
  EXPECT_THAT(plan["left_over"].dump(), AllOf(HasSubstr("albedo_gt.exr"), HasSubstr("normal_gt.exr")));
  EXPECT_EQ(session("coin").fabric, "old coin");
  EXPECT_EQ(session("coin").document["metadata"]["tags"], Json({"metal"}));
  EXPECT_EQ(imported()["imported"], 0) << "the same once more";
  for (const std::string name : {"buddha", "coin"}) {
    SCOPED_TRACE(name);
    const fs::path made = archive_ / (name + ".weft"), own = work_ / (name + " own");
    EXPECT_FALSE(session(name).is_of_rig());
    const Outcome solved = run_weft({"solve", made.string(), "-q", "--no-previews", "--json"});
    ASSERT_EQ(solved.exit_code, 0) << solved.error;
    run_weft({"solve", name == "coin" ? "--lp" : "--photos",
              (name == "coin" ? source_ / "coin/coin.lp" : source_ / name).string(), "-q", "--no-previews",
              "-o", own.string()});
    const Json difference = run_weft({"compare", solved.json()["normal"].get<std::string>(),
                                      (own / "normal.exr").string(), "--json"})
                                .json();
    EXPECT_LT(difference["max_deg"].get<double>(), 1e-4) << "directions are written to the last digit";
  }
}

TEST_F(Import, KeepsWhatAPersonSaysOfPhotographsAndSolvesThemSoAgain) {
  PhotographSample sample;
  sample.write(source_ / "buddha");
  EXPECT_EQ(run_weft(words({"--yes", "--json", "-q", "--mm-per-pixel", "0.05"})).exit_code, 0);
  const fs::path made = archive_ / "buddha.weft";
  ASSERT_TRUE(session("buddha").photographs);
  EXPECT_EQ(session("buddha").photographs->mm_per_pixel, 0.05);
  const auto solve = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"solve", made.string(), "-q", "--no-previews"});
    return run_weft(more);
  };
  const auto state_of_solve = [&] {
    return run_weft({"status", made.string(), "--json"}).json()["sessions"][0]["links"][1]["freshness"];
  };
  EXPECT_EQ(solve({}).exit_code, 0);
  EXPECT_EQ(state_of_solve(), "fresh");
  EXPECT_EQ(solve({"--flip", "x"}).exit_code, 0);
  EXPECT_EQ(session("buddha").photographs->flip, LightFlip::kX);
  EXPECT_EQ(state_of_solve(), "fresh") << "that is the current one";
  EXPECT_EQ(solve({"--unsay", "--mm-per-pixel", "0.1"}).exit_code, 0);
  EXPECT_EQ(session("buddha").photographs, (PhotoReading{.mm_per_pixel = 0.1}))
      << "the lights lie as they did";
  EXPECT_EQ(state_of_solve(), "fresh");
  EXPECT_THAT(solve({"--calibration", calibration_.string()}).error, HasSubstr("have no calibration"));
  expect_refusal(work_, {"solve", made.string(), "--dark", "x.png"}, 64, {"--dark"});
}

TEST_F(Import, MakesASessionOfAFolderThatEarlierImportsMade) {
  PhotographSample().write(source_ / "buddha.photos");
  fs::copy_file(source_folder() / "testdata/schemas/weft.photographs-1/photographs.json",
                source_ / "buddha.photos/photographs.json");
  EXPECT_EQ(imported()["imported"], 1);
  EXPECT_EQ(session("buddha.photos").shots.size(), 6U);
}

TEST_F(Import, RefusesPhotographsThatAreNotThoseThatWereImported) {
  PhotographSample sample;
  sample.write(source_ / "buddha");
  EXPECT_EQ(run_weft(words({"--yes", "--json", "-q", "--link", "copy"})).exit_code, 0);
  const fs::path made = archive_ / "buddha.weft", first = made / session("buddha").shots[0].file;
  fs::remove(first);
  fs::copy_file(source_ / "buddha" / sample.name_of(3), first);
  expect_refusal(work_, {"solve", made.string(), "-q"}, 65, {"one photograph is under two lights"});
  fs::remove(first);
  expect_refusal(work_, {"solve", made.string(), "-q"}, 66, {first.filename().string()});
}

TEST_F(Import, TakesLightFilesOfOtherHandsAndNamesWhatNoneNames) {
  const PhotographSample sample;
  sample.write(work_ / "photographs");
  std::string lines, directions, dome;
  for (std::size_t k = 0; k < 6; ++k) {
    for (const char* folder : {"rti/jpeg-exports", "dome", "uw/owl", "rti/assembly-files/again"}) {
      fs::create_directories(source_ / folder);
      fs::copy(work_ / "photographs" / sample.name_of(k), source_ / folder / sample.name_of(k));
    }
    const Vec3 l = sample.lights[k].direction;
    lines += fmt::format("..\\jpeg-exports\\{} {} {} {}\n", sample.name_of(k), l.x, l.y, l.z);
    directions += fmt::format("{} {} {}\n", l.x, l.y, l.z);
    dome += fmt::format(R"({}{{"x": {}, "y": {}, "z": {}}})", k == 0 ? "" : ",", l.x, l.y, l.z);
  }
  put_bytes(source_ / "rti/assembly-files/coin.lp", "6\n" + lines);
  put_bytes(source_ / "rti/assembly-files/again/below.lp", "6\n" + without(lines, "..\\jpeg-exports\\"));
  put_bytes(source_ / "dome/led.dome", R"({"directions": [)" + dome + "]}");
  fs::copy(work_ / "photographs/normal_gt.exr", source_ / "dome/other.exr");
  put_bytes(source_ / "uw/lights.txt", "6\n" + directions);
  const Json plan = imported();
  EXPECT_EQ(plan["imported"], 4) << plan["photographs"];
  for (const char* name : {"rti", "again", "dome", "owl"})
    EXPECT_TRUE(fs::exists(archive_ / (std::string(name) + ".weft") / "photographs/lights.lp")) << name;
  ASSERT_EQ(plan["left_over"].size(), 1U) << plan["left_over"];
  EXPECT_THAT(plan["left_over"].dump(), AllOf(HasSubstr("other.exr"), HasSubstr("no light file names it")));
  EXPECT_THAT(plan["photographs"].dump(), HasSubstr("in the order of their names, 01.exr to 06.exr"));
}

TEST_F(Import, RefusesAPhotographThatIsCut) {
  PhotographSample sample;
  sample.write(source_ / "buddha");
  const fs::path cut = source_ / "buddha" / sample.name_of(3);
  fs::resize_file(cut, fs::file_size(cut) / 2);
  const Outcome run = import();
  EXPECT_EQ(run.exit_code, 65) << run.error;
  EXPECT_THAT(run.json()["photographs"][0]["error"].dump(), HasSubstr(sample.name_of(3)));
  EXPECT_FALSE(fs::exists(archive_ / "buddha.weft"));
}

TEST_F(Import, AsksBeforeItImports) {
  put_all("roll/DSC_{}.dng", all_leds());
  type("");
  const Outcome unasked = run_weft(words({}));
  EXPECT_EQ(unasked.exit_code, 64) << unasked.error;
  EXPECT_THAT(unasked.error, AllOf(HasSubstr("nothing was imported"), HasSubstr("--yes")));
  EXPECT_THAT(unasked.output, HasSubstr("DSC_8.dng"));
  type("n\n");
  EXPECT_EQ(run_weft(words({})).exit_code, 64);
  EXPECT_EQ(run_weft(words({"--dry-run"})).exit_code, 0);
  EXPECT_FALSE(fs::exists(archive_));
  type("y\n");
  const Outcome asked = run_weft(words({}));
  EXPECT_EQ(asked.exit_code, 0) << asked.error;
  EXPECT_THAT(asked.error, HasSubstr("import into " + archive_.string()));
  expect_right(session("roll"));
}

TEST_F(Import, TakesCalibrationArchiveAndHeightOfARig) {
  put_all("roll/DSC_{}.dng", all_leds());
  const std::string name = session_of_scan().rig;
  put_bytes(work_ / "rig.toml",
            fmt::format("name = \"{}\"\n[scan]\ncalibration = \"{}\"\nsessions = \"archive\"\n"
                        "cloth_height_mm = 0.25\n",
                        name, calibration_.string()));
  const Outcome run =
      run_weft({"import", source_.string(), "--rig", (work_ / "rig.toml").string(), "--yes", "--json", "-q"});
  EXPECT_EQ(run.exit_code, 0) << run.error << run.output;
  EXPECT_EQ(session("roll").rig, name);
  EXPECT_EQ(session("roll").cloth_height_mm, 0.25);
  expect_right(session("roll"));
}

TEST_F(Import, NamesWhatItCannotBegin) {
  fs::create_directories(source_);
  expect_refusal(work_, words({"--yes"}), 66, {"there are no photographs", source_.string()});
  put_bytes(source_ / "a.txt", "x");
  expect_refusal(work_, words({"--yes"}), 66, {"no file in it is a raw"});
  expect_refusal(work_, words({"--yes", "--pattern", "{who}_{led}"}), 64, {"no word {who}"});
  expect_refusal(work_, {"import", (work_ / "none").string(), "-o", archive_.string(), "--yes"}, 66,
                 {"cannot list"});
}

}  // namespace
}  // namespace weft::test
