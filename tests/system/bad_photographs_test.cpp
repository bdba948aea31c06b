// SPDX-License-Identifier: Apache-2.0
// Photographs and light files that cannot be solved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

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
  expect_refused(66, {"cannot read", "03.exr", "1 of 6 are not there", "--skip-missing"});
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

TEST_F(BadPhotographs, AMaskIsReadAsPeopleMakeThem) {
  write({});
  // Masks of half the picture: the count 1 on 0, alpha on black, alpha on white, in capitals.
  struct Made {
    const char* name;
    std::array<float, 2> color, alpha;  // outside and inside
  };
  for (const Made& made : {Made{"mask.png", {0, 1}, {1, 1}}, Made{"mask.png", {0, 1 / 255.0F}, {1, 1}},
                           Made{"mask.png", {0, 0}, {0, 1}}, Made{"mask.png", {1, 1}, {0, 1}},
                           Made{"Mask.PNG", {0, 1}, {1, 1}}, Made{"mask.tif", {0, 1}, {1, 1}}}) {
    Image<float> mask({40, 30}, 4);
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) {
        const std::size_t side = x < 20 ? 0 : 1;
        for (int p = 0; p < 4; ++p) mask(x, y, p) = p < 3 ? made.color[side] : made.alpha[side];
      }
    }
    const std::array<View<const float>, 4> planes = {mask.plane(0), mask.plane(1), mask.plane(2),
                                                     mask.plane(3)};
    const fs::path written = folder_ / (std::string(made.name).ends_with("tif") ? "m.tif" : "m.png");
    ASSERT_TRUE(write_image(written, planes, {"R", "G", "B", "A"}, {.type = SampleType::kUint8}));
    fs::rename(written, folder_ / made.name);
    const fs::path maps = work_ / "maps";
    const Outcome run = run_weft(
        {"solve", "--photos", folder_.string(), "-o", maps.string(), "--no-previews", "--quiet", "--json"});
    EXPECT_EQ(run.exit_code, 0) << made.name << run.error;
    EXPECT_EQ(run.json()["pixels"], 20 * 30) << made.name << " " << made.color[1] << " " << made.alpha[0];
    fs::remove(folder_ / made.name);
    fs::rename(maps, work_ / "last");
    if (made.name != std::string("mask.tif")) fs::remove_all(work_ / "last");
  }
  const Outcome compared = run_weft({"compare", (work_ / "last" / "normal.exr").string(),
                                     (folder_ / "normal_gt.exr").string(), "--json", "--quiet"});
  EXPECT_EQ(compared.json()["pixels"], 20 * 30) << "pixels without a solution are no normals";
}

TEST_F(BadPhotographs, AMaskThatLeavesNothingIsRefused) {
  write({});
  Image<float> mask({40, 30});
  const std::array<View<const float>, 1> planes = {mask.plane()};
  ASSERT_TRUE(write_image(folder_ / "mask.png", planes, {"Y"}, {.type = SampleType::kUint8}));
  expect_refused(65, {"mask leaves no cloth", "mask.png", "white", "take the mask away"});
  mask(3, 4) = 0.3F;
  ASSERT_TRUE(write_image(folder_ / "mask.png", planes, {"Y"}, {.type = SampleType::kUint8}));
  expect_refused(65, {"mask says nothing", "mask.png", "30 percent of white", "paint white"});
  fs::copy_file(folder_ / "mask.png", folder_ / "Mask.png");
  expect_refused(65, {"several masks", "Mask.png and mask.png", "leave the one"});
}

TEST_F(BadPhotographs, BlackAndWhiteOnesAreNoSuccess) {
  PhotographSample sample;
  sample.ending = ".png";
  sample.type = SampleType::kUint16;
  for (const auto& [value, words] :
       {std::pair<float, std::vector<std::string>>{0, {"nothing was solved", "100 percent dark", "longer"}},
        {1, {"nothing was solved", "100 percent of the readings are full", "shorter exposure"}}}) {
    write(sample);
    Image<float> blank(sample.size, 3);
    for (int p = 0; p < 3; ++p) {
      for (int y = 0; y < 30; ++y) std::fill_n(blank.plane(p).row(y), 40, value);
    }
    const std::array<View<const float>, 3> planes = {blank.plane(0), blank.plane(1), blank.plane(2)};
    for (std::size_t k = 0; k < sample.lights.size(); ++k) {
      ASSERT_TRUE(
          write_image(folder_ / sample.name_of(k), planes, {"R", "G", "B"}, {.type = SampleType::kUint16}));
      // Files of one digest would be refused as that.
      const fs::path file = folder_ / sample.name_of(k);
      put_bytes(file, bytes_of(file) + std::string(k, ' '));
    }
    expect_refused(65, words);
  }
}

TEST_F(BadPhotographs, OfTwoKindsAreEachTakenByTheirOwn) {
  PhotographSample deep;
  deep.ending = ".png";
  deep.type = SampleType::kUint16;
  write(deep);
  Result<LoadedImage> linear = read_image(folder_ / "01.png");
  ASSERT_TRUE(linear) << linear.error().message();
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) {
        const double v = linear->planes(x, y, p);
        linear->planes(x, y, p) =
            static_cast<float>(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
      }
    }
  }
  const std::array<View<const float>, 3> planes = {linear->planes.plane(0), linear->planes.plane(1),
                                                   linear->planes.plane(2)};
  ASSERT_TRUE(write_image(folder_ / "01.png", planes, {"R", "G", "B"}, {.type = SampleType::kUint8}));
  const fs::path maps = work_ / "maps";
  const Outcome run = run_weft({"solve", "--photos", folder_.string(), "-o", maps.string(), "--no-previews"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.output.find("1 of 8 bits, taken as sRGB"), std::string::npos) << run.output;
  const Json compared = run_weft({"compare", (maps / "normal.exr").string(),
                                  (folder_ / "normal_gt.exr").string(), "--json", "--quiet"})
                            .json();
  EXPECT_LT(compared["mean_deg"], 0.2) << "one photograph of six in 8 bits";
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

TEST_F(BadPhotographs, ALightFileWithAnotherCountOrNoneIsReadAndTold) {
  const PhotographSample sample;
  write(sample);
  std::string lines;
  for (std::size_t k = 0; k < sample.lights.size(); ++k) {
    const Vec3 l = sample.lights[k].direction;
    lines += fmt::format("C:\\rti\\{} {} {} {}\n", sample.name_of(k), l.x, l.y, l.z);
  }
  for (const auto& [count, said] : {std::pair("7\n", "it announces 7 photographs and lists 6"),
                                    {"", "the first line has no count: 6 lights are listed"}}) {
    put_bytes(folder_ / "lights.lp", count + lines);
    const fs::path maps = work_ / said;
    const Outcome run =
        run_weft({"solve", "--lp", "lights.lp", "-o", maps.string(), "--no-previews"}, {.folder = folder_});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_NE(run.output.find(said), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("names are of another folder"), std::string::npos) << run.output;
    const Json assumed = Json::parse(bytes_of(maps / "solve.json"))["assumed"];
    ASSERT_EQ(assumed.size(), 3U) << assumed;
    EXPECT_EQ(assumed[0], said);
  }
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

TEST_F(BadPhotographs, ANumberThatIsNotReadWholeIsRefusedWithItsLine) {
  write({});
  struct Case {
    const char *number, *why;
  };
  for (const Case& each :
       {Case{"2,68", "decimal comma"}, Case{"1e400", "beyond"}, Case{"nan", "no finite number"},
        Case{"0x10", "no number"}, Case{"1.5abc", "no number"}}) {
    const std::string number = each.number;
    expect_light_file_refused("3\n01.exr 0 0 1\n02.exr 0 1 " + number + "\n03.exr 1 0 1\n", 65,
                              {"lights.lp", "line 3", number, each.why, "with a point"});
  }
  put_bytes(folder_ / "light_intensities.txt", "1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1e400\n");
  expect_refused(65, {"light_intensities.txt", "line 6", "1e400", "beyond"});
  put_bytes(folder_ / "light_directions.txt", "0 0 1\n2,68 1 1\n1 0 1\n0 0 1\n0 1 1\n1 1 1\n");
  expect_refused(65, {"light_directions.txt", "line 2", "2,68", "decimal comma"});
}

TEST_F(BadPhotographs, ACountThatIsNoneIsNamed) {
  write({});
  for (const std::string count : {"-1", "3.0", "3 lights"})
    expect_light_file_refused(count + "\n01.exr 0 0 1\n02.exr 0 1 1\n03.exr 1 0 1\n", 65,
                              {"lights.lp", "first line is not the number of photographs", count});
}

// What CLI11 reads by itself as far as it goes.
TEST_F(BadPhotographs, AnOptionsNumberIsReadWhole) {
  write({});
  for (const char* number : {"2,5", "nan", "0x10", "1e400"})
    expect_refusal(work_, {"solve", "--photos", folder_.string(), "--to", number, "--quiet"}, 64,
                   {"--to", number}, {.folder = work_.path()});
  for (const char* number : {"0x10", "64abc"})
    expect_refusal(work_, {"solve", "--photos", folder_.string(), "--tile-width", number, "--quiet"}, 64,
                   {"--tile-width", number}, {.folder = work_.path()});
}

}  // namespace
}  // namespace weft::test
