// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/test_shots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft::app {
namespace {

TestShot taken(TestShot shot) {
  shot.frame = FrameFile{stem_of_shot(shot.id) + ".dng", "", {}};
  return shot;
}

TEST(TestShots, AreFoundByIdsThatRise) {
  TestShots shots;
  EXPECT_EQ(shots.begin(0, 1000).id, 1);
  ASSERT_TRUE(shots.find(1));
  EXPECT_FALSE(shots.find(1)->frame);
  shots.end(taken(*shots.find(1)));
  EXPECT_EQ(shots.begin(3, 2000).id, 2);
  EXPECT_EQ(shots.find(1)->frame->file, "shot000001.dng");
  EXPECT_EQ(shots.find(2)->led, 3);
  EXPECT_EQ(shots.find(2)->exposure_us, 2000);
}

TEST(TestShots, AreTheLastEightWhoseFilesAreKept) {
  TestShots shots;
  std::vector<std::filesystem::path> gone;
  for (int id = 1; id <= 11; ++id) {
    TestShot shot = shots.begin(1, 1000);
    if (id != 2) shot = taken(std::move(shot));
    for (std::filesystem::path& file : shots.end(shot)) gone.push_back(std::move(file));
  }
  EXPECT_THAT(gone, testing::ElementsAre("shot000001.dng", "shot000003.dng"));
  EXPECT_TRUE(shots.find(4));
  for (const int id : {0, 3, 12}) {
    const Result<TestShot> none = shots.find(id);
    ASSERT_FALSE(none) << id;
    EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
  }
}

}  // namespace
}  // namespace weft::app
