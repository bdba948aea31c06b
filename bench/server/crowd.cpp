// SPDX-License-Identifier: Apache-2.0
#include "bench/server/crowd.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "bench/capture/malformed_request.h"
#include "core/files.h"

namespace weft::bench {
namespace {

constexpr int kClientPatience_s = 10;

/// `window`: bytes that the client lets wait unread; 0: as many as the system likes.
Result<Descriptor> connected_to(int port, int window = 0) {
  Descriptor client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (window > 0) ::setsockopt(client.get(), SOL_SOCKET, SO_RCVBUF, &window, sizeof window);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return Error{ErrorKind::kTryAgain, "the daemon cannot be connected to", std::to_string(port),
                 system_reason(errno), "run the benchmark again"};
  }
  const timeval patience = {kClientPatience_s, 0};
  ::setsockopt(client.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  return client;
}

/// The server may close before it has heard all.
void say(const Descriptor& client, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void hear_to_the_end(const Descriptor& client) {
  ::shutdown(client.get(), SHUT_WR);
  std::array<char, 4096> block = {};
  while (::recv(client.get(), block.data(), block.size(), 0) > 0) {
  }
}

void ask_for_much(int port, Descriptor& reader) {
  constexpr int kAnswers = 20;
  Result<Descriptor> one = connected_to(port, 4096);
  if (!one) return;
  for (int i = 0; i < kAnswers; ++i) {
    say(*one, "GET /api/v1/openapi.json HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  }
  reader = std::move(*one);
}

}  // namespace

void Crowd::send_malformed(std::uint64_t seed) {
  sending_ = true;
  threads_.emplace_back([this, seed](const std::stop_token& stop) {
    std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
    for (int i = 0; i < kMalformed && !stop.stop_requested(); ++i) {
      if (const Result<Descriptor> client = connected_to(port_)) {
        say(*client, malformed_request(random, port_));
        hear_to_the_end(*client);
      }
    }
    sending_ = false;
  });
}

Result<void> Crowd::stay_silent() {
  for (int i = 0; i < kSilent; ++i) {
    Result<Descriptor> one = connected_to(port_);
    if (!one) return std::move(one).error();
    if (i % 2 == 1) say(*one, "POST /api/v1/scan HTTP/1.1\r\nContent-Le");
    silent_.push_back(std::move(*one));
  }
  return {};
}

void Crowd::read_slowly() {
  threads_.emplace_back([this](const std::stop_token& stop) {
    std::vector<Descriptor> readers(kSlow);
    std::array<char, 2048> block = {};
    while (!stop.stop_requested()) {
      for (Descriptor& reader : readers) {
        if (!reader) ask_for_much(port_, reader);
        const ssize_t heard = ::recv(reader.get(), block.data(), block.size(), MSG_DONTWAIT);
        if (heard == 0 || (heard < 0 && errno != EAGAIN)) reader = Descriptor();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
}

}  // namespace weft::bench
