// SPDX-License-Identifier: Apache-2.0
#include "bench/batch/farm_simulation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::bench {
namespace {

TEST(FarmSimulation, TakesOneRoundAfterTheOtherWhereNothingFails) {
  FarmModel model;
  model.nodes = 3;
  model.slots = 4;
  model.tasks = 25;  // three rounds of twelve slots
  model.sessions = 7;
  model.session_s = 2;
  model.start_s = 0.5;
  const FarmOutcome outcome = simulate_farm(model);
  EXPECT_NEAR(outcome.seconds, 3 * (7 * 2 + 0.5), 1e-9);
  EXPECT_EQ(outcome.sessions, 25 * 7);
  EXPECT_NEAR(outcome.useful_s, 25 * (7 * 2 + 0.5), 1e-9);
  EXPECT_NEAR(outcome.busy, 25.0 / 36, 1e-12);
  EXPECT_EQ(outcome.failures, 0);
}

TEST(FarmSimulation, WaitsForAControllerThatStartsFewTasksASecond) {
  FarmModel model;
  model.nodes = 100;
  model.tasks = 100;
  model.session_s = 3;
  model.starts_rate = 4;
  EXPECT_NEAR(simulate_farm(model).seconds, 99 / 4.0 + 3, 1e-9);
}

TEST(FarmSimulation, IsAsSlowAsTheStoreWhereThatIsTooSlow) {
  FarmModel model;
  model.nodes = 10;
  model.slots = 2;
  model.tasks = 20;
  model.sessions = 50;
  model.session_s = 1;
  model.bytes = 100;  // 2000 a second asked for
  model.store_rate = 500;
  EXPECT_NEAR(simulate_farm(model).seconds, 20 * 50 * 100 / 500.0, 1e-6);
  model.store_rate = 2001;
  EXPECT_NEAR(simulate_farm(model).seconds, 50, 1e-9) << "a store that is fast enough slows nothing";
}

TEST(FarmSimulation, SharesTheStoreAmongThoseThatAreLeft) {
  FarmModel model;
  model.slots = 2;
  model.tasks = 3;
  model.session_s = 1;
  model.bytes = 1;
  model.store_rate = 1;  // two at half speed, then one at full speed
  EXPECT_NEAR(simulate_farm(model).seconds, 2 + 1, 1e-9);
}

TEST(FarmSimulation, IsAsSlowAsTheLinkOfANode) {
  FarmModel model;
  model.slots = 8;
  model.tasks = 8;
  model.sessions = 10;
  model.session_s = 1;
  model.bytes = 300;
  model.node_rate = 1200;
  EXPECT_NEAR(simulate_farm(model).seconds, 10 * 300 * 8 / 1200.0, 1e-9);
}

TEST(FarmSimulation, SpreadsSecondsAboutTheirMean) {
  FarmModel model;
  model.tasks = 1;
  model.sessions = 40000;
  model.session_s = 2;
  model.spread = 0.5;
  const double mean = simulate_farm(model).seconds / model.sessions;
  EXPECT_NEAR(mean, 2, 4 * 2 * 0.5 / std::sqrt(40000.0)) << "four standard errors";
}

// A session of s seconds that begins anew at each failure of rate r takes (exp(r s) - 1) / r on average
// (Daly, 2006, with a checkpoint after each session).
TEST(FarmSimulation, LosesTheSessionInHandAtEachFailure) {
  FarmModel model;
  model.tasks = 1;
  model.sessions = 20000;
  model.session_s = 1;
  model.failure_rate = 0.5;
  const FarmOutcome outcome = simulate_farm(model);
  const double expected = std::expm1(0.5) / 0.5;
  EXPECT_NEAR(outcome.seconds / model.sessions, expected, 0.02 * expected);
  EXPECT_EQ(outcome.sessions, model.sessions) << "each once";
  EXPECT_EQ(outcome.lost, outcome.failures);
  EXPECT_NEAR(outcome.useful_s, model.sessions, 1e-6);
  EXPECT_NEAR(outcome.useful_s + outcome.lost_s, outcome.seconds, 1e-6);
}

TEST(FarmSimulation, WaitsUntilAFailureIsNoticedAndTheNodeIsBack) {
  FarmModel model;
  model.tasks = 1;
  model.sessions = 5000;
  model.session_s = 1;
  model.failure_rate = 0.01;
  model.notice_s = 20;
  model.wait_s = 5;
  model.repair_s = 1;
  const FarmOutcome outcome = simulate_farm(model);
  EXPECT_GT(outcome.failures, 10);
  EXPECT_NEAR(outcome.seconds,
              outcome.useful_s + outcome.lost_s + 25.0 * static_cast<double>(outcome.requeued), 1e-6);
}

TEST(FarmSimulation, GivesTheSameForTheSameSeed) {
  FarmModel model;
  model.nodes = 5;
  model.slots = 3;
  model.tasks = 200;
  model.sessions = 4;
  model.spread = 0.3;
  model.failure_rate = 0.01;
  model.repair_s = 3;
  const FarmOutcome first = simulate_farm(model), second = simulate_farm(model);
  EXPECT_EQ(first.seconds, second.seconds);
  EXPECT_EQ(first.lost_s, second.lost_s);
  EXPECT_EQ(first.sessions, 800);
  model.seed = 2;
  EXPECT_NE(simulate_farm(model).seconds, first.seconds);
}

}  // namespace
}  // namespace weft::bench
