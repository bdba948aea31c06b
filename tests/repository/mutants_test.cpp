// SPDX-License-Identifier: Apache-2.0
// tests/mutants/faults.txt against the tree that it names.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/core/places.h"

namespace weft::repository {
namespace {

TEST(Mutants, StillFitTheLinesThatTheyChange) {
  const int status = std::system(("bash '" + in_sources("dev") + "' mutants --check >&2").c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
      << "a line of tests/mutants/faults.txt is not in its file once";
}

}  // namespace
}  // namespace weft::repository
