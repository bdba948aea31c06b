// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/malformed_request.h"

#include <fmt/format.h>

namespace weft::bench {
namespace {

std::string get(int port, const std::string& target, const std::string& header = "") {
  return fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}\r\n", target, port, header);
}

std::string post(int port, const std::string& body, const std::string& length) {
  return fmt::format(
      "POST /api/v1/scan HTTP/1.1\r\nContent-Length: {}\r\nContent-Type: application/json\r\n"
      "Host: 127.0.0.1:{}\r\n\r\n{}",
      length, port, body);
}

std::string post(int port, const std::string& body) {
  return post(port, body, std::to_string(body.size()));
}

}  // namespace

std::string malformed_request(std::mt19937& random, int port) {
  const auto number = [&](int most) { return std::uniform_int_distribution<int>(0, most)(random); };
  const auto count = [&](std::size_t most) {
    return static_cast<std::size_t>(number(static_cast<int>(most)));
  };
  const auto byte = [&] { return static_cast<char>(number(255)); };
  const auto bytes = [&](std::size_t most) {
    std::string text(count(most), '\0');
    for (char& c : text) c = byte();
    return text;
  };
  std::string good = post(port, R"({"fabric": "satin", "leds": [1, 2], "iso": 100})");
  switch (number(8)) {
    case 0:
      return bytes(3000);
    case 1:
      return good.substr(0, count(good.size() - 1));
    case 2:
      for (int i = 0; i < 4; ++i) good[count(good.size() - 1)] = byte();
      return good;
    case 3:
      return get(port, "/api/v1/rig",
                 fmt::format("X-{}: {}\r\n", std::string(50, 'x'), std::string(20000, 'y')));
    case 4:
      return post(port, bytes(500));
    case 5:
      return post(port, std::string(count(30000), number(1) == 0 ? '[' : '{'));
    case 6:
      return get(port, "/" + bytes(200));
    case 7:
      return post(port, "{}", fmt::format("{}0", number(2000000000)));
    default:
      return get(port, "/api/v1/sessions/" + std::string(count(900), '%'));
  }
}

}  // namespace weft::bench
