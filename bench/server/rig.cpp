// SPDX-License-Identifier: Apache-2.0
#include "bench/server/server_studies.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "app/server/http/client.h"
#include "bench/capture/malformed_request.h"
#include "bench/server/served_rig.h"
#include "bench/server/wide_solve.h"
#include "core/base/descriptor.h"
#include "core/base/files.h"
#include "core/base/statistics.h"
#include "core/base/temporary_folder.h"

namespace weft::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kDark_s = 2;       // asked for
constexpr double kPatience_s = 10;  // for a light that does not go out at all
constexpr double kRenewed_s = 0.5;
constexpr int kLeds = 10;

void sleep_s(double seconds) {
  std::this_thread::sleep_for(Seconds(seconds));
}

class Desk {
 public:
  explicit Desk(const StudyOptions& options) : options_(options) {}

  Result<void> start() { return rig_.start(options_.programs, options_.scenes / "satin.toml", 0.05); }

  // Seconds from the death to dark.
  Result<double> trial(bool daemon_dies, int led, double after_s) {
    if (Result<void> ok = rig_.serve(); !ok) return std::move(ok).error();
    if (auto opened = rig_.client().post("/api/v1/rig/devices", {{"open", true}}); !opened)
      return std::move(opened).error();
    const int renewals = 1 + static_cast<int>(after_s / kRenewed_s);
    for (int i = 0; i < renewals; ++i) {
      if (i > 0) sleep_s(kRenewed_s);
      auto lit = rig_.client().post("/api/v1/rig/light", {{"leds", {led}}});
      if (!lit) return std::move(lit).error();
      if ((*lit)["rest_s"] > 0) {
        sleep_s((*lit)["rest_s"].get<double>());
        i = -1;
      }
    }
    sleep_s(after_s - kRenewed_s * (renewals - 1));
    if (daemon_dies) rig_.kill_daemon();
    return seconds_to_dark(led);
  }

 private:
  Result<double> seconds_to_dark(int led) {
    const auto died = Clock::now();
    for (bool was_lit = false;; was_lit = true) {
      const Result<std::string> status = rig_.rig().say("status");
      if (!status) return status.error();
      const Json pins = Json::parse(*status)["pins"];
      const double passed_s = Seconds(Clock::now() - died).count();
      if (pins.empty() && !was_lit) {
        return Error{ErrorKind::kProtocol, fmt::format("LED {} was not lit", led), "lease", "",
                     "mend that first"};
      }
      if (pins.empty() || passed_s > kPatience_s) return passed_s;
      sleep_s(0.005);
    }
  }

  const StudyOptions& options_;
  ServedRig rig_;
};

}  // namespace

/// How long a LED stays lit once nobody holds it, told by the pins of a virtual board. A client lights a LED
/// through weft serve, renews it every half second, and at a random moment falls silent, or the daemon is
/// killed (SIGKILL). A row a death: "death" (client, daemon), "trials", "median_s", "worst_s", "late" (trials
/// that were not dark after 2 s). Errors: of the rig's and the daemon's start, and of a light that is
/// refused.
Result<Rows> server_lease_table(const StudyOptions& options) {
  Desk desk(options);
  if (Result<void> ok = desk.start(); !ok) return std::move(ok).error();
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> moment(0.05, 1.4);
  Rows rows;
  for (const bool daemon_dies : {false, true}) {
    std::vector<double> seconds;
    for (int i = 0; i < options.runs; ++i) {
      Result<double> dark = desk.trial(daemon_dies, 1 + i % kLeds, moment(random));
      if (!dark) return std::move(dark).error();
      seconds.push_back(*dark);
      options.progress(i + 1 + (daemon_dies ? options.runs : 0), 2 * options.runs);
    }
    rows.push_back({{"death", daemon_dies ? "daemon" : "client"},
                    {"trials", options.runs},
                    {"median_s", median(seconds)},
                    {"worst_s", *std::ranges::max_element(seconds)},
                    {"late", std::ranges::count_if(seconds, [](double s) { return s > kDark_s; })}});
  }
  return rows;
}

namespace {

/// Clients that keep the door of a daemon busy, until they go.
class Crowd {
 public:
  explicit Crowd(int port) : port_(port) {}

  static constexpr int kMalformed = 1000, kSilent = 64, kSlow = 32;

  /// Malformed requests one after another, drawn by `seed`.
  void send_malformed(std::uint64_t seed);
  bool sending() const { return sending_; }
  /// Who say nothing, every second one of them in the middle of its request. kTryAgain where one
  /// cannot connect.
  Result<void> stay_silent();
  /// Who ask for openapi.json twenty times at once and take 40 kB a second of it. Who is dropped
  /// comes back.
  void read_slowly();

 private:
  const int port_;
  std::atomic<bool> sending_ = false;
  std::vector<Descriptor> silent_;
  std::vector<std::jthread> threads_;
};

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

struct Beside {
  bool malformed = false, silent = false, slow = false;
};

Result<Json> row_of(const app::RigClient& client, int port, const Beside& beside,
                    const StudyOptions& options) {
  Crowd crowd(port);
  if (beside.silent) {
    if (Result<void> there = crowd.stay_silent(); !there) return std::move(there).error();
  }
  if (beside.slow) crowd.read_slowly();
  if (beside.slow) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  if (beside.malformed) crowd.send_malformed(options.seed);
  std::vector<double> times_ms;
  while (static_cast<int>(times_ms.size()) < options.runs || crowd.sending()) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<Json> answer = client.get("/api/v1/rig");
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (!answer) return answer.error();
    times_ms.push_back(time_ms.count());
  }
  return Json{{"malformed", beside.malformed ? Crowd::kMalformed : 0},
              {"silent", beside.silent ? Crowd::kSilent : 0},
              {"slow", beside.slow ? Crowd::kSlow : 0},
              {"requests", times_ms.size()},
              {"median_ms", median(times_ms)},
              {"most_ms", *std::ranges::max_element(times_ms)}};
}

}  // namespace

/// How long a daemon without devices takes for GET /api/v1/rig on a connection of its own, median and worst
/// in ms: undisturbed; beside malformed requests one after another; beside silent clients, every second
/// one of them in the middle of its request; beside slow readers, who ask for openapi.json twenty times at
/// once and take 40 kB a second of it; beside all of them. Errors: those of RigServer::start() and
/// RigClient::connect(), kTryAgain where a client cannot connect.
Result<Rows> door_table(const StudyOptions& options) {
  const TemporaryFolder folder;
  const auto server = server_without_devices("bench", folder.path() / "scans", folder.path() / "state");
  if (!server) return server.error();
  const Result<app::RigClient> client = app::RigClient::connect((*server)->address());
  if (!client) return client.error();
  Rows rows;
  for (const Beside& beside : {Beside{}, Beside{.malformed = true}, Beside{.silent = true},
                               Beside{.slow = true}, Beside{true, true, true}}) {
    if (Result<void> ok = add_row(rows, row_of(*client, (*server)->port(), beside, options)); !ok)
      return ok.error();
  }
  return rows;
}

namespace {

constexpr std::chrono::milliseconds kBetweenQuestions(50);
constexpr int kLeast = 19;  // niceness

/// One scan to its end, asked about all the while.
struct ScanTime {
  double seconds = 0;
  std::vector<double> answers_ms;
};

Result<ScanTime> time_of_scan(const ServedRig& served) {
  const auto begin = Clock::now();
  const Result<Json> begun =
      served.client().post("/api/v1/scan", {{"fabric", "bench"}, {"exposure_us", 20000}});
  if (!begun) return begun.error();
  ScanTime time;
  for (;; std::this_thread::sleep_for(kBetweenQuestions)) {
    const auto asked = Clock::now();
    const Result<Json> status = served.client().get("/api/v1/rig");
    if (!status) return status.error();
    time.answers_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - asked).count());
    const std::string state = status->at("state").get<std::string>();
    if (state == "failed") {
      return Error{ErrorKind::kTryAgain, "a scan failed", "bench", status->at("why").get<std::string>(),
                   "run the benchmark again"};
    }
    if (state == "idle") break;
  }
  time.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return time;
}

/// Ask for tiles until they go.
class Viewers {
 public:
  /// `calls` must outlive them.
  Viewers(const ServedRig& served, int count, const std::vector<std::string>& calls) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([&served, &calls, i](const std::stop_token& stop) {
        // They sit at other machines, and take nothing from this one's processor but what is left.
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLeast);
        for (std::size_t k = static_cast<std::size_t>(i); !stop.stop_requested(); ++k)
          static_cast<void>(served.client().bytes(calls[k % calls.size()]).has_value());
      });
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

/// The calls for tiles of a solve that is written beside the rig's own sessions, each answered once.
Result<std::vector<std::string>> tiles_to_look_at(const ServedRig& served, std::uint64_t seed) {
  constexpr int kMegapixels = 16, kTiles = 200;
  const Result<Json> next = served.client().get("/api/v1/next-name?fabric=wide");
  if (!next) return next.error();
  const std::filesystem::path sessions =
      std::filesystem::path(next->at("folder").get<std::string>()).parent_path();
  const Size size = wide_size(kMegapixels);
  if (Result<void> ok = write_wide_solve(sessions, size); !ok) return std::move(ok).error();
  std::vector<std::string> calls = wide_tiles(size, kTiles, seed);
  for (const std::string& call : calls) {
    if (const Result<std::string> tile = served.client().bytes(call); !tile) return tile.error();
  }
  return calls;
}

Result<Rows> scans_beside(const StudyOptions& options, int viewer_count) {
  ServedRig served;
  if (Result<void> ok = served.start(options.programs, options.scenes / "satin.toml", options.megapixels);
      !ok)
    return std::move(ok).error();
  if (Result<void> ok = served.serve(); !ok) return std::move(ok).error();
  if (const Result<ScanTime> first = time_of_scan(served); !first) return first.error();  // watches the clock
  std::vector<std::string> calls;
  if (viewer_count > 0) {
    Result<std::vector<std::string>> tiles = tiles_to_look_at(served, options.seed);
    if (!tiles) return std::move(tiles).error();
    calls = std::move(*tiles);
  }
  std::vector<double> alone, beside, ratios, answers_ms;
  for (int turn = 0; turn < options.runs; ++turn) {
    const Result<ScanTime> quiet = time_of_scan(served);
    if (!quiet) return quiet.error();
    Crowd crowd(served.port());
    std::optional<Viewers> viewers;
    if (viewer_count > 0) {
      viewers.emplace(served, viewer_count, calls);
    } else {
      if (Result<void> there = crowd.stay_silent(); !there) return std::move(there).error();
      crowd.read_slowly();
      crowd.send_malformed(options.seed + static_cast<std::uint64_t>(turn));
    }
    const Result<ScanTime> loud = time_of_scan(served);
    if (!loud) return loud.error();
    alone.push_back(quiet->seconds);
    beside.push_back(loud->seconds);
    ratios.push_back(loud->seconds / quiet->seconds);
    answers_ms.insert(answers_ms.end(), loud->answers_ms.begin(), loud->answers_ms.end());
    options.progress(turn + 1, options.runs);
  }
  return Rows{{{"turns", options.runs},
               {"alone_s", median(alone)},
               {"beside_s", median(beside)},
               {"ratio", median(ratios)},
               {"median_ms", median(answers_ms)},
               {"most_ms", *std::ranges::max_element(answers_ms)}}};
}

}  // namespace

/// What clients cost a scan: in turn one alone, and one beside those who mean ill (malformed requests one
/// after another, silent clients, slow readers) or beside viewers, each asking for one tile after
/// another. One row: "turns", "alone_s" and "beside_s" (median), "ratio" (median of the pairs), "median_ms"
/// and "most_ms" of GET /api/v1/rig every 50 ms beside them.
/// Errors: of the rig's and the daemon's start, and of a scan.
Result<Rows> scan_beside_table(const StudyOptions& options) {
  return scans_beside(options, 0);
}

Result<Rows> viewers_table(const StudyOptions& options) {
  return scans_beside(options, 2);
}

}  // namespace weft::bench
