// SPDX-License-Identifier: Apache-2.0
#include "core/image/image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>
#include <optional>
#include <type_traits>

#include "core/base/temporary_folder.h"
#include "core/image/page_out.h"

namespace weft {
namespace {

template <typename T>
class ImageOf : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::uint16_t, float, double>;
TYPED_TEST_SUITE(ImageOf, SampleTypes);

TYPED_TEST(ImageOf, ARowGroupMayBeWrittenAtAnyColumn) {
  for (const int width : {1, 2, 63, 64, 65, 127, 128, 129, 640}) {
    Image<TypeParam> image({width, 3}, 2);
    for (int p = 0; p < 2; ++p) {
      // From the last row up: what spills into the next row is seen there.
      for (int y = 2; y >= 0; --y) {
        TypeParam* row = image.plane(p).row(y);
        for (int x = 0; x < width - 1 + kRowGroup; ++x) row[x] = static_cast<TypeParam>(10 * p + y + 1);
      }
    }
    for (int p = 0; p < 2; ++p) {
      for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < width; ++x) {
          ASSERT_EQ(image(x, y, p), static_cast<TypeParam>(10 * p + y + 1))
              << "pixel (" << x << ", " << y << ") of plane " << p << ", width " << width;
        }
      }
    }
  }
}

TYPED_TEST(ImageOf, EveryRowOfEveryPlaneIsAligned) {
  for (const int width : {1, 100, 4928}) {
    const Image<TypeParam> image({width, 5}, 3);
    for (int p = 0; p < 3; ++p) {
      for (int y = 0; y < 5; ++y) {
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(image.plane(p).row(y)) % 64, 0U)
            << "row " << y << " of plane " << p << ", width " << width;
      }
    }
  }
}

// The first cache holds 4096 bytes a way and the second 65536 on the machines we know.
TYPED_TEST(ImageOf, NoTwoPlanesCompeteForTheSameCacheSets) {
  for (const Size size : {Size{1, 1}, Size{64, 64}, Size{192, 1}, Size{256, 256}, Size{512, 32},
                          Size{1000, 700}, Size{960, 1024}, Size{4928, 3264}}) {
    const auto bytes = static_cast<std::uint64_t>(
        detail::padded_plane(detail::padded_stride(size.width), size.height, sizeof(TypeParam)) *
        static_cast<std::ptrdiff_t>(sizeof(TypeParam)));
    for (std::uint64_t apart = 1; apart <= 30; ++apart) {
      const std::uint64_t distance = bytes * apart % (4096 * 16);
      EXPECT_FALSE(distance == 0 || std::has_single_bit(distance))
          << "planes " << apart << " apart are " << distance << " bytes apart modulo 64 KiB at " << size.width
          << " x " << size.height;
    }
  }
}

TYPED_TEST(ImageOf, ArrivesZeroedPaddingIncluded) {
  const Image<TypeParam> image({70, 9}, 3);
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < 9; ++y) {
      const TypeParam* row = image.plane(p).row(y);
      for (std::ptrdiff_t x = 0; x < image.plane(p).stride(); ++x) {
        ASSERT_EQ(row[x], TypeParam(0)) << "sample " << x << " of row " << y << ", plane " << p;
      }
    }
  }
}

TEST(Image, MovesAndIsNeverCopied) {
  static_assert(!std::is_copy_constructible_v<Image<float>> && !std::is_copy_assignable_v<Image<float>>);
  Image<float> a({5, 4}, 2);
  a(3, 2, 1) = 8;
  const float* data = a.plane().row(0);
  Image<float> b = std::move(a);
  EXPECT_EQ(b.plane().row(0), data);
  EXPECT_TRUE(a.empty());  // NOLINT(bugprone-use-after-move): what is left behind is part of the contract
  EXPECT_EQ(a.size(), Size());
  Image<float> c({900, 900});
  c = std::move(b);
  EXPECT_EQ(c(3, 2, 1), 8);
  EXPECT_EQ(c.size(), (Size{5, 4}));
  EXPECT_EQ(c.planes(), 2);
  EXPECT_TRUE(b.empty());  // NOLINT(bugprone-use-after-move)
}

TEST(Image, MayBeEmpty) {
  EXPECT_TRUE(Image<float>().empty());
  const Image<float> none({0, 0}, 3);
  EXPECT_EQ(none.size().pixels(), 0);
}

TEST(View, ACropCountsFromItsOwnCorner) {
  Image<int> image({20, 10});
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) image(x, y) = 100 * y + x;
  }
  const View<const int> crop = image.plane().crop({3, 2, 11, 7});
  EXPECT_EQ(crop.size(), (Size{8, 5}));
  EXPECT_EQ(crop(0, 0), 203);
  EXPECT_EQ(crop(7, 4), 610);
  EXPECT_EQ(crop.crop({1, 1, 3, 3})(1, 1), 405);
}

TEST(Size, CountsPixelsBeyondThirtyTwoBits) {
  EXPECT_EQ((Size{100'000, 100'000}.pixels()), 10'000'000'000);
  EXPECT_EQ((Rect{0, 0, 100'000, 100'000}.pixels()), 10'000'000'000);
}

// Resident pages of files, in bytes (proc(5), statm).
std::int64_t resident_file_bytes() {
  std::int64_t size = 0, resident = 0, shared = 0;
  std::ifstream("/proc/self/statm") >> size >> resident >> shared;
  return shared * sysconf(_SC_PAGESIZE);
}

TEST(ImageOnDisk, LeavesMemoryWhenPagedOutAndKeepsItsPixels) {
  const TemporaryFolder folder;
  std::optional<Image<float>> image = Image<float>::on_disk({2000, 1000}, 3, folder.path().c_str());
  ASSERT_TRUE(image);
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < 1000; ++y)
      std::fill_n(image->plane(p).row(y), 2000, static_cast<float>(10000 * p + y));
  }
  const std::int64_t held = resident_file_bytes();
  page_out(*image);
  EXPECT_LT(resident_file_bytes(), held - 20'000'000) << "of 24 MB";
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < 1000; y += 99) EXPECT_EQ((*image)(1999, y, p), static_cast<float>(10000 * p + y));
  }
}

}  // namespace
}  // namespace weft
