// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "tests/capture/scan/files_under.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using test::files_under;
using testing::HasSubstr;

const ShotList kList = {{1, 2}, true, {}};
constexpr ExposureSettings kExposure = {20000, 100, 8};

fs::path fresh_folder() {
  const fs::path folder = fs::path(testing::TempDir()) / "weft_journal" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

ScanRequest request_in(const fs::path& folder) {
  ScanRequest request;
  request.session = folder / "cloth.weft";
  request.fabric = "cloth";
  request.rig = "rig 1";
  request.metadata = {{"barcode", "4711"}};
  request.accepted_moved = {{"why", "only colours count"}, {"degrees", 0.8}};
  request.calibration = folder / "calibration";
  if (!is_there(request.calibration)) {
    fs::create_directories(request.calibration / "report");
    std::ofstream(request.calibration / "lights.json") << "{}";
    std::ofstream(request.calibration / "report" / "lights.html") << "<html>";
  }
  return request;
}

Result<Journal> opened(
    const ScanRequest& request, AfterStep after_step = [](const char*) {}) {
  return Journal::open(request, "0123", kList, std::move(after_step));
}

std::string text_of(int index) {
  return "photograph " + std::to_string(index);
}

Photograph landed(const Journal& journal, const DueShot& shot) {
  Photograph photograph;
  photograph.file = journal.incoming(file_stem(shot) + ".dng");
  std::ofstream(photograph.file) << text_of(shot.index);
  photograph.sha256 = sha256_of(text_of(shot.index));
  photograph.ending = "dng";
  photograph.image_number = 70 + static_cast<std::uint32_t>(shot.index);
  photograph.taken_s = 1795000000.25;
  return photograph;
}

/// Opens the journal, keeps what is missing and finishes.
Result<void> scanned(
    const ScanRequest& request, const AfterStep& after_step = [](const char*) {}) {
  Result<Journal> journal = opened(request, after_step);
  if (!journal) return journal.error();
  if (Result<void> ok = journal->set_exposure({{"exposure_us", 20000}}, 0); !ok) return ok;
  for (const DueShot& shot : missing_shots(plan_shots(kList, kExposure, {}), journal->session())) {
    Result<Shot> kept = journal->keep(shot, landed(*journal, shot), Json::object());
    if (!kept) return kept.error();
  }
  return journal->finish({});
}

std::string bytes_of(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  return text ? *text : "not there";
}

TEST(Journal, StoresOneExposureTimeForASetting) {
  const ScanRequest request = request_in(fresh_folder());
  Result<Journal> journal = opened(request);
  ASSERT_TRUE(journal) << journal.error().message();
  for (const DueShot& shot : plan_shots(kList, kExposure, {})) {
    Photograph photograph = landed(*journal, shot);
    photograph.exposure.exposure_us = shot.index == 0 ? 20080 : 19990;  // as a body that measures each anew
    ASSERT_TRUE(journal->keep(shot, photograph, Json::object()));
  }
  for (const Shot& shot : journal->session().shots)
    EXPECT_EQ(shot.exposure_us, 20080) << shot.file << ": what the first photograph says";
}

TEST(Journal, MakesASessionThatEveryReaderTakes) {
  const ScanRequest request = request_in(fresh_folder());
  ASSERT_TRUE(scanned(request));
  const Result<Session> session = read_session(request.session);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->state, "complete");
  EXPECT_EQ(session->fabric, "cloth");
  EXPECT_EQ(session->rig, "rig 1");
  EXPECT_EQ(session->document["metadata"]["barcode"], "4711");
  EXPECT_EQ(session->document["accepted_moved"]["why"], "only colours count");
  ASSERT_EQ(session->shots.size(), 5u);
  EXPECT_EQ(session->shots[1].file, "raw/01_led01.dng");
  EXPECT_EQ(session->shots[1].time, "2026-11-18T11:06:40.250Z");
  EXPECT_EQ(session->shots[1].document["image_number"], 71);
  EXPECT_EQ(bytes_of(session->path_of(session->shots[3])), text_of(3));
  struct stat info = {};
  ASSERT_EQ(stat(session->path_of(session->shots[0]).c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0222, 0u) << "a landed frame is read-only";
  EXPECT_EQ(files_under(request.session),
            (std::set<std::string>{"calibration/lights.json", "calibration/report/lights.html",
                                   "raw/00_led00.dng", "raw/01_led01.dng", "raw/02_led02.dng",
                                   "raw/03_led01.dng", "raw/04_led00.dng", "session.json"}));
}

TEST(Journal, SurvivesAKillAfterAnyStepWithEveryFrameWhole) {
  const fs::path folder = fresh_folder();
  request_in(folder);  // its calibration
  // Count the steps of an undisturbed scan.
  int steps = 0;
  ScanRequest reference = request_in(folder);
  reference.session = folder / "reference.weft";
  ASSERT_TRUE(scanned(reference, [&](const char*) { ++steps; }));
  ASSERT_GT(steps, 20);
  const std::set<std::string> files = files_under(reference.session);

  for (int end = 1; end <= steps; ++end) {
    ScanRequest request = request_in(folder);
    request.session = folder / ("killed" + std::to_string(end) + ".weft");
    std::string last;
    const pid_t child = fork();
    if (child == 0) {
      int step = 0;
      (void)scanned(request, [&](const char*) {
        if (++step == end) kill(getpid(), SIGKILL);
      });
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "step " << end;

    // Whatever is named is whole.
    if (is_there(request.session)) {
      const Result<Session> left = read_session(request.session);
      ASSERT_TRUE(left) << "after step " << end << ": " << left.error().message();
      for (const Shot& shot : left->shots) {
        EXPECT_EQ(bytes_of(left->path_of(shot)), text_of(shot.index)) << "after step " << end;
      }
      if (left->state == "complete") {
        EXPECT_EQ(files_under(request.session), files);
        continue;
      }
    }
    const Result<void> resumed = scanned(request);
    ASSERT_TRUE(resumed) << "after step " << end << ": " << resumed.error().message();
    EXPECT_EQ(files_under(request.session), files) << "after step " << end;
    EXPECT_EQ(bytes_of(request.session / "session.json"), bytes_of(reference.session / "session.json"))
        << "after step " << end;
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    EXPECT_FALSE(entry.path().string().ends_with(".partial")) << entry.path() << " is left over";
  }
}

/// A session with all frames that is not finished.
ScanRequest unfinished(const fs::path& folder) {
  const ScanRequest request = request_in(folder);
  Result<Journal> journal = opened(request);
  EXPECT_TRUE(journal) << journal.error().message();
  for (const DueShot& shot : plan_shots(kList, kExposure, {})) {
    const Result<Shot> kept = journal->keep(shot, landed(*journal, shot), Json::object());
    EXPECT_TRUE(kept) << kept.error().message();
  }
  return request;
}

TEST(Journal, TakesFramesAgainThatAreMissingOrChanged) {
  const ScanRequest request = unfinished(fresh_folder());
  fs::remove(request.session / "raw" / "01_led01.dng");
  fs::permissions(request.session / "raw" / "02_led02.dng", fs::perms::owner_all);
  std::ofstream(request.session / "raw" / "02_led02.dng") << "something else";
  const Result<Journal> journal = opened(request);
  ASSERT_TRUE(journal) << journal.error().message();
  std::vector<int> missing;
  for (const DueShot& shot : missing_shots(plan_shots(kList, kExposure, {}), journal->session())) {
    missing.push_back(shot.index);
  }
  EXPECT_EQ(missing, (std::vector<int>{1, 2}));
  EXPECT_FALSE(is_there(request.session / "raw" / "02_led02.dng"));
}

TEST(Journal, ForgetsNoFrameWhileItsFoldersDiskIsAway) {
  const ScanRequest request = unfinished(fresh_folder());
  const fs::path raw = request.session / "raw", disk = request.session.parent_path() / "disk";
  const std::string before = bytes_of(request.session / "session.json");
  fs::rename(raw, disk);
  fs::create_symlink("/nowhere/raw", raw);
  const Result<Journal> away = opened(request);
  ASSERT_FALSE(away);
  EXPECT_EQ(away.error().kind, ErrorKind::kInputOutput) << away.error().message();
  EXPECT_THAT(away.error().remedy, HasSubstr("bring back the disk"));
  EXPECT_EQ(bytes_of(request.session / "session.json"), before);

  fs::remove(raw);
  fs::rename(disk, raw);
  const Result<Journal> back = opened(request);
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_EQ(back->session().shots.size(), 5u);
}

TEST(Journal, LosesNoFrameThatComesBackWithItsDiskAfterItWasForgotten) {
  const ScanRequest request = unfinished(fresh_folder());
  const fs::path raw = request.session / "raw", disk = request.session.parent_path() / "disk";
  fs::rename(raw, disk);
  fs::create_directory(raw);  // a mount point that nothing is mounted on
  ASSERT_TRUE(opened(request));
  ASSERT_TRUE(read_session(request.session)->shots.empty());
  fs::remove(raw);
  fs::rename(disk, raw);
  ASSERT_TRUE(opened(request));
  EXPECT_EQ(bytes_of(raw / ".dropped" / "01_led01.dng"), text_of(1));
  EXPECT_EQ(files_under(raw).size(), 5u);
}

TEST(Journal, KeepsEveryTakeAsideUntilTheSessionIsFinished) {
  const ScanRequest request = unfinished(fresh_folder());
  const fs::path raw = request.session / "raw";
  {
    Result<Journal> journal = opened(request);
    ASSERT_TRUE(journal) << journal.error().message();
    const DueShot shot = plan_shots(kList, kExposure, {})[1];
    ASSERT_TRUE(journal->discard({1}));
    ASSERT_TRUE(journal->keep(shot, landed(*journal, shot), Json::object()));
    ASSERT_TRUE(journal->discard({1}));
  }
  EXPECT_EQ(files_under(raw / ".dropped"), (std::set<std::string>{"01_led01.dng", "01_led01.dng.2"}));
  ASSERT_TRUE(scanned(request));
  EXPECT_FALSE(is_there(raw / ".dropped"));
}

TEST(Journal, MovesAsideWhatNoSessionNames) {
  const ScanRequest request = unfinished(fresh_folder());
  std::ofstream(request.session / "raw" / "04_led02.dng") << "of a crash";
  fs::create_directories(request.session / "incoming");
  std::ofstream(request.session / "incoming" / "x.dng.partial") << "half";
  const Result<Journal> journal = opened(request);
  ASSERT_TRUE(journal) << journal.error().message();
  EXPECT_FALSE(is_there(request.session / "raw" / "04_led02.dng"));
  EXPECT_EQ(bytes_of(request.session / "raw" / ".dropped" / "04_led02.dng"), "of a crash");
  EXPECT_FALSE(is_there(request.session / "incoming" / "x.dng.partial"));
  EXPECT_EQ(journal->session().shots.size(), 5u);
}

TEST(Journal, RefusesAFinishedSession) {
  const ScanRequest request = request_in(fresh_folder());
  ASSERT_TRUE(scanned(request));
  const Result<int> again = Journal::check(request, "0123", kList);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate);
  EXPECT_THAT(again.error().message(), HasSubstr("scan under another name"));
  EXPECT_EQ(opened(request).error().kind, ErrorKind::kCannotCreate);
}

TEST(Journal, RefusesToGoOnWithAnotherRigCalibrationClothOrPlan) {
  const ScanRequest request = unfinished(fresh_folder());
  const auto refusal = [](const Result<Journal>& journal) {
    EXPECT_FALSE(journal) << "was opened";
    if (journal) return std::string();
    EXPECT_EQ(journal.error().kind, ErrorKind::kCannotCreate);
    return journal.error().why;
  };
  ScanRequest other = request;
  other.rig = "rig 2";
  EXPECT_THAT(refusal(opened(other)), HasSubstr("rig 2"));
  other = request;
  other.fabric = "another";
  EXPECT_THAT(refusal(opened(other)), HasSubstr("another"));
  other = request;
  other.cloth_height_mm = 2;
  EXPECT_THAT(refusal(opened(other)), HasSubstr("2 mm"));
  EXPECT_THAT(refusal(Journal::open(request, "4567", kList)), HasSubstr("4567"));
  EXPECT_THAT(refusal(Journal::open(request, "0123", {{1, 2, 3}, true, {}})), HasSubstr("LEDs"));
  EXPECT_TRUE(opened(request)) << "as it was begun";
}

TEST(Journal, RefusesShotsThatItsPlanHasNot) {
  for (const auto& [key, value] : {std::pair("index", 99), {"index", -1}, {"led", 2}}) {
    const ScanRequest request = unfinished(fresh_folder());
    Json document = Json::parse(bytes_of(request.session / "session.json"));
    document["shots"][1][key] = value;
    ASSERT_TRUE(write_file(request.session / "session.json", document.dump()));
    const Result<Journal> journal = opened(request);
    ASSERT_FALSE(journal) << key << " " << value;
    EXPECT_EQ(journal.error().kind, ErrorKind::kBadData) << journal.error().message();
  }
}

TEST(Journal, ForgetsNoFrameThatItOnlyCannotRead) {
  const ScanRequest request = unfinished(fresh_folder());
  const fs::path frame = request.session / "raw" / "01_led01.dng";
  fs::remove(frame);
  fs::create_directory(frame);  // opens, and every read of it fails, for root too
  const Result<Journal> journal = opened(request);
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().kind, ErrorKind::kInputOutput) << journal.error().message();
  EXPECT_TRUE(is_there(frame));
  EXPECT_EQ(read_session(request.session)->shots.size(), 5u);
}

TEST(Journal, IsWrittenByOneScanAtATime) {
  const ScanRequest request = request_in(fresh_folder());
  {
    const Result<Journal> first = opened(request);
    ASSERT_TRUE(first) << first.error().message();
    const Result<Journal> second = opened(request);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::kTryAgain);
  }
  EXPECT_TRUE(opened(request)) << "once the first has ended";
}

TEST(Journal, DoesNotKeepAPhotographThatChangedOnItsWay) {
  const ScanRequest request = request_in(fresh_folder());
  Result<Journal> journal = opened(request);
  ASSERT_TRUE(journal) << journal.error().message();
  const DueShot shot = plan_shots(kList, kExposure, {}).front();
  Photograph photograph = landed(*journal, shot);
  std::ofstream(photograph.file) << "other bytes";
  const Result<Shot> kept = journal->keep(shot, photograph, Json::object());
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().kind, ErrorKind::kTryAgain);
  EXPECT_TRUE(journal->session().shots.empty());
  EXPECT_TRUE(fs::is_empty(request.session / "raw"));
}

TEST(Journal, LeavesNothingWhereTheSessionCannotBeMade) {
  const fs::path folder = fresh_folder();
  ScanRequest request = request_in(folder);
  std::ofstream(folder / "file") << "no folder";
  request.session = folder / "file" / "cloth.weft";
  const Result<Journal> journal = opened(request);
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().kind, ErrorKind::kCannotCreate) << journal.error().message();
}

TEST(Journal, TakesFramesOutAgain) {
  const ScanRequest request = unfinished(fresh_folder());
  Result<Journal> journal = opened(request);
  ASSERT_TRUE(journal) << journal.error().message();
  ASSERT_TRUE(journal->discard({1, 3}));
  EXPECT_EQ(journal->session().shots.size(), 3u);
  EXPECT_FALSE(is_there(request.session / "raw" / "01_led01.dng"));
  EXPECT_EQ(read_session(request.session)->shots.size(), 3u);
}

}  // namespace
}  // namespace weft::capture
