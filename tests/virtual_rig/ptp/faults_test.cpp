// SPDX-License-Identifier: Apache-2.0
// What each fault of the camera looks like from libgphoto2's side: the table of the research notes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <set>

#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"
#include "virtual_rig/ptp/faults.h"

namespace weft::virtual_rig {
namespace {

/// libgphoto2 gives up a read after 2.5 s.
constexpr double kReadTimeout = 2.5;

std::unique_ptr<GphotoClient> connected(const std::string& port, const char* target = "Internal RAM") {
  auto client = std::make_unique<GphotoClient>(port);
  EXPECT_EQ(client->init(), GP_OK);
  EXPECT_EQ(client->set("capturetarget", target), GP_OK);
  EXPECT_EQ(client->set("shutterspeed2", "1/60"), GP_OK);
  return client;
}

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

VirtualCameraOptions quick() {
  return {.away_s = 0.8, .late_s = 0.6};
}

struct LossCase {
  const char* fault;
  double least_s, most_s;  ///< until the client knows
};
void PrintTo(const LossCase& loss, std::ostream* out) {
  *out << loss.fault;
}

class LostShot : public testing::TestWithParam<LossCase> {};

TEST_P(LostShot, IsAnErrorInTimeAndTheNextSessionsShotsAreRight) {
  const LossCase loss = GetParam();
  Studio studio(quick());
  studio.inject(loss.fault, 2);
  auto client = connected(studio.network());
  ASSERT_EQ(studio.number_of(client->shoot().file.bytes), 1u);

  GphotoClient::Shot lost;
  const double took_s = seconds([&] { lost = client->shoot(4); });
  EXPECT_FALSE(lost.whole());
  EXPECT_TRUE(lost.triggered < 0 || lost.waited < 0) << lost.triggered << ' ' << lost.waited;
  EXPECT_GE(took_s, loss.least_s);
  EXPECT_LE(took_s, loss.most_s);
  client->exit();

  client = connected(studio.network());
  for (int i = 0; i < 2; ++i) {
    const auto number = static_cast<std::uint32_t>(studio.camera().shots() + 1);
    EXPECT_EQ(studio.number_of(client->shoot().file.bytes), number) << number;
  }
}

INSTANTIATE_TEST_SUITE_P(VirtualCamera, LostShot,
                         testing::Values(LossCase{"drop_in_exposure", 0, kReadTimeout},
                                         LossCase{"drop_before_object", 0, kReadTimeout},
                                         LossCase{"drop_in_data", 0, kReadTimeout},
                                         LossCase{"no_answer", kReadTimeout, 3 * kReadTimeout},
                                         LossCase{"data_stalls", kReadTimeout, 3 * kReadTimeout},
                                         LossCase{"data_ends_early", 0, 3 * kReadTimeout}),
                         [](const auto& one) { return std::string(one.param.fault); });

TEST(CameraFaults, AnOldShotIsTheFirstThingThatTheNextSessionGets) {
  Studio studio(quick());
  studio.inject("old_shot");
  auto client = connected(studio.network());
  EXPECT_FALSE(client->shoot().whole());
  client = connected(studio.network());
  const GphotoClient::Shot old = client->next_file(2);
  ASSERT_TRUE(old.added);
  EXPECT_EQ(studio.number_of(old.file.bytes), 1u);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 2u);
}

TEST(CameraFaults, SilenceAtTheOpeningOfASessionCostsThreeReads) {
  ClientProcess client([](const std::string& port) { return -GphotoClient(port).init(); });
  Studio studio(quick());
  studio.inject("open_session_silent");
  client.begin(studio.network());
  ClientProcess::End end;
  EXPECT_NEAR(seconds([&] { end = client.wait(15); }), 3 * kReadTimeout, 2);
  EXPECT_EQ(end.exit_code, -GP_ERROR_TIMEOUT);
  EXPECT_EQ(GphotoClient(studio.network()).init(), GP_OK);
}

TEST(CameraFaults, AHostTurnedAwayKnowsAtOnce) {
  Studio studio(quick());
  studio.inject("init_fail");
  GphotoClient client(studio.network());
  EXPECT_LT(client.init(), 0);
  EXPECT_EQ(client.init(), GP_OK);
}

TEST(CameraFaults, AClosedPortIsKnownAtOnceAndOpensAgain) {
  Studio studio(quick());
  studio.inject("refused");
  GphotoClient client(studio.network());
  EXPECT_LT(seconds([&] { EXPECT_LT(client.init(), 0); }), kReadTimeout);
  EXPECT_EQ(client.init_within(5), GP_OK);
}

TEST(CameraFaults, ABusyCameraLetsTheTriggerSayThatAllIsWell) {
  Studio studio(quick());
  studio.inject("capture_busy");
  const auto client = connected(studio.network());
  EXPECT_EQ(client->trigger(), GP_OK) << "libgphoto2 2.5.30 keeps silent about it";
  EXPECT_FALSE(client->next_file(0.3).added);
  EXPECT_EQ(studio.camera().shots(), 0);
}

TEST(CameraFaults, BusyForEverBlocksTheTriggerUntilItsProcessIsKilled) {
  ClientProcess client([](const std::string& port) { return connected(port)->trigger() == GP_OK ? 0 : 1; });
  Studio studio(quick());
  studio.inject("busy_for_ever");
  client.begin(studio.network());
  EXPECT_FALSE(client.wait(1.5).ended);
  EXPECT_EQ(studio.camera().shots(), 1);
  client.kill();
  EXPECT_EQ(studio.number_of(connected(studio.network())->shoot().file.bytes), 2u);
}

TEST(CameraFaults, AnObjectThatNeverComesIsAQuestionOfTheClientsDeadline) {
  Studio studio(quick());
  studio.inject("no_object");
  const auto client = connected(studio.network());
  const GphotoClient::Shot none = client->shoot(0.6);
  EXPECT_EQ(none.waited, GP_OK);
  EXPECT_FALSE(none.added);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 2u);
}

TEST(CameraFaults, ASizeThatIsALieIsAShortFileInCardMode) {
  Studio studio(quick());
  studio.inject("object_size_lie");
  const auto client = connected(studio.network(), "Memory card");
  const GphotoClient::Shot shot = client->shoot();
  EXPECT_TRUE(shot.added);
  EXPECT_TRUE(shot.file.code < 0 || shot.file.bytes.size() < shot.file.said_bytes)
      << shot.file.bytes.size() << " of " << shot.file.said_bytes;
}

TEST(CameraFaults, AShortFileIsOneThatTheCameraIsContentWith) {
  Studio studio(quick());
  studio.inject("short_data");
  const GphotoClient::Shot shot = connected(studio.network())->shoot();
  ASSERT_TRUE(shot.whole());
  EXPECT_EQ(shot.file.bytes.size(), Studio::kFileBytes / 2);
}

class HarmlessFault : public testing::TestWithParam<const char*> {};

TEST_P(HarmlessFault, CostsNoPicture) {
  Studio studio(quick());
  studio.inject(GetParam());
  const auto client = connected(studio.network());
  for (std::uint32_t number = 1; number <= 2; ++number)
    EXPECT_EQ(studio.number_of(client->shoot().file.bytes), number) << number;
}

INSTANTIATE_TEST_SUITE_P(VirtualCamera, HarmlessFault,
                         testing::Values("no_capture_complete", "property_noise"),
                         [](const auto& one) { return std::string(one.param); });

TEST(CameraFaults, AnUnknownPropertysEventIsOneErrorAndNoLostLink) {
  Studio studio(quick());
  studio.inject("unsupported_property");
  const auto client = connected(studio.network());
  ASSERT_EQ(client->trigger(), GP_OK);
  int errors = 0;
  GphotoClient::Event event;
  for (int tries = 0; tries < 20 && event.type != GP_EVENT_FILE_ADDED; ++tries) {
    event = client->wait(100);
    errors += event.code < 0;
  }
  EXPECT_LE(errors, 1);
  ASSERT_EQ(event.type, GP_EVENT_FILE_ADDED);
  EXPECT_EQ(studio.number_of(client->fetch(event.path).bytes), 1u);
}

TEST(CameraFaults, ALateFileComesInTheNextShotsTime) {
  Studio studio(quick());
  studio.inject("file_late");
  const auto client = connected(studio.network());
  EXPECT_FALSE(client->shoot(0.2).added);
  ASSERT_EQ(client->set("shutterspeed2", "1/1"), GP_OK);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 1u) << "the mislabelled one";
  EXPECT_EQ(studio.number_of(client->next_file(2).file.bytes), 2u);
}

TEST(CameraFaults, ADuplicateIsTheFileBefore) {
  Studio studio(quick());
  studio.inject("duplicate_frame", 2);
  const auto client = connected(studio.network());
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 1u);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 1u);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 3u);
}

TEST(CameraFaults, ACameraThatIsSwitchedOffIsBackAfterAWhileAndCountsOn) {
  Studio studio(quick());
  studio.inject("power_cycle");
  auto client = connected(studio.network());
  EXPECT_LT(seconds([&] { EXPECT_FALSE(client->shoot().whole()); }), kReadTimeout);
  EXPECT_LT(client->init(), 0);
  ASSERT_EQ(client->init_within(5), GP_OK);
  EXPECT_EQ(client->get("shutterspeed2"), "1/60");
  EXPECT_FALSE(client->next_file(0.3).added) << "a picture that was lost";
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 2u);
}

TEST(CameraFaults, ACameraThatIsOffComesBackWhenItIsSwitchedOn) {
  Studio studio(quick());
  studio.inject("power_off");
  auto client = connected(studio.network());
  EXPECT_FALSE(client->shoot().whole());
  EXPECT_LT(client->init(), 0);
  studio.inject("power_on");
  EXPECT_EQ(client->init(), GP_OK);
}

TEST(CameraFaults, HandsOnTheBodyShowInItsSettings) {
  Studio studio(quick());
  const auto client = connected(studio.network());
  studio.inject("battery_low");
  client->wait(1);
  EXPECT_THAT(client->get("batterylevel"), testing::HasSubstr("5%"));
  studio.inject("exposure_changed");
  client->wait(1);
  EXPECT_EQ(client->get("shutterspeed2"), "1/50");
  studio.inject("raw_off");
  client->wait(1);
  EXPECT_NE(client->get("imagequality"), "NEF (Raw)");
  studio.inject("auto_iso");
  client->wait(1);
  EXPECT_EQ(client->get("isoauto"), "On");
  EXPECT_EQ(client->get("iso"), "100");
  studio.inject("dial_turned");
  client->wait(1);
  EXPECT_EQ(client->get("expprogram"), "P");
  EXPECT_TRUE(client->read_only("shutterspeed2"));
}

TEST(CameraFaults, HandsOnTheBodyWaitForTheShotBefore) {
  Studio studio(quick());
  const auto client = connected(studio.network());
  studio.inject("exposure_changed", 2);
  EXPECT_EQ(client->get("shutterspeed2"), "1/60");
  ASSERT_TRUE(client->shoot().whole());
  client->wait(1);
  EXPECT_EQ(client->get("shutterspeed2"), "1/50");
}

TEST(CameraFaults, AClockThatIsSetStepsByAsMuch) {
  Studio studio(quick());
  // A client keeps for a while what it has read.
  const auto clock = [&] { return std::stod(connected(studio.network())->get("datetime")); };
  const double before = clock();
  studio.inject("clock_back");
  EXPECT_NEAR(clock() - before, -3600, 5);
  studio.inject("clock_ahead");
  studio.inject("clock_ahead");
  EXPECT_NEAR(clock() - before, 3600, 5);
  studio.inject("clock_reset");
  EXPECT_NEAR(clock(), 946684800, 86400) << "the year 2000 of any zone";
  studio.inject("well");
  EXPECT_NEAR(clock() - before, 0, 5);
}

TEST(CameraFaults, AKilledClientsShotIsTheNextSessionsFirst) {
  ClientProcess client([](const std::string& port) {
    const auto child = connected(port);
    child->set("shutterspeed2", "1/2");
    return child->trigger();
  });
  Studio studio(quick());
  client.begin(studio.network());
  while (studio.camera().shots() == 0 && !client.wait(0.01).ended) {
  }
  client.kill();
  EXPECT_EQ(studio.number_of(connected(studio.network())->next_file(3).file.bytes), 1u);
}

TEST(CameraFaults, HaveNamesOfTheirOwnAndASentenceEach) {
  std::set<std::string> names;
  for (const auto& [name, sentence] : camera_faults()) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_TRUE(sentence.ends_with('.')) << sentence;
  }
  Studio studio;
  EXPECT_EQ(studio.camera().inject({"no_such_fault", 1}).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(studio.camera().inject({"power_off", 0}).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace weft::virtual_rig
