// SPDX-License-Identifier: Apache-2.0
// What `weft bench page` measures in a browser, of the largest maps.
#include <gtest/gtest.h>

#include <string>

#include "core/base/json_document.h"
#include "tests/core/places.h"
#include "tests/system/program.h"

namespace weft::test {
namespace {

TEST(PageSoak, AnyPlaceOfAHundredMegapixelsIsThereIn300Milliseconds) {
  const Outcome run =
      run_weft({"bench", "page", "--megapixels", "100", "--json", "-q"}, {.folder = source_folder()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  int found = 0;
  for (const Json& row : run.json()["rows"]) {
    if (row["what"] != "a new place at 1:1, ms") continue;
    ++found;
    EXPECT_LE(row["reached"].get<double>(), 300);
  }
  EXPECT_EQ(found, 1) << run.output;
}

}  // namespace
}  // namespace weft::test
