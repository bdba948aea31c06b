// SPDX-License-Identifier: Apache-2.0
// Disks that fill up, and work that cannot fit and is refused before it starts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFreeDisk = "free disk space";

/// A tmpfs of so many bytes, gone at the end; `mounted()` is false where that is not allowed.
class SmallDisk {
 public:
  SmallDisk(fs::path folder, std::uint64_t bytes) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
    const std::string size = "size=" + std::to_string(bytes);
    mounted_ = mount("tmpfs", folder_.c_str(), "tmpfs", 0, size.c_str()) == 0;
    if (!mounted_) reason_ = std::strerror(errno);
  }
  ~SmallDisk() {
    if (mounted_) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool mounted() const { return mounted_; }
  std::string reason() const { return "a small tmpfs cannot be mounted here: " + reason_; }
  fs::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  fs::path folder_;
  bool mounted_ = false;
  std::string reason_;
};

class NoRoom : public SessionTest {
 protected:
  fs::path write_scene(const simulator::Scene& scene) const {
    put_bytes(work_ / "scene.toml", simulator::to_toml(scene));
    return work_ / "scene.toml";
  }
  static constexpr Size kLarge = {2000, 2000};
  /// Photographs of this size that would take twice the memory that is free.
  static std::size_t too_many() {
    return 2 * available_memory_bytes() / (static_cast<std::uint64_t>(kLarge.pixels()) * 3 * sizeof(float));
  }
  /// A square PNG of grey without its pixels.
  static std::string header_of_png(std::uint32_t side) {
    std::string chunk = "IHDR";
    for (int i = 0; i < 8; ++i) chunk.push_back(static_cast<char>(side >> (24 - 8 * (i % 4)) & 255));
    chunk += std::string("\x08\0\0\0\0", 5);
    std::uint32_t sum = 0xffffffff;  // PNG, third edition, annex D
    for (const char c : chunk) {
      sum ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) sum = (sum & 1) != 0 ? 0xedb88320 ^ sum >> 1 : sum >> 1;
    }
    for (int i = 3; i >= 0; --i) chunk.push_back(static_cast<char>(~sum >> (8 * i) & 255));
    return "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\r", 4) + chunk +
           std::string("\0\0\0\0IDAT\0\0\0\0\0\0\0\0IEND\xae\x42\x60\x82", 24);
  }
  static void write_large(const fs::path& file) {
    const Image<float> grey(kLarge);
    const std::array<View<const float>, 1> planes = {grey.plane()};
    ASSERT_TRUE(write_image(file, planes, {"Y"}, {.type = SampleType::kUint16}));
  }
};

TEST_F(NoRoom, AMapThatCannotGrowEndsASolve) {
  for (const std::uint64_t bytes : {1024U, 16000U}) {
    SCOPED_TRACE(bytes);
    expect_refusal(work_, {"solve", session_.string(), "-q"}, 74,
                   {"cannot write", session_.string(), ".exr: File too large", kFreeDisk},
                   {.largest_file_bytes = bytes});
  }
}

TEST_F(NoRoom, APictureThatCannotGrowEndsASolve) {
  PhotographSample sample;
  sample.size = {8, 8};
  sample.write(work_ / "photos");
  expect_refusal(work_, {"solve", "--photos", (work_ / "photos").string(), "-q"}, 74,
                 {"cannot write", "photos-solve", "sheet.png", "File too large", kFreeDisk},
                 {.folder = work_.path(), .largest_file_bytes = 4096});
}

TEST_F(NoRoom, AFileThatCannotGrowEndsASimulation) {
  const fs::path scene = write_scene(scene_named("golden", {48, 32}));
  for (const auto& [bytes, file] : {std::pair{4096U, "lights.json"}, std::pair{10000U, "truth"}}) {
    SCOPED_TRACE(bytes);
    expect_refusal(work_, {"simulate", scene.string(), "-o", (work_ / "new.weft").string(), "-q"}, 74,
                   {"cannot write", "new.weft", file, "File too large", kFreeDisk},
                   {.largest_file_bytes = bytes});
  }
}

TEST_F(NoRoom, ADiskTooSmallForTheMapsIsSeenBeforeSolving) {
  const SmallDisk disk(work_ / "disk", 40000);
  if (!disk.mounted()) GTEST_SKIP() << disk.reason();
  expect_refusal(work_, {"solve", session_.string(), "-o", (disk / "maps").string()}, 74,
                 {"not enough disk space", "disk", "are free", kFreeDisk});
}

TEST_F(NoRoom, ADiskThatFillsUpEndsASolve) {
  // 56 bytes a pixel are asked for and given; the pictures and the header of each file need more.
  const SmallDisk disk(work_ / "disk", 48 * 32 * 56 + 8192);
  if (!disk.mounted()) GTEST_SKIP() << disk.reason();
  expect_refusal(work_, {"solve", session_.string(), "-o", (disk / "maps").string(), "-q"}, 74,
                 {"cannot write", "disk", "No space left", kFreeDisk});
}

TEST_F(NoRoom, ADiskTooSmallForTheSessionIsSeenBeforeSimulating) {
  const SmallDisk disk(work_ / "disk", 40000);
  if (!disk.mounted()) GTEST_SKIP() << disk.reason();
  const fs::path scene = write_scene(scene_named("golden", {48, 32}));
  expect_refusal(work_, {"simulate", scene.string(), "-o", (disk / "new.weft").string()}, 74,
                 {"no room for the session", "new.weft", "are free", kFreeDisk});
}

TEST_F(NoRoom, ADiskThatFillsUpEndsASimulation) {
  const SmallDisk disk(work_ / "disk", 48 * 32 * (28 + 11 * 2) + 8192);
  if (!disk.mounted()) GTEST_SKIP() << disk.reason();
  const fs::path scene = write_scene(scene_named("golden", {48, 32}));
  expect_refusal(work_, {"simulate", scene.string(), "-o", (disk / "new.weft").string(), "-q"}, 74,
                 {"cannot write", "new.weft", "No space left", kFreeDisk});
}

TEST_F(NoRoom, ASessionLargerThanTheDiskIsSeenBeforeSimulating) {
  simulator::Scene scene = scene_named("golden", {20000, 20000});
  scene.lights.rings = {{.count = 256, .zenith_deg = 40}};
  const auto pixels =
      static_cast<std::uint64_t>(scene.camera.width) * static_cast<std::uint64_t>(scene.camera.height);
  if (free_disk_bytes(work_.path()) > pixels * 257 * 2)
    GTEST_SKIP() << "the disk is large enough for any session";
  expect_refusal(work_, {"simulate", write_scene(scene).string(), "-o", (work_ / "new.weft").string()}, 74,
                 {"no room for the session", "new.weft", "are needed", kFreeDisk});
}

TEST_F(NoRoom, MorePhotographsThanTheMemoryIsSeenBeforeReadingThem) {
  // Two threads hold six photographs of 12 bytes a pixel; their maps take fewer bytes of the disk.
  const double pixels = 1.3 * static_cast<double>(available_memory_bytes()) / 72;
  if (static_cast<double>(fs::space(work_.path()).available) < 60 * pixels)
    GTEST_SKIP() << "the disk here has less room than the memory, and is asked first";
  const std::string header = header_of_png(static_cast<std::uint32_t>(std::sqrt(pixels)));
  std::string text = "4\n";
  for (int k = 0; k < 4; ++k) {
    const std::string name = "large" + std::to_string(k) + ".png";
    put_bytes(work_ / name, header + std::string(static_cast<std::size_t>(k), ' '));
    text += name + " " + std::to_string(k % 3) + " " + std::to_string(k % 2) + " 1\n";
  }
  put_bytes(work_ / "lights.lp", text);
  expect_refusal(work_, {"solve", "--lp", (work_ / "lights.lp").string(), "--threads", "2"}, 75,
                 {"not enough memory", "MB are needed", "MB are free", "fewer or smaller"},
                 {.folder = work_.path()});
}

TEST_F(NoRoom, MoreFramesThanTheMemoryIsSeenBeforeReadingThem) {
  Result<Calibration> calibration = read_calibration(session_ / "calibration");
  ASSERT_TRUE(calibration) << calibration.error().message();
  calibration->camera->size = kLarge;
  auto& leds = std::get<NearLights>(*calibration->lights).leds;
  const std::size_t count = too_many();
  leds.resize(count, leds.front());
  fs::remove_all(session_ / "calibration");
  calibration = write_calibration(session_ / "calibration", *calibration);
  ASSERT_TRUE(calibration) << calibration.error().message();

  Result<Session> session = read_session(session_);
  ASSERT_TRUE(session) << session.error().message();
  session->calibration_id = calibration->id;
  Shot shot = session->shots.front();
  shot.file = "raw/large.png";
  shot.sha256.clear();
  write_large(session_ / shot.file);
  session->shots.assign(count, shot);
  for (std::size_t k = 0; k < count; ++k) session->shots[k].led = static_cast<int>(k) + 1;
  ASSERT_TRUE(write_session(*session));
  expect_solve_refused(
      75, {"not enough memory", session_.string(), "MB are needed", "MB are free", "close other"});
}

}  // namespace
}  // namespace weft::test
