// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/decode_raw.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "capture/raw/raw_info.h"
#include "tests/capture/raw/dng_bytes.h"

namespace weft::capture {
namespace {

using testing::HasSubstr;

/// The number of counts that differ; all of them where the sizes do.
std::int64_t differing_counts(const RawFrame& a, const RawFrame& b) {
  if (a.counts.size() != b.counts.size()) return std::max(a.counts.size().pixels(), b.counts.size().pixels());
  std::int64_t differing = 0;
  for (int y = 0; y < a.counts.height(); ++y)
    for (int x = 0; x < a.counts.width(); ++x) differing += a.counts(x, y) != b.counts(x, y);
  return differing;
}

std::filesystem::path written(const RawFrame& frame, const std::string& name) {
  const auto file = temp_file(name);
  const auto done = simulator::write_dng(file, frame);
  EXPECT_TRUE(done.has_value()) << done.error().message();
  return file;
}

std::filesystem::path written(const std::string& text, const std::string& name) {
  const auto file = temp_file(name);
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// Both readers must refuse the file; returns decode_raw's error.
Error refusal(const std::filesystem::path& file, const DecodeExpectation& expected = {}) {
  const auto frame = decode_raw(file, expected);
  EXPECT_FALSE(frame.has_value()) << file << " was decoded";
  if (frame) return {};
  EXPECT_EQ(frame.error().where, file.string());
  EXPECT_FALSE(frame.error().remedy.empty()) << frame.error().message();
  return frame.error();
}

void expect_bad_data(const std::filesystem::path& file, const std::string& reason) {
  const Error error = refusal(file);
  EXPECT_EQ(error.kind, ErrorKind::kBadData) << error.message();
  EXPECT_THAT(error.message(), HasSubstr(reason));
}

CfaPattern bayer(int red_x, int red_y) {
  const CfaPattern rggb;
  CfaPattern cell;
  for (const int y : {0, 1})
    for (const int x : {0, 1})
      cell.site[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
          rggb.site_at(x + red_x, y + red_y);
  return cell;
}

TEST(DecodeRaw, ReturnsEveryCountOfOddAndEvenSizes) {
  for (const Size size : {Size{22, 22}, Size{23, 29}, Size{101, 53}, Size{64, 64}, Size{640, 480}}) {
    const RawFrame truth = sample_frame(size);
    const auto frame = decode_raw(written(truth, "sizes.dng"));
    ASSERT_TRUE(frame.has_value()) << frame.error().message();
    EXPECT_EQ(frame->counts.size(), size);
    EXPECT_EQ(differing_counts(*frame, truth), 0) << size.width << " x " << size.height;
  }
}

TEST(DecodeRaw, ReturnsTheFilterCellWithBothGreensApart) {
  for (const int red_y : {0, 1})
    for (const int red_x : {0, 1}) {
      RawFrame truth = sample_frame({24, 26});
      truth.cfa = bayer(red_x, red_y);
      const auto frame = decode_raw(written(truth, "cell.dng"));
      ASSERT_TRUE(frame.has_value()) << frame.error().message();
      EXPECT_EQ(frame->cfa, truth.cfa) << "red at " << red_x << ", " << red_y;
      EXPECT_EQ(frame->cfa.site_at(red_x + 1, red_y), 1) << "green on a red row";
      EXPECT_EQ(frame->cfa.site_at(red_x, red_y + 1), 3) << "green on a blue row";
    }
}

TEST(DecodeRaw, ReturnsOneBlackLevelOrFourWithTheirFractions) {
  RawFrame truth = sample_frame({24, 26});
  for (const std::array<std::array<float, 2>, 2> black :
       {std::array<std::array<float, 2>, 2>{{{0, 0}, {0, 0}}},
        {{{600.5f, 600.5f}, {600.5f, 600.5f}}},
        {{{600, 601.25f}, {602.7f, 603.9f}}}}) {
    truth.black = black;
    const auto frame = decode_raw(written(truth, "black.dng"));
    ASSERT_TRUE(frame.has_value()) << frame.error().message();
    EXPECT_EQ(frame->black, truth.black) << "first " << frame->black[0][0] << " of " << truth.black[0][0];
    EXPECT_EQ(frame->white, 15520);
  }
}

TEST(DecodeRaw, ReturnsWhatTheFileSaysOfTheShot) {
  const RawFrame truth = sample_frame({24, 26});
  const auto frame = decode_raw(written(truth, "shot.dng"));
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  EXPECT_EQ(frame->shot.make, "Lumitex");
  EXPECT_EQ(frame->shot.model, "Virtual D5100");
  EXPECT_EQ(frame->shot.serial, "SN-0042");
  EXPECT_NEAR(frame->shot.exposure_us, 1e6 / 60, 1e-6 * 1e6 / 60);
  EXPECT_EQ(frame->shot.iso, 100);
  EXPECT_EQ(frame->shot.f_number, 8);
}

TEST(DecodeRaw, ReturnsTheApertureThatTheLensShows) {
  RawFrame truth = sample_frame({24, 26});
  for (const double f_number : {1.4, 2.8, 5.6, 6.3}) {
    truth.shot.f_number = f_number;
    const auto frame = decode_raw(written(truth, "aperture.dng"));
    ASSERT_TRUE(frame.has_value()) << frame.error().message();
    EXPECT_EQ(frame->shot.f_number, f_number) << "off by " << frame->shot.f_number - f_number;
  }
}

TEST(DecodeRaw, ReturnsTheFocalLengthThatTheLensShows) {
  RawFrame truth = sample_frame({24, 26});
  for (const double focal_mm : {18.0, 35.5, 105.2}) {
    truth.shot.focal_mm = focal_mm;
    const auto frame = decode_raw(written(truth, "zoom.dng"));
    ASSERT_TRUE(frame.has_value()) << frame.error().message();
    EXPECT_EQ(frame->shot.focal_mm, focal_mm) << "off by " << frame->shot.focal_mm - focal_mm;
  }
}

TEST(DecodeRaw, LeavesOutWhatTheFileDoesNotSay) {
  RawFrame truth = sample_frame({24, 26});
  truth.shot = {"Lumitex", "Virtual D5100", "", 0, 0, 0};
  const auto frame = decode_raw(written(truth, "silent.dng"));
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  EXPECT_EQ(frame->shot.serial, "");
  EXPECT_EQ(frame->shot.exposure_us, 0);
  EXPECT_EQ(frame->shot.iso, 0);
  EXPECT_EQ(frame->shot.f_number, 0);
  EXPECT_EQ(frame->shot.focal_mm, 0);
}

TEST(DecodeRaw, KeepsTextPrintable) {
  DngBytes dng;
  dng.bytes[dng.value_at(50735)] = 0xff;
  dng.bytes[dng.value_at(50735) + 3] = 1;
  const auto frame = decode_raw(dng.save("text.dng"));
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  EXPECT_EQ(frame->shot.serial, "?N-?042");
}

TEST(DecodeRaw, RefusesCameraNamesThatAreDamagedOrHaveNoEnd) {
  for (const std::uint16_t tag : std::initializer_list<std::uint16_t>{271, 272, 50708}) {
    DngBytes dng;
    dng.bytes[dng.value_at(tag) + 2] = 0xff;
    expect_bad_data(dng.save("name.dng"), "name of its camera");
    expect_bad_data(DngBytes().retag(tag, tag, 2, 5).save("name.dng"), "name of its camera");
    expect_bad_data(DngBytes().retag(tag, tag, 1, 8).save("name.dng"), "name of its camera");
  }
}

TEST(DecodeRaw, CutsTheMarginsOffAndCountsTheCellFromTheActiveArea) {
  const RawFrame truth = sample_frame({40, 30});
  DngBytes dng(truth);
  dng.retag(50728, 50829, 4, 4).set(50829, {3, 5, 28, 37});  // rows 3 to 27, columns 5 to 36
  const auto frame = decode_raw(dng.save("margins.dng"));
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  ASSERT_EQ(frame->counts.size(), (Size{32, 25}));
  EXPECT_EQ(frame->cfa, CfaPattern{}) << "a DNG's cell starts at its active area";
  for (int y = 0; y < 25; ++y)
    for (int x = 0; x < 32; ++x)
      ASSERT_EQ(frame->counts(x, y), truth.counts(x + 5, y + 3)) << "at " << x << ", " << y;
}

TEST(DecodeRaw, ReadsAVendorsFileOfAKnownCamera) {
  RawFrame truth = sample_frame({640, 480});
  truth.shot.make = "NIKON CORPORATION";
  truth.shot.model = "NIKON D5100";
  DngBytes file(truth);
  file.remove(50706).remove(50714).remove(50717);
  const auto frame = decode_raw(file.save("vendor.nef"));
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  ASSERT_EQ(frame->counts.size(), (Size{640 - 44, 480})) << "LibRaw cuts 44 masked columns from this camera";
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640 - 44; ++x)
      ASSERT_EQ(frame->counts(x, y), truth.counts(x, y)) << "at " << x << ", " << y;
  EXPECT_EQ(frame->cfa, CfaPattern{});
  EXPECT_EQ(frame->black, (std::array<std::array<float, 2>, 2>{}));
  EXPECT_EQ(frame->white, 15846);
  EXPECT_EQ(frame->shot.model, "D5100");
}

TEST(DecodeRaw, RefusesAVendorsFileOfAnUnknownCamera) {
  expect_bad_data(DngBytes(sample_frame({640, 480})).remove(50706).save("unknown.nef"),
                  "does not know this camera");
}

TEST(DecodeRaw, NamesBothValuesWhereAFrameIsNotAsExpected) {
  const auto file = written(sample_frame({40, 30}), "expected.dng");
  EXPECT_TRUE(
      decode_raw(file, {.size = Size{40, 30}, .cfa = CfaPattern{}, .model = "Virtual D5100"}).has_value());
  EXPECT_THAT(refusal(file, {.size = Size{41, 30}}).message(),
              HasSubstr("expected 41 x 30 pixels, found 40 x 30 pixels"));
  EXPECT_THAT(refusal(file, {.cfa = bayer(1, 0)}).message(), HasSubstr("expected GRBG, found RGGB"));
  EXPECT_THAT(refusal(file, {.model = "D850"}).message(), HasSubstr("expected D850, found Virtual D5100"));
}

TEST(DecodeRaw, RefusesAPathThatCannotBeRead) {
  const Error missing = refusal(temp_file("absent.dng"));
  EXPECT_EQ(missing.kind, ErrorKind::kNoInput);
  EXPECT_THAT(missing.message(), HasSubstr("No such file"));

  const Error folder = refusal(testing::TempDir());
  EXPECT_EQ(folder.kind, ErrorKind::kNoInput);
  EXPECT_THAT(folder.message(), HasSubstr("it is no file"));

  const auto pipe = temp_file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe).kind, ErrorKind::kNoInput);
}

TEST(DecodeRaw, SaysWhichPermissionIsMissing) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read every file";
  const auto file = written(sample_frame({40, 30}), "forbidden.dng");
  ASSERT_EQ(chmod(file.c_str(), 0), 0);
  const Error error = refusal(file);
  EXPECT_EQ(error.kind, ErrorKind::kNoInput);
  EXPECT_THAT(error.message(), HasSubstr("Permission denied"));
}

TEST(DecodeRaw, RefusesFilesThatAreNoRaws) {
  expect_bad_data(written(std::string(), "empty.dng"), "0 bytes");
  expect_bad_data(written("a letter to the weaver\n", "text.dng"), "not a raw frame");
  expect_bad_data(written(std::string(5000, '\0'), "zeros.dng"), "not a raw frame");
  expect_bad_data(written("\xff\xd8\xff\xe0 and so on", "picture.jpg"), "a JPEG is not a raw frame");
  expect_bad_data(written("II*", "short.dng"), "not a raw frame");
}

TEST(DecodeRaw, CountsTheMissingBytesOfATruncatedFile) {
  const DngBytes whole;
  for (const std::size_t missing : {std::size_t{1}, std::size_t{2}, std::size_t{1000}, std::size_t{2400}}) {
    DngBytes cut = whole;
    cut.bytes.resize(whole.bytes.size() - missing);
    const auto file = cut.save("cut.dng");
    expect_bad_data(file, "truncated");
    expect_bad_data(file,
                    std::to_string(missing) + " bytes are missing of " + std::to_string(whole.bytes.size()));
    EXPECT_FALSE(read_raw_info(file).has_value()) << "the same can be told without decoding";
  }
}

/// A Panasonic's raw file: its blocks of 16 kB are of zeros, which is the code of counts that are all zero.
DngBytes rw2() {
  RawFrame frame = sample_frame({280, 200});
  frame.shot.make = "Panasonic";
  frame.shot.model = "DMC-GF1";
  DngBytes file(frame);
  file.bytes[2] = 0x55;
  file.retag(254, 1, 7, 4).set(1, {0x30313330}).retag(256, 2, 3, 1).retag(257, 3, 3, 1).retag(273, 280, 4, 1);
  file.remove(50706).remove(258).remove(259);
  file.bytes.resize(file.get(280));
  file.bytes.resize(file.bytes.size() + 4 * 0x4000);  // 14 counts in 16 bytes
  return file;
}

/// A Nikon's raw file of 12 bits, packed.
DngBytes packed_nef() {
  RawFrame frame = sample_frame({640, 480});
  frame.shot.make = "NIKON CORPORATION";
  frame.shot.model = "NIKON D5100";
  return DngBytes(frame).pack(12).remove(50706).remove(50714).remove(50717);
}

TEST(DecodeRaw, RefusesVendorsFilesThatEndWhereLibRawDoesNotLook) {
  for (const DngBytes& whole : {rw2(), packed_nef()}) {
    const auto frame = decode_raw(whole.save("whole.raw"));
    ASSERT_TRUE(frame.has_value()) << frame.error().message();
    for (const std::size_t missing : {std::size_t{24}, std::size_t{900}, whole.bytes.size() / 2}) {
      DngBytes cut = whole;
      cut.bytes.resize(whole.bytes.size() - missing);
      expect_bad_data(cut.save("cut.raw"), "raw frame is truncated");
    }
  }
}

TEST(DecodeRaw, DoesNotCallAWholeFileTruncatedWhoseDataAreDamaged) {
  DngBytes file = rw2();
  std::fill(file.bytes.begin() + file.get(280), file.bytes.end(), std::uint8_t{0x7f});
  expect_bad_data(file.save("damaged.rw2"), "its data are damaged");
}

TEST(DecodeRaw, ReadsEveryCountOfADngThatACameraWrote) {
  const char* shared = std::getenv("WEFT_SHARED_DATA");
  if (shared == nullptr) GTEST_SKIP() << "WEFT_SHARED_DATA is not set";
  const auto file = std::filesystem::path(shared) / "raws" / "colorchart.dng";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const auto frame = decode_raw(file);
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  ASSERT_EQ(frame->counts.size(), (Size{1734, 1156}));

  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  // 14 bits a count from byte 1536 on, 1888 counts a row; the active area begins at row 26, column 152.
  const auto bit = [&bytes](std::size_t at) { return bytes[at / 8] >> (7 - at % 8) & 1; };
  std::int64_t differing = 0;
  for (int y = 0; y < 1156; ++y)
    for (int x = 0; x < 1734; ++x) {
      const std::size_t at = 8 * 1536 + 14 * static_cast<std::size_t>((y + 26) * 1888 + x + 152);
      int count = 0;
      for (std::size_t i = 0; i < 14; ++i) count = 2 * count + bit(at + i);
      differing += count != frame->counts(x, y);
    }
  EXPECT_EQ(differing, 0);
}

TEST(DecodeRaw, ReturnsTheSameCountsWhicheverWayTheBodyFeltItWasHeld) {
  const RawFrame truth = sample_frame({41, 30});
  for (std::uint32_t orientation = 1; orientation <= 9; ++orientation) {
    const auto frame = decode_raw(DngBytes(truth).set(274, {orientation}, 2).save("turned.dng"));
    ASSERT_TRUE(frame.has_value()) << frame.error().message();
    EXPECT_EQ(differing_counts(*frame, truth), 0) << "orientation " << orientation;
    EXPECT_EQ(frame->cfa, truth.cfa) << "orientation " << orientation;
  }
}

TEST(DecodeRaw, RefusesWhatIsNotABayerMosaic) {
  const std::array<std::uint32_t, 4> cells[] = {
      {1, 1, 1, 1}, {0, 1, 2, 1}, {0, 0, 1, 2}, {0, 2, 2, 1}, {0, 1, 1, 3}};
  for (const auto& c : cells)
    expect_bad_data(DngBytes().set(33422, {c[0], c[1], c[2], c[3]}, 1).save("cell.dng"),
                    "not a Bayer mosaic");
  expect_bad_data(DngBytes().remove(33422).save("no_cell.dng"), "not a Bayer mosaic");
  expect_bad_data(DngBytes().set(33421, {6, 6}, 2).save("x_trans.dng"), "not a Bayer mosaic");
}

TEST(DecodeRaw, NeedsASensorThatLibRawTakes) {
  expect_bad_data(written(sample_frame({21, 40}), "narrow.dng"), "not a raw frame");
}

TEST(DecodeRaw, GivesTheSameFrameToManyThreads) {
  const RawFrame truth = sample_frame({101, 53});
  const auto file = written(truth, "threads.dng");
  std::array<std::int64_t, 4> differing = {};
  std::vector<std::thread> threads;
  for (auto& count : differing)
    threads.emplace_back([&file, &truth, &count] {
      for (int i = 0; i < 5; ++i) {
        const auto frame = decode_raw(file);
        count += frame ? differing_counts(*frame, truth) : truth.counts.size().pixels();
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_THAT(differing, testing::Each(0));
}

TEST(ReadRawInfo, AgreesWithTheDecodedFrame) {
  RawFrame truth = sample_frame({640, 480});
  truth.cfa = bayer(1, 1);
  const auto file = written(truth, "info.dng");
  const auto info = read_raw_info(file);
  const auto frame = decode_raw(file);
  ASSERT_TRUE(info.has_value()) << info.error().message();
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  EXPECT_EQ(info->size, frame->counts.size());
  EXPECT_EQ(info->cfa, frame->cfa);
  EXPECT_EQ(info->shot.model, frame->shot.model);
  EXPECT_EQ(info->shot.serial, frame->shot.serial);
  EXPECT_EQ(info->shot.exposure_us, frame->shot.exposure_us);
}

/// Decoding rubbish must end in an error or in a frame that keeps every promise of RawFrame.
void expect_error_or_plausible(const DngBytes& dng, int round, int& decoded) {
  const auto frame = decode_raw(dng.save("rubbish.dng"));
  if (!frame) {
    ASSERT_FALSE(frame.error().what.empty()) << "round " << round;
    return;
  }
  ++decoded;
  const Size size = frame->counts.size();
  ASSERT_TRUE(size.width > 0 && size.height > 0 &&
              2 * size.pixels() <= static_cast<std::int64_t>(dng.bytes.size()))
      << "round " << round << ": " << size.width << " x " << size.height;
  ASSERT_THAT((std::array{bayer(0, 0), bayer(1, 0), bayer(0, 1), bayer(1, 1)}), testing::Contains(frame->cfa))
      << "round " << round;
  ASSERT_LE(frame->white, 65535) << "round " << round;
  for (const auto& row : frame->black)
    for (const float black : row)
      ASSERT_TRUE(black >= 0 && black < frame->white) << "round " << round << ": " << black;
  ASSERT_TRUE(std::isfinite(frame->shot.exposure_us) && frame->shot.exposure_us >= 0) << "round " << round;
}

class DecodeRubbish : public testing::TestWithParam<int> {};

TEST_P(DecodeRubbish, EndsInAnErrorOrAPlausibleFrame) {
  const DngBytes whole(sample_frame({24, 26}));
  const std::size_t head = whole.get(273);
  std::mt19937 random(static_cast<std::uint32_t>(GetParam()));
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int decoded = 0;
  for (int round = 0; round < 250; ++round) {
    DngBytes dng = whole;
    for (std::size_t i = 0; i <= below(4); ++i) dng.bytes[below(head)] = static_cast<std::uint8_t>(random());
    if (round % 5 == 0) dng.bytes.resize(below(dng.bytes.size()));
    ASSERT_NO_FATAL_FAILURE(expect_error_or_plausible(dng, round, decoded));
  }
  EXPECT_GT(decoded, 10) << "the rubbish is too wild to reach the decoder";
  EXPECT_LT(decoded, 240) << "the rubbish is too tame";
}

INSTANTIATE_TEST_SUITE_P(Seeds, DecodeRubbish, testing::Range(1, 9));

}  // namespace
}  // namespace weft::capture
