// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/rig_owner.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/http/error_reply.h"
#include "app/server/rig/rig_lock.h"
#include "calibration/guide/scan_price.h"
#include "calibration/run/rig_look.h"
#include "capture/rig.h"
#include "core/base/files.h"
#include "core/base/percent.h"
#include "core/describe/field_json.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "library/chain/chain.h"
#include "solve/run/solve_session.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr auto kBetweenQuestions = std::chrono::milliseconds(500);

struct ScanArguments {
  fs::path rig;
  ScanWish wish;             ///< its session is a folder
  std::optional<int> again;  ///< LED of a finished session; 0: the dark shot
  bool preview = true;       ///< a quick solve at the end
};

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

/// What was said, as a call says it.
Json body_of(ScanWish wish) {
  const fs::path name = wish.session.filename();
  wish.session = name.extension() == ".weft" ? name.stem() : name;
  wish.only_explains = false;
  return changes_of(wish);
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
    if (quiet_ || frame["kept"] == false) return;  // a refused one is told by the status
    double clipped = 0;
    for (const Json& share : frame["clipped_rgb"]) clipped = std::max(clipped, share.get<double>());
    const int led = frame["led"].get<int>();
    const std::string role = frame["role"].get<std::string>();
    const std::string polariser = frame["polariser"].get<std::string>();
    note(fmt::format("  {:>2} {:7} {:8} {}clipped {} %", frame["index"].get<int>(),
                     led > 0           ? fmt::format("LED {}", led)
                     : role == "below" ? "below"
                                       : "dark",
                     role, polariser == "none" ? "" : fmt::format("{:8} ", polariser),
                     percent_words(clipped)));
    for (const Json& warning : frame["warnings"]) note("     " + warning.get<std::string>());
  }

 private:
  bool quiet_;
  ProgressLine line_;
  std::string why_;
};

bool has_ended(const Json& status) {
  return status["state"] == "idle" || status["state"] == "attended" || status["state"] == "failed";
}

/// The last status of a scan whose events are not told, because too many clients follow them already.
Result<Json> ask_until_it_ends(const RigClient& client, const Json& session, Narrator& narrator,
                               const Error& not_followed) {
  for (;; std::this_thread::sleep_for(kBetweenQuestions)) {
    Result<Json> status = client.get("/api/v1/rig");
    if (!status || status->at("session") != session) return not_followed;
    narrator.show_status(*status);
    if (has_ended(*status)) return status;
  }
}

/// Who lays the blade, at this terminal, where the scan waits for that: an empty line goes on with it, the
/// end of their input cancels it.
class BladeLayer {
 public:
  explicit BladeLayer(const RigClient& client) : client_(client) {}

  void follow(const Json& status) {
    const bool is_awaited = status["phase"] == "paused" && status["role"] == name_of(ShotRole::kBlade);
    if (is_awaited == asked_.joinable()) return;
    asked_ = {};
    if (!is_awaited) return;
    note("then press Enter");
    asked_ = std::jthread([this](const std::stop_token& done) {
      const bool is_laid = typed_line(done).has_value();
      if (!done.stop_requested())
        static_cast<void>(client_.post(is_laid ? "/api/v1/scan/resume" : "/api/v1/scan/cancel"));
    });
  }

 private:
  const RigClient& client_;
  std::jthread asked_;
};

/// Follows the scan of this session to its end; an interrupt cancels it first. The last status.
Result<Json> follow(const RigClient& client, const Json& session, const CommonArguments& common) {
  const std::stop_token interrupt = stop_on_signal();
  const std::stop_callback cancel(interrupt, [&] { static_cast<void>(client.post("/api/v1/scan/cancel")); });
  Narrator narrator(common);
  BladeLayer layer(client);
  Json last;
  const Result<void> followed = client.follow(
      [&](const RigClient::Event& event) {
        if (event.name == "frame") narrator.show_frame(event.data);
        if (event.name != "status") return true;
        last = event.data;
        narrator.show_status(last);
        layer.follow(last);
        return !has_ended(last);
      },
      {});
  if (followed) return last;
  return ask_until_it_ends(client, session, narrator, followed.error());
}

/// What is worth knowing of the session where the command named none.
void say_choice(const Json& choice, const capture::Rig& rig) {
  const std::string name = choice["session"].get<std::string>();
  if (choice["resumed"] == true) {
    note(fmt::format("goes on with {}: {} of {} frames are there; -o NEW_NAME begins another", name,
                     choice["frames"].get<int>(), choice["frames_planned"].get<int>()));
  }
  if (!choice.contains("unfinished")) return;
  const std::string other = choice["unfinished"].get<std::string>();
  note(fmt::format("{} of the same cloth is not finished; -o {} finishes it", other,
                   (rig.scan.sessions / (other + ".weft")).string()));
}

Result<int> name_only(const capture::Rig& rig, const std::optional<std::string>& owner, const Json& body,
                      const CommonArguments& common) {
  const Result<ReachedRig> scanner = reach_rig(rig, owner);
  if (!scanner) return scanner.error();
  Result<Json> choice = scanner->client.post("/api/v1/scan", body);
  if (!choice) return std::move(choice).error();
  if (!body.contains("session")) say_choice(*choice, rig);
  const fs::path session = rig.scan.sessions / (choice->at("session").get<std::string>() + ".weft");
  (*choice)["session"] = session.string();
  if (common.json) {
    print_json(*choice);
  } else {
    print(session.string());
  }
  return kDone;
}

void print_offers(const calibration::ScanPrices& offers) {
  print("  degrees   light  cloth        of  shots  seconds       MB  shots to buy");
  const auto cell = [](const std::optional<double>& value, double factor) {
    return value ? fmt::format("{:.3g}", factor * *value) : std::string("-");
  };
  for (const calibration::ShotsPrice& row : offers.rows) {
    print(fmt::format("{:>9} {:>7} {:>6} {:>9} {:>6} {:>8} {:>8}  {}{}{}", cell(row.predicted_deg, 1),
                      cell(row.light_deg, 1), row.predicted_deg ? fmt::format("{:.3g}", row.cloth_deg) : "-",
                      row.predicted_deg ? share_in_words(row.solved) : "-", row.shots, cell(row.seconds, 1),
                      cell(row.bytes, 1e-6), row.what, row.is_asked ? "  <- asked for" : "",
                      row.is_chosen ? "  <- to buy" : ""));
    if (row.is_chosen && !row.is_asked)
      print(fmt::format("{:60}  --leds {}{}{}", "", fmt::join(row.list.leds, ","),
                        row.list.repeat ? "" : " --no-repeat",
                        row.list.bracket ? fmt::format(" --bracket {:g}", *row.list.bracket) : ""));
  }
  for (const std::string& each : offers.notes) print(each);
}

/// Lists what may be bought; nothing is photographed.
Result<int> explain_scan(const capture::Rig& rig, const std::optional<std::string>& owner, const Json& body,
                         const CommonArguments& common) {
  const Result<ReachedRig> scanner = reach_rig(rig, owner);
  if (!scanner) return scanner.error();
  const Result<Json> told = scanner->client.post("/api/v1/scan/price", body);
  if (!told) return told.error();
  if (common.json) {
    print_json(*told);
    return kDone;
  }
  JsonReader reader(*told, "scan/price");
  calibration::ScanPrices offers;
  describe(reader, offers);
  if (Result<void> ok = reader.status(); !ok) return std::move(ok).error();
  print_offers(offers);
  return kDone;
}

/// The sheet of a quick solve; empty where there is none, and then a remark or a warning says why.
fs::path solve_preview(const fs::path& session, const CommonArguments& common, Json& warnings) {
  const Result<Calibration> calibration = read_calibration(session / "calibration");
  const bool suffices = calibration && calibration->camera && calibration->lights && calibration->response;
  if (!is_there(session / "calibration") || (calibration && !suffices)) {
    if (!common.quiet) note("no preview: it needs a calibration of camera, response and lights");
    return {};
  }
  ProgressLine line(common.quiet);
  solve::SolveOptions options;
  options.method = "preview";
  const Result<solve::SolveReport> solved =
      solve::solve_session({session, {}, {}}, options, {common.threads, stop_on_signal(), line.callback()});
  if (solved) return solved->folder / "sheet.png";
  warnings.push_back("there is no preview: " + solved.error().message());
  return {};
}

/// Holds the scan against its calibration, as a daemon's job does; without one there is nothing to hold it
/// against, and the preview says so.
void look_at_rig(const fs::path& folder, const CommonArguments& common) {
  const Result<Session> session = read_session(folder);
  if (!session || !is_there(session->calibration_folder())) return;
  ProgressLine line(common.quiet);
  const auto look = calibration::look_at_scan(*session, {common.threads, stop_on_signal(), line.callback()});
  if (!look && look.error().kind != ErrorKind::kBadData && !common.quiet)
    note("the rig was not checked: " + look.error().message());
}

/// The call that takes the LED's shot of a finished session once more.
Result<std::string> call_again(const fs::path& folder, int led) {
  if (folder.empty()) {
    return Error{ErrorKind::kUsage, "nothing says of which session", "--again", "",
                 "name it: -o NAME.weft --again LED"};
  }
  const Result<Session> session = read_session(folder);
  if (!session) return session.error();
  const std::vector<const Shot*> lit = session->lit();
  const auto found = std::ranges::find(lit, led, &Shot::led);
  const Shot* shot = led == 0 ? session->dark() : found != lit.end() ? *found : nullptr;
  if (shot == nullptr) {
    return Error{ErrorKind::kUsage, fmt::format("the session has no shot of LED {}", led), folder.string(),
                 "", "name a LED that it lit, or 0 for the dark shot"};
  }
  return fmt::format("/api/v1/sessions/{}/frames/{}/again", folder.stem().string(), shot->index);
}

/// The sheet of the quick solve that the daemon makes of a finished scan as a job; empty where it makes none.
fs::path await_preview(const capture::Rig& rig, const std::string& owner, const std::string& session,
                       const CommonArguments& common, Json& warnings) {
  const Result<RigClient> client = connect_to_owner(rig, owner);
  if (!client) return {};
  ProgressLine line(common.quiet);
  const std::stop_token interrupt = stop_on_signal();
  for (; !interrupt.stop_requested(); std::this_thread::sleep_for(kBetweenQuestions)) {
    const Result<Json> page = client->get("/api/v1/jobs");
    if (!page) return {};
    const Json& jobs = page->at("jobs");
    const auto job = std::ranges::find_if(jobs, [&](const Json& each) {
      return each["of"] == session && each["by"] == "scan" && each["kind"] == "solve";
    });
    if (job == jobs.end()) return {};
    const std::string state = job->at("state").get<std::string>();
    if (state == "done") return fs::path(job->at("result").value("folder", "")) / "sheet.png";
    if (state == "failed" || state == "cancelled") {
      warnings.push_back("there is no preview: its job " + state);
      return {};
    }
    line.update("preview", job->at("share").get<double>());
  }
  return {};
}

/// Scans. Returns the rig's last status, once nothing of this process holds the rig any more.
Result<Json> photograph(const capture::Rig& rig, const std::optional<std::string>& owner, const Json& body,
                        const std::string& call, const CommonArguments& common) {
  const Result<ReachedRig> scanner = reach_rig(rig, owner);
  if (!scanner) return scanner.error();
  const Result<Json> begun = scanner->client.post(call, body);
  if (!begun) return begun.error();
  if (begun->contains("resumed") && !body.contains("session")) say_choice(*begun, rig);
  return follow(scanner->client, begun->at("session"), common);
}

void print_outcome(const fs::path& session, const Json& status, const Json& warnings, const fs::path& sheet,
                   const CommonArguments& common) {
  const Result<Session> scanned = read_session(session);
  const auto verdict = scanned ? std::optional(library::chain_of(*scanned).verdict) : std::nullopt;
  if (common.json) {
    print_json({{"session", session.string()},
                {"frames", status["frames"]},
                {"exposure_us", status["exposure_us"]},
                {"warnings", warnings},
                {"verdict", verdict ? object_of(*verdict) : Json()},
                {"preview", sheet.string()}});
    return;
  }
  print(session.string());
  if (verdict) print("  " + words_of(*verdict));
  for (const Json& warning : warnings) print("  " + warning.get<std::string>());
  if (!sheet.empty()) print("  look at " + sheet.string());
}

Result<int> scan(ScanArguments arguments, const CommonArguments& common) {
  fs::path& output = arguments.wish.session;
  if (!output.has_filename()) output = output.parent_path();  // "NAME.weft/", as a shell completes it
  Result<capture::Rig> rig = capture::read_rig(find_rig(arguments.rig));
  if (!rig) return std::move(rig).error();
  Json body = body_of(arguments.wish);
  std::string call = "/api/v1/scan";
  if (arguments.again) {
    Result<std::string> again = call_again(output, *arguments.again);
    if (!again) return std::move(again).error();
    call = std::move(*again);
    body = Json{{"exposure_us", arguments.wish.exposure_us.value_or(0)}};
  }
  const Result<std::optional<std::string>> owner = address_of_owner(*rig);
  if (!owner) return owner.error();
  if (*owner) {
    if (Result<void> ok = check_folder(*rig, output); !ok) return std::move(ok).error();
  } else if (!output.empty()) {
    rig->scan.sessions = fs::absolute(output).parent_path();
  }
  if (arguments.wish.only_explains) return explain_scan(*rig, *owner, body, common);
  if (arguments.wish.dry_run) return name_only(*rig, *owner, body, common);
  Result<Json> ended = photograph(*rig, *owner, body, call, common);
  if (!ended) return std::move(ended).error();
  Json& status = *ended;
  if (!status["error"].is_null())
    return error_of_document(Json{{"error", status["error"]}}.dump(), rig->name);
  const fs::path session = rig->scan.sessions / (status["session"].get<std::string>() + ".weft");
  if (status["phase"] == "cancelled") {
    return Error{ErrorKind::kInterrupted, "the scan was stopped", session.string(),
                 fmt::format("{} of {} frames are kept", status["frames"].get<int>(),
                             status["frames_planned"].get<int>()),
                 "run the same command again to finish it"};
  }
  Json warnings = status["warnings"];
  if (!*owner) look_at_rig(session, common);
  const fs::path sheet = !arguments.preview ? fs::path()
                         : *owner           ? await_preview(*rig, **owner, session.stem(), common, warnings)
                                            : solve_preview(session, common, warnings);
  print_outcome(session, status, warnings, sheet, common);
  return kDone;
}

Run add_scan(Options& options) {
  const auto a = std::make_shared<ScanArguments>();
  add_rig_file(options, a->rig);
  add_options(options, a->wish);
  options
      .add("--again", &a->again,
           "LED whose shot of the finished session -o is taken once more, 0: the dark shot. The new frame "
           "stands for the old one, which stays; with --exposure it is a bracket")
      .in_range(0, 10);
  options.add_flag("!--no-preview", &a->preview, "Do not solve a quick preview at the end");
  return [a](const CommonArguments& common) { return scan(*a, common); };
}

}  // namespace

Verb scan_verb() {
  return {"scan", "Photograph a cloth under each LED; run again, it finishes a scan that was cut short",
          add_scan};
}

}  // namespace weft::app
