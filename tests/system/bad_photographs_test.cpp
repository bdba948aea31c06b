// SPDX-License-Identifier: Apache-2.0
// Photographs and light files that cannot be solved.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "core/image_io/image_io.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class BadPhotographs : public testing::Test {
 protected:
  void write(const PhotographSample& sample) const { sample.write(folder_); }

  void spoil(const std::string& name, float value) const {
    Result<LoadedImage> image = read_image(folder_ / name);
    ASSERT_TRUE(image) << image.error().message();
    image->planes(17, 5, 1) = value;
    const std::array<View<const float>, 3> planes = {image->planes.plane(0), image->planes.plane(1),
                                                     image->planes.plane(2)};
    ASSERT_TRUE(write_image(folder_ / name, planes, {"R", "G", "B"}, {}));
  }
  void expect_refused(int exit_code, const std::vector<std::string>& words) const {
    expect_refusal(work_, {"solve", "--photos", folder_.string(), "--quiet"}, exit_code, words,
                   {.folder = work_.path()});
  }
  void expect_light_file_refused(const std::string& text, int exit_code,
                                 const std::vector<std::string>& words) const {
    put_bytes(folder_ / "lights.lp", text);
    expect_refusal(work_, {"solve", "--lp", (folder_ / "lights.lp").string(), "--quiet"}, exit_code, words,
                   {.folder = work_.path()});
  }

  Workspace work_;
  const fs::path folder_ = work_ / "photos";
};

TEST_F(BadPhotographs, AMissingFolderIsNamed) {
  expect_refused(66, {"cannot read", "photos", "No such file", "check the path"});
}

TEST_F(BadPhotographs, AMissingPhotographIsNamed) {
  write({});
  fs::remove(folder_ / "03.exr");
  expect_refused(66, {"cannot read", "03.exr", "No such file", "check the path"});
}

TEST_F(BadPhotographs, TwoAreTooFew) {
  PhotographSample two;
  two.lights.resize(2);
  write(two);
  expect_refused(65, {"too few lights", folder_.string(), "2 photographs", "at least three"});
}

TEST_F(BadPhotographs, NanIsRefused) {
  write({});
  spoil("03.exr", std::numeric_limits<float>::quiet_NaN());
  expect_refused(65, {"no numbers", "03.exr", "NaN", "(17, 5)", "export it again"});
}

TEST_F(BadPhotographs, InfinityIsRefused) {
  write({});
  spoil("03.exr", -std::numeric_limits<float>::infinity());
  expect_refused(65, {"no numbers", "03.exr", "infinity", "(17, 5)", "export it again"});
}

TEST_F(BadPhotographs, OneOfAnotherSizeIsRefused) {
  write({});
  PhotographSample other;
  other.size = {40, 31};
  other.write(work_ / "other");
  fs::copy_file(work_ / "other" / "03.exr", folder_ / "03.exr", fs::copy_options::overwrite_existing);
  expect_refused(65, {"differ in size", "03.exr", "40 x 31", "40 x 30", "one camera"});
}

TEST_F(BadPhotographs, AMaskOfAnotherSizeIsRefused) {
  write({});
  const Image<float> mask({40, 31});
  const std::array<View<const float>, 1> planes = {mask.plane()};
  ASSERT_TRUE(write_image(folder_ / "mask.png", planes, {"Y"}, {.type = SampleType::kUint8}));
  expect_refused(65, {"mask differs in size", "mask.png", "40 x 31", "40 x 30", "make the mask again"});
}

TEST_F(BadPhotographs, APhotographThatIsNoImageIsRefused) {
  write({});
  put_bytes(folder_ / "03.exr", "no image");
  expect_refused(65, {"03.exr"});
}

TEST_F(BadPhotographs, LightsInOnePlaneAreRefused) {
  PhotographSample flat;
  for (std::size_t k = 0; k < flat.lights.size(); ++k) {
    const double zenith = radians(12.0 * static_cast<double>(k) - 30);
    flat.lights[k].direction = {0.6 * std::sin(zenith), 0.8 * std::sin(zenith), std::cos(zenith)};
  }
  write(flat);
  expect_refused(65, {"lights", "centre", "condition number", "do not lie in one plane"});
}

TEST_F(BadPhotographs, LightsAtOneHeightAreSolved) {
  write({});
  const Outcome run =
      run_weft({"solve", "--photos", folder_.string(), "--lights", "1,3,5", "--quiet", "--json"},
               {.folder = work_.path()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(run.json()["pixels"], 40 * 30);
}

TEST_F(BadPhotographs, ListsOfUnequalLengthAreRefused) {
  write({});
  put_bytes(folder_ / "light_directions.txt", "0 0 1\n0 1 1\n1 0 1\n");
  expect_refused(65, {"lights cannot be read", folder_.string(), "6 lines", "light_directions.txt 3",
                      "docs/formats.md"});
}

TEST_F(BadPhotographs, ADirectionOfNoLengthIsRefused) {
  write({});
  put_bytes(folder_ / "light_directions.txt", "0 0 1\n0 1 1\n1 0 1\n0 0 0\n0 1 1\n1 1 1\n");
  expect_refused(65, {"lights cannot be read", "light_directions.txt", "no length"});
}

TEST_F(BadPhotographs, ALineThatIsNoDirectionIsNamed) {
  write({});
  put_bytes(folder_ / "light_directions.txt", "0 0 1\n0 1 1\n1 0 one\n0 0 1\n0 1 1\n1 1 1\n");
  expect_refused(65, {"lights cannot be read", "light_directions.txt", "line 3", "three numbers"});
}

TEST_F(BadPhotographs, ALineOfFourNumbersIsNoDirection) {
  write({});
  put_bytes(folder_ / "light_directions.txt", "0 0 1\n0 1 1\n1 0 1 7\n0 0 1\n0 1 1\n1 1 1\n");
  expect_refused(65, {"lights cannot be read", "light_directions.txt", "line 3", "three numbers"});
}

TEST_F(BadPhotographs, ALightWithoutIntensityIsRefused) {
  write({});
  put_bytes(folder_ / "light_intensities.txt", "1 1 1\n1 1 1\n1 1 1\n1 0 1\n1 1 1\n1 1 1\n");
  expect_refused(65, {"lights cannot be read", "light_intensities.txt", "light 4", "intensity of 0"});
}

TEST_F(BadPhotographs, ALightThatIsNotThereIsAUsageError) {
  write({});
  expect_refusal(work_, {"solve", "--photos", folder_.string(), "--lights", "1,2,7", "--quiet"}, 64, {"7"},
                 {.folder = work_.path()});
}

TEST_F(BadPhotographs, ALightGivenTwiceIsAUsageError) {
  write({});
  expect_refusal(work_, {"solve", "--photos", folder_.string(), "--lights", "1,2,2", "--quiet"}, 64, {"2"},
                 {.folder = work_.path()});
}

TEST_F(BadPhotographs, ALightFileWithAnotherCountIsRefused) {
  write({});
  expect_light_file_refused("4\n01.exr 0 0 1\n02.exr 0 1 1\n03.exr 1 0 1\n", 65,
                            {"lights cannot be read", "lights.lp", "announces 4", "lists 3"});
}

TEST_F(BadPhotographs, ALightFileWithoutACountIsRefused) {
  write({});
  expect_light_file_refused("03.exr 1 0 1\n01.exr 0 0 1\n02.exr 0 1 1\n04.exr 1 1 1\n", 65,
                            {"lights cannot be read", "lights.lp", "first line"});
}

TEST_F(BadPhotographs, ALightFileWithALineCutShortIsRefused) {
  write({});
  expect_light_file_refused("3\n01.exr 0 0 1\n02.exr 0 1\n03.exr 1 0 1\n", 65,
                            {"lights cannot be read", "lights.lp", "02.exr 0 1", "file x y z"});
}

TEST_F(BadPhotographs, ALightFileWithADirectionThatIsNoNumberIsRefused) {
  write({});
  expect_light_file_refused("3\n01.exr 0 0 1\n02.exr 0 nan 1\n03.exr 1 0 1\n", 65,
                            {"lights cannot be read", "lights.lp"});
}

}  // namespace
}  // namespace weft::test
