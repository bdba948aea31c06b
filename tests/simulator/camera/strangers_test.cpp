// SPDX-License-Identifier: Apache-2.0
// What programs that know nothing of weft read from its DNGs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "simulator/camera/dng_writer.h"
#include "simulator/camera/sensor.h"

namespace weft::simulator {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

constexpr Size kSize = {66, 44};

RawFrame frame() {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      frame.counts(x, y) = static_cast<std::uint16_t>((7919 * x + 104729 * y) % 65536);
  frame.black = {{{600, 600}, {600, 600}}};
  frame.white = 15520;
  frame.shot = {"Weft", "virtual camera", "SN-0042", 1e6 / 60, 400, 8};
  return frame;
}

struct Output {
  std::string bytes;
  int status = 0;
};

Output output_of(const std::string& command) {
  Output output;
  std::FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return {"", -1};
  std::array<char, 4096> part;
  for (std::size_t n; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    output.bytes.append(part.data(), n);
  output.status = WEXITSTATUS(pclose(pipe));
  return output;
}

bool is_installed(const std::string& program) {
  return output_of("command -v " + program).status == 0;
}

class StrangersReadDng : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    write(frame());
  }
  void write(const RawFrame& frame) const {
    DngTags tags;
    tags.date_time_original = "2026:01:31 23:59:58";
    tags.as_shot_neutral = {0.5, 1, 0.625};
    const auto done = write_dng(folder_ / "frame.dng", frame, tags);
    ASSERT_TRUE(done.has_value()) << done.error().message();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file() const { return "'" + (folder_ / "frame.dng").string() + "'"; }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("weft_strangers_" + std::to_string(getpid()));
};

TEST_F(StrangersReadDng, DcrawKnowsTheShot) {
  if (!is_installed("dcraw")) GTEST_SKIP() << "dcraw is not installed";
  const Output info = output_of("TZ=UTC LC_ALL=C dcraw -i -v " + file());
  ASSERT_EQ(info.status, 0);
  EXPECT_THAT(info.bytes, HasSubstr("Camera: Weft virtual camera\n"));
  EXPECT_THAT(info.bytes, HasSubstr("ISO speed: 400\n"));
  EXPECT_THAT(info.bytes, HasSubstr("Shutter: 1/60.0 sec\n"));
  EXPECT_THAT(info.bytes, HasSubstr("Aperture: f/8.0\n"));
  EXPECT_THAT(info.bytes, HasSubstr("DNG Version: 1.4.0.0\n"));
  EXPECT_THAT(info.bytes, HasSubstr("Image size:    66 x 44\n"));
  EXPECT_THAT(info.bytes, HasSubstr("Filter pattern: RG/GB\n"));
  EXPECT_THAT(info.bytes, HasSubstr("Camera multipliers: 2.000000 1.000000 1.600000"));
}

TEST_F(StrangersReadDng, DcrawTakesTheSimulatedNikonForOne) {
  if (!is_installed("dcraw")) GTEST_SKIP() << "dcraw is not installed";
  CameraSettings camera;
  camera.body = Body::kD5100;
  const Sensor sensor = sensor_of(camera);
  RawFrame nikon = frame();
  nikon.black = {};
  nikon.white = static_cast<float>(sensor.white);
  nikon.shot.make = sensor.make;
  nikon.shot.model = sensor.model;
  write(nikon);
  const Output info = output_of("LC_ALL=C dcraw -i -v " + file());
  EXPECT_THAT(info.bytes, HasSubstr("Camera: Nikon D5100\n"));
  EXPECT_THAT(info.bytes, HasSubstr("Image size:    66 x 44\n"));
}

TEST_F(StrangersReadDng, DcrawGivesTheCountsBack) {
  if (!is_installed("dcraw")) GTEST_SKIP() << "dcraw is not installed";
  const Output pgm = output_of("dcraw -D -4 -c " + file());
  ASSERT_EQ(pgm.status, 0);
  const std::string head = "P5\n66 44\n65535\n";
  ASSERT_EQ(pgm.bytes.substr(0, head.size()), head);
  const RawFrame truth = frame();
  ASSERT_EQ(pgm.bytes.size(), head.size() + 2 * static_cast<std::size_t>(kSize.pixels()));
  int differing = 0;
  std::size_t at = head.size();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x, at += 2) {
      const int count =
          static_cast<std::uint8_t>(pgm.bytes[at]) << 8 | static_cast<std::uint8_t>(pgm.bytes[at + 1]);
      differing += count != truth.counts(x, y);
    }
  EXPECT_EQ(differing, 0);
}

TEST_F(StrangersReadDng, Exiv2KnowsEveryTag) {
  if (!is_installed("exiv2")) GTEST_SKIP() << "exiv2 is not installed";
  const Output info = output_of("LC_ALL=C exiv2 -pa " + file());
  ASSERT_EQ(info.status, 0);
  const auto expect_tag = [&info](const std::string& tag, const std::string& value) {
    EXPECT_THAT(info.bytes, ContainsRegex(tag + " +[A-Za-z]+ +[0-9]+ +" + value + "\n"));
  };
  expect_tag("Exif.Image.Make", "Weft");
  expect_tag("Exif.Image.Model", "virtual camera");
  expect_tag("Exif.Image.CameraSerialNumber", "SN-0042");
  expect_tag("Exif.Image.ImageWidth", "66");
  expect_tag("Exif.Image.ImageLength", "44");
  expect_tag("Exif.Image.BlackLevel", "600/1");
  expect_tag("Exif.Image.WhiteLevel", "15520");
  expect_tag("Exif.Image.AsShotNeutral", "1/2 1/1 5/8");
  expect_tag("Exif.Photo.ExposureTime", "1/60 s");
  expect_tag("Exif.Photo.FNumber", "F8");
  expect_tag("Exif.Photo.ISOSpeedRatings", "400");
  expect_tag("Exif.Photo.DateTimeOriginal", "2026:01:31 23:59:58");
}

}  // namespace
}  // namespace weft::simulator
