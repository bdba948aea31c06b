// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/http.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <random>
#include <string>
#include <string_view>
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

constexpr int kPatience_s = 10;

Result<Descriptor> connected_to(int port) {
  Descriptor client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return Error{ErrorKind::kTryAgain, "the daemon cannot be connected to", std::to_string(port),
                 system_reason(errno), "run the benchmark again"};
  }
  const timeval patience = {kPatience_s, 0};
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

Result<Json> row_of(const app::RigClient& client, int requests, int malformed, int silent) {
  std::vector<double> times_ms;
  for (int i = 0; i < requests; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<Json> answer = client.get("/api/v1/rig");
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (!answer) return answer.error();
    times_ms.push_back(time_ms.count());
  }
  return Json{{"malformed", malformed},
              {"silent", silent},
              {"requests", requests},
              {"median_ms", median(times_ms)},
              {"most_ms", *std::ranges::max_element(times_ms)}};
}

Result<void> send_malformed(const CaptureHttpOptions& options, int port) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(options.seed));
  for (int i = 0; i < options.malformed; ++i) {
    const Result<Descriptor> client = connected_to(port);
    if (!client) return client.error();
    say(*client, malformed_request(random, port));
    hear_to_the_end(*client);
  }
  return {};
}

}  // namespace

Result<Rows> capture_http_table(const CaptureHttpOptions& options) {
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

  Result<Json> undisturbed = row_of(*client, options.requests, 0, 0);
  if (!undisturbed) return std::move(undisturbed).error();
  const int port = (*server)->port();
  if (Result<void> sent = send_malformed(options, port); !sent) return std::move(sent).error();
  std::vector<Descriptor> silent;
  for (int i = 0; i < options.silent; ++i) {
    Result<Descriptor> one = connected_to(port);
    if (!one) return std::move(one).error();
    if (i % 2 == 1) say(*one, "POST /api/v1/scan HTTP/1.1\r\nContent-Le");
    silent.push_back(std::move(*one));
  }
  Result<Json> disturbed = row_of(*client, options.requests, options.malformed, options.silent);
  if (!disturbed) return std::move(disturbed).error();
  return Rows{std::move(*undisturbed), std::move(*disturbed)};
}

}  // namespace weft::bench
