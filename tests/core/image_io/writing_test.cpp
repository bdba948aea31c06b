// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "core/image_io/image_io.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/image_io/test_images.h"

namespace weft {
namespace {

using testing::HasSubstr;
using testing::Not;
using enum SampleType;
using enum Compression;

struct NamedFile {
  const char* name;
  SampleType type;
  Compression compression;
};

const std::vector<NamedFile> kNamedFiles = {
    {"a.exr", kFloat, kNone}, {"a.exr", kHalf, kNone},   {"a.exr", kHalf, kZip},
    {"a.exr", kHalf, kPiz},   {"a.tif", kUint16, kNone}, {"a.tif", kUint16, kZip},
    {"a.tif", kFloat, kZip},  {"a.png", kUint8, kNone},  {"a.png", kUint16, kNone}};

std::string describe(const NamedFile& c) {
  return fmt::format("{} of type {}, {}", c.name, static_cast<int>(c.type), name_of(c.compression));
}

TEST(ImageWriter, WritesTheSameBytesForAnyBands) {
  const ScratchFolder folder;
  const Size size{331, 211};
  const Image<float> image = exact_noise(size, 3, kUint8);
  const std::vector<View<const float>> views = views_of(image);
  for (const NamedFile& c : kNamedFiles) {
    std::string whole;
    for (const int band : {211, 128, 32, 7, 1}) {
      Result<ImageWriter> writer = ImageWriter::open(folder / c.name, size, {"R", "G", "B"},
                                                     {c.type, c.compression, {{"weft.a", "b"}}});
      ASSERT_TRUE(writer) << writer.error().message();
      for (int y = 0; y < size.height; y += band) {
        ASSERT_TRUE(writer->write_rows(rows_of(views, y, std::min(y + band, size.height))));
      }
      ASSERT_TRUE(writer->finish());
      const std::string bytes = bytes_of(folder / c.name);
      if (whole.empty()) whole = bytes;
      EXPECT_TRUE(bytes == whole) << describe(c) << " in bands of " << band << " rows";
    }
  }
}

// An encoder is given chunks of 4 MB.
TEST(ImageWriter, WritesEveryRowOfManyChunks) {
  const ScratchFolder folder;
  const Size size{1501, 1001};
  for (const NamedFile& c : kNamedFiles) {
    if (c.type == kUint8) continue;
    Image<float> image = exact_noise(size, 3, c.type);
    ASSERT_TRUE(write_image(folder / c.name, views_of(image), {"R", "G", "B"}, {c.type, c.compression}));
    Result<LoadedImage> read = read_image(folder / c.name);
    ASSERT_TRUE(read) << read.error().message();
    round_to_counts(image, c.type);
    round_to_counts(read->planes, c.type);
    EXPECT_EQ(first_difference(read->planes, image), "") << describe(c);
  }
}

TEST(ImageWriter, PutsNoDateHostOrSoftwareIntoAFile) {
  const ScratchFolder folder;
  const Image<float> image({40, 30}, 3);
  char host[256] = {};
  ASSERT_EQ(gethostname(host, sizeof host - 1), 0);
  for (const NamedFile& c : kNamedFiles) {
    ASSERT_TRUE(write_image(folder / c.name, views_of(image), {"R", "G", "B"},
                            {c.type, c.compression, {{"weft.units", "mm"}}}));
    const std::string bytes = bytes_of(folder / c.name);
    for (const char* word : std::initializer_list<const char*>{"capDate", "DateTime", "tIME", "Software",
                                                               "libtiff", "libpng", host}) {
      EXPECT_THAT(bytes, Not(HasSubstr(word))) << describe(c);
    }
    EXPECT_THAT(bytes, HasSubstr("weft.units")) << describe(c);
  }
}

TEST(ImageWriter, LeavesNothingBehindWhenDroppedUnfinished) {
  const ScratchFolder folder;
  const Image<float> image = exact_noise({300, 200}, 3, kUint8);
  for (const NamedFile& c : kNamedFiles) {
    {
      Result<ImageWriter> writer =
          ImageWriter::open(folder / c.name, image.size(), {"R", "G", "B"}, {c.type});
      ASSERT_TRUE(writer);
      ASSERT_TRUE(writer->write_rows(rows_of(views_of(image), 0, 150)));
      EXPECT_FALSE(std::filesystem::exists(folder / c.name)) << "under its name before it is complete";
    }
    EXPECT_TRUE(folder.empty()) << describe(c);
  }
}

TEST(ImageWriter, RefusesToFinishAnIncompleteImage) {
  const ScratchFolder folder;
  const Image<float> image({30, 20});
  Result<ImageWriter> writer = ImageWriter::open(folder / "a.exr", image.size(), {"Y"}, {});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write_rows(rows_of(views_of(image), 0, 19)));
  const Result<void> finished = writer->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().kind, ErrorKind::kInternal);
  EXPECT_EQ(finished.error().why, "19 of 20 rows");
}

TEST(ImageWriter, RefusesRowsThatDoNotFit) {
  const ScratchFolder folder;
  const Image<float> image({30, 20}, 3), narrow({29, 20}, 3), high({30, 21}, 3);
  const Image<std::uint16_t> counts({30, 20});
  Result<ImageWriter> writer = ImageWriter::open(folder / "a.exr", image.size(), {"R", "G", "B"}, {});
  ASSERT_TRUE(writer);
  std::vector<View<const float>> mixed = views_of(image);
  mixed[2] = mixed[2].crop({0, 0, 30, 10});
  for (const std::vector<View<const float>>& rows :
       {views_of(narrow), views_of(high), mixed, {mixed[0], mixed[1]}, {}}) {
    const Result<void> wrote = writer->write_rows(rows);
    ASSERT_FALSE(wrote);
    EXPECT_EQ(wrote.error().kind, ErrorKind::kInternal) << wrote.error().message();
  }
  EXPECT_FALSE(writer->write_rows(View<const std::uint16_t>(counts.plane())));
}

TEST(ImageWriter, RefusesWhatAFormatCannotHold) {
  const ScratchFolder folder;
  const Size size{4, 4};
  const std::vector<std::string> five = {"R", "G", "B", "A", "Z"};
  const auto kind_of = [&](const char* name, const std::vector<std::string>& channels,
                           const WriteOptions& options, Size of = {4, 4}) {
    const Result<ImageWriter> writer = ImageWriter::open(folder / name, of, channels, options);
    return writer ? -1 : static_cast<int>(writer.error().kind);
  };
  const int usage = static_cast<int>(ErrorKind::kUsage);
  EXPECT_EQ(kind_of("a.exr", {"Y"}, {.type = kUint16}), usage);
  EXPECT_EQ(kind_of("a.png", {"Y"}, {.type = kFloat}), usage);
  EXPECT_EQ(kind_of("a.png", five, {.type = kUint8}), usage);
  EXPECT_EQ(kind_of("a.tif", {"Y"}, {.compression = kPiz}), usage);
  EXPECT_EQ(kind_of("a.bmp", {"Y"}, {.type = kUint8}), usage);
  EXPECT_EQ(kind_of("a", {"Y"}, {}), usage);
  EXPECT_EQ(kind_of("a.exr", {}, {}), usage);
  EXPECT_EQ(kind_of("a.exr", {"Y", "Y"}, {}), usage);
  EXPECT_EQ(kind_of("a.exr", {""}, {}), usage);
  EXPECT_EQ(kind_of("a.exr", {"Y"}, {}, {0, 4}), usage);
  EXPECT_EQ(kind_of("a.exr", five, {}, size), -1) << "EXR holds any number of channels";
  EXPECT_EQ(kind_of("A.EXR", {"Y"}, {}), -1) << "endings in capitals";
  EXPECT_TRUE(folder.empty());
}

TEST(ImageWriter, SaysWhyAFileCannotBeCreated) {
  const ScratchFolder folder;
  put_bytes(folder / "file", "no folder");
  for (const std::string name : {"missing/a.exr", "file/a.exr"}) {
    const Result<ImageWriter> writer = ImageWriter::open(folder / name, {4, 4}, {"Y"}, {});
    ASSERT_FALSE(writer) << name;
    EXPECT_EQ(writer.error().kind, ErrorKind::kCannotCreate) << writer.error().message();
    EXPECT_EQ(writer.error().where, (folder / name).string());
  }
}

/// No file of this process may grow beyond `bytes` while this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_ = {};
};

TEST(ImageWriter, ReportsAFileThatMayNotGrowAndKeepsTheOneThatWasThere) {
  const Image<float> image = exact_noise({600, 400}, 3, kUint16);
  for (const NamedFile& c : kNamedFiles) {
    for (const rlim_t limit : {rlim_t{100}, rlim_t{100'000}}) {
      const ScratchFolder folder;
      put_bytes(folder / c.name, "of before");
      const Result<void> wrote = [&] {
        const FileSizeLimit limited(limit);
        return write_image(folder / c.name, views_of(image), {"R", "G", "B"}, {c.type, c.compression});
      }();
      ASSERT_FALSE(wrote) << describe(c) << ", at most " << limit << " bytes";
      EXPECT_EQ(wrote.error().kind, ErrorKind::kInputOutput) << wrote.error().message();
      EXPECT_THAT(wrote.error().why, HasSubstr("File too large"));
      EXPECT_EQ(bytes_of(folder / c.name), "of before");
      std::filesystem::remove(folder / c.name);
      EXPECT_TRUE(folder.empty()) << describe(c) << ": something was left behind";
    }
  }
}

TEST(ImageWriter, ReportsAFullDisk) {
  for (const NamedFile& c : kNamedFiles) {
    const ScratchFolder folder;
    std::filesystem::create_symlink("/dev/full", folder / (std::string(c.name) + ".partial"));
    const Image<float> image({40, 30}, 3);
    const Result<void> wrote =
        write_image(folder / c.name, views_of(image), {"R", "G", "B"}, {c.type, c.compression});
    ASSERT_FALSE(wrote) << describe(c);
    EXPECT_EQ(wrote.error().kind, ErrorKind::kInputOutput);
    EXPECT_THAT(wrote.error().message(), HasSubstr("No space left on device"));
    EXPECT_TRUE(folder.empty()) << describe(c);
  }
}

TEST(ImageWriter, ReplacesAnOlderFile) {
  const ScratchFolder folder;
  put_bytes(folder / "a.exr", "of before");
  const Image<float> image = exact_noise({8, 8}, 1, kFloat);
  ASSERT_TRUE(write_image(folder / "a.exr", views_of(image), {"Y"}, {}));
  EXPECT_TRUE(read_image(folder / "a.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr.partial"));
}

}  // namespace
}  // namespace weft
