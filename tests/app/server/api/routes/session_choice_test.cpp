// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/session_choice.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "core/rig/session.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;

/// A rig without a calibration and its folder of sessions.
class SessionChoices : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    rig_.name = "north";
    rig_.scan.sessions = folder_;
    rig_.scan.session_name = "new";
  }

  /// A session of LEDs 1 and 2 without a repeat, with one frame at 20 ms.
  void leave(const std::string& name, minutes age, const std::string& fabric = "satin",
             const std::string& state = "capturing", const std::string& calibration = "") const {
    Session session;
    session.folder = folder_ / (name + ".weft");
    session.fabric = fabric;
    session.cloth_height_mm = 1.5;
    session.rig = "north";
    session.calibration_id = calibration;
    session.state = state;
    Shot dark;
    dark.role = ShotRole::kDark;
    dark.file = "raw/00_led00.dng";
    dark.exposure_us = 20000;
    dark.f_number = 8;
    session.shots = {dark};
    session.document = {{"schema", "weft.session/1.1"},
                        {"metadata", {{"id", "7"}}},
                        {"plan", {{"leds", {1, 2}}, {"repeat", false}}},
                        {"exposure", {{"exposure_us", 20000}, {"iso", 100}, {"f_number", 8}}}};
    ASSERT_TRUE(make_writable_folder(session.folder / "raw"));
    ASSERT_TRUE(write_session(session));
    fs::last_write_time(session.folder / "session.json", fs::file_time_type::clock::now() - age);
  }
  // With a library that looks at what was left for the first time.
  Result<SessionChoice> choose(const std::string& body) const {
    const TemporaryFolder state;
    const auto library = LibraryService::open(state.path(), folder_);
    if (!library) return library.error();
    return choose_session(Json::parse(body), rig_, **library, std::chrono::system_clock::now());
  }
  std::string name_for(const std::string& body) const {
    const Result<SessionChoice> choice = choose(body);
    return choice ? choice->name : choice.error().message();
  }

  const TemporaryFolder scratch_;
  const fs::path folder_ = scratch_.path() / "scans";
  capture::Rig rig_;
};

TEST_F(SessionChoices, GoOnWithTheNewestUnfinishedOneOfTheCloth) {
  leave("older", minutes(50));
  leave("newer", minutes(40));
  leave("newest_but_velvet", minutes(1), "velvet");
  leave("newest_but_done", minutes(1), "satin", "complete");
  const Result<SessionChoice> choice = choose(R"({"fabric": "satin"})");
  ASSERT_TRUE(choice) << choice.error().message();
  EXPECT_EQ(choice->name, "newer");
  EXPECT_TRUE(choice->resumed);
  EXPECT_EQ(choice->frames, 1);
  EXPECT_EQ(choice->frames_planned, 3);
  EXPECT_EQ(choice->request.session, folder_ / "newer.weft");
  EXPECT_EQ(choice->request.cloth_height_mm, 1.5) << "what the body does not say is as it was";
  EXPECT_EQ(choice->unfinished, "");
}

TEST_F(SessionChoices, NameAnOldOneAndBeginAnother) {
  leave("yesterday", minutes(24 * 60));
  const Result<SessionChoice> choice = choose(R"({"fabric": "satin"})");
  ASSERT_TRUE(choice) << choice.error().message();
  EXPECT_EQ(choice->name, "new");
  EXPECT_FALSE(choice->resumed);
  EXPECT_EQ(choice->unfinished, "yesterday");
  EXPECT_EQ(to_json(*choice), (Json{{"session", "new"}, {"resumed", false}, {"unfinished", "yesterday"}}));
}

TEST_F(SessionChoices, GoOnOnlyWithWhatIsAskedFor) {
  leave("left", minutes(1));
  for (const char* same :
       {R"("cloth_height_mm": 1.5)", R"("leds": [1, 2])", R"("repeat": false)", R"("metadata": {"id": "7"})",
        R"("exposure_us": 20000)", R"("exposure_us": 21000)", R"("iso": 100, "f_number": 8)"}) {
    EXPECT_EQ(name_for(std::string(R"({"fabric": "satin", )") + same + "}"), "left") << same;
  }
  for (const char* other :
       {R"("cloth_height_mm": 2)", R"("leds": [1])", R"("repeat": true)", R"("bracket": 4)",
        R"("metadata": {"id": "8"})", R"("exposure_us": 25000)", R"("iso": 200)"}) {
    EXPECT_EQ(name_for(std::string(R"({"fabric": "satin", )") + other + "}"), "new") << other;
  }
}

TEST_F(SessionChoices, DoNotGoOnUnderAnotherCalibration) {
  leave("left", minutes(1), "satin", "capturing", std::string(64, 'a'));
  const Result<SessionChoice> choice = choose(R"({"fabric": "satin"})");
  ASSERT_TRUE(choice) << choice.error().message();
  EXPECT_EQ(choice->name, "new");
  EXPECT_EQ(choice->unfinished, "") << "its name would not finish it";
}

TEST_F(SessionChoices, TakeTheNameThatIsSaid) {
  leave("left", minutes(24 * 60));
  leave("done", minutes(1), "satin", "complete");
  EXPECT_EQ(name_for(R"({"session": "left"})"), "left");
  EXPECT_EQ(name_for(R"({"session": "other", "fabric": "satin"})"), "other");
  EXPECT_EQ(choose(R"({"session": "done"})").error().kind, ErrorKind::kCannotCreate);
  EXPECT_EQ(choose(R"({"session": "other"})").error().where, "fabric");
  EXPECT_EQ(choose("{}").error().where, "fabric");
}

}  // namespace
}  // namespace weft::app
