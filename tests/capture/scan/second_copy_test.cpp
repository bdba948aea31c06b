// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/second_copy.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/sendfile.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "tests/capture/scan/files_under.h"

// A disk that garbles what it takes: the C++ library copies files by this call.
static bool disk_garbles = false;
extern "C" ssize_t sendfile(int out, int in, off_t* offset, size_t count) noexcept {
  static const auto real = reinterpret_cast<decltype(&sendfile)>(dlsym(RTLD_NEXT, "sendfile"));
  const ssize_t taken = real(out, in, offset, count);
  if (disk_garbles && taken > 0) {
    EXPECT_EQ(pwrite(out, "?", 1, 0), 1);
  }
  return taken;
}

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using test::files_under;
using testing::HasSubstr;

/// A finished session of two frames, in a fresh folder of the running test.
Session finished_session() {
  const fs::path folder = fs::path(testing::TempDir()) / "weft_second_copy" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  Session session;
  session.folder = folder / "cloth.weft";
  session.rig = "rig 1";
  session.document = Json::object();
  fs::create_directories(session.folder / "raw" / ".dropped");
  fs::create_directories(session.folder / "calibration" / "report");
  std::ofstream(session.folder / "calibration" / "report" / "lights.html") << "<html>";
  std::ofstream(session.folder / "raw" / ".dropped" / "00_led01.dng") << "of a crash";
  for (int i = 0; i < 2; ++i) {
    Shot shot;
    shot.index = i;
    shot.led = i + 1;
    shot.file = "raw/0" + std::to_string(i) + "_led0" + std::to_string(i + 1) + ".dng";
    shot.exposure_us = 20000;
    const std::string bytes = "photograph " + std::to_string(i);
    std::ofstream(session.path_of(shot)) << bytes;
    shot.sha256 = sha256_of(bytes);
    session.shots.push_back(shot);
  }
  EXPECT_TRUE(write_session(session));
  return session;
}

fs::path other_disk(const Session& session) {
  return session.folder.parent_path() / "other disk";
}

Json copy_in(const Session& session) {
  return read_session(session.folder)->document.value("copy", Json());
}

TEST(SecondCopy, OnADiskThatGarblesWhatItTakesIsNone) {
  const Session session = finished_session();
  disk_garbles = true;
  const Result<void> copied = copy_session(session, other_disk(session));
  disk_garbles = false;
  ASSERT_FALSE(copied);
  EXPECT_THAT(copied.error().message(), HasSubstr("copy differs from its session"));
  EXPECT_THAT(copied.error().where, HasSubstr("other disk"));
  EXPECT_FALSE(fs::exists(place_of_copy(session, other_disk(session))));
}

TEST(SecondCopy, HoldsTheSessionUnderTheNameOfItsRig) {
  Session session = finished_session();
  const Result<void> copied = copy_session(session, other_disk(session));
  ASSERT_TRUE(copied) << copied.error().message();
  EXPECT_EQ(files_under(other_disk(session)),
            (std::set<std::string>{"rig-1/cloth.weft/calibration/report/lights.html",
                                   "rig-1/cloth.weft/raw/00_led01.dng", "rig-1/cloth.weft/raw/01_led02.dng",
                                   "rig-1/cloth.weft/session.json"}));
  EXPECT_TRUE(copy_session(session, other_disk(session))) << "it is there already";
  session.shots[1].sha256 = session.shots[0].sha256;
  const Result<void> again = copy_session(session, other_disk(session));
  ASSERT_FALSE(again) << "a copy is never overwritten, nor is a frame copied that is not what was received";
}

TEST(SecondCopy, StaysBelowItsFolderWhateverTheRigIsCalled) {
  Session session = finished_session();
  for (const char* rig : {"..", "", ".", "a/../../b"}) {
    session.rig = rig;
    const fs::path place = place_of_copy(session, "/copies");
    EXPECT_EQ(place.lexically_normal(), place) << rig;
    EXPECT_EQ(place.parent_path().parent_path(), "/copies") << rig;
  }
}

TEST(SecondCopy, OfTwoRigsWithSessionsOfOneNameStandSideBySide) {
  Session session = finished_session();
  ASSERT_TRUE(copy_session(session, other_disk(session)));
  session.rig = "rig 2";
  session.shots.pop_back();
  const Result<void> copied = copy_session(session, other_disk(session));
  EXPECT_TRUE(copied) << copied.error().message();
}

TEST(SecondCopy, IsReadBackEachTimeItIsAskedFor) {
  const Session session = finished_session();
  ASSERT_TRUE(copy_session(session, other_disk(session)));
  std::ofstream(place_of_copy(session, other_disk(session)) / "raw" / "01_led02.dng") << "decayed";
  const Result<void> again = copy_session(session, other_disk(session));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kInputOutput);
  EXPECT_THAT(again.error().message(), HasSubstr("01_led02.dng"));
}

TEST(SecondCopy, IsNotMadeOfAFrameThatChangedSinceItWasReceived) {
  const Session session = finished_session();
  std::ofstream(session.path_of(session.shots[0])) << "decayed";
  const Result<void> copied = copy_session(session, other_disk(session));
  ASSERT_FALSE(copied);
  EXPECT_EQ(copied.error().kind, ErrorKind::kInputOutput);
  EXPECT_FALSE(is_there(place_of_copy(session, other_disk(session))));
}

TEST(SecondCopy, IsMadeLaterWhereItsDiskWasAway) {
  Session session = finished_session();
  std::ofstream(other_disk(session)) << "no folder";
  const Result<void> failed = copy_session(session, other_disk(session));
  ASSERT_FALSE(failed);
  session.document["copy"] = record_of_copy(other_disk(session), failed);
  ASSERT_TRUE(write_session(session));
  EXPECT_FALSE(copy_later(session.folder, {}));
  EXPECT_EQ(copy_in(session).value("state", ""), "missing");
  EXPECT_THAT(copy_in(session).value("why", ""), HasSubstr("Not a directory"));

  fs::remove(other_disk(session));
  const Result<fs::path> made = copy_later(session.folder, {});
  ASSERT_TRUE(made) << made.error().message();
  EXPECT_EQ(*made, place_of_copy(session, other_disk(session)));
  EXPECT_EQ(copy_in(session), (Json{{"to", other_disk(session).string()}, {"state", "verified"}}));
  EXPECT_FALSE(read_session(*made)->document.contains("copy")) << "a copy has none of its own";
}

TEST(SecondCopy, IsMadeOfFinishedSessionsAndWhereAPersonSays) {
  Session session = finished_session();
  EXPECT_EQ(copy_later(session.folder, {}).error().kind, ErrorKind::kUsage) << "nobody said where to";
  EXPECT_TRUE(copy_later(session.folder, other_disk(session)));
  session.state = "capturing";
  ASSERT_TRUE(write_session(session));
  EXPECT_EQ(copy_later(session.folder, other_disk(session)).error().kind, ErrorKind::kTryAgain);
}

TEST(SecondCopy, IsWarnedOfOnTheDiskOfTheSessions) {
  const Session session = finished_session();
  const auto warning = warning_of_one_disk(session.folder, other_disk(session));
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, HasSubstr("is on the disk of the sessions"));
  EXPECT_FALSE(warning_of_one_disk(session.folder, "/proc/nowhere")) << "/proc is no disk of anybody's";
}

}  // namespace
}  // namespace weft::capture
