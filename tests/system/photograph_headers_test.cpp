// SPDX-License-Identifier: Apache-2.0
// What files of photographs say of themselves, and what is made of it when they are solved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"
#include "core/image_io/linear_image.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

void put_number(std::string& bytes, std::uint32_t value, int size, bool big_endian = false) {
  for (int i = 0; i < size; ++i) {
    const int byte = big_endian ? size - 1 - i : i;
    bytes.push_back(static_cast<char>(value >> (8 * byte) & 255));
  }
}

// EXIF as a TIFF of one directory: Orientation, and ExposureTime where there is one.
std::string exif_of(int orientation, std::uint32_t exposure_below = 0) {
  const bool has_time = exposure_below > 0;
  std::string exif("II*\0\x08\0\0\0", 8);
  put_number(exif, has_time ? 2 : 1, 2);
  const auto field = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t value) {
    put_number(exif, tag, 2);
    put_number(exif, type, 2);
    put_number(exif, 1, 4);
    put_number(exif, value, 4);
  };
  field(274, 3, static_cast<std::uint32_t>(orientation));
  if (has_time) field(33434, 5, 8 + 2 + 2 * 12 + 4);
  put_number(exif, 0, 4);
  if (has_time) {
    put_number(exif, 1, 4);
    put_number(exif, exposure_below, 4);
  }
  return exif;
}

// A PNG with a chunk eXIf behind its header, whose sum nobody looks at.
void add_exif(const fs::path& file, const std::string& exif) {
  const std::string png = bytes_of(file);
  const std::size_t behind_header = 8 + 25;
  std::string chunk;
  put_number(chunk, static_cast<std::uint32_t>(exif.size()), 4, true);
  chunk += "eXIf" + exif + std::string(4, 0);
  put_bytes(file, png.substr(0, behind_header) + chunk + png.substr(behind_header));
}

class PhotographHeaders : public testing::Test {
 protected:
  PhotographHeaders() {
    sample_.ending = ".png";
    sample_.type = SampleType::kUint16;
    sample_.write(folder_);
  }

  fs::path photograph(std::size_t light) const { return folder_ / sample_.name_of(light); }

  // Changes the pixels of a photograph.
  template <typename Change>
  void change(std::size_t light, const Change& to) const {
    Result<LoadedImage> read = read_image(photograph(light));
    ASSERT_TRUE(read) << read.error().message();
    const Image<float> image = to(std::move(read->planes));
    const std::array<View<const float>, 3> planes = {image.plane(0), image.plane(1), image.plane(2)};
    ASSERT_TRUE(write_image(photograph(light), planes, {"R", "G", "B"}, {.type = SampleType::kUint16}));
  }

  Outcome solve(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"solve", "--photos",     folder_.string(),
                                          "-o",    maps_.string(), "--no-previews"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_weft(arguments);
  }
  double degrees() const {
    const Outcome run = run_weft({"compare", (maps_ / "normal.exr").string(),
                                  (folder_ / "normal_gt.exr").string(), "--json", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.exit_code == 0 ? run.json()["mean_deg"].get<double>() : 180;
  }
  void expect_refused(const std::vector<std::string>& words,
                      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"solve", "--photos", folder_.string(), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_refusal(work_, arguments, 65, words, {.folder = work_.path()});
  }

  Workspace work_;
  const fs::path folder_ = work_ / "photos", maps_ = work_ / "maps";
  PhotographSample sample_;
};

TEST_F(PhotographHeaders, StoredBottomUpTheyAreSolvedAsTheyAreShown) {
  for (std::size_t k = 0; k < 6; ++k) {
    change(k, [](Image<float> image) { return as_shown(std::move(image), 4); });
    add_exif(photograph(k), exif_of(4));
  }
  const Outcome run = solve();
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_LT(degrees(), 0.01);
  EXPECT_NE(run.output.find("orientation 4: mirrored top to bottom"), std::string::npos) << run.output;
}

TEST_F(PhotographHeaders, AMaskIsTurnedByItsOwn) {
  // The upper third is cloth, stored at the bottom of a mask that is to be shown mirrored.
  Image<float> mask({40, 30});
  for (int y = 20; y < 30; ++y) std::fill_n(mask.plane().row(y), 40, 1.0F);
  const std::array<View<const float>, 1> planes = {mask.plane()};
  ASSERT_TRUE(write_image(folder_ / "mask.png", planes, {"Y"}, {.type = SampleType::kUint8}));
  add_exif(folder_ / "mask.png", exif_of(4));
  const auto solved_at = [&](int row) {
    const Outcome run = solve();
    EXPECT_EQ(run.exit_code, 0) << run.error;
    const Result<LoadedImage> albedo = read_image(maps_ / "albedo.exr");
    return albedo && albedo->channel("R")(20, row) > 0;
  };
  EXPECT_TRUE(solved_at(5)) << "the upper third, as it is shown";
  EXPECT_FALSE(solved_at(25));
}

TEST_F(PhotographHeaders, OfOneThatIsToBeShownTurnedThePersonDecides) {
  add_exif(photograph(2), exif_of(6));
  expect_refused(
      {"photographs differ in orientation", "03.png", "turned right by a quarter", "--orientation"});
  const Outcome run = solve({"--orientation", "stored"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_LT(degrees(), 0.01);
}

TEST_F(PhotographHeaders, ExposuresThatDifferAreDividedOut) {
  for (std::size_t k = 0; k < 6; ++k) sample_.lights[k].irradiance_rgb = {1, 1, 1};
  sample_.write(folder_);
  fs::remove(folder_ / "light_intensities.txt");
  for (std::size_t k = 0; k < 6; ++k) {
    const double share = k % 2 == 0 ? 1 : 0.5;
    change(k, [&](Image<float> image) {
      scale(image, share);
      return image;
    });
    add_exif(photograph(k), exif_of(1, k % 2 == 0 ? 30 : 60));
  }
  const Outcome run = solve();
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_LT(degrees(), 0.02);
  EXPECT_NE(run.output.find("each photograph is divided by its own"), std::string::npos) << run.output;
}

TEST_F(PhotographHeaders, OneFileUnderTwoLightsIsRefused) {
  fs::copy_file(photograph(1), photograph(4), fs::copy_options::overwrite_existing);
  expect_refused({"one photograph is under two lights", "05.png", "02.png", "--lights"});
}

TEST_F(PhotographHeaders, LightsBelowTheTableAreRefusedAndTurnedWhenAskedTo) {
  for (DistantLight& light : sample_.lights) light.direction.z = -light.direction.z;
  const PhotographSample truth;
  sample_.write(folder_);
  for (std::size_t k = 0; k < 6; ++k) {
    PhotographSample upright = truth;
    upright.ending = ".png";
    upright.type = SampleType::kUint16;
    upright.write(work_ / "upright");
    fs::copy_file(work_ / "upright" / upright.name_of(k), photograph(k),
                  fs::copy_options::overwrite_existing);
  }
  expect_refused({"lights lie below the table", "z is negative in all", "--flip z"});
  ASSERT_EQ(solve({"--flip", "z"}).exit_code, 0);
  EXPECT_LT(degrees(), 0.01);
}

TEST_F(PhotographHeaders, ADarkPhotographIsTakenFromTheOthers) {
  const auto lit_by_the_room = [](Image<float> image) {
    brighten(image, 0.05);
    return image;
  };
  for (std::size_t k = 0; k < 6; ++k) change(k, lit_by_the_room);
  Image<float> dark(sample_.size, 3);
  brighten(dark, 0.05);
  const std::array<View<const float>, 3> planes = {dark.plane(0), dark.plane(1), dark.plane(2)};
  ASSERT_TRUE(write_image(work_ / "off.png", planes, {"R", "G", "B"}, {.type = SampleType::kUint16}));
  ASSERT_EQ(solve({"--dark", (work_ / "off.png").string()}).exit_code, 0);
  EXPECT_LT(degrees(), 0.02);
  fs::remove_all(maps_);
  ASSERT_EQ(solve({"--ambient", "0.05"}).exit_code, 0);
  EXPECT_LT(degrees(), 0.02);
}

// Waves that cross each other aslant, so that no flip of an axis is a surface too: the height in pixels is
// 1.5 sin(x/5 + y/9) + 1.2 cos(y/6 - x/14), y downwards.
TEST_F(PhotographHeaders, LightsWhoseYPointsDownAreDoubtedAndFlipped) {
  sample_.size = {160, 120};
  sample_.write(folder_);
  Image<float> truth(sample_.size, 3);
  std::string directions;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 light = sample_.lights[k].direction;
    directions += fmt::format("{} {} {}\n", light.x, -light.y, light.z);
    change(k, [&](Image<float> image) {
      for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
          const double a = std::cos(x / 5.0 + y / 9.0), b = std::sin(y / 6.0 - x / 14.0);
          const Vec3 normal = normalized({-0.3 * a - 1.2 / 14 * b, 1.5 / 9 * a - 0.2 * b, 1});
          for (int c = 0; c < 3; ++c) {
            truth(x, y, c) = static_cast<float>(c == 0 ? normal.x : c == 1 ? normal.y : normal.z);
            image(x, y, c) = static_cast<float>(0.5 * std::max(0.0, dot(normal, light)));
          }
        }
      }
      return image;
    });
  }
  const std::array<View<const float>, 3> planes = {truth.plane(0), truth.plane(1), truth.plane(2)};
  ASSERT_TRUE(write_image(folder_ / "normal_gt.exr", planes, {"X", "Y", "Z"}, {}));
  fs::remove(folder_ / "light_intensities.txt");
  put_bytes(folder_ / "light_directions.txt", directions);
  const Outcome doubted = solve();
  ASSERT_EQ(doubted.exit_code, 0) << doubted.error;
  EXPECT_NE(doubted.error.find("The lights are mirrored"), std::string::npos) << doubted.error;
  EXPECT_NE(doubted.error.find("--flip y"), std::string::npos) << doubted.error;
  EXPECT_GT(degrees(), 10);
  fs::remove_all(maps_);
  const Outcome flipped = solve({"--flip", "y"});
  ASSERT_EQ(flipped.exit_code, 0) << flipped.error;
  EXPECT_LT(degrees(), 0.01);
  EXPECT_EQ(flipped.error.find("mirrored"), std::string::npos) << flipped.error;
}

TEST_F(PhotographHeaders, LinearValuesOfEightBitsAreTakenAsLinearWhereThatIsSure) {
  sample_.size = {160, 120};
  sample_.type = SampleType::kUint8;
  sample_.write(folder_);
  const Outcome run = solve();
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.output.find("values are linear, since left-out light"), std::string::npos) << run.output;
  EXPECT_LT(degrees(), 0.5);
}

TEST_F(PhotographHeaders, ValuesThatStopBelowFullScaleAreClipped) {
  sample_.size = {160, 120};
  sample_.write(folder_);
  float full = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    const Result<LoadedImage> read = read_image(photograph(k));
    ASSERT_TRUE(read) << read.error().message();
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) full = std::max(full, 0.9F * read->planes(x, y, 1));
    }
  }
  const auto clip = [full](Image<float> image) {
    for (int p = 0; p < image.planes(); ++p) {
      for (int y = 0; y < image.height(); ++y) {
        float* row = image.plane(p).row(y);
        std::transform(row, row + image.width(), row, [full](float v) { return std::min(v, full); });
      }
    }
    return image;
  };
  for (std::size_t k = 0; k < 6; ++k) change(k, clip);
  const Outcome run = solve();
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.output.find("of the files' full scale is taken as clipped"), std::string::npos) << run.output;
  EXPECT_LT(degrees(), 0.05);
}

TEST_F(PhotographHeaders, LookSaysWhatAFileMeans) {
  add_exif(photograph(0), exif_of(6, 60));
  const Outcome run = run_weft({"look", photograph(0).string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json picture = run.json()["pictures"][0];
  EXPECT_EQ(picture["transfer"], "linear");
  EXPECT_EQ(picture["transfer_by"], "");
  EXPECT_EQ(picture["orientation"], 6);
  EXPECT_NEAR(picture["exposure_us"].get<double>(), 1e6 / 60, 1);
  EXPECT_TRUE(picture["unfit"].is_null());
  const Outcome map = run_weft({"look", (folder_ / "normal_gt.exr").string(), "--json"});
  ASSERT_EQ(map.exit_code, 0) << map.error;
  EXPECT_EQ(map.json()["pictures"][0]["holds"],
            (std::vector<std::string>{"normal.x", "normal.y", "normal.z"}));
  EXPECT_FALSE(map.json()["pictures"][0]["unfit"].is_null());
}

TEST_F(PhotographHeaders, LookHasALineForEachPictureOfAFolder) {
  put_bytes(folder_ / "half.png", "\x89PNG");
  put_bytes(folder_ / "notes.txt", "no picture");
  const Outcome run = run_weft({"look", folder_.string()});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.output.find("01.png         40 x 30, 16 bits of R, G, B; linear"), std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find("half.png       cannot be read: "), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("notes"), std::string::npos) << run.output;
  const Json pictures = run_weft({"look", folder_.string(), "--json"}).json()["pictures"];
  EXPECT_EQ(std::ranges::count(run.output, '\n'), static_cast<std::ptrdiff_t>(pictures.size()));
  fs::create_directories(work_ / "none");
  expect_refusal(work_, {"look", (work_ / "none").string()}, 66, {"there are no pictures"});
}

// Waves under six lamps 120 to 160 mm from the middle of 160 x 120 mm, and a list of their places.
struct NearSample {
  static constexpr double kMmPerPixel = 1;
  Size size = {160, 120};
  std::vector<Vec3> lamps = {{90, 10, 90},    {30, 85, 95},   {-70, 60, 90},
                             {-85, -40, 100}, {-10, -90, 85}, {65, -60, 110}};

  static Vec3 normal_at(int x, int y) {
    return normalized({-0.3 * std::cos(x / 7.0 + y / 11.0), 0.25 * std::sin(y / 6.0 - x / 13.0), 1});
  }
  void write(const fs::path& folder) const {
    fs::create_directories(folder);
    std::string list = std::to_string(lamps.size()) + "\n";
    Image<float> truth(size, 3);
    for (std::size_t k = 0; k < lamps.size(); ++k) {
      Image<float> photograph(size, 3);
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          const Vec3 at = {kMmPerPixel * (x - (size.width - 1) / 2.0),
                           kMmPerPixel * ((size.height - 1) / 2.0 - y), 0};
          const Vec3 away = lamps[k] - at, normal = normal_at(x, y);
          const double reach = length(lamps[k]) / length(away);
          const double light = std::max(0.0, dot(normal, normalized(away))) * reach * reach;
          const std::array<double, 3> albedo = {0.3, 0.25 + 0.05 * std::sin(x / 3.0), 0.2};
          for (int c = 0; c < 3; ++c) {
            photograph(x, y, c) = static_cast<float>(albedo[static_cast<std::size_t>(c)] * light);
            truth(x, y, c) = static_cast<float>(c == 0 ? normal.x : c == 1 ? normal.y : normal.z);
          }
        }
      }
      const std::string name = "lamp" + std::to_string(k) + ".exr";
      write_planes(folder / name, photograph, {"R", "G", "B"});
      list += name + " " + std::to_string(lamps[k].x) + " " + std::to_string(lamps[k].y) + " " +
              std::to_string(lamps[k].z) + "\n";
    }
    write_planes(folder / "truth.exr", truth, {"X", "Y", "Z"});
    put_bytes(folder / "lamps.lp", list);
  }
  static void write_planes(const fs::path& file, const Image<float>& image,
                           const std::vector<std::string>& names) {
    const std::array<View<const float>, 3> planes = {image.plane(0), image.plane(1), image.plane(2)};
    ASSERT_TRUE(write_image(file, planes, names, {}));
  }
};

TEST(NearPhotographs, LampsInMillimetresAreSolvedAsNearOnesAndToldOfWhereTheyAreNot) {
  const Workspace work;
  const NearSample sample;
  sample.write(work / "photos");
  const auto solve = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"solve",         "--lp", (work / "photos/lamps.lp").string(),
                                          "--no-previews", "-o",   (work / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_weft(arguments);
  };
  const auto degrees = [&](const std::string& name) {
    const Outcome run = run_weft({"compare", (work / name / "normal.exr").string(),
                                  (work / "photos/truth.exr").string(), "--json", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.exit_code == 0 ? run.json()["mean_deg"].get<double>() : 180;
  };
  const Outcome near = solve("near", {"--mm-per-pixel", "1"});
  ASSERT_EQ(near.exit_code, 0) << near.error;
  EXPECT_LT(degrees("near"), 0.05);
  EXPECT_NE(near.output.find("near lights, in mm"), std::string::npos) << near.output;
  const Outcome distant = solve("distant", {});
  ASSERT_EQ(distant.exit_code, 0) << distant.error;
  EXPECT_GT(degrees("distant"), 2);
  EXPECT_NE(distant.error.find("--mm-per-pixel"), std::string::npos) << distant.error;
}

}  // namespace
}  // namespace weft::test
