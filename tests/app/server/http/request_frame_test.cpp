// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/request_frame.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace weft::app {
namespace {

constexpr FrameLimits kLimits;

std::string with_header(const std::string& header) {
  return "GET / HTTP/1.1\r\nHost: a\r\n" + header + "\r\n\r\n";
}

TEST(RequestFrame, IsWholeAtItsLastByteAndNotBefore) {
  const std::string request = "POST /a HTTP/1.1\r\nHost: a\r\ncontent-LENGTH:  5 \r\n\r\nhello";
  for (std::size_t bytes = 0; bytes < request.size(); ++bytes) {
    const RequestFrame frame = frame_request(request.substr(0, bytes), kLimits);
    EXPECT_EQ(frame.status, 0) << bytes << " bytes: " << frame.why;
    EXPECT_EQ(frame.bytes, 0U) << bytes << " bytes";
  }
  EXPECT_EQ(frame_request(request, kLimits).bytes, request.size());
  EXPECT_EQ(frame_request(request + "POST /b", kLimits).bytes, request.size());
}

TEST(RequestFrame, RefusesWhatItNeedNotTake) {
  const std::string much(5000, 'a');
  std::string many;
  for (int i = 0; i < 70; ++i) many += "X: y\r\n";
  many.resize(many.size() - 2);
  for (const auto& [request, status] : std::vector<std::pair<std::string, int>>{
           {"\x16\x03\x01", 400},  // TLS
           {"GET\r\n\r\n", 400},
           {"GET /\r\n\r\n", 400},
           {"G@T / HTTP/1.1\r\n\r\n", 400},
           {"GET  / HTTP/1.1\r\n\r\n", 400},
           {"GET http://a/ HTTP/1.1\r\n\r\n", 400},
           {"GET /a#b HTTP/1.1\r\n\r\n", 400},
           {"GET / HTTP/2\r\n\r\n", 505},
           {"GET /" + much + " HTTP/1.1\r\n\r\n", 414},
           {with_header("X: " + much), 431},
           {with_header(many), 431},
           {std::string(20000, 'a'), 431},
           {with_header("no colon"), 400},
           {with_header(" folded: x"), 400},
           {with_header("X : y"), 400},
           {with_header("X: y\nZ: w"), 400},
           {with_header(std::string("X: \0", 4)), 400},
           {with_header("Host: b"), 400},
           {with_header("Transfer-Encoding: chunked"), 411},
           {with_header("Content-Encoding: gzip"), 415},
           {with_header("Range: bytes=" + std::string(100, '1') + "-"), 416},
           {with_header("Range: bytes=0-1\r\nRange: bytes=0-1"), 400},
           {with_header("Content-Length: -1"), 400},
           {with_header("Content-Length: 1x"), 400},
           {with_header("Content-Length:"), 400},
           {with_header("Content-Length: 1\r\nContent-Length: 1"), 400},
           {with_header("Content-Length: 65537"), 413},
           {with_header("Content-Length: 99999999999999999999999"), 413}}) {
    const RequestFrame frame = frame_request(request, kLimits);
    EXPECT_EQ(frame.status, status) << request.substr(0, 100);
    EXPECT_FALSE(frame.why.empty()) << request.substr(0, 100);
    EXPECT_EQ(frame.bytes, 0U) << request.substr(0, 100);
  }
}

TEST(RequestFrame, TellsWhichIsTheLastOfItsConnection) {
  EXPECT_FALSE(frame_request(with_header("X: close"), kLimits).last);
  EXPECT_FALSE(frame_request(with_header("Connection: keep-alive"), kLimits).last);
  EXPECT_FALSE(frame_request(with_header("Connection: closed"), kLimits).last);
  EXPECT_TRUE(frame_request(with_header("Connection: close"), kLimits).last);
  EXPECT_TRUE(frame_request(with_header("connection: TE , Close"), kLimits).last);
  EXPECT_TRUE(frame_request("GET / HTTP/1.0\r\nConnection: keep-alive\r\n\r\n", kLimits).last);
}

TEST(RequestFrame, TakesTheLargestBodyAllowed) {
  const std::string head = with_header("Content-Length: 65536");
  EXPECT_EQ(frame_request(head, kLimits).status, 0);
  EXPECT_EQ(frame_request(head + std::string(65536, ' '), kLimits).bytes, head.size() + 65536);
}

}  // namespace
}  // namespace weft::app
