// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/dng_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "capture/raw/decode_raw.h"
#include "capture/raw/tiff_tags.h"

namespace weft::simulator {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

RawFrame sample_frame(Size size) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      frame.counts(x, y) = static_cast<std::uint16_t>((7919 * x + 104729 * y) % 65536);
  frame.black = {{{600, 600}, {600, 600}}};
  frame.white = 15520;
  frame.shot = {"Lumitex", "Virtual D5100", "SN-0042", 1e6 / 60, 100, 8};
  return frame;
}

/// A file in a folder of this process alone, which goes with it.
std::filesystem::path temp_file(const std::string& name) {
  struct Folder {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / ("weft_dng_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
  };
  static const Folder folder;
  return folder.path / name;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::filesystem::path written_file(const RawFrame& frame, const DngTags& tags = {}) {
  const auto file = temp_file("written.dng");
  const auto done = write_dng(file, frame, tags);
  EXPECT_TRUE(done.has_value()) << done.error().message();
  return file;
}

std::string written(const RawFrame& frame, const DngTags& tags = {}) {
  return bytes_of(written_file(frame, tags));
}

/// A frame as the product gets it back from LibRaw.
RawFrame decoded(const RawFrame& frame, const DngTags& tags = {}) {
  auto result = capture::decode_raw(written_file(frame, tags));
  if (result) return std::move(*result);
  ADD_FAILURE() << result.error().message();
  return {};
}

TEST(Dng, ReadsBackEveryCountThroughLibRaw) {
  for (const Size size : {Size{22, 22}, Size{23, 29}, Size{127, 61}, Size{640, 480}}) {
    const RawFrame frame = sample_frame(size), back = decoded(frame);
    ASSERT_EQ(back.counts.size(), size);
    int differing = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) differing += back.counts(x, y) != frame.counts(x, y);
    EXPECT_EQ(differing, 0) << size.width << " x " << size.height;
  }
}

TEST(Dng, EndsWithTheCountsOfFramesTooSmallForLibRaw) {
  for (const Size size : {Size{1, 1}, Size{2, 2}, Size{3, 5}}) {
    const RawFrame frame = sample_frame(size);
    const std::string bytes = written(frame);
    const std::size_t count_bytes = 2 * static_cast<std::size_t>(size.pixels());
    ASSERT_GT(bytes.size(), count_bytes);
    std::size_t at = bytes.size() - count_bytes;
    EXPECT_EQ(at % 16, 0u);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x, at += 2) {
        std::uint16_t count = 0;
        std::memcpy(&count, bytes.data() + at, 2);
        EXPECT_EQ(count, frame.counts(x, y)) << "at " << x << ", " << y << " of " << size.width;
      }
  }
}

TEST(Dng, KeepsEveryBayerCellAndBothGreensApart) {
  const CfaPattern rggb;
  for (const int dy : {0, 1})
    for (const int dx : {0, 1}) {
      RawFrame frame = sample_frame({24, 24});
      for (const int y : {0, 1})
        for (const int x : {0, 1})
          frame.cfa.site[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
              rggb.site_at(x + dx, y + dy);
      EXPECT_EQ(decoded(frame).cfa, frame.cfa) << "red at " << dx << ", " << dy;
    }
}

TEST(Dng, StoresOneBlackLevelOrFourAndTheWhiteLevel) {
  RawFrame frame = sample_frame({24, 24});
  EXPECT_EQ(decoded(frame).black, frame.black);
  frame.black = {{{600, 601.5f}, {602.25f, 603.7f}}};
  frame.white = 65535;
  EXPECT_EQ(decoded(frame).black, frame.black);
  EXPECT_EQ(decoded(frame).white, 65535);
}

TEST(Dng, StoresWhatCameraTookTheShotAndHow) {
  RawFrame frame = sample_frame({24, 24});
  frame.shot.focal_mm = 35;
  const ShotMetadata shot = decoded(frame).shot;
  EXPECT_EQ(shot.make, "Lumitex");
  EXPECT_EQ(shot.model, "Virtual D5100");
  EXPECT_EQ(shot.serial, "SN-0042");
  EXPECT_NEAR(shot.exposure_us, 1e6 / 60, 1e-6 * 1e6 / 60);
  EXPECT_EQ(shot.iso, 100);
  EXPECT_EQ(shot.f_number, 8);
  EXPECT_EQ(shot.focal_mm, 35);

  RawFrame silent = sample_frame({24, 24});
  silent.shot = {"Lumitex", "Virtual D5100", "", 0, 0, 0};
  const ShotMetadata nothing = decoded(silent).shot;
  EXPECT_EQ(nothing.serial, "");
  EXPECT_EQ(nothing.exposure_us, 0);
  EXPECT_EQ(nothing.iso, 0);
  EXPECT_EQ(nothing.f_number, 0);
  EXPECT_EQ(nothing.focal_mm, 0);
}

TEST(Dng, HasTheSameBytesInMemory) {
  const RawFrame frame = sample_frame({23, 29});
  const Result<std::vector<std::uint8_t>> bytes = dng_bytes(frame);
  ASSERT_TRUE(bytes) << bytes.error().message();
  EXPECT_EQ(std::string(bytes->begin(), bytes->end()), written(frame));
  RawFrame nameless = sample_frame({24, 24});
  nameless.shot.make.clear();
  EXPECT_EQ(dng_bytes(nameless).error().kind, ErrorKind::kUsage);
}

TEST(Dng, StoresTheCountOfShotsAndTheMillisecondOnlyWhereTheyAreGiven) {
  DngTags tags;
  tags.date_time_original = "2026:01:31 23:59:58";
  tags.milliseconds = 42;
  tags.image_number = 0x01020304;
  const std::string number = {'\x11', '\x92', 4, 0, 1, 0, 0, 0, 4, 3, 2, 1};              // 0x9211, one LONG
  const std::string milliseconds = {'\x91', '\x92', 2, 0, 4, 0, 0, 0, '0', '4', '2', 0};  // 0x9291, ASCII
  const std::string bytes = written(sample_frame({24, 24}), tags);
  EXPECT_THAT(bytes, HasSubstr(number));
  EXPECT_THAT(bytes, HasSubstr(milliseconds));
  EXPECT_EQ(decoded(sample_frame({24, 24}), tags).counts(7, 7), sample_frame({24, 24}).counts(7, 7));
  const std::string silent = written(sample_frame({24, 24}));
  EXPECT_THAT(silent, testing::Not(HasSubstr(number.substr(0, 4))));
  EXPECT_THAT(silent, testing::Not(HasSubstr(milliseconds.substr(0, 4))));
  tags.milliseconds = 1000;
  EXPECT_FALSE(dng_bytes(sample_frame({24, 24}), tags));
}

TEST(Dng, StoresColorAndDateAsTheyAreGiven) {
  DngTags tags;
  tags.date_time_original = "2026:01:31 23:59:58";
  tags.as_shot_neutral = {0.5, 1, 0.6249};
  const std::string bytes = written(sample_frame({24, 24}), tags);
  EXPECT_THAT(bytes, HasSubstr(tags.date_time_original));
  EXPECT_THAT(written(sample_frame({24, 24})), testing::Not(HasSubstr("2026")));

  const auto tiff = capture::Tiff::read([&bytes](std::uint64_t offset, std::span<std::uint8_t> out) {
    return bytes.copy(reinterpret_cast<char*>(out.data()), out.size(), offset) == out.size();
  });
  ASSERT_TRUE(tiff.has_value());
  const capture::TiffDirectory& directory = tiff->directories()[0];
  EXPECT_THAT(tiff->numbers(directory, 50721), Pointwise(DoubleNear(2e-9), tags.camera_from_xyz));
  EXPECT_THAT(tiff->numbers(directory, 50728), Pointwise(DoubleNear(2e-9), tags.as_shot_neutral));
  EXPECT_EQ(tiff->number(directory, 50778), 21) << "D65";
  EXPECT_EQ(tiff->text(directory, 50708), "Lumitex Virtual D5100");
  EXPECT_THAT(tiff->numbers(directory, 50706), ElementsAre(1, 4, 0, 0));
}

TEST(Dng, ListsItsTagsInRisingOrder) {
  const std::string bytes = written(sample_frame({24, 24}));
  const auto word = [&bytes](std::size_t at) {
    return std::uint8_t(bytes[at]) | std::uint8_t(bytes[at + 1]) << 8;
  };
  const int tags = word(8);
  ASSERT_GT(tags, 20);
  for (int i = 1; i < tags; ++i) {
    const std::size_t at = 10 + 12 * static_cast<std::size_t>(i);
    EXPECT_LT(word(at - 12), word(at)) << "tag " << i;
  }
}

TEST(Dng, StoresAnExposureAsTheFractionAPersonKnows) {
  for (const std::uint32_t denominator : {1u, 3u, 60u, 4000u, 8000u}) {
    RawFrame frame = sample_frame({24, 24});
    frame.shot.exposure_us = 1e6 / denominator;
    const std::array<std::uint32_t, 2> fraction = {1, denominator};
    const std::string needle(reinterpret_cast<const char*>(fraction.data()), sizeof fraction);
    EXPECT_NE(written(frame).find(needle), std::string::npos) << "1 / " << denominator << " s";
  }
  RawFrame frame = sample_frame({24, 24});
  for (const double exposure_us : {0.001, 16666.7, 123456.789, 2.5e6, 1e9}) {
    frame.shot.exposure_us = exposure_us;
    EXPECT_NEAR(decoded(frame).shot.exposure_us, exposure_us, 1e-6 * exposure_us);
  }
}

TEST(Dng, IsTheSameBytesForTheSameFrame) {
  const std::string first = written(sample_frame({31, 37})), second = written(sample_frame({31, 37}));
  EXPECT_EQ(first, second);
  RawFrame other = sample_frame({31, 37});
  ++other.counts(30, 36);
  EXPECT_NE(written(other), first);
}

TEST(Dng, RefusesAFrameThatNoReaderWouldUnderstand) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  struct Case {
    std::string reason;
    std::function<void(RawFrame&, DngTags&)> spoil;
  };
  const Case cases[] = {
      {"no mosaic of one plane", [](RawFrame& f, DngTags&) { f.counts = {}; }},
      {"no mosaic of one plane",
       [](RawFrame& f, DngTags&) {
         f.counts = Image<std::uint16_t>({24, 24}, 3);
       }},
      {"is over 65535",
       [](RawFrame& f, DngTags&) {
         f.counts = Image<std::uint16_t>({65536, 2});
       }},
      {"not a Bayer cell",
       [](RawFrame& f, DngTags&) {
         f.cfa.site = {{{0, 1}, {2, 3}}};
       }},
      {"not a Bayer cell",
       [](RawFrame& f, DngTags&) {
         f.cfa.site = {{{0, 3}, {1, 2}}};
       }},
      {"not a Bayer cell",
       [](RawFrame& f, DngTags&) {
         f.cfa.site = {{{0, 1}, {3, 9}}};
       }},
      {"white level 0 ", [](RawFrame& f, DngTags&) { f.white = 0; }},
      {"white level 65536 ", [](RawFrame& f, DngTags&) { f.white = 65536; }},
      {"white level 1000.5 ", [](RawFrame& f, DngTags&) { f.white = 1000.5f; }},
      {"white level nan ", [](RawFrame& f, DngTags&) { f.white = kNan; }},
      {"black level 15520 ", [](RawFrame& f, DngTags&) { f.black[1][0] = 15520; }},
      {"black level -1 ", [](RawFrame& f, DngTags&) { f.black[0][1] = -1; }},
      {"black level nan ", [](RawFrame& f, DngTags&) { f.black[0][0] = kNan; }},
      {"make and model", [](RawFrame& f, DngTags&) { f.shot.make.clear(); }},
      {"make and model", [](RawFrame& f, DngTags&) { f.shot.model.clear(); }},
      {"no text of up to 63", [](RawFrame& f, DngTags&) { f.shot.model = "D\n5100"; }},
      {"no text of up to 63", [](RawFrame& f, DngTags&) { f.shot.serial.assign(64, '7'); }},
      {"exposure of -1 us", [](RawFrame& f, DngTags&) { f.shot.exposure_us = -1; }},
      {"exposure of nan us", [](RawFrame& f, DngTags&) { f.shot.exposure_us = double{kNan}; }},
      {"ISO 65536 ", [](RawFrame& f, DngTags&) { f.shot.iso = 65536; }},
      {"f-number nan ", [](RawFrame& f, DngTags&) { f.shot.f_number = double{kNan}; }},
      {"focal length of 10001 mm", [](RawFrame& f, DngTags&) { f.shot.focal_mm = 10001; }},
      {"date \"today\"", [](RawFrame&, DngTags& t) { t.date_time_original = "today"; }},
      {"colour matrix or neutral", [](RawFrame&, DngTags& t) { t.as_shot_neutral[1] = double{kNan}; }},
      {"colour matrix or neutral", [](RawFrame&, DngTags& t) { t.camera_from_xyz[8] = 1e9; }},
  };
  const auto file = temp_file("refused.dng");
  for (const Case& c : cases) {
    RawFrame frame = sample_frame({24, 24});
    DngTags tags;
    c.spoil(frame, tags);
    const auto done = write_dng(file, frame, tags);
    ASSERT_FALSE(done.has_value()) << c.reason;
    EXPECT_EQ(done.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(done.error().message(), HasSubstr(c.reason));
    EXPECT_FALSE(std::filesystem::exists(file)) << c.reason;
  }
}

TEST(Dng, RefusesAFrameOverFourGibibytes) {
  RawFrame frame = sample_frame({24, 24});
  try {
    frame.counts = Image<std::uint16_t>({65535, 32769});  // address space; its pages are never touched
  } catch (const std::bad_alloc&) {
    GTEST_SKIP() << "4 GiB of address space cannot be had";
  }
  const auto done = write_dng(temp_file("huge.dng"), frame);
  ASSERT_FALSE(done.has_value());
  EXPECT_THAT(done.error().message(), HasSubstr("65535 x 32769 pixels do not fit into 4 GiB"));
}

TEST(Dng, SaysWhyItCannotBeCreated) {
  const auto done = write_dng(temp_file("no_such_folder") / "frame.dng", sample_frame({24, 24}));
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().kind, ErrorKind::kCannotCreate);
  EXPECT_THAT(done.error().message(), HasSubstr("No such file or directory"));
}

TEST(Dng, LeavesTheOlderFileWhereWritingFailsHalfWay) {
  const auto file = temp_file("limited.dng");
  ASSERT_TRUE(write_dng(file, sample_frame({24, 24})).has_value());
  const std::string older = bytes_of(file);

  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 10000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto done = write_dng(file, sample_frame({640, 480}));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);

  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().kind, ErrorKind::kInputOutput);
  EXPECT_THAT(done.error().message(), HasSubstr("File too large"));
  EXPECT_EQ(bytes_of(file), older);
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".partial"));
}

}  // namespace
}  // namespace weft::simulator
