// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/request_headers.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace weft::app {
namespace {

TEST(Conditions, NameATagByTheWholeOfIt) {
  for (const char* list :
       {R"("a")", R"(W/"a")", R"("b", "a")", R"("b",W/"a" , "c")", "*", R"(  "a")", R"("a",)"}) {
    EXPECT_TRUE(names_tag(list, "a")) << list;
  }
  for (const char* list :
       {"", "a", R"("aa")", R"("b")", R"("a)", R"("b" "a")", "w/\"a\"", "**", ",", R"("")"}) {
    EXPECT_FALSE(names_tag(list, "a")) << list;
  }
}

TEST(Conditions, TakeACodingThatIsNamedWithAWeight) {
  for (const char* header : {"gzip", "deflate, gzip", "br;q=1.0, gzip;q=0.001", " gzip ; q=0.5"}) {
    EXPECT_TRUE(takes_coding(header, "gzip")) << header;
  }
  for (const char* header : {"", "br", "gzip;q=0", "gzip; q=0.000", "xgzip", "gzip2", "*"}) {
    EXPECT_FALSE(takes_coding(header, "gzip")) << header;
  }
}

struct Asked {
  const char* header;
  AskedRange::Is is;
  std::uint64_t first = 0, bytes = 0;
};

// RFC 9110, 14.1.2, with its file of 10000 bytes.
TEST(Conditions, ReadARangeAsTheStandardSays) {
  using Is = AskedRange::Is;
  for (const Asked& asked : {Asked{"bytes=0-499", Is::kPart, 0, 500},
                             {"bytes=500-999", Is::kPart, 500, 500},
                             {"bytes=-500", Is::kPart, 9500, 500},
                             {"bytes=9500-", Is::kPart, 9500, 500},
                             {"bytes=0-0", Is::kPart, 0, 1},
                             {"bytes=0-99999999999999999999999", Is::kPart, 0, 10000},
                             {"bytes=-20000", Is::kPart, 0, 10000},
                             {"bytes=10000-", Is::kBeyond},
                             {"bytes=99999999999999999999999-", Is::kBeyond},
                             {"bytes=-0", Is::kBeyond},
                             {"", Is::kWhole},
                             {"bytes=5-4", Is::kWhole},
                             {"bytes=0-1,5-6", Is::kWhole},
                             {"bytes=-", Is::kWhole},
                             {"bytes=a-b", Is::kWhole},
                             {"bytes= 0-1", Is::kWhole},
                             {"bytes=+0-1", Is::kWhole},
                             {"lines=0-1", Is::kWhole}}) {
    const AskedRange range = asked_range(asked.header, 10000);
    EXPECT_EQ(range.is, asked.is) << asked.header;
    EXPECT_EQ(range.first, asked.first) << asked.header;
    EXPECT_EQ(range.bytes, asked.bytes) << asked.header;
  }
  EXPECT_EQ(asked_range("bytes=0-", 0).is, Is::kBeyond) << "an empty file has no range";
}

}  // namespace
}  // namespace weft::app
