// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/prune.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "core/base/files.h"
#include "library/catalogue/metadata.h"
#include "tests/library/catalogue/shelf.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> ids_of(const std::vector<Prunable>& solves) {
  std::vector<std::string> ids;
  for (const Prunable& solve : solves) ids.push_back(solve.solve);
  return ids;
}

// Four solves, an hour apart, and rectified maps of the second.
fs::path four_solves(const Shelf& shelf) {
  const fs::path folder = shelf.put("a");
  const auto now = fs::file_time_type::clock::now();
  for (int i = 1; i <= 4; ++i) {
    const std::string id = "000000000000000" + std::to_string(i);
    shelf.solve("a", id);
    std::ofstream(folder / "solve" / id / "normal.exr") << std::string(1000, 'n');
    fs::last_write_time(folder / "solve" / id / "solve.json", now - std::chrono::hours(5 - i));
  }
  fs::create_directories(folder / "raw");
  std::ofstream(folder / "raw" / "00_led01.dng") << "photograph";
  fs::create_directories(folder / "rectified" / "aaaa");
  const Json rectified = {{"schema", "weft.rectified/1"}, {"solve", "0000000000000002"}};
  EXPECT_TRUE(write_json(folder / "rectified" / "aaaa" / "rectify.json", rectified));
  return folder;
}

TEST(Prune, TakesNeitherTheCurrentSolveNorTheNewest) {
  const Shelf shelf;
  const fs::path folder = four_solves(shelf);
  EXPECT_EQ(ids_of(*prunable(folder, 1)),
            (std::vector<std::string>{"0000000000000001", "0000000000000002", "0000000000000003"}))
      << "all are alike, so the newest is the current one";
  ASSERT_TRUE(change_metadata(folder, {{"current_solve", "0000000000000002"}}));
  EXPECT_EQ(ids_of(*prunable(folder, 1)), (std::vector<std::string>{"0000000000000001", "0000000000000003"}));
  EXPECT_EQ(ids_of(*prunable(folder, 3)), std::vector<std::string>{"0000000000000001"});
  EXPECT_TRUE(prunable(folder, 9)->empty());
}

TEST(Prune, RemovesASolveWithWhatWasMadeFromItAndNoPhotograph) {
  const Shelf shelf;
  const fs::path folder = four_solves(shelf);
  const Result<std::vector<Prunable>> solves = prunable(folder, 1);
  ASSERT_TRUE(solves);
  EXPECT_EQ((*solves)[1].folders.size(), 2U);
  EXPECT_GT((*solves)[1].bytes, 1000U);
  ASSERT_TRUE(prune(folder, *solves));
  EXPECT_TRUE(prunable(folder, 1)->empty());
  EXPECT_FALSE(fs::exists(folder / "solve" / "0000000000000002"));
  EXPECT_TRUE(fs::is_empty(folder / "rectified"));
  EXPECT_TRUE(fs::exists(folder / "solve" / "0000000000000004" / "normal.exr"));
  EXPECT_TRUE(fs::exists(folder / "raw" / "00_led01.dng"));
}

}  // namespace
}  // namespace weft::library
