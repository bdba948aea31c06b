// SPDX-License-Identifier: Apache-2.0
// Scenes that cannot be simulated.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

class BadScene : public testing::Test {
 protected:
  void expect_refused(const std::string& toml, const std::vector<std::string>& words) const {
    put_bytes(work_ / "scene.toml", toml);
    expect_refusal(work_,
                   {"simulate", (work_ / "scene.toml").string(), "-o", (work_ / "a.weft").string(), "-q"}, 65,
                   words);
  }
  Workspace work_;
};

TEST_F(BadScene, AnUnknownKeyIsNamedWithTheNearestKnownOne) {
  expect_refused("[camera]\nwidth = 64\nheigth = 48\n",
                 {"unknown key", "camera.heigth", "scene.toml:3", "\"height\"", "correct or remove"});
}

TEST_F(BadScene, AnUnknownSectionIsNamedWithTheNearestKnownOne) {
  expect_refused("[light]\nflux = 1e7\n",
                 {"unknown key", "light", "scene.toml:1", "\"lights\"", "correct or remove"});
}

TEST_F(BadScene, AnUnknownEffectIsNamedWithTheNearestKnownOne) {
  expect_refused("[effects]\nnear_lights = true\n", {"unknown key", "effects.near_lights", "scene.toml:2",
                                                     "\"near_light\"", "correct or remove"});
}

TEST_F(BadScene, AnOddSideIsRefused) {
  expect_refused("[camera]\nwidth = 65\n", {"camera.width", "scene.toml:2", "even"});
}

TEST_F(BadScene, AValueOutOfRangeIsRefused) {
  expect_refused("[material]\nalbedo = 1.2\n",
                 {"material.albedo", "scene.toml:2", "1.2", "between 0 and 1", "inside"});
}

TEST_F(BadScene, AFileThatIsNoTomlIsRefused) {
  expect_refused("[camera\nwidth = 64\n", {"not TOML", "scene.toml:1", "correct that line"});
}

TEST_F(BadScene, AMissingFileIsNamed) {
  expect_refusal(work_, {"simulate", (work_ / "no.toml").string(), "-o", (work_ / "a.weft").string(), "-q"},
                 66, {"cannot read", "no.toml", "No such file", "check the path"});
}

TEST_F(BadScene, ASessionIsNeverOverwritten) {
  std::filesystem::create_directories(work_ / "a.weft");
  expect_refusal(work_,
                 {"simulate", source_file("testdata/scenes/golden.toml").string(), "-o",
                  (work_ / "a.weft").string(), "-q"},
                 73, {"session exists", "a.weft", "never overwritten", "another name"});
}

}  // namespace
}  // namespace weft::test
