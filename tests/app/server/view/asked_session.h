// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "core/base/temporary_folder.h"
#include "core/solve/solve.h"
#include "solve/run/solve_session.h"

namespace weft::app {

/// A small deep weave under near lights, simulated once for a suite and solved at `standard`.
class AskedSession : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite() { folder_.reset(); }

  static std::filesystem::path root() { return folder_->path(); }
  static std::filesystem::path session() { return root() / "scans" / "asked.weft"; }

  static constexpr Size kFrame = {256, 192};
  static constexpr double kMmPerPixel = 0.04;
  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline SolveFacts solve_;
  static inline std::filesystem::path maps_;
};

}  // namespace weft::app
