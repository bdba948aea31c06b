// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "tests/core/places.h"

namespace weft::bench {
namespace {

const std::filesystem::path kRig = source_folder() / "testdata/scenes/rig.toml";

TEST(Chain, HasCasesThatCanBeSimulatedEachOfAnotherName) {
  const auto cases = chain_cases(kRig, 1);
  ASSERT_TRUE(cases.has_value()) << cases.error().message();
  std::set<std::string> names;
  for (const ChainCase& one : *cases) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    const Result<void> sound = simulator::check_scene(one.scene);
    EXPECT_TRUE(sound.has_value()) << one.name << ": " << sound.error().message();
  }
}

TEST(Chain, DrawsOtherClothsForAnotherSeed) {
  const auto first = chain_cases(kRig, 1), second = chain_cases(kRig, 2);
  ASSERT_TRUE(first.has_value() && second.has_value());
  for (std::size_t i = 0; i < first->size(); ++i)
    EXPECT_NE((*first)[i].scene.geometry, (*second)[i].scene.geometry) << (*first)[i].name;
}

TEST(Chain, NamesTheCasesWhereOneIsUnknown) {
  AccuracyTableOptions options;
  options.scenes = std::filesystem::path(kRig).parent_path();
  options.scene = "brocade";
  const auto refused = chain_table(options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_NE(refused.error().message().find("plain satin"), std::string::npos) << refused.error().message();
}

}  // namespace
}  // namespace weft::bench
