// SPDX-License-Identifier: Apache-2.0
// Live view of the virtual camera, as the real libgphoto2 asks for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"

namespace weft::virtual_rig {
namespace {

VirtualCameraOptions with_finder(double most_s = 600) {
  VirtualCameraOptions options;
  options.away_s = 0.3;
  options.finder_s = most_s;
  // Numbered pictures between the two ends of a JPEG.
  options.finder = [number = std::uint8_t{0}]() mutable {
    return std::vector<std::uint8_t>{0xff, 0xd8, ++number, 0, 0xff, 0xd9};
  };
  return options;
}

std::unique_ptr<GphotoClient> looking(const std::string& port) {
  auto client = std::make_unique<GphotoClient>(port);
  EXPECT_EQ(client->init(), GP_OK);
  EXPECT_EQ(client->set("capturetarget", "Internal RAM"), GP_OK);
  EXPECT_EQ(client->set("shutterspeed2", "1/60"), GP_OK);
  return client;
}

TEST(LiveView, GivesAPictureEachTimeItIsAskedFor) {
  Studio studio(with_finder());
  const auto client = looking(studio.network());
  std::uint8_t last = 0;
  const auto began = std::chrono::steady_clock::now();
  for (int i = 0; i < 10; ++i) {
    const GphotoClient::File picture = client->preview();
    ASSERT_EQ(picture.code, GP_OK) << i;
    ASSERT_EQ(picture.bytes.size(), 6U) << i;
    EXPECT_GT(picture.bytes[2], last) << "a new one";
    last = picture.bytes[2];
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_GT(seconds, 9 * 0.066) << "no faster than the body";
  EXPECT_EQ(client->get("viewfinder"), "1");
  EXPECT_EQ(studio.camera().shots(), 0);
}

TEST(LiveView, EndsWhenItIsToldToAndBeforeAnExposure) {
  Studio studio(with_finder());
  const auto client = looking(studio.network());
  ASSERT_EQ(client->preview().code, GP_OK);
  ASSERT_EQ(client->set("viewfinder", "0"), GP_OK);
  EXPECT_EQ(client->get("viewfinder"), "0");
  EXPECT_TRUE(client->shoot().whole());
  EXPECT_EQ(client->preview().code, GP_OK) << "it starts again";
}

TEST(LiveView, WaitsForAPictureThatNobodyHasFetched) {
  Studio studio(with_finder());
  const auto client = looking(studio.network());
  ASSERT_GE(client->trigger(), GP_OK);
  EXPECT_LT(client->preview().code, 0) << "the body's memory holds a photograph";
  ASSERT_TRUE(client->next_file(3).added);
  EXPECT_EQ(client->preview().code, GP_OK);
}

TEST(LiveView, StartsAgainWhereTheBodyEndedIt) {
  Studio studio(with_finder());
  const auto client = looking(studio.network());
  ASSERT_EQ(client->preview().code, GP_OK);
  studio.inject("live_ends");
  EXPECT_EQ(client->preview().code, GP_OK);
}

}  // namespace
}  // namespace weft::virtual_rig
