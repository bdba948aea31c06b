// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "app/cli/exit_code.h"
#include "app/cli/rig_devices.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/daemon/client.h"
#include "app/daemon/error_json.h"
#include "app/daemon/http_guard.h"
#include "app/daemon/rig_lock.h"
#include "app/daemon/rig_server.h"
#include "app/daemon/session_name.h"
#include "app/jobs/solve.h"
#include "capture/rig.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

/// Who scans: the daemon that owns the rig, or one in this process for as long as this scan takes.
struct Scanner {
  std::unique_ptr<RigServer> own;  ///< null where a daemon runs
  RigClient client;
};

Result<std::string> token_of(const capture::Rig& rig) {
  return rig.daemon.token.empty() ? Result<std::string>(std::string()) : read_token(rig.daemon.token);
}

/// A daemon keeps its sessions in one folder.
Result<void> check_folder(const capture::Rig& rig, const fs::path& output) {
  std::error_code ignored;
  if (output.empty() || fs::weakly_canonical(fs::absolute(output).parent_path(), ignored) ==
                            fs::weakly_canonical(rig.scan.sessions, ignored)) {
    return {};
  }
  return Error{ErrorKind::kUsage, "the daemon of this rig keeps its sessions elsewhere", output.string(),
               "they are in " + rig.scan.sessions.string(), "give a name in that folder, or stop weft serve"};
}

Result<Scanner> find_scanner(capture::Rig rig, const fs::path& output) {
  const Result<std::string> token = token_of(rig);
  if (!token) return token.error();
  if (const std::optional<std::string> address = address_of_owner(rig)) {
    if (Result<void> ok = check_folder(rig, output); !ok) return std::move(ok).error();
    Result<RigClient> client = RigClient::connect(*address, *token);
    if (!client) return std::move(client).error();
    return Scanner{nullptr, std::move(*client)};
  }
  rig.daemon.host = "127.0.0.1";
  rig.daemon.port = 0;
  if (!output.empty()) rig.scan.sessions = fs::absolute(output).parent_path();
  auto server = RigServer::start(
      rig, open_devices,
      [](const auto& request, auto& lamps, auto& camera, const auto& events, const auto& control) {
        return capture::scan(request, lamps, camera, events, control);
      });
  if (!server) return std::move(server).error();
  Result<RigClient> client = RigClient::connect((*server)->address(), (*server)->token());
  if (!client) return std::move(client).error();
  return Scanner{std::move(*server), std::move(*client)};
}

Result<Json> body_of(const ScanArguments& arguments) {
  Json body = Json::object();
  if (!arguments.output.empty()) {
    const fs::path name = arguments.output.filename();
    body["session"] = name.extension() == ".weft" ? name.stem().string() : name.string();
  }
  if (!arguments.fabric.empty()) body["fabric"] = arguments.fabric;
  if (!arguments.leds.empty()) body["leds"] = arguments.leds;
  if (arguments.exposure_us) body["exposure_us"] = *arguments.exposure_us;
  if (arguments.bracket) body["bracket"] = *arguments.bracket;
  if (arguments.cloth_height_mm) body["cloth_height_mm"] = *arguments.cloth_height_mm;
  if (!arguments.repeat) body["repeat"] = false;
  for (const std::string& pair : arguments.metadata) {
    const std::size_t equals = pair.find('=');
    if (equals == 0 || equals == std::string::npos) {
      return Error{ErrorKind::kUsage, "metadata cannot be read", pair, "it must be KEY=VALUE",
                   "write --metadata weight=\"180 g/m2\""};
    }
    body["metadata"][pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  return body;
}

/// What happens, for the person who waits.
class Narrator {
 public:
  explicit Narrator(const CommonArguments& common) : quiet_(common.quiet), line_(common.quiet) {}

  void show_status(const Json& status) {
    const int planned = status["frames_planned"].get<int>();
    const std::string phase = status["phase"].is_string() ? status["phase"].get<std::string>() : "waiting";
    const bool photographs = phase == "exposing" || phase == "fetching" || status["frames"].get<int>() > 0;
    line_.update(photographs ? "scan" : phase,
                 planned > 0 ? static_cast<double>(status["frames"].get<int>()) / planned : 0);
    const std::string why = status["why"].get<std::string>();
    if (why != why_ && !why.empty() && !quiet_) note(why);
    why_ = why;
  }
  void show_frame(const Json& frame) const {
    if (quiet_) return;
    double clipped = 0;
    for (const Json& share : frame["clipped_rgb"]) clipped = std::max(clipped, share.get<double>());
    const int led = frame["led"].get<int>();
    note(fmt::format("  {:>2} {:7} {:8} clipped {:.3g} %", frame["index"].get<int>(),
                     led > 0 ? fmt::format("LED {}", led) : "dark", frame["role"].get<std::string>(),
                     100 * clipped));
    for (const Json& warning : frame["warnings"]) note("     " + warning.get<std::string>());
  }

 private:
  bool quiet_;
  ProgressLine line_;
  std::string why_;
};

bool has_ended(const Json& status) {
  return status["state"] == "idle" || status["state"] == "failed";
}

/// Follows the scan to its end; an interrupt cancels it first. The last status.
Result<Json> follow(const RigClient& client, const CommonArguments& common) {
  const std::stop_token interrupt = stop_on_signal();
  const std::stop_callback cancel(interrupt, [&] { static_cast<void>(client.post("/api/v1/scan/cancel")); });
  Narrator narrator(common);
  Json last;
  const Result<void> followed = client.follow(
      [&](const RigClient::Event& event) {
        if (event.name == "frame") narrator.show_frame(event.data);
        if (event.name != "status") return true;
        last = event.data;
        narrator.show_status(last);
        return !has_ended(last);
      },
      {});
  if (!followed) return followed.error();
  return last;
}

Result<SolveReport> solve_preview(const fs::path& session, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  SolveOptions options;
  options.method = "preview";
  return solve_session({session, {}, {}}, options, {common.threads, stop_on_signal(), line.callback()});
}

Result<int> name_only(const capture::Rig& rig, const ScanArguments& arguments,
                      const CommonArguments& common) {
  fs::path session = arguments.output;
  if (session.empty()) {
    const Result<std::string> name = next_session_name(rig.scan.session_name, arguments.fabric, rig.name,
                                                       rig.scan.sessions, std::chrono::system_clock::now());
    if (!name) return name.error();
    session = rig.scan.sessions / (*name + ".weft");
  }
  if (common.json) {
    print_json({{"session", session.string()}});
  } else {
    print(session.string());
  }
  return kDone;
}

}  // namespace

Result<int> run_scan(const ScanArguments& arguments, const CommonArguments& common) {
  const Result<capture::Rig> rig = capture::read_rig(find_rig(arguments.rig));
  if (!rig) return rig.error();
  if (arguments.dry_run) return name_only(*rig, arguments, common);
  const Result<Json> body = body_of(arguments);
  if (!body) return body.error();
  fs::path sessions = rig->scan.sessions;
  Json status;
  {
    const Result<Scanner> scanner = find_scanner(*rig, arguments.output);
    if (!scanner) return scanner.error();
    if (scanner->own && !arguments.output.empty()) sessions = fs::absolute(arguments.output).parent_path();
    if (const Result<Json> begun = scanner->client.post("/api/v1/scan", *body); !begun) return begun.error();
    Result<Json> ended = follow(scanner->client, common);
    if (!ended) return std::move(ended).error();
    status = std::move(*ended);
  }
  if (!status["error"].is_null())
    return error_of_document(Json{{"error", status["error"]}}.dump(), rig->name);
  const fs::path session = sessions / (status["session"].get<std::string>() + ".weft");
  if (status["phase"] == "cancelled") {
    return Error{ErrorKind::kInterrupted, "the scan was stopped", session.string(),
                 fmt::format("{} of {} frames are kept", status["frames"].get<int>(),
                             status["frames_planned"].get<int>()),
                 "run the same command again to finish it"};
  }
  fs::path sheet;
  if (arguments.preview) {
    const Result<SolveReport> solved = solve_preview(session, common);
    if (!solved) return solved.error();
    sheet = solved->folder / "sheet.png";
  }
  if (common.json) {
    print_json({{"session", session.string()},
                {"frames", status["frames"]},
                {"exposure_us", status["exposure_us"]},
                {"warnings", status["warnings"]},
                {"preview", sheet.string()}});
    return kDone;
  }
  print(session.string());
  for (const Json& warning : status["warnings"]) print("  " + warning.get<std::string>());
  if (!sheet.empty()) print("  look at " + sheet.string());
  return kDone;
}

}  // namespace weft::app
