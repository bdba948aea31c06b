// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "bench/sanity/sanity.h"

namespace weft::bench {
namespace {

constexpr std::uint32_t kSeed = 9;  // a ball, of which even half a turn is told

class SetFaults : public testing::TestWithParam<std::size_t> {};

TEST_P(SetFaults, IsToldOrMendedAndNothingIsSaidWithoutOne) {
  const SetFault& fault = set_faults()[GetParam()];
  const Result<SetOutcome> outcome = outcome_of(fault, kSeed);
  ASSERT_TRUE(outcome) << outcome.error().message();
  const bool is_none = fault.verdicts.empty() && fault.words.empty();
  const bool is_told = outcome->told == Told::kNamed || outcome->told == Told::kMended;
  if (is_none) {
    EXPECT_EQ(outcome->told, Told::kNot) << fault.name << ": " << outcome->said;
  } else {
    EXPECT_TRUE(is_told) << fault.name << ": " << outcome->said;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SetFaults, testing::Range<std::size_t>(0, set_faults().size()));

}  // namespace
}  // namespace weft::bench
