// SPDX-License-Identifier: Apache-2.0
// The stock gphoto2 program at the virtual camera's port.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"

namespace weft::virtual_rig {
namespace {

using testing::HasSubstr;

std::vector<std::uint8_t> contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class StockGphoto2 : public testing::Test {
 protected:
  ProgramRun run(std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"/usr/bin/gphoto2", "--port", studio_.network(), "--camera", "PTP/IP Camera"});
    return run_program(options, {"HOME=" + private_home(), "LC_ALL=C"}, private_home(), 20);
  }

  Studio studio_;
};

TEST_F(StockGphoto2, CapturesAFile) {
  const std::filesystem::path file = std::filesystem::path(private_home()) / "captured.dng";
  const ProgramRun captured = run({"--set-config", "capturetarget=0", "--capture-image-and-download",
                                   "--filename", file.string(), "--force-overwrite"});
  EXPECT_EQ(captured.exit_code, 0) << captured.output;
  EXPECT_EQ(studio_.number_of(contents(file)), 1u);
}

TEST_F(StockGphoto2, ListsAndSetsWhatTheCameraHas) {
  const ProgramRun listed = run({"--list-config"});
  EXPECT_EQ(listed.exit_code, 0) << listed.output;
  for (const char* const name :
       {"shutterspeed2", "iso", "f-number", "imagequality", "capturetarget", "datetime"})
    EXPECT_THAT(listed.output, HasSubstr(name));
  const ProgramRun set = run({"--set-config", "iso=400", "--get-config", "iso"});
  EXPECT_EQ(set.exit_code, 0) << set.output;
  EXPECT_THAT(set.output, HasSubstr("Current: 400"));
}

TEST_F(StockGphoto2, SummarizesTheCamera) {
  const ProgramRun summary = run({"--summary"});
  EXPECT_EQ(summary.exit_code, 0) << summary.output;
  EXPECT_THAT(summary.output, HasSubstr("Model: D5100"));
  EXPECT_THAT(summary.output, HasSubstr("Serial Number: 6000001"));
}

}  // namespace
}  // namespace weft::virtual_rig
