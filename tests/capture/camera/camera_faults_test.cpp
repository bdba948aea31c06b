// SPDX-License-Identifier: Apache-2.0
// Each fault of a camera costs one photograph and under 10 s, and none is kept that is not its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "tests/capture/camera/link_bench.h"

namespace weft::capture {
namespace {

constexpr double kMostS = 10;

struct Befallen {
  const char* fault;
  double most_s = kMostS;
};

std::ostream& operator<<(std::ostream& out, const Befallen& befallen) {
  return out << befallen.fault;
}

class CameraFaults : public testing::TestWithParam<Befallen> {};

TEST_P(CameraFaults, CostOnePhotographAndUnderTenSeconds) {
  virtual_rig::VirtualCameraOptions options;
  options.away_s = 1.5;
  LinkBench bench(options);
  bench.ready();
  ASSERT_TRUE(bench.camera().inject({GetParam().fault, 2}));
  std::uint32_t last = 0;
  for (int i = 1; i <= 4; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const auto taken = bench.take_patiently(i);
    ASSERT_TRUE(taken) << i << ": " << taken.error().message();
    EXPECT_LT(seconds_since(begin), GetParam().most_s) << bench.last_error().message();
    EXPECT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "")
        << "photograph " << i << " is not the camera's latest";
    EXPECT_GT(*taken->image_number, last);
    last = *taken->image_number;
  }
  EXPECT_LE(bench.retakes(), 1) << bench.last_error().message();
  EXPECT_EQ(left_over(bench.folder() / "raw"), 0);
  RecordProperty("retakes", bench.retakes());
  RecordProperty("error", bench.last_error().message());
}

std::vector<Befallen> of_shots() {
  return {{"drop_in_exposure"},    {"drop_before_object"}, {"drop_in_data"},         {"old_shot"},
          {"no_answer"},           {"data_stalls"},        {"data_ends_early"},      {"capture_busy"},
          {"busy_for_ever"},       {"no_object"},          {"object_size_lie"},      {"short_data"},
          {"no_capture_complete"}, {"property_noise"},     {"unsupported_property"}, {"duplicate_frame"},
          {"power_cycle"},         {"clock_back"},         {"clock_ahead"},          {"clock_reset"}};
}

INSTANTIATE_TEST_SUITE_P(OfAShot, CameraFaults, testing::ValuesIn(of_shots()), [](const auto& befallen) {
  std::string name;
  for (const char c : std::string(befallen.param.fault)) {
    if (c != '_') name += c;
  }
  return name;
});

/// The hurried profile gives up before the file is there, which then comes in the middle of another shot.
TEST(CameraFaults, DoNotLetALateFilePassForAnother) {
  for (const double late_s : {1.7, 2.0, 2.4, 3.0}) {
    virtual_rig::VirtualCameraOptions options;
    options.late_s = late_s;
    LinkBench bench(options);
    bench.hurry(1);
    bench.ready();
    ASSERT_TRUE(bench.camera().inject({"file_late", 2}));
    for (int i = 1; i <= 8; ++i) {
      const auto taken = bench.take_patiently(i);
      ASSERT_TRUE(taken) << i << ": " << taken.error().message();
      EXPECT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "")
          << "photograph " << i << ", one file " << late_s << " s late";
    }
  }
}

TEST(CameraFaults, OfASessionThatIsNotOpenedEndInTime) {
  for (const char* fault : {"open_session_silent", "init_fail", "refused"}) {
    LinkBench bench;
    ASSERT_TRUE(bench.camera().inject({fault, 1}));
    const auto begin = std::chrono::steady_clock::now();
    auto facts = bench.link().connect();
    while (!facts && seconds_since(begin) < kMostS) facts = bench.link().connect();
    EXPECT_TRUE(facts) << fault << ": " << facts.error().message();
    EXPECT_LT(seconds_since(begin), kMostS) << fault;
  }
}

TEST(CameraFaults, OfACardThatTakesTooLongToListSaysWhatToDoWithIt) {
  LinkBench bench;
  ASSERT_TRUE(bench.camera().inject({"card_full", 1}));
  const auto facts = bench.link().connect();
  ASSERT_FALSE(facts);
  EXPECT_EQ(facts.error().kind, ErrorKind::kTryAgain) << facts.error().message();
  EXPECT_THAT(facts.error().remedy, testing::HasSubstr("format it or take it out"));
  EXPECT_TRUE(bench.link().connect()) << "without the card";
}

TEST(CameraFaults, OfTheWorkerAtAnyMomentLoseNothing) {
  std::mt19937 random(1);
  LinkBench bench;
  bench.hurry(2);
  bench.ready();
  int kills = 0;
  for (int i = 1; i <= 10; ++i) {
    const pid_t worker = bench.link().worker_pid();
    const auto when = std::chrono::milliseconds(std::uniform_int_distribution(0, 250)(random));
    std::jthread killer([&] {
      std::this_thread::sleep_for(when);
      kills += ::kill(worker, SIGKILL) == 0 ? 1 : 0;
    });
    const auto taken = bench.take_patiently(i);
    killer.join();
    ASSERT_TRUE(taken) << i << ": " << taken.error().message();
    EXPECT_EQ(wrong_with(*taken, static_cast<std::uint32_t>(bench.camera().shots())), "")
        << "killed after " << when.count() << " ms";
  }
  EXPECT_EQ(left_over(bench.folder() / "raw"), 0);
  EXPECT_GT(kills, 5) << "of a worker that was there";
}

}  // namespace
}  // namespace weft::capture
