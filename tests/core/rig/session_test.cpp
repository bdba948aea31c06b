// SPDX-License-Identifier: Apache-2.0
#include "core/rig/session.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

using testing::HasSubstr;

Shot shot_of(int index, int led, ShotRole role, const std::string& file) {
  Shot shot;
  shot.index = index;
  shot.led = led;
  shot.role = role;
  shot.file = file;
  shot.sha256 = std::string(64, 'a');
  shot.exposure_us = 20000.0 / 3;
  shot.iso = 200;
  shot.f_number = 5.6;
  return shot;
}

// LEDs lit in the order 2, 1, a dark shot, a repeat and a bracket of its own exposure.
Session small_session(const std::filesystem::path& folder) {
  Session session;
  session.folder = folder;
  session.fabric = "len, \xc5\xbc\xc3\xb3\xc5\x82ty";
  session.cloth_height_mm = 1.0 / 3;
  session.rig = "rig A";
  session.calibration_id = std::string(64, 'c');
  session.state = "capturing";
  session.shots = {shot_of(0, 2, ShotRole::kLit, "raw/00_led02.nef"),
                   shot_of(1, 1, ShotRole::kLit, "raw/01_led01.nef"),
                   shot_of(2, 0, ShotRole::kDark, "raw/02_led00.nef"),
                   shot_of(3, 2, ShotRole::kRepeat, "raw/03_led02.nef"),
                   shot_of(4, 2, ShotRole::kBracket, "raw/04_led02.nef")};
  session.shots[1].time = "2026-01-31T12:00:00Z";
  session.shots[4].exposure_us = 100;
  session.shots[4].polariser = Polariser::kParallel;
  return session;
}

Json json_in(const ScratchFolder& folder) {
  return Json::parse(bytes_of(folder / "session.json"));
}

Json small_document() {
  const ScratchFolder folder;
  EXPECT_TRUE(write_session(small_session(folder / "")));
  return json_in(folder);
}

// What reading a small session says after a change of its document.
std::string verdict(const std::function<void(Json&)>& change) {
  static const Json small = small_document();
  const ScratchFolder folder;
  Json json = small;
  change(json);
  put_bytes(folder / "session.json", json.dump());
  const Result<Session> session = read_session(folder / "");
  if (!session) {
    EXPECT_EQ(session.error().kind, ErrorKind::kBadData);
    return session.error().message();
  }
  return "read";
}

TEST(Session, ReturnsEveryFieldThatWasWritten) {
  const ScratchFolder folder;
  const Session written = small_session(folder / "");
  ASSERT_TRUE(write_session(written));
  const Result<Session> read = read_session(folder / "");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->folder, folder / "");
  EXPECT_EQ(read->fabric, written.fabric);
  EXPECT_EQ(read->cloth_height_mm, written.cloth_height_mm);
  EXPECT_EQ(read->rig, written.rig);
  EXPECT_EQ(read->calibration_id, written.calibration_id);
  EXPECT_EQ(read->state, "capturing");
  ASSERT_EQ(read->shots.size(), written.shots.size());
  for (std::size_t i = 0; i < written.shots.size(); ++i) {
    const Shot &now = read->shots[i], &before = written.shots[i];
    EXPECT_EQ(now.index, before.index) << "shot " << i;
    EXPECT_EQ(now.led, before.led) << "shot " << i;
    EXPECT_EQ(now.role, before.role) << "shot " << i;
    EXPECT_EQ(now.file, before.file) << "shot " << i;
    EXPECT_EQ(now.sha256, before.sha256) << "shot " << i;
    EXPECT_EQ(now.exposure_us, before.exposure_us) << "shot " << i;
    EXPECT_EQ(now.iso, before.iso) << "shot " << i;
    EXPECT_EQ(now.f_number, before.f_number) << "shot " << i;
    EXPECT_EQ(now.time, before.time) << "shot " << i;
    EXPECT_EQ(now.polariser, before.polariser) << "shot " << i;
  }
}

TEST(Session, ListsItsLitShotsByLedAndItsDarkShot) {
  const Session session = small_session("a.weft");
  const std::vector<const Shot*> lit = session.lit();
  ASSERT_EQ(lit.size(), 2U);
  EXPECT_EQ(lit[0]->file, "raw/01_led01.nef");
  EXPECT_EQ(lit[1]->file, "raw/00_led02.nef");
  ASSERT_NE(session.dark(), nullptr);
  EXPECT_EQ(session.dark()->file, "raw/02_led00.nef");
  EXPECT_EQ(session.path_of(*session.dark()), "a.weft/raw/02_led00.nef");
  EXPECT_EQ(session.calibration_folder(), "a.weft/calibration");
  EXPECT_EQ(Session().dark(), nullptr);
}

TEST(Session, ListsNoShotThatAnotherStandsFor) {
  const ScratchFolder folder;
  Session written = small_session(folder / "");
  written.shots.push_back(shot_of(5, 2, ShotRole::kLit, "raw/05_led02.nef"));
  written.shots.push_back(shot_of(6, 0, ShotRole::kDark, "raw/06_dark.nef"));
  written.shots[0].superseded_by = 5;
  written.shots[2].superseded_by = 6;
  ASSERT_TRUE(write_session(written));
  const Result<Session> session = read_session(folder / "");
  ASSERT_TRUE(session) << session.error().message();
  ASSERT_EQ(session->lit().size(), 2U);
  EXPECT_EQ(session->lit()[1]->file, "raw/05_led02.nef");
  EXPECT_EQ(session->dark()->file, "raw/06_dark.nef");
}

TEST(Session, TakesALedOncePerStateOfThePolariser) {
  const ScratchFolder folder;
  Session written = small_session(folder / "");
  for (int led = 1; led <= 2; ++led) {
    Shot shot = shot_of(4 + led, led, ShotRole::kLit, "raw/crossed.nef");
    shot.polariser = Polariser::kCrossed;
    written.shots.push_back(shot);
  }
  ASSERT_TRUE(write_session(written));
  const Result<Session> session = read_session(folder / "");
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->lit(), session->lit(Polariser::kNone)) << "as the first lit shot has it";
  EXPECT_EQ(session->lit(Polariser::kCrossed).size(), 2U);
}

TEST(Session, IsOfTheVersionThatHasBladesWhereItHasOne) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_session(small_session(folder / "")));
  EXPECT_EQ(json_in(folder)["schema"], "weft.session/1");
  Result<Session> session = read_session(folder / "");
  ASSERT_TRUE(session) << session.error().message();
  session->shots.push_back(shot_of(5, 2, ShotRole::kBlade, "raw/05_led02_blade.nef"));
  ASSERT_TRUE(write_session(*session));
  EXPECT_EQ(json_in(folder)["schema"], "weft.session/1.8");
  const Result<Session> again = read_session(folder / "");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(again->shots.back().role, ShotRole::kBlade);
  EXPECT_EQ(again->lit().size(), 2U);
}

TEST(Session, KeepsFieldsItDoesNotKnowWhenItIsRewritten) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_session(small_session(folder / "")));
  Json json = json_in(folder);
  json["schema"] = "weft.session/1.9";
  json["tags"] = {"linen", "summer"};
  json["shots"][1]["temperature_c"] = 31;
  put_bytes(folder / "session.json", json.dump());

  Result<Session> session = read_session(folder / "");
  ASSERT_TRUE(session) << session.error().message();
  session->state = "complete";
  session->shots[1].sha256 = std::string(64, 'b');
  session->shots.push_back(shot_of(5, 3, ShotRole::kLit, "raw/05_led03.nef"));
  ASSERT_TRUE(write_session(*session));

  json["state"] = "complete";
  json["shots"][1]["sha256"] = std::string(64, 'b');
  const Json now = json_in(folder);
  ASSERT_EQ(now["shots"].size(), 6U);
  EXPECT_EQ(now["shots"][5]["led"], 3);
  json["shots"].push_back(now["shots"][5]);
  EXPECT_EQ(now.dump(1), json.dump(1));
}

TEST(Session, ReadsANewerMinorVersionAndRefusesANewerMajorOne) {
  EXPECT_EQ(verdict([](Json& json) { json["schema"] = "weft.session/1.9"; }), "read");
  EXPECT_THAT(verdict([](Json& json) { json["schema"] = "weft.session/2"; }),
              HasSubstr("use a version of weft that reads weft.session/2."));
}

TEST(Session, RefusesTwoLitShotsOfOneLed) {
  EXPECT_THAT(verdict([](Json& json) { json["shots"][1]["led"] = 2; }),
              HasSubstr("LED 2 has two lit shots. keep one of them as lit"));
}

TEST(Session, RefusesAShotThatNoLaterOneOfItsKindStandsFor) {
  for (const int other : {0, 1, 2, 3, 7}) {
    EXPECT_THAT(verdict([&](Json& json) { json["shots"][1]["superseded_by"] = other; }),
                HasSubstr(fmt::format("shot 1 is superseded by {}, which is no later shot", other)));
  }
}

TEST(Session, RefusesTwoDarkShots) {
  EXPECT_THAT(verdict([](Json& json) { json["shots"].push_back(json["shots"][2]); }),
              HasSubstr("there are two dark shots"));
}

TEST(Session, RefusesLitAndDarkShotsOfMixedExposure) {
  for (const std::size_t shot : {0U, 1U, 2U}) {
    for (const char* setting : {"exposure_us", "iso", "f_number"}) {
      const std::string said = verdict([&](Json& json) { json["shots"][shot][setting] = 7.5; });
      EXPECT_THAT(said, HasSubstr("session cannot be used")) << setting << " of shot " << shot;
      EXPECT_THAT(said, HasSubstr("7.5")) << setting << " of shot " << shot;
      EXPECT_THAT(said, HasSubstr("raw/00_led02.nef was taken at")) << setting << " of shot " << shot;
    }
  }
  EXPECT_EQ(verdict([](Json& json) { json["shots"][3]["iso"] = 800; }), "read") << "a repeat of its own ISO";
}

TEST(Session, RefusesAFileOutsideItsFolder) {
  for (const char* file : {"", "../other.nef", "raw/../../other.nef", "/etc/passwd", "raw/..", ".."}) {
    EXPECT_THAT(verdict([&](Json& json) { json["shots"][1]["file"] = file; }),
                HasSubstr("shot 1: \"file\" must be a path inside the session"))
        << file;
  }
  EXPECT_EQ(verdict([](Json& json) { json["shots"][1]["file"] = "raw/..led..nef"; }), "read");
}

TEST(Session, NamesTheShotAndTheFieldThatIsWrong) {
  const auto said_of = [](const char* key, Json value) {
    return verdict([&](Json& json) { json["shots"][2][key] = value; });
  };
  EXPECT_THAT(said_of("role", "bright"),
              HasSubstr("shot 2: \"role\" is \"bright\"; lit, dark, repeat, bracket, below or blade"));
  EXPECT_THAT(said_of("role", "lit"), HasSubstr("shot 2: \"led\" must be above 0 for a lit shot"));
  EXPECT_THAT(said_of("polariser", "left"),
              HasSubstr("shot 2: \"polariser\" is \"left\"; none, parallel or crossed"));
  EXPECT_THAT(said_of("led", -1), HasSubstr("shot 2: \"led\" must be a whole number of at least 0"));
  EXPECT_THAT(said_of("led", 1.5), HasSubstr("shot 2: \"led\" is 1.5; a whole number"));
  EXPECT_THAT(said_of("exposure_us", 0), HasSubstr("has no exposure"));
  EXPECT_THAT(said_of("iso", -100), HasSubstr("shot 2: \"iso\" must be a number of at least 0"));
  EXPECT_THAT(said_of("f_number", nullptr), HasSubstr("shot 2: \"f_number\" is null"));
  EXPECT_THAT(said_of("sha256", 3), HasSubstr("shot 2: \"sha256\" is 3; a text"));
  EXPECT_THAT(verdict([](Json& json) { json["shots"][2] = "dark"; }),
              HasSubstr("shot 2: \"index\" is missing"));
  EXPECT_THAT(verdict([](Json& json) { json["shots"] = 3; }), HasSubstr("\"shots\" is 3; a list"));
  EXPECT_THAT(verdict([](Json& json) { json.erase("cloth_height_mm"); }),
              HasSubstr("\"cloth_height_mm\" is missing"));
}

TEST(Session, ThatIsNotThereIsNoInput) {
  const ScratchFolder folder;
  const Result<Session> session = read_session(folder / "missing.weft");
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(session.error().where, (folder / "missing.weft").string());
}

}  // namespace
}  // namespace weft
