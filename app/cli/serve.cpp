// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>

#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "app/server/service_manager.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "capture/scan/scan.h"

namespace weft::app {
namespace {

using Clock = std::chrono::steady_clock;

struct ServeArguments {
  std::filesystem::path rig;        ///< rig.toml; empty: found as find_rig() says
  std::optional<std::string> host;  ///< in place of what the rig file says
  std::optional<int> port;
};

constexpr auto kTick = std::chrono::milliseconds(50);

Result<capture::ScanOutcome> run_scan_of(const capture::ScanRequest& request, capture::Lamps& lamps,
                                         capture::Camera& camera, const capture::ScanEvents& events,
                                         const capture::ScanControl& control) {
  return capture::scan(request, lamps, camera, events, control);
}

std::string percent_encoded(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    encoded += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return encoded;
}

Result<void> say_address(const RigServer& server, const std::string& rig, bool json) {
  if (json) {
    print_json({{"rig", rig}, {"address", server.address()}, {"port", server.port()}});
  } else {
    // A log is no place for a token.
    const bool read_by_a_person = isatty(STDOUT_FILENO) != 0 && !server.token().empty();
    print(server.address() + (read_by_a_person ? "/#" + percent_encoded(server.token()) : ""));
  }
  return flush_output();
}

/// Tells the service manager that all is well for as long as the server answers a client.
class Watchdog {
 public:
  explicit Watchdog(const RigServer& server) : server_(server), interval_(watchdog_interval()) {}

  void look() {
    if (!interval_ || Clock::now() < next_) return;
    next_ = Clock::now() + *interval_;
    if (RigClient::connect(server_.address(), server_.token())) tell_service_manager("WATCHDOG=1");
  }

 private:
  const RigServer& server_;
  std::optional<std::chrono::milliseconds> interval_;
  Clock::time_point next_ = {};
};

Result<int> serve(const ServeArguments& arguments, const CommonArguments& common) {
  const std::stop_token stop = stop_on_signal();
  Result<capture::Rig> rig = capture::read_rig(find_rig(arguments.rig));
  if (!rig) return std::move(rig).error();
  if (arguments.host) rig->daemon.host = *arguments.host;
  if (arguments.port) rig->daemon.port = *arguments.port;

  const Result<std::unique_ptr<RigServer>> server =
      RigServer::start(*rig, capture::open_devices, run_scan_of,
                       {.previews = rig->daemon.preview, .say = [](const std::string& line) { note(line); }});
  if (!server) return server.error();
  if (Result<void> said = say_address(**server, rig->name, common.json); !said)
    return std::move(said).error();
  tell_service_manager(fmt::format("READY=1\nSTATUS=rig {} at {}", rig->name, (*server)->address()));

  Watchdog watchdog(**server);
  while (!stop.stop_requested()) {
    watchdog.look();
    std::this_thread::sleep_for(kTick);
  }
  tell_service_manager("STOPPING=1");
  if ((*server)->stop()) return kDone;
  // The board turns its lights off when it hears no more of us, and the session is a journal: a device that
  // does not answer is no reason to stay.
  note("weft: a device did not answer in time; the lights go off by the board's own timer");
  std::_Exit(kDone);
}

Run add_serve(Options& options) {
  const auto a = std::make_shared<ServeArguments>();
  add_rig_file(options, a->rig);
  options.add("--host", &a->host,
              "Address to listen on; default the rig file's, 127.0.0.1. Any other needs a token");
  options.add("--port", &a->port, "Port to listen on; 0 is any free one; default the rig file's, 8470")
      .in_range(0, 65535);
  return [a](const CommonArguments& common) { return serve(*a, common); };
}

}  // namespace

Verb serve_verb() {
  return {"serve", "Own a rig and answer over HTTP (docs/http.md)", add_serve};
}

}  // namespace weft::app
