// SPDX-License-Identifier: Apache-2.0
#include "tests/repository/source_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace weft::repository {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(SourceTree, HoldsThisFileAndNoBuildResult) {
  const std::vector<TextFile> files = text_files();
  const auto here = std::ranges::find(files, "tests/repository/source_tree_test.cpp", &TextFile::path);
  ASSERT_NE(here, files.end()) << "among " << files.size() << " files";
  EXPECT_THAT(here->text, testing::StartsWith("// SPDX"));
  for (const TextFile& file : files) EXPECT_FALSE(file.path.starts_with("build/")) << file.path;
}

TEST(SourceTree, IgnoresWhatGitIgnores) {
  for (const char* path : {".git", "build", "demo", "a/b.weft", "app/web/node_modules", "app/web/dist"}) {
    EXPECT_TRUE(is_ignored(path)) << path;
  }
  for (const char* path : {".gitignore", ".ci", "app/demo", "testdata/a.weft", "docs/build.md"}) {
    EXPECT_FALSE(is_ignored(path)) << path;
  }
}

TEST(SourceTree, SplitsLinesWithAndWithoutALastLineEnd) {
  EXPECT_THAT(lines_of(""), IsEmpty());
  EXPECT_THAT(lines_of("a\n\nb\n"), ElementsAre("a", "", "b"));
  EXPECT_THAT(lines_of("a\nb"), ElementsAre("a", "b"));
}

}  // namespace
}  // namespace weft::repository
