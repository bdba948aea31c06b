// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/solve_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "core/solve/solve_record.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/places.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr Size kSize = {5, 3};

void write_map(const fs::path& file, Size size, const std::vector<std::string>& channels,
               SampleType type = SampleType::kHalf) {
  Image<float> planes(size, static_cast<int>(channels.size()));
  std::vector<View<const float>> views;
  for (int c = 0; c < planes.planes(); ++c) {
    planes(size.width - 1, size.height - 1, c) = 0.25f * static_cast<float>(c + 1);
    views.push_back(planes.plane(c));
  }
  ASSERT_TRUE(write_image(file, views, channels, {.type = type}));
}

// What a solve leaves: the last pixel has 1/4, 1/2, 3/4 ... in its channels and its own status.
void write_maps(const fs::path& folder) {
  write_map(folder / "normal.exr", kSize, {"X", "Y", "Z"}, SampleType::kFloat);
  write_map(folder / "albedo.exr", kSize, {"R", "G", "B"});
  write_map(folder / "sigma.exr", kSize, {"R", "G", "B", "normal_deg"});
  Image<std::uint16_t> status(kSize);
  status(4, 2) = kNoSolution | kInvalidReading;
  auto writer = ImageWriter::open(folder / "status.png", kSize, {"Y"}, {.type = SampleType::kUint16});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write_rows(status.plane()));
  ASSERT_TRUE(writer->finish());
}

TEST(SolveMaps, AreReadByWhatTheyAre) {
  const ScratchFolder folder;
  write_maps(folder / "");
  const Result<SolveMaps> maps = SolveMaps::open(folder / "");
  ASSERT_TRUE(maps) << maps.error().message();
  EXPECT_EQ(maps->size(), kSize);
  const auto status = maps->status();
  ASSERT_TRUE(status) << status.error().message();
  EXPECT_EQ((*status)(4, 2), kNoSolution | kInvalidReading);
  EXPECT_EQ((*status)(3, 2), 0);
  const auto normal = maps->normal(), albedo = maps->albedo(), sigma = maps->sigma();
  ASSERT_TRUE(normal && albedo && sigma);
  EXPECT_EQ(normal->channel("Z")(4, 2), 0.75f);
  EXPECT_EQ(albedo->channel("G")(4, 2), 0.5f);
  EXPECT_EQ(sigma->channel("normal_deg")(4, 2), 1.0f);
}

TEST(SolveMaps, MayHaveTheShareOfTheCalibrationInSigma) {
  const ScratchFolder folder;
  write_maps(folder / "");
  write_map(folder / "sigma.exr", kSize,
            {"R", "G", "B", "normal_deg", "R.calibration", "G.calibration", "normal_deg.noise",
             "normal_deg.model"});
  const Result<SolveMaps> maps = SolveMaps::open(folder / "");
  ASSERT_TRUE(maps) << maps.error().message();
  EXPECT_EQ(maps->sigma()->channel("G.calibration")(4, 2), 1.5f);
  EXPECT_EQ(maps->sigma()->channel("normal_deg.model")(4, 2), 2);
}

TEST(SolveMaps, OfTwoSizesAreRefusedAtOnce) {
  const ScratchFolder folder;
  write_maps(folder / "");
  write_map(folder / "albedo.exr", {5, 4}, {"R", "G", "B"});
  const Result<SolveMaps> maps = SolveMaps::open(folder / "");
  ASSERT_FALSE(maps);
  EXPECT_EQ(maps.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(maps.error().message(), HasSubstr("maps of a solve differ in size"));
  EXPECT_THAT(maps.error().message(), HasSubstr("albedo.exr: it has 5 x 4 pixels, status.png 5 x 3"));
}

TEST(SolveMaps, WithOtherChannelsThanASolveWritesAreRefused) {
  struct Wrong {
    const char* file;
    std::vector<std::string> channels;
    const char* said;
  };
  const std::vector<Wrong> all = {
      {"normal.exr", {"R", "G", "B"}, "it has R, G, B; X, Y, Z were expected"},
      {"albedo.exr", {"Y"}, "it has Y; R, G, B were expected"},
      {"sigma.exr", {"R", "G", "B"}, "R, G, B, normal_deg were expected"},
      {"sigma.exr", {"R", "G", "B", "normal_deg", "other"}, "R, G, B, normal_deg were expected"}};
  for (const Wrong& wrong : all) {
    const ScratchFolder folder;
    write_maps(folder / "");
    write_map(folder / wrong.file, kSize, wrong.channels);
    const Result<SolveMaps> maps = SolveMaps::open(folder / "");
    ASSERT_FALSE(maps) << wrong.said;
    EXPECT_THAT(maps.error().message(), HasSubstr(wrong.file));
    EXPECT_THAT(maps.error().message(), HasSubstr(wrong.said));
  }
}

TEST(SolveMaps, ChangedAfterTheyWereOpenedAreRefused) {
  const ScratchFolder folder;
  write_maps(folder / "");
  const Result<SolveMaps> maps = SolveMaps::open(folder / "");
  ASSERT_TRUE(maps);
  write_map(folder / "normal.exr", {2, 2}, {"X", "Y", "Z"});
  const auto normal = maps->normal();
  ASSERT_FALSE(normal);
  EXPECT_THAT(normal.error().message(), HasSubstr("maps of a solve differ in size"));
}

TEST(SolveMaps, ThatAreNotThereAreNamed) {
  const ScratchFolder folder;
  write_maps(folder / "");
  fs::remove(folder / "sigma.exr");
  const Result<SolveMaps> maps = SolveMaps::open(folder / "");
  ASSERT_FALSE(maps);
  EXPECT_EQ(maps.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(maps.error().message(), HasSubstr("sigma.exr"));
}

TEST(SolveMaps, OfAStoredSolveAreRead) {
  const fs::path golden = source_folder() / "testdata/golden/satin.weft";
  for (const char* product : {"solve", "rectified"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(golden / product)) {
      const Result<SolveMaps> maps = SolveMaps::open(entry.path());
      ASSERT_TRUE(maps) << maps.error().message();
      const auto normal = maps->normal(), albedo = maps->albedo(), sigma = maps->sigma();
      ASSERT_TRUE(maps->status() && normal && albedo && sigma) << entry.path();
      const int x = maps->size().width / 2, y = maps->size().height / 2;
      EXPECT_GT(normal->channel("Z")(x, y), 0.5f) << entry.path();
      EXPECT_GT(albedo->channel("R")(x, y), albedo->channel("G")(x, y)) << "the satin is red";
      EXPECT_GT(sigma->channel("normal_deg")(x, y), 0.0f) << entry.path();
    }
  }
}

}  // namespace
}  // namespace weft
