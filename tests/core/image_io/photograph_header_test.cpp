// SPDX-License-Identifier: Apache-2.0
// Which picture of a file is the photograph, which of its channels are light, and which way up it is.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/image_io/linear_image.h"
#include "tests/core/image_io/foreign_formats.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

ForeignTiff grey_page(int width, int height, std::uint8_t value, int kind) {
  ForeignTiff page = {.width = width, .height = height, .fields = tiff_fields(8, 1, PHOTOMETRIC_MINISBLACK)};
  page.fields.emplace_back(TIFFTAG_SUBFILETYPE, kind);
  page.bytes.assign(static_cast<std::size_t>(width * height), value);
  return page;
}

void write_pages(const std::filesystem::path& file, const std::vector<ForeignTiff>& pages) {
  for (std::size_t i = 0; i < pages.size(); ++i) {
    ForeignTiff page = pages[i];
    page.mode = i == 0 ? "w" : "a";
    ASSERT_TRUE(write_foreign(file, page));
  }
}

TEST(PhotographHeader, ATiffIsReadFromItsLargestPageThatIsNoThumbnail) {
  const ScratchFolder folder;
  const std::vector<std::vector<ForeignTiff>> files = {
      {grey_page(2, 1, 9, FILETYPE_REDUCEDIMAGE), grey_page(4, 2, 51, 0)},
      {grey_page(2, 1, 9, 0), grey_page(4, 2, 51, 0)},
      {grey_page(4, 2, 51, 0), grey_page(2, 1, 9, FILETYPE_REDUCEDIMAGE)},
      {grey_page(4, 2, 51, 0), grey_page(4, 2, 9, FILETYPE_MASK)}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    write_pages(folder / "a.tif", files[i]);
    const Result<LoadedImage> read = read_image(folder / "a.tif");
    ASSERT_TRUE(read) << i << ": " << read.error().message();
    EXPECT_EQ(read->info.size, (Size{4, 2})) << i;
    EXPECT_FLOAT_EQ(read->planes(0, 0), 0.2F) << i;
    EXPECT_TRUE(read->info.alike.empty()) << i;
  }
}

TEST(PhotographHeader, TwoPagesOfOneSizeAreNoPhotograph) {
  const ScratchFolder folder;
  write_pages(folder / "a.tif", {grey_page(4, 2, 51, 0), grey_page(4, 2, 9, 0)});
  const Result<ImageFileInfo> info = read_linear_image_info(folder / "a.tif");
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().kind, ErrorKind::kBadData);
  EXPECT_NE(info.error().why.find("2 parts or pages"), std::string::npos) << info.error().message();
}

TEST(PhotographHeader, AMosaicInATiffIsNoPhotograph) {
  const ScratchFolder folder;
  ForeignTiff mosaic = grey_page(4, 2, 51, 0);
  mosaic.fields = tiff_fields(8, 1, PHOTOMETRIC_CFA);
  write_pages(folder / "a.tif", {mosaic});
  const Result<ImageFileInfo> info = read_linear_image_info(folder / "a.tif");
  ASSERT_FALSE(info);
  EXPECT_NE(info.error().why.find("mosaic"), std::string::npos) << info.error().message();
}

TEST(PhotographHeader, BytesBehindTheEndOfAPngArePassedOverAndSaid) {
  const ScratchFolder folder;
  const Image<float> grey({3, 2});
  ASSERT_TRUE(write_image(folder / "a.png", std::array{grey.plane()}, {"Y"}, {.type = SampleType::kUint8}));
  const std::string whole = bytes_of(folder / "a.png");
  put_bytes(folder / "a.png", whole + "abc");
  const Result<LoadedImage> read = read_image(folder / "a.png");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.remarks, std::vector<std::string>{"3 bytes behind its end"});
  put_bytes(folder / "a.png", whole.substr(0, whole.size() - 1));
  EXPECT_FALSE(read_image(folder / "a.png")) << "one byte of its end is missing";
}

struct ExrPart {
  const char* name;
  int width, height;
  std::vector<const char*> channels;
};

void write_parts(const std::filesystem::path& file, const std::vector<ExrPart>& parts) {
  std::vector<Imf::Header> headers;
  for (const ExrPart& part : parts) {
    Imf::Header header(part.width, part.height);
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const char* channel : part.channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  Imf::MultiPartOutputFile out(file.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<float> pixels(static_cast<std::size_t>(parts[i].width * parts[i].height),
                              0.25F * static_cast<float>(1 + i));
    Imf::FrameBuffer frame;
    for (const char* channel : parts[i].channels) {
      frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), sizeof(float),
                                       sizeof(float) * static_cast<std::size_t>(parts[i].width)));
    }
    Imf::OutputPart part(out, static_cast<int>(i));
    part.setFrameBuffer(frame);
    part.writePixels(parts[i].height);
  }
}

TEST(PhotographHeader, AnExrIsReadFromTheOnlyPartThatHasColours) {
  const ScratchFolder folder;
  write_parts(folder / "a.exr", {{"depth", 4, 2, {"Z"}}, {"beauty", 4, 2, {"R", "G", "B"}}});
  const Result<LoadedImage> read = read_image(folder / "a.exr");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->info.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_FLOAT_EQ(read->planes(1, 1), 0.5F);
  EXPECT_EQ(read->info.remarks.size(), 1U);
  EXPECT_TRUE(read->info.alike.empty());
}

TEST(PhotographHeader, TwoPartsOfColoursAndOneSizeAreNoPhotograph) {
  const ScratchFolder folder;
  write_parts(folder / "a.exr", {{"left", 4, 2, {"R", "G", "B"}}, {"right", 4, 2, {"R", "G", "B"}}});
  const Result<ImageFileInfo> info = read_linear_image_info(folder / "a.exr");
  ASSERT_FALSE(info);
  EXPECT_NE(info.error().why.find("part 2 \"right\""), std::string::npos) << info.error().message();
}

TEST(PhotographHeader, LightIsFoundByTheNamesOfChannels) {
  const struct {
    std::vector<std::string> names;
    std::vector<std::size_t> places;  // none: refused
    const char* format = "openexr";
  } cases[] = {{{"R", "G", "B"}, {0, 1, 2}},
               {{"A", "B", "G", "R"}, {3, 2, 1}},
               {{"R", "G", "B", "Z", "N.X", "N.Y", "N.Z"}, {0, 1, 2}},
               {{"A", "diff.R", "diff.G", "diff.B"}, {1, 2, 3}},
               {{"Y"}, {0, 0, 0}},
               {{"Y", "A"}, {0, 0, 0}},
               {{"R"}, {0, 0, 0}},
               {{"Y", "RY", "BY"}, {}},
               {{"X", "Y", "Z"}, {}},
               {{"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}, {}},
               {{"Z", "id"}, {}},
               {{"Z"}, {}},
               {{"R", "G", "B", "channel3"}, {0, 1, 2}, "tiff"},
               {{"R", "G", "B", "channel3", "channel4"}, {}, "tiff"},
               {{"R", "G"}, {}, "tiff"}};
  for (const auto& c : cases) {
    ImageFileInfo info;
    info.format = c.format;
    info.channels = c.names;
    const Result<LightChannels> found = light_channels(info, "a");
    ASSERT_EQ(found.has_value(), !c.places.empty()) << c.names[0] << ", " << c.names.size() << " in all";
    if (!found) continue;
    EXPECT_EQ(std::vector<std::size_t>(found->begin(), found->end()), c.places) << c.names[0];
  }
}

// Numbered 0 to 5 in their rows, as TIFF 6.0 has it: "the 0th row is the visual top, ..."
TEST(PhotographHeader, EachOrientationShowsWhatTheTagSays) {
  const Size size = {3, 2};
  const std::array<std::vector<float>, 8> shown = {{{0, 1, 2, 3, 4, 5},
                                                    {2, 1, 0, 5, 4, 3},
                                                    {5, 4, 3, 2, 1, 0},
                                                    {3, 4, 5, 0, 1, 2},
                                                    {0, 3, 1, 4, 2, 5},
                                                    {3, 0, 4, 1, 5, 2},
                                                    {5, 2, 4, 1, 3, 0},
                                                    {2, 5, 1, 4, 0, 3}}};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    Image<float> stored(size);
    for (int i = 0; i < 6; ++i) stored(i % 3, i / 3) = static_cast<float>(i);
    const Image<float> image = as_shown(std::move(stored), orientation);
    EXPECT_EQ(image.size(), shown_size(size, orientation)) << orientation;
    const std::vector<float>& truth = shown[static_cast<std::size_t>(orientation) - 1];
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(image(i % image.width(), i / image.width()), truth[static_cast<std::size_t>(i)])
          << "orientation " << orientation << ", pixel " << i;
  }
}

}  // namespace
}  // namespace weft
