// SPDX-License-Identifier: Apache-2.0
// The benchmark of the simulator's effects prices every one of them.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "simulator/scene/scene.h"
#include "tests/system/program.h"

namespace weft::test {
namespace {

TEST(BenchEffects, HasARowForEveryEffect) {
  const Outcome run = run_weft({"bench", "effects", "--json", "--megapixels", "0.01", "--threads", "2"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json json = run.json();
  EXPECT_TRUE(json.at("machine").contains("processor")) << json;
  std::map<std::string, Json> rows;
  for (const Json& row : json.at("rows")) rows[row.at("effect")] = row;
  for (const simulator::EffectKey& effect : simulator::effect_keys()) {
    EXPECT_TRUE(rows.contains(effect.name)) << effect.name;
  }
  for (const char* name : {"lambert", "near_light + noise", "all"}) {
    EXPECT_TRUE(rows.contains(name)) << name;
  }
  for (const auto& [name, row] : rows) {
    EXPECT_GT(row.at("ns_per_pixel"), 0) << name;
    EXPECT_EQ(row.at("threads"), 2) << name;
    EXPECT_GT(row.at("ratio"), 0) << name;
  }
  EXPECT_EQ(rows["lambert"].at("ratio"), 1);
}

}  // namespace
}  // namespace weft::test
