// SPDX-License-Identifier: Apache-2.0
#include "core/base/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace weft {
namespace {

TEST(Error, SaysWhatWhereWhyAndWhatToDo) {
  const Error error = {ErrorKind::kBadData, "raw frame is truncated", "raw/03_led03.dng",
                       "1 byte is missing of 32 170 000", "copy the session again"};
  EXPECT_EQ(error.message(),
            "raw frame is truncated: raw/03_led03.dng: 1 byte is missing of 32 170 000. "
            "copy the session again.");
}

TEST(Error, LeavesOutWhatItDoesNotKnow) {
  EXPECT_EQ((Error{ErrorKind::kInterrupted, "interrupted", "", "", ""}.message()), "interrupted.");
  EXPECT_EQ((Error{ErrorKind::kInterrupted, "a", "b", "", ""}.message()), "a: b.");
  EXPECT_EQ((Error{ErrorKind::kInterrupted, "a", "", "c", ""}.message()), "a: c.");
  EXPECT_EQ((Error{ErrorKind::kInterrupted, "a", "", "", "d"}.message()), "a. d.");
}

TEST(Result, HoldsEitherAValueOrAnError) {
  const Result<int> good = 7;
  EXPECT_TRUE(good);
  EXPECT_EQ(*good, 7);
  const Result<int> bad = Error{ErrorKind::kNoInput, "not there", "", "", ""};
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.error().kind, ErrorKind::kNoInput);
}

TEST(Result, AnErrorIsAValueOfItsOwnWhenTheValueIsAText) {
  const Result<std::string> good = std::string("not an error");
  EXPECT_TRUE(good);
  EXPECT_EQ(good->size(), 12U);
}

TEST(Result, GivesAwayWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  const std::unique_ptr<int> taken = *std::move(result);
  EXPECT_EQ(*taken, 3);
}

TEST(Result, OfNothingIsSuccessUnlessItHoldsAnError) {
  EXPECT_TRUE(Result<void>());
  const Result<void> bad = Error{ErrorKind::kTryAgain, "busy", "", "", ""};
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.error().message(), "busy.");
}

}  // namespace
}  // namespace weft
