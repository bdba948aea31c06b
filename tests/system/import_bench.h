// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/rig/session.h"
#include "simulator/camera/dng_writer.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {

inline constexpr int kImportLeds = 10;
inline constexpr double kMidnight = 3600.0 * 23;

// A coarse weave, large enough for its light to fall off over the frame as on a real table.
inline simulator::Scene coarse_scene(Size size = {264, 176}) {
  simulator::Scene scene = scene_named("golden", size);
  scene.camera.mm_per_pixel = 211.0 / size.width;
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 12;
  return scene;
}

/// One simulated session, whose frames the tests write under other names and times.
struct ScannedCloth {
  ScannedCloth() {
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("weft_import_{}.weft", getpid());
    std::filesystem::remove_all(folder);
    simulate(coarse_scene(), folder);
    const Result<Session> session = read_session(folder);
    EXPECT_TRUE(session) << session.error().message();
    for (const Shot& shot : session->shots) {
      Result<RawFrame> frame = capture::decode_raw(session->path_of(shot));
      EXPECT_TRUE(frame) << frame.error().message();
      if (shot.role != ShotRole::kRepeat) frames.emplace(shot.led, std::move(*frame));
    }
  }
  ~ScannedCloth() { std::filesystem::remove_all(folder); }

  std::filesystem::path folder;
  std::map<int, RawFrame> frames;  // by LED; 0 the dark one
};

/// A folder that another rig left, and weft import of it.
class ImportBench : public testing::Test {
 protected:
  static void SetUpTestSuite() { scanned_ = new ScannedCloth; }
  static void TearDownTestSuite() {
    delete scanned_;
    scanned_ = nullptr;
  }

  /// Writes the frame of a LED; without `second` the file names no time.
  void put(const std::string& name, int led, std::optional<double> second = {},
           const std::function<void(RawFrame&)>& change = {}) const {
    RawFrame frame = copy_of(scanned_->frames.at(led));
    if (change) change(frame);
    simulator::DngTags tags;
    if (second) {
      const int whole = static_cast<int>(kMidnight + *second);
      tags.date_time_original = fmt::format("2026:01:{:02} {:02}:{:02}:{:02}", 30 + whole / 86400,
                                            whole / 3600 % 24, whole / 60 % 60, whole % 60);
    }
    std::filesystem::create_directories((source_ / name).parent_path());
    const Result<void> written = simulator::write_dng(source_ / name, frame, tags);
    ASSERT_TRUE(written) << written.error().message();
  }
  /// Frames of all LEDs in this order of names, `step` seconds apart; 0 is the dark one.
  void put_all(const std::string& names, const std::vector<int>& leds, double step = 2,
               double from = 0) const {
    for (std::size_t i = 0; i < leds.size(); ++i)
      put(fmt::format(fmt::runtime(names), i + 8), leds[i], from + step * static_cast<double>(i));
  }
  void put_by_number(const std::string& folder, const std::vector<int>& leds) const {
    for (const int led : leds) put(fmt::format("{}/satin_{:02}.DNG", folder, led), led);
  }
  static std::vector<int> all_leds(bool with_dark = true) {
    std::vector<int> leds;
    for (int led = with_dark ? 0 : 1; led <= kImportLeds; ++led) leds.push_back(led);
    return leds;
  }

  std::vector<std::string> words(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {
        "import", source_.string(), "--calibration", calibration_.string(), "-o", archive_.string(), "-q"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Outcome import(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--yes", "--json"});
    return run_weft(words(more));
  }
  Json imported(const std::vector<std::string>& more = {}) const {
    const Outcome run = import(more);
    EXPECT_EQ(run.exit_code, 0) << run.error << run.output;
    return run.json();
  }
  static void expect_sure(const Json& plan) {
    for (const Json& f : plan["sessions"][0]["frames"]) EXPECT_TRUE(f["led"] == 0 || f["sure"] > 1.6) << f;
  }
  /// Imports and expects one refused session, whose error has these words.
  Json refused(const std::vector<std::string>& more, const std::vector<std::string>& words) const {
    const Outcome run = import(more);
    EXPECT_EQ(run.exit_code, 65) << run.error << run.output;
    Json plan = run.json();
    EXPECT_EQ(plan["sessions"].size(), 1U);
    EXPECT_EQ(plan["sessions"][0]["state"], "refused");
    for (const std::string& word : words)
      EXPECT_THAT(plan["sessions"][0]["error"].dump(), testing::HasSubstr(word));
    EXPECT_FALSE(std::filesystem::exists(archive_)) << "nothing is made";
    return plan;
  }
  /// What programs that are run from now on read.
  void type(const std::string& text) const {
    put_bytes(work_ / "typed", text);
    const int file = ::open((work_ / "typed").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_GE(file, 0);
    ASSERT_EQ(::dup2(file, STDIN_FILENO), STDIN_FILENO);
    ::close(file);
  }
  Session session(const std::string& name) const {
    Result<Session> session = read_session(archive_ / (name + ".weft"));
    EXPECT_TRUE(session) << session.error().message();
    return session ? std::move(*session) : Session();
  }
  static Session session_of_scan() { return *read_session(scanned_->folder); }
  /// Whether each shot holds the frame of the LED that it names.
  void expect_right(const Session& session) const {
    for (const Shot& shot : session.shots) {
      const Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
      ASSERT_TRUE(frame) << frame.error().message();
      const RawFrame& wanted = scanned_->frames.at(shot.led);
      for (int y = 0; y < wanted.counts.height(); ++y) {
        const auto* row = wanted.counts.plane().row(y);
        ASSERT_TRUE(std::equal(row, row + wanted.counts.width(), frame->counts.plane().row(y)))
            << shot.file << " is not of LED " << shot.led;
      }
      EXPECT_EQ(shot.role, shot.led == 0 ? ShotRole::kDark : ShotRole::kLit);
    }
  }

  static inline ScannedCloth* scanned_ = nullptr;
  Workspace work_;
  const std::filesystem::path source_ = work_ / "left", archive_ = work_ / "archive";
  std::filesystem::path calibration_ = scanned_->folder / "calibration";
  const std::vector<std::string> by_number_ = {"--pattern", "{session}/{fabric}_{led}.{ext}"};
};

}  // namespace weft::test
