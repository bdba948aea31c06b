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
#include "app/cli/verb.h"
#include "app/server/api/api.h"
#include "app/server/http/client.h"
#include "app/server/rig/rig_lock.h"
#include "app/server/rig_server.h"
#include "app/server/service_manager.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "capture/scan/scan.h"
#include "core/base/files.h"
#include "core/base/process.h"

namespace weft::app {
namespace {

using Clock = std::chrono::steady_clock;

struct ServeArguments {
  std::filesystem::path rig;        ///< rig.toml; empty: found as find_rig() says
  std::optional<std::string> host;  ///< in place of what the rig file says
  std::optional<int> port;
  std::vector<std::string> archives;
  bool open = false;       ///< the page, in a browser
  bool describes = false;  ///< prints openapi.json, and serves nothing
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

std::string page_address(const std::string& address, const std::string& token) {
  return token.empty() ? address : address + "/#" + percent_encoded(token);
}

Result<void> say_address(const RigServer& server, const std::string& rig, bool json) {
  if (json) {
    print_json({{"rig", rig}, {"address", server.address()}, {"port", server.port()}});
  } else {
    // A log is no place for a token.
    const bool read_by_a_person = isatty(STDOUT_FILENO) != 0;
    print(read_by_a_person ? page_address(server.address(), server.token()) : server.address());
  }
  return flush_output();
}

void open_page(const std::string& address, const std::string& token) {
  const Result<pid_t> opened = start_process(
      {.command = {"xdg-open", page_address(address, token)}, .group = ProcessGroup::kOwnSession});
  if (!opened) note("weft: no browser could be opened (xdg-open): open " + address);
}

/// Opens the page of a daemon that owns this rig already; nothing where none does.
Result<bool> open_page_of_owner(const capture::Rig& rig) {
  const Result<std::optional<std::string>> owner = address_of_owner(rig);
  if (!owner) return owner.error();
  if (!*owner) return false;
  const Result<std::string> token = token_of_owner(rig);
  if (!token) return token.error();
  open_page(**owner, *token);
  return true;
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

/// Where sessions are that nobody said a folder for.
Result<std::string> own_sessions() {
  const char* home = std::getenv("HOME");
  const std::filesystem::path folder = std::filesystem::path(home == nullptr ? "/" : home) / "weft";
  if (Result<void> made = make_writable_folder(folder); !made) return std::move(made).error();
  return folder.string();
}

/// What a server works on that has archives and no rig.
capture::Rig no_rig(const std::vector<std::string>& archives) {
  capture::Rig rig;
  rig.name = "archive";
  rig.leds = 0;
  rig.scan.sessions = absolute_folder(archives.front());
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  rig.daemon.state = state != nullptr && *state != '\0'
                         ? std::filesystem::path(state) / "weft/archive"
                         : std::filesystem::path(home == nullptr ? "/" : home) / ".local/state/weft/archive";
  return rig;
}

/// The rig of its file; where none is named or found, no rig.
Result<capture::Rig> rig_to_serve(ServeArguments arguments) {
  const std::filesystem::path file = find_rig(arguments.rig);
  const bool has_rig = !named_rig(arguments.rig).empty() || is_there(file);
  if (!has_rig && arguments.archives.empty()) {
    Result<std::string> folder = own_sessions();
    if (!folder) return std::move(folder).error();
    note("weft: no rig file is named, and none lies here or at " + file.string() +
         ": serving the sessions of " + *folder + " without a rig");
    arguments.archives.push_back(std::move(*folder));
  }
  Result<capture::Rig> rig = has_rig ? capture::read_rig(file) : no_rig(arguments.archives);
  if (!rig) return rig;
  for (const std::string& archive : arguments.archives) {
    std::error_code error;
    if (!std::filesystem::is_directory(archive, error)) {
      return Error{ErrorKind::kNoInput, "there is no such folder of sessions", archive, error.message(),
                   "name one that is there with --archive"};
    }
    if (absolute_folder(archive) != absolute_folder(rig->scan.sessions))
      rig->daemon.archives.push_back(absolute_folder(archive));
  }
  if (arguments.host) rig->daemon.host = *arguments.host;
  if (arguments.port) rig->daemon.port = *arguments.port;
  return rig;
}

Result<int> serve(const ServeArguments& arguments, const CommonArguments& common) {
  if (arguments.describes) {
    print_json(api_description());
    return kDone;
  }
  const std::stop_token stop = stop_on_signal();
  const Result<capture::Rig> rig = rig_to_serve(arguments);
  if (!rig) return rig.error();
  if (arguments.open) {
    const Result<bool> opened = open_page_of_owner(*rig);
    if (!opened) return opened.error();
    if (*opened) return kDone;
  }

  const Result<std::unique_ptr<RigServer>> server = RigServer::start(
      *rig, capture::open_devices, run_scan_of,
      {.looks = true, .previews = rig->daemon.preview, .say = [](const std::string& line) { note(line); }});
  if (!server) return server.error();
  if (Result<void> said = say_address(**server, rig->name, common.json); !said)
    return std::move(said).error();
  if (arguments.open) open_page((*server)->address(), (*server)->token());
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
  options.add(
      "--archive", &a->archives,
      "Folder of sessions to show beside the rig's, with those below it; may be given again. Without a "
      "rig file the server has no rig: library and jobs alone, by default of ~/weft");
  options.add_flag("--open", &a->open, "Open the page in a browser, of a daemon that runs already too");
  options.add_flag("--describe", &a->describes,
                   "Only print what the calls take and answer, as GET openapi.json does");
  return [a](const CommonArguments& common) { return serve(*a, common); };
}

}  // namespace

Verb serve_verb() {
  return {"serve", "Own a rig and answer over HTTP (docs/http.md)", add_serve};
}

}  // namespace weft::app
