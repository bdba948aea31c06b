// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/sanity/drawn_cloth.h"
#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::bench {
namespace {

// The formula is wrong by a factor that a fact tells, exp(slope - 0.5), and noise adds to it.
std::vector<BlockError> drawn_blocks(std::uint32_t seed, int count) {
  Draws draws(seed);
  std::vector<BlockError> blocks(static_cast<std::size_t>(count));
  for (BlockError& block : blocks) {
    for (float& fact : block.facts) fact = static_cast<float>(draws.between(-1, 1));
    block.facts[solver::kSlope] = static_cast<float>(draws.between(0, 1));
    block.other2 = 0.04;
    const double model = std::exp(static_cast<double>(block.facts[solver::kLogModel]) +
                                  static_cast<double>(block.facts[solver::kSlope]) - 0.5);
    block.error_deg = solver::kMeanOfRms * std::sqrt(model * model + block.other2);
    block.weight = block.pixels = 1;
  }
  return blocks;
}

TEST(ForecastOfBlocks, LearnsAFactorThatAFactTells) {
  const ErrorNetwork learned = teach(drawn_blocks(1, 400), 1);
  double square = 0;
  const std::vector<BlockError> others = drawn_blocks(2, 100);
  for (const BlockError& block : others) {
    const double truth = static_cast<double>(block.facts[solver::kSlope]) - 0.5;
    square += std::pow(learned.log_factor(block.facts) - truth, 2);
  }
  EXPECT_LT(std::sqrt(square / 100), 0.1) << "of factors between exp(-0.5) and exp(0.5)";
}

TEST(ErrorNetwork, IsASumOfNeuronsOverScatter) {
  ErrorNetwork one;
  one.scatter.fill(1);
  one.mean[solver::kSlope] = 0.2;
  one.scatter[solver::kSlope] = 0.1;
  one.hidden[3][solver::kSlope] = 0.5;
  one.hidden[3][solver::kBlockFacts] = -0.25;
  one.sum[3] = 2;
  one.sum[ErrorNetwork::kHidden] = 0.1;
  solver::BlockFacts facts = {};
  facts[solver::kSlope] = 0.4F;
  EXPECT_NEAR(one.log_factor(facts), 0.1 + 2 * std::tanh(0.5 * 2 - 0.25), 1e-6);
}

TEST(ForecastOfBlocks, IsTheSameForTheSameBlocksAndSeed) {
  const std::vector<BlockError> blocks = drawn_blocks(3, 60);
  EXPECT_EQ(teach(blocks, 7).sum, teach(blocks, 7).sum);
}

TEST(ForecastOfBlocks, SaysWhichLineIsNoBlock) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "blocks.jsonl";
  ASSERT_TRUE(write_file(file, "{\"facts\": [1, 2]}\n"));
  const Result<std::vector<BlockError>> read = read_blocks(file);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  EXPECT_NE(read.error().message().find("line 1"), std::string::npos) << read.error().message();
}

}  // namespace
}  // namespace weft::bench
