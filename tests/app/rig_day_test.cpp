// SPDX-License-Identifier: Apache-2.0
// docs/user/rig_day.md, typed line by line: a rig that nobody has calibrated becomes one that is known as
// well as if it had been built from a drawing, through its own camera alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "material/read/compare.h"
#include "simulator/scene/resolution.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"
#include "tests/core/places.h"
#include "virtual_rig/table/knock.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// The lines of all sh blocks of a page.
std::string typed_lines(const fs::path& page) {
  std::istringstream in(read_text(page).value());
  std::string lines;
  bool is_typed = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) {
      is_typed = line == "```sh";
    } else if (is_typed) {
      lines += line + '\n';
    }
  }
  return lines;
}

class RigDay : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    fs::create_directory_symlink(in_sources("testdata"), folder_->path() / "testdata");
    code_ = run("rig_day", typed_lines(in_sources("docs/user/rig_day.md")));
    said_ = read_text(folder_->path() / "rig_day.txt").value();
  }
  static void TearDownTestSuite() {
    run("end", "test ! -e rig/control || weft-virtual-rig --folder rig --inject end");
    delete folder_;
  }

  /// A shell runs the lines and stops at the first that fails; its exit code. NAME.txt has what it said.
  static int run(const std::string& name, const std::string& lines) {
    const fs::path script = folder_->path() / (name + ".sh");
    std::ofstream(script) << "set -ev\ncd '" << folder_->path().string() << "'\nexport PATH='"
                          << program_folder().string() << "':\"$PATH\" WEFT_RIG=\n"
                          << lines;
    const std::string command = "timeout -k 5 800 bash '" + script.string() + "' > '" +
                                (folder_->path() / (name + ".txt")).string() + "' 2>&1 < /dev/null";
    return std::system(command.c_str());
  }
  static fs::path in_folder(const std::string& name) { return folder_->path() / name; }

  /// What is exactly so of the page's rig after knocks, behind the lens as it was measured: the page cannot
  /// know better.
  static Result<void> write_exact_calibration(const fs::path& to, const Calibration& measured,
                                              const virtual_rig::Knocks& knocks) {
    Result<simulator::Scene> scene = simulator::read_scene(in_sources("testdata/scenes/rig.toml"));
    if (!scene) return scene.error();
    simulator::resize(scene->camera, 0.25);
    scene = virtual_rig::knocked(std::move(*scene), knocks);
    if (!scene) return scene.error();
    const Result<simulator::SceneRig> rig = simulator::rig_of(*scene);
    if (!rig) return rig.error();
    Calibration exact = simulator::exact_calibration(*scene, *rig);
    exact.subject = measured.subject;
    exact.spread = measured.spread;
    exact.color = measured.color;
    exact.response->levels = measured.response->levels;  // the body's are not the scene's
    const Result<Calibration> written = write_calibration(to, std::move(exact));
    return written ? Result<void>() : written.error();
  }

  static fs::path scan(const std::string& number) {
    for (const auto& session : fs::directory_iterator(in_folder("rig/scans"))) {
      if (session.path().stem().string().ends_with(number)) return session.path();
    }
    return {};
  }

  /// Against the exact calibration of the rig as it stood then.
  static void expect_right_normals(const std::string& number, const std::string& calibration,
                                   const virtual_rig::Knocks& knocks) {
    const fs::path own = in_folder("rig/calibrations") / calibration, exact = in_folder("exact" + number);
    const Result<Calibration> measured = read_calibration(own);
    ASSERT_TRUE(measured) << measured.error().message();
    const Result<void> written = write_exact_calibration(exact, *measured, knocks);
    ASSERT_TRUE(written) << written.error().message();
    ASSERT_EQ(
        run("solve", "for by in '" + own.string() + "' '" + exact.string() + "'; do weft solve '" +
                         scan(number).string() +
                         "' --quality standard --quiet --calibration $by -o solved_$(basename $by); done"),
        0)
        << read_text(in_folder("solve.txt")).value();
    const auto off = material::compare_normals(in_folder("solved_" + calibration + "/normal.exr"),
                                               in_folder("solved_exact" + number + "/normal.exr"), {});
    ASSERT_TRUE(off) << off.error().message();
    EXPECT_LT(off->median_deg, 0.1);
    EXPECT_LT(off->p95_deg, 0.2);
    std::printf("scan %s: median %.3f, 95 percent %.3f degrees\n", number.c_str(), off->median_deg,
                off->p95_deg);
  }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline int code_ = -1;
  static inline std::string said_;
};

TEST_F(RigDay, RunsLineByLine) {
  ASSERT_EQ(code_, 0) << said_.substr(said_.size() - std::min<std::size_t>(said_.size(), 2000));
  EXPECT_THAT(said_, HasSubstr("Accepted: 3 sheets"));
  EXPECT_THAT(said_, HasSubstr("names it from now on"));
  EXPECT_THAT(said_, Not(HasSubstr("not used")));
}

TEST_F(RigDay, LeavesAScanThatSaysHowOldItsCalibrationIs) {
  ASSERT_EQ(code_, 0);
  const Result<Calibration> measured = read_calibration(in_folder("rig/calibrations/first-color"));
  ASSERT_TRUE(measured) << measured.error().message();
  const Result<Session> session = read_session(scan("001"));
  ASSERT_TRUE(session) << session.error().message();
  const Json calibrated = session->document.value("calibrated", Json::object());
  EXPECT_EQ(calibrated.value("measured", ""), measured->subject.measured);
  EXPECT_EQ(calibrated.value("passed", false), true) << calibrated;
  EXPECT_GT(calibrated.value("checked", ""), measured->subject.measured);
}

TEST_F(RigDay, GivesNormalsThatAnExactCalibrationWouldGive) {
  ASSERT_EQ(code_, 0);
  expect_right_normals("001", "first-color", {});
}

TEST_F(RigDay, GivesThemAgainAfterTheKnock) {
  ASSERT_EQ(code_, 0);
  expect_right_normals("002", "knock-updated",
                       {.camera = {.roll_deg = 0.4, .x_mm = 3}, .leds_mm = {{3, {6, 0, -4}}}});
}

}  // namespace
}  // namespace weft::app
