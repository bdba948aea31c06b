// SPDX-License-Identifier: Apache-2.0
#include "bench/server/door.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "bench/capture/malformed_request.h"
#include "core/descriptor.h"
#include "core/files.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"

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

/// Those who keep the door busy, and how far they have come.
class Crowd {
 public:
  Crowd(const DoorOptions& options, int port) : options_(options), port_(port) {}

  void send_malformed() {
    sending_ = true;
    threads_.emplace_back([this] {
      std::mt19937 random(static_cast<std::mt19937::result_type>(options_.seed));
      for (int i = 0; i < options_.malformed; ++i) {
        if (const Result<Descriptor> client = connected_to(port_)) {
          say(*client, malformed_request(random, port_));
          hear_to_the_end(*client);
        }
      }
      sending_ = false;
    });
  }
  bool sending() const { return sending_; }

  Result<void> stay_silent() {
    for (int i = 0; i < options_.silent; ++i) {
      Result<Descriptor> one = connected_to(port_);
      if (!one) return std::move(one).error();
      if (i % 2 == 1) say(*one, "POST /api/v1/scan HTTP/1.1\r\nContent-Le");
      silent_.push_back(std::move(*one));
    }
    return {};
  }

  /// Who is dropped comes back.
  void read_slowly() {
    threads_.emplace_back([this](const std::stop_token& stop) {
      std::vector<Descriptor> readers(static_cast<std::size_t>(options_.slow));
      std::array<char, 2048> block = {};
      while (!stop.stop_requested()) {
        for (Descriptor& reader : readers) {
          if (!reader) ask_for_much(reader);
          const ssize_t heard = ::recv(reader.get(), block.data(), block.size(), MSG_DONTWAIT);
          if (heard == 0 || (heard < 0 && errno != EAGAIN)) reader = Descriptor();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    });
  }

 private:
  void ask_for_much(Descriptor& reader) const {
    constexpr int kAnswers = 20;
    Result<Descriptor> one = connected_to(port_, 4096);
    if (!one) return;
    for (int i = 0; i < kAnswers; ++i) {
      say(*one, "GET /api/v1/openapi.json HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
    }
    reader = std::move(*one);
  }

  const DoorOptions& options_;
  const int port_;
  std::atomic<bool> sending_ = false;
  std::vector<Descriptor> silent_;
  std::vector<std::jthread> threads_;
};

struct Beside {
  bool malformed = false, silent = false, slow = false;
};

Result<Json> row_of(const app::RigClient& client, int port, const Beside& beside,
                    const DoorOptions& options) {
  Crowd crowd(options, port);
  if (beside.silent) {
    if (Result<void> there = crowd.stay_silent(); !there) return std::move(there).error();
  }
  if (beside.slow) crowd.read_slowly();
  if (beside.slow) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  if (beside.malformed) crowd.send_malformed();
  std::vector<double> times_ms;
  while (static_cast<int>(times_ms.size()) < options.requests || crowd.sending()) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<Json> answer = client.get("/api/v1/rig");
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (!answer) return answer.error();
    times_ms.push_back(time_ms.count());
  }
  return Json{{"malformed", beside.malformed ? options.malformed : 0},
              {"silent", beside.silent ? options.silent : 0},
              {"slow", beside.slow ? options.slow : 0},
              {"requests", times_ms.size()},
              {"median_ms", median(times_ms)},
              {"most_ms", *std::ranges::max_element(times_ms)}};
}

}  // namespace

Result<Rows> door_table(const DoorOptions& options) {
  const TemporaryFolder folder;
  capture::Rig rig;
  rig.name = "bench";
  rig.scan.sessions = folder.path() / "scans";
  rig.daemon.port = 0;
  rig.daemon.state = folder.path() / "state";
  const Error no_devices = {ErrorKind::kTryAgain, "this rig has no devices", rig.name, "", "name another"};
  const Result<std::unique_ptr<app::RigServer>> server = app::RigServer::start(
      rig, [&](const capture::Rig&) -> Result<capture::RigDevices> { return no_devices; },
      [&](const capture::ScanRequest&, capture::Lamps&, capture::Camera&, const capture::ScanEvents&,
          const capture::ScanControl&) -> Result<capture::ScanOutcome> { return no_devices; });
  if (!server) return server.error();
  const Result<app::RigClient> client = app::RigClient::connect((*server)->address());
  if (!client) return client.error();
  Rows rows;
  for (const Beside& beside : {Beside{}, Beside{.malformed = true}, Beside{.silent = true},
                               Beside{.slow = true}, Beside{true, true, true}}) {
    Result<Json> row = row_of(*client, (*server)->port(), beside, options);
    if (!row) return std::move(row).error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace weft::bench
