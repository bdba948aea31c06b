// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/cookies.h"

#include <gtest/gtest.h>

namespace weft::app {
namespace {

TEST(Cookies, AreFoundByTheirWholeName) {
  struct Header {
    const char* text;
    const char* value;
  };
  for (const auto& [text, value] : {Header{"weft_1=a", "a"},
                                    {"x=1; weft_1=a", "a"},
                                    {"x=1;weft_1=a; y", "a"},
                                    {"weft_1=a; weft_1=b", "a"},
                                    {"weft_1=a=b", "a=b"},
                                    {"weft_1=", ""},
                                    {"weft_12=a", ""},
                                    {"aweft_1=a", ""},
                                    {"weft_1", ""},
                                    {" ; ;;", ""},
                                    {"", ""}}) {
    EXPECT_EQ(cookie_in(text, "weft_1"), value) << text;
  }
}

}  // namespace
}  // namespace weft::app
