// SPDX-License-Identifier: Apache-2.0
// A session that was scanned after a check had found that the rig moved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/base/files.h"
#include "core/rig/session.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class MovedRig : public SessionTest {
 protected:
  void SetUp() override {
    SessionTest::SetUp();
    fs::create_directories(work_ / "calibrations");
    fs::copy(session_ / "calibration", work_ / "calibrations" / "one", fs::copy_options::recursive);
    Result<Session> session = read_session(session_);
    EXPECT_TRUE(session) << session.error().message();
    session->shots.front().time = "2026-11-05T10:00:00Z";
    EXPECT_TRUE(write_session(*session));
    calibration_ = session->calibration_id;
    EXPECT_TRUE(write_file(work_ / "rig.toml",
                           "name = \"" + session->rig + "\"\n[scan]\ncalibration = \"calibrations/one\"\n"));
    setenv("WEFT_RIG", (work_ / "rig.toml").c_str(), 1);
  }
  ~MovedRig() override { unsetenv("WEFT_RIG"); }

  void check(const std::string& date, bool passed) const {
    const fs::path folder = work_ / "calibrations" / "checks" / date;
    fs::create_directories(folder);
    EXPECT_TRUE(write_json(folder / "result.json",
                           {{"schema", "weft.calibration-check/1"},
                            {"date", date},
                            {"of", "session"},
                            {"calibration", calibration_},
                            {"passed", passed},
                            {"numbers", {{"cost_mean_deg", 0.82}, {"cost_worst_deg", 2.1}}}}));
  }
  Outcome solve(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"solve", session_.string(), "-q", "--json", "--quality", "preview"};
    words.insert(words.end(), more.begin(), more.end());
    return run_weft(words);
  }

  std::string calibration_;
};

TEST_F(MovedRig, IsNotSolvedByUnlessThatIsAccepted) {
  check("2026-11-04T10:00:00Z", true);
  check("2026-11-06T10:00:00Z", false);
  const Outcome refused = solve();
  EXPECT_EQ(refused.exit_code, 65) << refused.output;
  EXPECT_THAT(refused.error, HasSubstr("0.82 degrees on average, 2.1 at worst"));
  EXPECT_THAT(refused.error, HasSubstr("--accept-moved"));
  EXPECT_FALSE(is_there(session_ / "solve"));
  const Outcome accepted = solve({"--accept-moved", "only colours count"});
  ASSERT_EQ(accepted.exit_code, 0) << accepted.error;
  const fs::path folder = accepted.json()["folder"].get<std::string>();
  EXPECT_THAT(bytes_of(folder / "solve.json"), HasSubstr("only colours count"));
}

TEST_F(MovedRig, IsTrustedForWhatItScannedBeforeACheckThatPassed) {
  check("2026-11-06T10:00:00Z", true);
  check("2026-11-07T10:00:00Z", false);
  EXPECT_EQ(solve().exit_code, 0);
}

TEST_F(MovedRig, OfAnotherCalibrationSaysNothingOfThisSession) {
  calibration_ = std::string(64, '0');
  check("2026-11-06T10:00:00Z", false);
  EXPECT_EQ(solve().exit_code, 0);
}

}  // namespace
}  // namespace weft::test
