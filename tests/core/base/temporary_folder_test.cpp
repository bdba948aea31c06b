// SPDX-License-Identifier: Apache-2.0
#include "core/base/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace weft {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsItsOwnAndGoesWithAllInIt) {
  fs::path first, second;
  {
    const TemporaryFolder a, b;
    first = a.path();
    second = b.path();
    EXPECT_NE(first, second);
    EXPECT_TRUE(fs::is_empty(first));
    fs::create_directory(first / "inside");
    std::ofstream(first / "inside" / "file") << "text";
  }
  EXPECT_FALSE(fs::exists(first));
  EXPECT_FALSE(fs::exists(second));
}

}  // namespace
}  // namespace weft
