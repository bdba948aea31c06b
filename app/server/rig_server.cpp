// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig_server.h"

#include <fmt/format.h>
#include <unistd.h>

#include <optional>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/job_kinds.h"
#include "app/server/http/event_log.h"
#include "app/server/page/served_page.h"
#include "app/server/rig/attendance.h"
#include "app/server/rig/controls.h"
#include "app/server/rig/frame_pictures.h"
#include "app/server/rig/rig_lock.h"
#include "app/server/rig/rig_watch.h"
#include "core/base/files.h"
#include "core/base/process.h"
#include "core/describe/field_json.h"
#include "core/rig/calibration.h"

namespace weft::app {
namespace {

constexpr const char* kScan = "scan";  // who asks for what is done with each scan

// A job without what it made and where it waits, which is asked for by its id.
Json event_of(const JobStatus& job) {
  Json event = object_of(job);
  event.erase("result");
  event.erase("place");
  event.erase("notes");
  return event;
}

}  // namespace

struct RigServer::State {
  State(const capture::Rig& its_rig, RigLock its_lock, capture::OpenDevices open, RunScan run,
        Logbook::Say say)
      : rig(its_rig),
        lock(std::move(its_lock)),
        log(lock.folder() / "log", std::move(say)),
        pictures(lock.folder() / "pictures", 2000, [this] { return capture::calibration_now(rig); }),
        views(lock.folder() / "views"),
        swatches(lock.folder() / "swatches"),
        watch(rig, [this] { keeper.tell_status(); }),
        controls([this](const std::string& name) { tell_controls(name); }),
        screens(rig),
        attendance(rig, std::move(open), lock.folder() / "test-shots", screens,
                   {[this] { keeper.tell_status(); }, [this](const TestShot& shot) { tell_shot(shot); }}),
        sets(rig, keeper, events),
        framing(rig),
        keeper(rig, attendance, screens, std::move(run), events, log, pictures) {
    keeper.on_controls([this] { return controls.holder(); });
    keeper.on_place([this] { return watch.place(); });
  }

  void tell_controls(const std::string& name) {
    log.add("controls", name.empty() ? "nobody holds the controls" : name + " holds the controls",
            {{"name", name}});
    events.add("control", {{"name", name}});
    keeper.tell_status();
  }

  void tell_shot(const TestShot& shot) { events.add("shot", document_of(shot, pictures)); }

  /// What is done with each finished scan: it is held against its calibration, then solved quickly, where
  /// the calibration that it was scanned with suffices.
  void look_at(const capture::ScanRequest& request, bool looks, bool previews) {
    const Result<Calibration> calibration = read_calibration(request.session / "calibration");
    if (!calibration || !calibration->camera || !calibration->lights || !calibration->response) return;
    const std::string session = request.session.string(), name = request.session.stem().string();
    if (previews)
      add_first({"solve",
                 name,
                 {"solve", session, "--quality", "preview"},
                 kScan,
                 "",
                 {session},
                 {{"session", name}, {"quality", "preview"}}});
    if (looks && std::holds_alternative<NearLights>(*calibration->lights))
      add_first({kRigCheck, name, {"rig", "check", session}, kScan, "", {session}, {{"session", name}}});
  }

  void add_first(const JobSpec& spec) {
    const Result<JobStatus> job = jobs->add(spec);
    if (!job) {
      log.add("job_failed", job.error().message(), {{"session", spec.of}, {"kind", spec.kind}});
    } else {
      static_cast<void>(jobs->first(job->id));
    }
  }

  void job_changed(const JobStatus& job) {
    events.add("job", event_of(job));
    if (job.ended.empty()) return;
    library->expire();
    if (job.spec.kind == kRigCheck && job.state == JobState::kDone) watch.saw(job.spec.arguments.back());
  }

  Result<void> open_jobs_and_library(const RigServerOptions& wish) {
    Result<std::unique_ptr<LibraryService>> shelves =
        LibraryService::open(lock.folder(), rig.scan.sessions, rig.daemon.archives);
    if (!shelves) return std::move(shelves).error();
    library = std::move(*shelves);
    JobQueueOptions options;
    options.folder = lock.folder() / "jobs";
    options.program = wish.weft.empty() ? program_beside("weft") : wish.weft;
    options.memory_bytes = available_memory_bytes() / 4 * 3;
    options.changed = [this](const JobStatus& job) { job_changed(job); };
    Result<std::unique_ptr<JobQueue>> opened = JobQueue::open(std::move(options));
    if (!opened) return std::move(opened).error();
    jobs = std::move(*opened);
    keeper.on_busy([this](bool is_busy) { jobs->hold(is_busy); });
    keeper.on_scanned([this, looks = wish.looks, previews = wish.previews](
                          const capture::ScanRequest& request) { look_at(request, looks, previews); });
    parts.emplace(RigParts{rig, lock.folder(), keeper, pictures, attendance, screens, scans, sets, framing,
                           watch, controls, *jobs, *library, views, swatches, pixels, guard});
    return {};
  }

  const capture::Rig rig;
  RigLock lock;
  EventLog events;
  Logbook log;
  FramePictures pictures;
  ViewStore views;
  Swatches swatches;
  PixelTables pixels;
  RigWatch watch;  // its jobs tell it of what they saw until they end
  std::unique_ptr<LibraryService> library;
  std::unique_ptr<JobQueue> jobs;
  Controls controls;
  Screens screens;
  Once scans;
  Attendance attendance;
  SetKeeper sets;  // outlives what the keeper does for it
  FramingGuide framing;
  RigKeeper keeper;
  std::optional<RigParts> parts;
  GuardRules guard;
  std::string address;
  std::unique_ptr<HttpServer> http;
};

namespace {

Result<GuardRules> rules_of(const capture::Rig& rig, bool own_token) {
  GuardRules rules;
  rules.listening_host = rig.daemon.host;
  rules.names = rig.daemon.names;
  rules.origins = rig.daemon.origins;
  if (own_token || !rig.daemon.token.empty()) {
    Result<std::string> token = own_token ? new_token() : read_token(rig.daemon.token.string());
    if (!token) return std::move(token).error();
    rules.token = std::move(*token);
  }
  if (!rig.daemon.look_token.empty()) {
    Result<std::string> token = read_token(rig.daemon.look_token.string());
    if (!token) return std::move(token).error();
    rules.look_token = std::move(*token);
  }
  return rules;
}

}  // namespace

Result<std::unique_ptr<RigServer>> RigServer::start(const capture::Rig& rig, capture::OpenDevices open,
                                                    RunScan run, const RigServerOptions& options) {
  Result<RigLock> lock = RigLock::take(rig);
  if (!lock) return std::move(lock).error();
  const bool is_own = rig.daemon.token.empty() && options.own_token;
  Result<GuardRules> rules = rules_of(rig, is_own);
  if (!rules) return std::move(rules).error();
  auto state = std::make_unique<State>(rig, std::move(*lock), std::move(open), std::move(run), options.say);
  state->guard = *rules;
  if (Result<void> ok = state->open_jobs_and_library(options); !ok) return std::move(ok).error();
  std::vector<Route> routes = api_routes(*state->parts);
  for (Route& route : page_routes()) routes.push_back(std::move(route));
  Result<std::unique_ptr<HttpServer>> http =
      HttpServer::start(rig.daemon.port, std::move(*rules), std::move(routes), state->events, options.limits);
  if (!http) return std::move(http).error();
  state->http = std::move(*http);
  const bool v6 = rig.daemon.host.find(':') != std::string::npos;
  const std::string host = v6 ? "[" + rig.daemon.host + "]" : rig.daemon.host;
  state->address = fmt::format("http://{}:{}", host, state->http->port());
  if (Result<void> told = state->lock.publish(state->address, is_own ? state->guard.token : ""); !told)
    return std::move(told).error();
  state->log.add("daemon_began", fmt::format("rig {} is served at {}", rig.name, state->address),
                 {{"rig", rig.name}, {"pid", getpid()}});
  return std::unique_ptr<RigServer>(new RigServer(std::move(state)));
}

RigServer::RigServer(std::unique_ptr<State> state) : state_(std::move(state)) {}

RigServer::~RigServer() {
  stop();
}

int RigServer::port() const {
  return state_->http->port();
}
const std::string& RigServer::address() const {
  return state_->address;
}
const std::string& RigServer::token() const {
  return state_->guard.token;
}

std::vector<std::string> RigServer::calls() const {
  std::vector<std::string> calls;
  for (const Route& route : api_routes(*state_->parts)) calls.push_back(route.method + " " + route.path);
  return calls;
}

bool RigServer::stop(std::chrono::milliseconds most) {
  state_->controls.stop();
  state_->watch.stop();
  const bool ended = state_->keeper.stop(most) && state_->attendance.stop(most);
  if (!state_->events.closed()) {
    state_->log.add("daemon_ended",
                    ended ? "it was told to" : "it was told to, and a device does not answer");
  }
  state_->events.close();
  state_->pictures.stop();
  state_->http->stop();
  return ended;
}

}  // namespace weft::app
