// SPDX-License-Identifier: Apache-2.0
// weft lights: what any light file says, as a table, a picture and an .lp.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

TEST(Lights, OfAFolderAreShownDrawnAndWrittenForOthers) {
  const Workspace work;
  const PhotographSample sample;
  sample.write(work / "photos");
  const fs::path written = work / "lights.lp", picture = work / "lights.svg";
  const Outcome run =
      run_weft({"lights", (work / "photos").string(), "-o", written.string(), "--picture", picture.string()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_THAT(run.output, AllOf(HasSubstr("6 lights"), HasSubstr("01.exr"), HasSubstr("50.00")))
      << "40 degrees from the zenith";
  EXPECT_THAT(bytes_of(picture), AllOf(HasSubstr("<svg"), HasSubstr("6 lights, x to the right, y up")));
  EXPECT_THAT(bytes_of(written), HasSubstr("6\nphotos/01.exr "));
  const auto lights_of = [&](const fs::path& source) {
    return run_weft({"lights", source.string(), "--json", "-q"}).json()["lights"];
  };
  const Json own = lights_of(work / "photos"), again = lights_of(written);
  ASSERT_EQ(own.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(own[k]["direction"][axis].get<double>(), again[k]["direction"][axis].get<double>(), 1e-15)
          << k;
    EXPECT_EQ(own[k]["strength_rgb"], again[k]["strength_rgb"]) << k;
    EXPECT_EQ(own[k]["photograph"], again[k]["photograph"]) << k;
  }
  expect_refusal(work, {"lights", (work / "photos").string(), "-o", written.string()}, 73,
                 {"lights.lp", "never overwritten", "another name"});
}

TEST(Lights, AreShownWithoutTheirPhotographs) {
  const Workspace work;
  put_bytes(work / "d.dome", R"({"lightConfiguration": "lights3d", "directions": [],
    "positions3d": [{"x": 0, "y": 100, "z": 100}, {"x": 300, "y": 0, "z": 0}]})");
  const Outcome run = run_weft({"lights", (work / "d.dome").string()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_THAT(run.output, AllOf(HasSubstr("RelightLab dome"), HasSubstr("positions"), HasSubstr("90.00"),
                                HasSubstr("45.00"), HasSubstr("names no photograph")));
}

}  // namespace
}  // namespace weft::test
