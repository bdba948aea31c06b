// SPDX-License-Identifier: Apache-2.0
// Long runs: nothing grows, nothing is lost.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>

#include "tests/capture/camera/usb_bench.h"

namespace weft::capture {
namespace {

int open_descriptors() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

/// Resident memory of a process in MiB.
double resident_mib(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/statm");
  double pages = 0;
  file >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

TEST(CameraSoak, FiveHundredPhotographsLeaveMemoryAndDescriptorsFlat) {
  LinkBench bench;
  CameraLink& link = bench.ready();
  double early_mib = 0;
  int early = 0;
  for (int i = 1; i <= 500; ++i) {
    const auto taken = link.take(bench.raw(i), [] {});
    ASSERT_TRUE(taken) << i << ": " << taken.error().message();
    ASSERT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(i)), "") << i;
    std::filesystem::remove(taken->file);
    if (i != 50) continue;
    early_mib = resident_mib(link.worker_pid());
    early = open_descriptors();
  }
  EXPECT_LT(resident_mib(link.worker_pid()), early_mib + 4)
      << "MiB after 500 photographs, after 50 on the right";
  EXPECT_EQ(open_descriptors(), early);
}

TEST(CameraSoak, AHundredReconnectionsLeaveMemoryAndDescriptorsFlat) {
  LinkBench bench;
  bench.ready();
  const int early = open_descriptors();
  const double early_mib = resident_mib(getpid());
  for (int i = 0; i < 100; ++i) {
    const auto facts = bench.link().recover();
    ASSERT_TRUE(facts) << i << ": " << facts.error().message();
  }
  EXPECT_EQ(open_descriptors(), early);
  EXPECT_LT(resident_mib(getpid()), early_mib + 8);
}

TEST(CameraSoak, TwoHundredKillsAtRandomMomentsLoseNothing) {
  std::mt19937 random(2026);
  LinkBench bench;
  bench.hurry(3);
  bench.ready();
  for (int i = 1; i <= 200; ++i) {
    const pid_t worker = bench.link().worker_pid();
    const auto when = std::chrono::milliseconds(std::uniform_int_distribution(0, 300)(random));
    std::jthread killer([&] {
      std::this_thread::sleep_for(when);
      ::kill(worker, SIGKILL);
    });
    const auto taken = bench.take_patiently(i);
    killer.join();
    ASSERT_TRUE(taken) << i << ", killed after " << when.count() << " ms: " << taken.error().message();
    ASSERT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "")
        << i << ", killed after " << when.count() << " ms";
  }
  EXPECT_EQ(left_over(bench.folder() / "raw"), 0);
}

/// A person looks through the finder, which may fail, and then something is scanned, a hundred times.
void look_and_scan(LinkBench& bench, std::mt19937& random) {
  const std::vector<std::string> faults = {"", "", "live_stalls", "live_ends", "never_live"};
  bench.hurry(3);
  bench.ready();
  for (int run = 0; run < 100; ++run) {
    const std::string fault =
        faults[std::uniform_int_distribution<std::size_t>(0, faults.size() - 1)(random)];
    const int looks = std::uniform_int_distribution(1, 4)(random);
    const int fails_at = std::uniform_int_distribution(0, looks)(random);
    for (int look = 0; look < looks; ++look) {
      if (!fault.empty() && look == fails_at) {
        ASSERT_TRUE(bench.camera().inject({fault, 1}));
      }
      if (const auto picture = bench.link().look(); picture) continue;
      ASSERT_TRUE(bench.camera().inject({"well", 1}));
      const auto back = bench.link().recover();
      ASSERT_TRUE(back) << run << ", " << fault << ": " << back.error().message();
    }
    ASSERT_TRUE(bench.camera().inject({"well", 1}));
    if (std::bernoulli_distribution(0.5)(random)) static_cast<void>(bench.link().stop_looking());
    for (int shot = 0; shot < 3; ++shot) {
      const auto taken = bench.take_patiently(3 * run + shot);
      ASSERT_TRUE(taken) << run << ", " << fault << ": " << taken.error().message();
      ASSERT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "")
          << run << ", " << fault;
      ASSERT_NEAR(taken->exposure.exposure_us, 1e6 / 60, 1) << run << ": a setting was changed";
      ASSERT_EQ(taken->exposure.iso, 100) << run;
      ASSERT_EQ(taken->exposure.f_number, 8) << run;
    }
  }
  EXPECT_EQ(bench.retakes(), 0) << bench.last_error().message();
}

TEST(CameraSoak, TwoHundredRunsOfLiveViewAndScansLoseNothing) {
  std::mt19937 random(2027);
  LinkBench network(with_finder());
  look_and_scan(network, random);
  if (HasFailure()) return;
  UsbBench usb("soak");
  look_and_scan(usb, random);
}

}  // namespace
}  // namespace weft::capture
