// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/live_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "tests/virtual_rig/small_scene.h"

namespace weft::virtual_rig {
namespace {

cv::Mat seen(const LightFrames& frames, double seconds) {
  GatheredLight light;
  light.leds_s.assign(static_cast<std::size_t>(frames.leds()), 0);
  light.leds_s[0] = seconds;
  return cv::imdecode(live_picture(frames, light), cv::IMREAD_GRAYSCALE);
}

TEST(LivePicture, IsAJpegOf640PixelsAtMostWhateverTheFrame) {
  for (const int width : {128, 1400}) {
    const Result<LightFrames> frames = LightFrames::open(small_scene(width), fresh_folder());
    ASSERT_TRUE(frames) << frames.error().message();
    const cv::Mat picture = seen(*frames, 0.05);
    EXPECT_LE(std::max(picture.cols, picture.rows), 640) << width;
    EXPECT_GE(picture.cols, std::min(width / 2, 320)) << width;
  }
}

TEST(LivePicture, ChoosesItsBrightnessAndIsNoiseWithoutLight) {
  const Result<LightFrames> frames = LightFrames::open(small_scene(), fresh_folder());
  ASSERT_TRUE(frames) << frames.error().message();
  const auto middle = [](const cv::Mat& picture) {
    return static_cast<int>(picture.at<std::uint8_t>(picture.rows / 2, picture.cols / 2));
  };
  EXPECT_NEAR(middle(seen(*frames, 0.05)), middle(seen(*frames, 0.01)), 25);
  EXPECT_LT(middle(seen(*frames, 0)), 100) << "nothing is lit";
}

}  // namespace
}  // namespace weft::virtual_rig
