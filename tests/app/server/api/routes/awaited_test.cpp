// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/awaited.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace weft::app {
namespace {

using std::chrono::milliseconds;

TEST(Awaited, WaitsNoLongerThanItIsToldAndBeginsOneAtATime) {
  struct Disk {
    std::atomic<bool> hangs = true;
    std::atomic<int> asked = 0;
  };
  const auto disk = std::make_shared<Disk>();
  Awaited<int> awaited(milliseconds(50));
  const auto look = [disk] {
    ++disk->asked;
    disk->hangs.wait(true);
    return 7;
  };
  const auto began = std::chrono::steady_clock::now();
  EXPECT_EQ(awaited.get(look), std::nullopt);
  EXPECT_EQ(awaited.get(look), std::nullopt);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  EXPECT_GE(took_s, 0.1);
  EXPECT_LT(took_s, 2);
  EXPECT_EQ(disk->asked, 1) << "the second waits for what the first began";
  disk->hangs = false;
  disk->hangs.notify_all();
  std::optional<int> seven;
  for (int tries = 0; tries < 100 && !seven; ++tries) seven = awaited.get(look);
  EXPECT_EQ(seven, 7);
}

}  // namespace
}  // namespace weft::app
