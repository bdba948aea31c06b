// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {

/// A test of one small session: ten LEDs and a dark shot of a twill, 48 x 32.
class SessionTest : public testing::Test {
 protected:
  void SetUp() override { simulate(scene_named("golden", {48, 32}), session_); }

  void expect_solve_refused(int exit_code, const std::vector<std::string>& words,
                            const std::vector<std::string>& more_arguments = {}) const {
    std::vector<std::string> arguments = {"solve", session_.string(), "--quiet"};
    arguments.insert(arguments.end(), more_arguments.begin(), more_arguments.end());
    expect_refusal(work_, arguments, exit_code, words);
  }

  Workspace work_;
  const std::filesystem::path session_ = work_ / "cloth.weft";
};

}  // namespace weft::test
