// SPDX-License-Identifier: Apache-2.0
// Files and folders that the user may not read or write. The tests may run as root, who may do everything, so
// weft runs as nobody.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/core/places.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr auto kReadOnly = fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                           fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec;

class NoPermission : public SessionTest {
 protected:
  void SetUp() override {
    if (run_weft({"--version"}, {.as_nobody = true}).exit_code != 0) {
      GTEST_SKIP() << "the user nobody may not run " << program_path("weft");
    }
    SessionTest::SetUp();
    fs::create_directories(work_ / "open");
    fs::permissions(work_ / "open", fs::perms::all);
  }
  void TearDown() override {
    std::error_code absent;
    for (const fs::path& path :
         {work_.path(), session_, session_ / "calibration", session_ / "truth", work_ / "closed"}) {
      fs::permissions(path, fs::perms::owner_all, absent);
    }
  }
  void make_read_only(const fs::path& folder) const { fs::permissions(folder, kReadOnly); }
  void expect_refused(const std::vector<std::string>& arguments, int exit_code,
                      const std::vector<std::string>& words) const {
    expect_refusal(work_, arguments, exit_code, words, {.folder = work_ / "open", .as_nobody = true});
  }
  std::string open(const std::string& name) const { return (work_ / "open" / name).string(); }

  const std::string scene_ = source_file("testdata/scenes/golden.toml").string();
};

TEST_F(NoPermission, SimulatingWhereNothingMayBeMade) {
  put_bytes(work_ / "scene.toml", bytes_of(scene_));
  make_read_only(work_.path());
  expect_refused({"simulate", (work_ / "scene.toml").string(), "-o", (work_ / "new.weft").string(), "-q"}, 73,
                 {"cannot create", "new.weft", "Permission denied", "choose a folder"});
}

TEST_F(NoPermission, SolvingASessionThatMayNotBeWrittenTo) {
  make_read_only(session_);
  expect_refused({"solve", session_.string(), "-q"}, 73,
                 {"cannot create", (session_ / "solve").string(), "Permission denied", "choose a folder"});
}

TEST_F(NoPermission, SolvingIntoAFolderThatMayNotBeWrittenTo) {
  fs::create_directories(work_ / "closed");
  make_read_only(work_ / "closed");
  expect_refused({"solve", session_.string(), "-o", (work_ / "closed" / "maps").string(), "-q"}, 73,
                 {"cannot create", "closed", "Permission denied", "choose a folder"});
}

TEST_F(NoPermission, SolvingPhotographsWhereNothingMayBeMade) {
  PhotographSample().write(work_ / "photos");
  make_read_only(work_.path());
  expect_refusal(work_, {"solve", "--photos", (work_ / "photos").string(), "-q"}, 73,
                 {"cannot create", "photos-solve", "Permission denied", "choose a folder"},
                 {.folder = work_.path(), .as_nobody = true});
}

TEST_F(NoPermission, ARawThatMayNotBeRead) {
  fs::permissions(session_ / "raw" / "03_led04.dng", fs::perms::none);
  expect_refused({"solve", session_.string(), "-o", open("maps"), "-q"}, 66,
                 {"cannot read", "03_led04.dng", "Permission denied", "right to read"});
}

TEST_F(NoPermission, AJournalThatMayNotBeRead) {
  fs::permissions(session_ / "session.json", fs::perms::none);
  expect_refused({"solve", session_.string(), "-o", open("maps"), "-q"}, 66,
                 {"cannot read", "session.json", "Permission denied", "right to read"});
}

TEST_F(NoPermission, ACalibrationThatMayNotBeEntered) {
  fs::permissions(session_ / "calibration", fs::perms::none);
  expect_refused({"solve", session_.string(), "-o", open("maps"), "-q"}, 66,
                 {"cannot read", "calibration.json", "Permission denied", "right to read"});
}

TEST_F(NoPermission, ASessionThatMayNotBeEntered) {
  fs::permissions(session_, fs::perms::none);
  expect_refused({"solve", session_.string(), "-o", open("maps"), "-q"}, 66,
                 {"cannot read", "session.json", "Permission denied", "right to read"});
}

TEST_F(NoPermission, AnOutputInsideAFolderThatMayNotBeEntered) {
  fs::create_directories(work_ / "closed");
  fs::permissions(work_ / "closed", fs::perms::none);
  expect_refused({"solve", session_.string(), "-o", (work_ / "closed" / "maps").string(), "-q"}, 73,
                 {"cannot create", "closed", "Permission denied", "choose a folder"});
}

TEST_F(NoPermission, ADemoInsideAFolderThatMayNotBeEntered) {
  fs::create_directories(work_ / "closed");
  fs::permissions(work_ / "closed", fs::perms::none);
  expect_refused({"demo", scene_, "-o", (work_ / "closed" / "demo").string(), "-q"}, 73,
                 {"cannot create", "closed", "Permission denied", "choose a folder"});
}

TEST_F(NoPermission, AMapThatMayNotBeRead) {
  const fs::path truth = session_ / "truth" / "normal.exr";
  fs::permissions(truth, fs::perms::none);
  expect_refused({"compare", truth.string(), truth.string()}, 66,
                 {"cannot read", "normal.exr", "Permission denied", "right to read"});
}

TEST_F(NoPermission, ATruthThatMayNotBeEnteredIsNotNeeded) {
  fs::permissions(session_ / "truth", fs::perms::none);
  const Outcome run = run_weft({"solve", session_.string(), "-o", open("maps"), "-q"},
                               {.folder = work_ / "open", .as_nobody = true});
  EXPECT_EQ(run.exit_code, 0) << run.error;
}

TEST_F(NoPermission, ASceneThatMayNotBeRead) {
  put_bytes(work_ / "scene.toml", bytes_of(scene_));
  fs::permissions(work_ / "scene.toml", fs::perms::none);
  expect_refused({"simulate", (work_ / "scene.toml").string(), "-o", open("new.weft"), "-q"}, 66,
                 {"cannot read", "scene.toml", "Permission denied", "right to read"});
}

TEST_F(NoPermission, AReadOnlySessionIsSolvedIntoAnotherFolder) {
  make_read_only(session_);
  const auto before = contents_of(session_);
  const Outcome run = run_weft({"solve", session_.string(), "-o", open("maps"), "-q"}, {.as_nobody = true});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_TRUE(fs::exists(open("maps/normal.exr")));
  EXPECT_EQ(contents_of(session_), before);
}

}  // namespace
}  // namespace weft::test
