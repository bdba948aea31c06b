// SPDX-License-Identifier: Apache-2.0
// Sessions that cannot be solved: what weft says, how it ends, and that it leaves nothing behind.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "simulator/camera/dng_writer.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

// 8 x 8 grey, written by oiiotool --pattern constant:color=.5 8x8 1 -d uint8 --compression jpeg:20.
constexpr std::string_view kJpeg =
    "ffd8ffe000104a46494600010100000100010000ffe1001645786966000049492a0008000000000000000000ffdb00430028"
    "1c1e231e19282321232d2b28303c64413c37373c7b585d4964918099968f808c8aa0b4e6c3a0aadaad8a8cc8ffcbdaeef5ff"
    "ffff9bc1fffffffaffe6fdfff8ffc0000b080008000801011100ffc4001f0000010501010101010100000000000000000102"
    "030405060708090a0bffc400b5100002010303020403050504040000017d0102030004110512213141061351610722711432"
    "8191a1082342b1c11552d1f02433627282090a161718191a25262728292a3435363738393a434445464748494a5354555657"
    "58595a636465666768696a737475767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6"
    "b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffda000801010000"
    "3f002bffd9";

void put_jpeg(const fs::path& file) {
  std::string bytes;
  for (std::size_t i = 0; i < kJpeg.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(kJpeg.substr(i, 2)), nullptr, 16));
  }
  put_bytes(file, bytes);
}

class BadSession : public SessionTest {
 protected:
  const fs::path raw_ = session_ / "raw" / "03_led04.dng";

  void edit_session(const std::function<void(Json&)>& change) const {
    edit_json(session_ / "session.json", change);
  }
  /// Writes another frame in the place of LED 4's, with its digest in the journal.
  void change_raw(const std::function<void(RawFrame&)>& change) const {
    Result<RawFrame> frame = capture::decode_raw(raw_);
    ASSERT_TRUE(frame) << frame.error().message();
    change(*frame);
    ASSERT_TRUE(simulator::write_dng(raw_, *frame));
    edit_session([&](Json& s) { s["shots"][3]["sha256"] = *sha256_of_file(raw_); });
  }
};

TEST_F(BadSession, AMissingRawIsNamed) {
  fs::remove(raw_);
  expect_solve_refused(66, {"cannot read", "03_led04.dng", "No such file", "check the path"});
}

TEST_F(BadSession, ARawOfAnotherSizeIsRefused) {
  change_raw([](RawFrame& frame) { frame.counts = Image<std::uint16_t>({48, 34}); });
  expect_solve_refused(
      65, {"frame does not belong", "03_led04.dng", "48 x 34", "48 x 32", "scan the cloth again"});
}

TEST_F(BadSession, ARawShortOfOneByteIsTruncated) {
  fs::resize_file(raw_, fs::file_size(raw_) - 1);
  expect_solve_refused(65,
                       {"raw frame is truncated", "03_led04.dng", "missing of 3664", "copy the file again"});
}

TEST_F(BadSession, ARawWithAnotherFilterCellIsRefused) {
  change_raw([](RawFrame& frame) { frame.cfa.site = {{{2, 3}, {1, 0}}}; });
  expect_solve_refused(65,
                       {"frame does not belong", "03_led04.dng", "colour filters", "scan the cloth again"});
}

TEST_F(BadSession, ARawWithAnotherBlackLevelIsRefused) {
  change_raw([](RawFrame& frame) { frame.black = {{{512, 512}, {512, 512}}}; });
  expect_solve_refused(65, {"frame does not belong", "03_led04.dng", "512", "600", "fixed camera settings"});
}

TEST_F(BadSession, ARawWithAnotherWhiteLevelIsRefused) {
  change_raw([](RawFrame& frame) { frame.white = 16000; });
  expect_solve_refused(65,
                       {"frame does not belong", "03_led04.dng", "16000", "15520", "fixed camera settings"});
}

TEST_F(BadSession, ARawWithABlackLevelOnlyAtOneSiteIsRefused) {
  change_raw([](RawFrame& frame) { frame.black[1][1] = 601; });
  expect_solve_refused(65, {"frame does not belong", "03_led04.dng", "601", "600", "fixed camera settings"});
}

TEST_F(BadSession, ARawTakenAtAnotherExposureIsRefused) {
  change_raw([](RawFrame& frame) { frame.shot.exposure_us *= 2; });
  expect_solve_refused(
      65, {"frame does not belong", "03_led04.dng", "session.json says", "scan the cloth again"});
}

TEST_F(BadSession, ARawWithOneChangedByteIsNotTheOneCaptured) {
  std::string bytes = bytes_of(raw_);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  put_bytes(raw_, bytes);
  expect_solve_refused(
      65, {"not the one that was captured", "03_led04.dng", "SHA-256", "copy the session again"});
}

TEST_F(BadSession, TwoFramesMixedUpAreNotTheOnesCaptured) {
  fs::rename(raw_, session_ / "raw" / "x");
  fs::rename(session_ / "raw" / "04_led05.dng", raw_);
  fs::rename(session_ / "raw" / "x", session_ / "raw" / "04_led05.dng");
  expect_solve_refused(65, {"not the one that was captured", "SHA-256", "copy the session again"});
}

TEST_F(BadSession, TwoLitShotsOfOneLedAreRefused) {
  edit_session([](Json& s) { s["shots"][3]["led"] = 5; });
  expect_solve_refused(
      65, {"session cannot be used", "session.json", "LED 5 has two lit shots", "mark the other"});
}

TEST_F(BadSession, TwoDarkShotsAreRefused) {
  edit_session([](Json& s) { s["shots"][3]["role"] = "dark"; });
  expect_solve_refused(65, {"session cannot be used", "session.json", "two dark shots", "keep one"});
}

TEST_F(BadSession, ShotsOfTwoExposuresAreRefused) {
  edit_session([](Json& s) { s["shots"][3]["exposure_us"] = 5000; });
  expect_solve_refused(65,
                       {"session cannot be used", "session.json", "03_led04.dng", "at 5 ms", "one exposure"});
}

TEST_F(BadSession, AFrameOutsideTheSessionIsRefused) {
  edit_session([](Json& s) { s["shots"][3]["file"] = "../03_led04.dng"; });
  expect_solve_refused(65, {"session.json", "shot 3", "file", "inside the session"});
}

TEST_F(BadSession, AJpegAmongRawsIsRefused) {
  put_jpeg(session_ / "raw" / "03_led04.jpg");
  edit_session([](Json& s) { s["shots"][3]["file"] = "raw/03_led04.jpg"; });
  expect_solve_refused(65,
                       {"session mixes raw and developed frames", "03_led04.jpg", "one kind", "same way"});
}

TEST_F(BadSession, AJpegNamedAsRawIsRefused) {
  put_jpeg(raw_);
  expect_solve_refused(65, {"a JPEG is not a raw frame", "03_led04.dng"});
}

TEST_F(BadSession, AFolderWithoutSessionIsNamed) {
  fs::remove(session_ / "session.json");
  expect_solve_refused(66, {"there is no such session", "it holds no session.json", "weft solve --photos"});
}

TEST_F(BadSession, AJournalThatIsNoJsonIsRefused) {
  put_bytes(session_ / "session.json", "{\"schema\": \"weft.session/1\", ");
  expect_solve_refused(65, {"session.json", "JSON"});
}

TEST_F(BadSession, AJournalWithoutAFieldNamesIt) {
  edit_session([](Json& s) { s["shots"][3].erase("file"); });
  expect_solve_refused(65, {"session.json", "shot 3", "\"file\""});
}

TEST_F(BadSession, AScanThatWasNotFinishedIsRefused) {
  edit_session([](Json& s) { s["state"] = "capturing"; });
  expect_solve_refused(65, {"session is not complete", session_.string(), "capturing", "finish the scan"});
}

TEST_F(BadSession, ANewerSchemaNamesTheVersionNeeded) {
  edit_session([](Json& s) { s["schema"] = "weft.session/2.3"; });
  expect_solve_refused(65, {"session.json", "weft.session/2", "newer"});
}

TEST_F(BadSession, AnotherKindOfDocumentIsRefused) {
  edit_session([](Json& s) { s["schema"] = "weft.calibration/1"; });
  expect_solve_refused(65, {"session.json", "weft.calibration/1", "weft.session"});
}

TEST_F(BadSession, ANewerMinorVersionIsSolvedAndItsFieldsAreKept) {
  edit_session([](Json& s) {
    s["schema"] = "weft.session/1.7";
    s["weight_gsm"] = 210;
    s["shots"][0]["polariser"] = "none";
  });
  const std::string before = bytes_of(session_ / "session.json");
  const Outcome run = run_weft({"solve", session_.string(), "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(bytes_of(session_ / "session.json"), before);
}

TEST_F(BadSession, TwoLightsAreTooFew) {
  expect_solve_refused(65, {"too few lights", session_.string(), "2 lit shots", "at least three"},
                       {"--lights", "1,2"});
}

TEST_F(BadSession, ASessionOfTwoLitShotsHasTooFew) {
  edit_session([](Json& s) {
    for (std::size_t i = 2; i < 10; ++i) s["shots"][i]["role"] = "repeat";
  });
  expect_solve_refused(65, {"too few lights", session_.string(), "2 lit shots", "at least three"});
}

TEST_F(BadSession, ALightThatWasNotLitIsAUsageError) {
  expect_solve_refused(64, {"no such light", "LED 11", session_.string(), "name LEDs that were lit"},
                       {"--lights", "1,2,3,11"});
}

class BadDevelopedSession : public testing::Test {
 protected:
  void develop(Size size, const std::string& ending, SampleType type) {
    simulate_developed(scene_named("flat", size), session_, ending, type);
  }
  /// Puts one value of LED 4's red plane to `value`.
  void spoil(float value) const {
    const fs::path file = session_ / "raw" / "03_led04.exr";
    Result<LoadedImage> image = read_image(file);
    ASSERT_TRUE(image) << image.error().message();
    image->planes(17, 5, 0) = value;
    const std::array<View<const float>, 3> planes = {image->planes.plane(0), image->planes.plane(1),
                                                     image->planes.plane(2)};
    ASSERT_TRUE(write_image(file, planes, {"R", "G", "B"}, {}));
  }
  void expect_solve_refused(int exit_code, const std::vector<std::string>& words) const {
    expect_refusal(work_, {"solve", session_.string(), "--quiet"}, exit_code, words);
  }
  /// One pixel has lost a reading, and says so; none has lost its solution.
  void expect_counted(const char* status) const {
    const Outcome run = run_weft({"solve", session_.string(), "--quiet", "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(run.json()["status"][status], 1) << run.json();
    EXPECT_EQ(run.json()["pixels"], 48 * 32);
  }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(BadDevelopedSession, NanInAnExrIsAReadingLeftOutAndCounted) {
  develop({48, 32}, ".exr", SampleType::kFloat);
  spoil(std::numeric_limits<float>::quiet_NaN());
  expect_counted("INVALID_READING");
}

TEST_F(BadDevelopedSession, InfinityInAnExrIsAReadingLeftOutAndCounted) {
  develop({48, 32}, ".exr", SampleType::kFloat);
  spoil(std::numeric_limits<float>::infinity());
  expect_counted("SATURATED");
}

TEST_F(BadDevelopedSession, AJpegOfTheRightSizeIsRefused) {
  develop({8, 8}, ".tif", SampleType::kUint16);
  put_jpeg(session_ / "raw" / "03_led04.jpg");
  edit_json(session_ / "session.json", [](Json& s) { s["shots"][3]["file"] = "raw/03_led04.jpg"; });
  expect_solve_refused(65,
                       {"a JPEG is not linear", "03_led04.jpg", "tone curve", "use raw, TIFF, PNG or EXR"});
}

TEST_F(BadDevelopedSession, AJpegNamedAsTiffIsRefused) {
  develop({8, 8}, ".tif", SampleType::kUint16);
  put_jpeg(session_ / "raw" / "03_led04.tif");
  expect_solve_refused(65,
                       {"a JPEG is not linear", "03_led04.tif", "tone curve", "use raw, TIFF, PNG or EXR"});
}

TEST_F(BadDevelopedSession, ATiffShortOfItsEndIsRefused) {
  develop({48, 32}, ".tif", SampleType::kUint16);
  const fs::path file = session_ / "raw" / "03_led04.tif";
  fs::resize_file(file, fs::file_size(file) - 1);
  expect_solve_refused(65, {"cannot read the image", "03_led04.tif", "copy the file again"});
}

}  // namespace
}  // namespace weft::test
