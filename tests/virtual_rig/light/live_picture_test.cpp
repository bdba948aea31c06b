// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/live_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/image_io/grey_jpeg.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::virtual_rig {
namespace {

Image<std::uint8_t> seen(const LightFrames& frames, double seconds) {
  GatheredLight light;
  light.leds_s.assign(static_cast<std::size_t>(frames.leds()), 0);
  light.leds_s[0] = seconds;
  const std::vector<std::uint8_t> jpeg = live_picture(frames, light);
  auto picture = grey_of_jpeg({reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
  EXPECT_TRUE(picture);
  return picture ? *std::move(picture) : Image<std::uint8_t>({1, 1});
}

TEST(LivePicture, IsAJpegOf640PixelsAtMostWhateverTheFrame) {
  for (const int width : {128, 1400}) {
    const Result<LightFrames> frames = LightFrames::open(small_scene(width), fresh_folder());
    ASSERT_TRUE(frames) << frames.error().message();
    const Image<std::uint8_t> picture = seen(*frames, 0.05);
    EXPECT_LE(std::max(picture.width(), picture.height()), 640) << width;
    EXPECT_GE(picture.width(), std::min(width / 2, 320)) << width;
  }
}

TEST(LivePicture, ChoosesItsBrightnessAndIsNoiseWithoutLight) {
  const Result<LightFrames> frames = LightFrames::open(small_scene(), fresh_folder());
  ASSERT_TRUE(frames) << frames.error().message();
  const auto middle = [](const Image<std::uint8_t>& picture) {
    return static_cast<int>(picture(picture.width() / 2, picture.height() / 2));
  };
  EXPECT_NEAR(middle(seen(*frames, 0.05)), middle(seen(*frames, 0.01)), 25);
  EXPECT_LT(middle(seen(*frames, 0)), 100) << "nothing is lit";
}

}  // namespace
}  // namespace weft::virtual_rig
