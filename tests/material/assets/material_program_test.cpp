// SPDX-License-Identifier: Apache-2.0
// Materials as a person makes them, by the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/system/program.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(MaterialProgram, MakesResolvesAndBuildsAMaterialOfTheLibrary) {
  const Workspace work;
  const std::string file = (work / "jacket.toml").string();
  ASSERT_EQ(run_weft({"material", "new", file, "--inherits", "library:denim"}).exit_code, 0);
  const Outcome resolved = run_weft({"material", "resolve", file});
  EXPECT_THAT(resolved.output, HasSubstr("surface.roughness"));
  EXPECT_THAT(resolved.output, HasSubstr("library:cloth/denim"));
  EXPECT_THAT(resolved.output, HasSubstr("library:cloth/cotton"));
  const Json first = run_weft({"material", "build", file, "--json", "--quiet"}).json();
  EXPECT_EQ(first["built"], 1);
  EXPECT_TRUE(fs::exists(fs::path(first["materials"][0]["folder"].get<std::string>()) / "preview.png"));
  EXPECT_EQ(fs::path(first["materials"][0]["folder"].get<std::string>()).parent_path(), work / "build");
  const Json second = run_weft({"material", "build", file, "--json", "--quiet"}).json();
  EXPECT_EQ(second["built"], 0);
  EXPECT_EQ(second["kept"], 1);
  EXPECT_THAT(run_weft({"material", "graph", file}).output, HasSubstr("digraph materials"));
}

TEST(MaterialProgram, ListsAndPrintsWhatWeftBringsAlong) {
  const Outcome list = run_weft({"material", "list"});
  EXPECT_THAT(list.output, HasSubstr("library:cloth/dark-satin"));
  EXPECT_THAT(run_weft({"material", "show", "library:dust"}).output,
              HasSubstr("schema = \"weft.material/1\""));
}

TEST(MaterialProgram, RefusesWithFileAndKeyAndWritesNothing) {
  const Workspace work;
  put_bytes(work / "typo.toml", "schema = \"weft.material/1\"\n[surface]\nrougness = 0.5\n");
  expect_refusal(work, {"material", "build", (work / "typo.toml").string()}, 65,
                 {"typo.toml: [surface] rougness", "the nearest is roughness"});
  put_bytes(work / "circle.toml", "schema = \"weft.material/1\"\ninherits = \"circle.toml\"\n");
  expect_refusal(work, {"material", "resolve", (work / "circle.toml").string()}, 65,
                 {"in a circle", "circle.toml -> "});
  put_bytes(work / "lost.toml", "schema = \"weft.material/1\"\n[surface]\nnormal = { map = \"gone.exr\" }\n");
  expect_refusal(work, {"material", "build", (work / "lost.toml").string()}, 66,
                 {"surface.normal", "gone.exr"});
  expect_refusal(work, {"material", "build", "library:cotton"}, 64, {"library:cloth/cotton", "-o"});
}

}  // namespace
}  // namespace weft::test
