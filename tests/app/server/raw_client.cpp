// SPDX-License-Identifier: Apache-2.0
#include "tests/app/server/raw_client.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace weft::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPatience = std::chrono::seconds(10);

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::max<std::int64_t>(left, 0));
}

}  // namespace

RawClient::RawClient(int port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    socket_ = Descriptor();
  }
}

bool RawClient::say(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

void RawClient::end_of_words() {
  shutdown(socket_.get(), SHUT_WR);
}

std::string RawClient::hear(std::chrono::milliseconds most, std::string_view end) {
  const Clock::time_point deadline = Clock::now() + most;
  std::string heard;
  std::array<char, 4096> block = {};
  pollfd readable = {socket_.get(), POLLIN, 0};
  std::size_t searched = 0;
  while (heard.find(end, searched) == std::string::npos &&
         poll(&readable, 1, milliseconds_until(deadline)) > 0) {
    const ssize_t bytes = recv(socket_.get(), block.data(), block.size(), 0);
    if (bytes <= 0) break;
    searched = heard.size() - std::min(heard.size(), end.size());
    heard.append(block.data(), static_cast<std::size_t>(bytes));
  }
  return heard;
}

std::string RawClient::hear_some(std::size_t most) {
  std::string heard;
  std::vector<char> block(65536);
  pollfd readable = {socket_.get(), POLLIN, 0};
  while (heard.size() < most && poll(&readable, 1, 100) > 0) {
    const ssize_t bytes = recv(socket_.get(), block.data(), std::min(block.size(), most - heard.size()), 0);
    if (bytes <= 0) break;
    heard.append(block.data(), static_cast<std::size_t>(bytes));
  }
  return heard;
}

bool RawClient::closed_within(std::chrono::milliseconds most) {
  const Clock::time_point deadline = Clock::now() + most;
  std::array<char, 4096> block = {};
  pollfd readable = {socket_.get(), POLLIN, 0};
  while (poll(&readable, 1, milliseconds_until(deadline)) > 0) {
    if (recv(socket_.get(), block.data(), block.size(), 0) <= 0) return true;
  }
  return false;
}

Json Answer::json() const {
  Json document = Json::parse(body, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << "no JSON: " << body;
  return document;
}

Answer parsed(const std::string& response) {
  constexpr std::string_view kVersion = "HTTP/1.1 ";
  Answer answer;
  const std::size_t end = response.find("\r\n\r\n");
  if (!response.starts_with(kVersion) || end == std::string::npos) return answer;
  std::from_chars(response.data() + kVersion.size(), response.data() + response.size(), answer.status);
  answer.head = response.substr(0, end);
  answer.body = response.substr(end + 4);
  constexpr std::string_view kLength = "Content-Length: ";
  if (const std::size_t at = answer.head.find(kLength); at != std::string::npos) {
    std::size_t bytes = answer.body.size();
    std::from_chars(answer.head.data() + at + kLength.size(), answer.head.data() + end, bytes);
    answer.body.resize(std::min(bytes, answer.body.size()));
  }
  return answer;
}

std::string request_text(int port, const std::string& method, const std::string& target,
                         const std::string& body, const HeaderLines& headers) {
  HeaderLines all = {{"Host", fmt::format("127.0.0.1:{}", port)}, {"Connection", "close"}};
  if (method == "POST" || method == "PATCH") {
    all["Content-Type"] = "application/json";
    all["Content-Length"] = std::to_string(body.size());
  }
  for (const auto& [name, value] : headers) all[name] = value;
  std::string text = fmt::format("{} {} HTTP/1.1\r\n", method, target);
  for (const auto& [name, value] : all) text += fmt::format("{}: {}\r\n", name, value);
  return text + "\r\n" + body;
}

Answer ask(int port, const std::string& method, const std::string& target, const std::string& body,
           const HeaderLines& headers) {
  RawClient client(port);
  client.say(request_text(port, method, target, body, headers));
  return parsed(client.hear(kPatience));
}

}  // namespace weft::app
