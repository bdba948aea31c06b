// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/controls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

namespace weft::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ControlsTest : public testing::Test {
 protected:
  std::vector<std::string> told_;
  Controls controls_{[this](const std::string& name) { told_.push_back(name); }};
};

TEST_F(ControlsTest, WhileNobodyHoldsThemEverybodyCommands) {
  EXPECT_EQ(controls_.commander("").value(), "");
  EXPECT_EQ(controls_.commander("an old id").value(), "");
  EXPECT_EQ(controls_.holder(), "");
}

TEST_F(ControlsTest, OneHoldsThemUntilAnotherTakesThemOver) {
  const std::string ann = controls_.take("Ann at the desk", false).value();
  EXPECT_EQ(controls_.commander(ann).value(), "Ann at the desk");
  const auto without = controls_.commander("");
  ASSERT_FALSE(without);
  EXPECT_THAT(without.error().message(), HasSubstr("Ann at the desk"));
  const auto refused = controls_.take("Bob", false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kTryAgain);
  const std::string bob = controls_.take("Bob", true).value();
  EXPECT_NE(ann, bob);
  EXPECT_FALSE(controls_.commander(ann));
  EXPECT_FALSE(controls_.renew(ann));
  EXPECT_TRUE(controls_.renew(bob));
  controls_.release(ann);
  EXPECT_EQ(controls_.holder(), "Bob") << "who does not hold them cannot give them back";
  controls_.release(bob);
  EXPECT_THAT(told_, ElementsAre("Ann at the desk", "Bob", ""));
}

TEST(Controls, AreFreeAndSaySoOnceTheirHolderFallsSilent) {
  std::promise<void> free;
  std::vector<std::string> told;
  Controls controls(
      [&](const std::string& name) {
        told.push_back(name);
        if (name.empty()) free.set_value();
      },
      std::chrono::milliseconds(100));
  const std::string ann = controls.take("Ann", false).value();
  for (int i = 0; i < 5; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    ASSERT_TRUE(controls.renew(ann)) << "after " << 40 * (i + 1) << " ms";
  }
  ASSERT_EQ(free.get_future().wait_for(std::chrono::seconds(5)), std::future_status::ready);
  controls.stop();
  EXPECT_EQ(controls.holder(), "");
  EXPECT_THAT(told, ElementsAre("Ann", ""));
}

TEST_F(ControlsTest, NamesOfWhoeverCommandsArePlain) {
  for (const char* name : {"", "a\nb", "<b>", "\x1b[31m"}) EXPECT_FALSE(controls_.take(name, false)) << name;
  EXPECT_FALSE(controls_.take(std::string(61, 'a'), false));
  EXPECT_EQ(controls_.holder(), "");
  EXPECT_TRUE(controls_.take("Zoë", false));
}

}  // namespace
}  // namespace weft::app
