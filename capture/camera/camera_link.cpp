// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_link.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <system_error>
#include <thread>
#include <utility>

#include "capture/camera/photograph_facts.h"
#include "capture/camera/worker_lines.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/base/json_document.h"
#include "core/describe/error_json.h"

namespace weft::capture {
namespace {

constexpr double kKept_s = 3600;
constexpr double kDrift = 1e-4;  // of two quartzes, 50 ppm each: 0.36 s in an hour
constexpr const char* kSchema = "weft.camera_clock";

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

// For the worker to start and to load its drivers, which a busy machine may take long over and no camera has
// a part in.
constexpr double kDriversS = 30;
// Detection, session, the card's list, settings, 1.5 s of watching a clock. On USB a silent body is reset
// twice, after 1.5 s each; over the network a new connection does more than libgphoto2's third try.
constexpr double kOpenUsbS = 12, kOpenNetworkS = 5;
constexpr const char* kNotOpenedRemedy =
    "switch the camera off and on; if its card holds thousands of pictures, format it or take it out";
constexpr double kSetS = 5;     // libgphoto2 gives up on a packet after 2.5 s
constexpr double kLookS = 2.5;  // for the mirror and a first picture, of which later ones take a tenth
constexpr std::size_t kMostPictureBytes = 4U << 20;
constexpr double kOverdueS = 1;   // beyond the deadline that the worker keeps by itself
constexpr double kEndS = 0.5;     // for the camera's session to be closed
constexpr double kComeBackS = 1;  // a camera that just lost its link may refuse a new one for a moment

Steady::duration seconds(double s) {
  return std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(s));
}

/// Seconds that clocks on the wall are ahead of UTC here and now.
double local_offset_s() {
  const std::time_t now = std::time(nullptr);
  std::tm local = {};
  return localtime_r(&now, &local) == nullptr ? 0 : static_cast<double>(local.tm_gmtoff);
}

Error wrong_line(const std::string& why) {
  return {ErrorKind::kProtocol, "a line of weft-camera makes no sense", "weft-camera", why,
          "install weft whole: weft-camera belongs beside weft"};
}

Error not_connected() {
  return {ErrorKind::kTryAgain, "the camera is not connected", "", "", "connect it again"};
}

Error not_started(const Error& cause) {
  return {ErrorKind::kTryAgain, "the camera's program does not start", "weft-camera", cause.why,
          "try again; libgphoto2 looks at each mounted disk: see that none hangs"};
}

Result<fs::path> folder_of_its_own() {
  std::error_code failed;
  std::string name = (fs::temp_directory_path(failed) / "weft-camera.XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) return cannot_write(name, errno);
  return fs::path(name);
}

}  // namespace

std::optional<RememberedClock> ClockMemory::recall(double now_s) const {
  const Result<Json> document = read_json(file_, kSchema, 1);
  if (!document) return {};
  JsonFields fields(*document, file_.string());
  RememberedClock known = {fields.text("serial"),
                           {fields.number("offset_s"), fields.number("uncertainty_s")}};
  const double age_s = now_s - fields.number("read_s");
  if (!fields.status() || !(age_s >= 0 && age_s <= kKept_s)) return {};
  known.clock.uncertainty_s += kDrift * age_s;
  return known;
}

void ClockMemory::keep(const RememberedClock& watched, double now_s) const {
  static_cast<void>(write_json(file_, {{"schema", std::string(kSchema) + "/1.0"},
                                       {"serial", watched.serial},
                                       {"read_s", now_s},
                                       {"offset_s", watched.clock.offset_s},
                                       {"uncertainty_s", watched.clock.uncertainty_s}}));
}

void ClockMemory::forget() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

Result<std::unique_ptr<CameraLink>> CameraLink::make(CameraLinkOptions options) {
  Result<CameraProfile> profile = read_camera_profile(options.profile);
  if (!profile) return std::move(profile).error();
  if (options.worker.empty()) options.worker = weft_camera_program();
  const bool own_state = options.state.empty();
  if (own_state) {
    Result<fs::path> folder = folder_of_its_own();
    if (!folder) return std::move(folder).error();
    options.state = std::move(*folder);
  } else if (Result<void> made = make_writable_folder(options.state); !made) {
    return std::move(made).error();
  }
  return std::unique_ptr<CameraLink>(new CameraLink(std::move(options), std::move(*profile), own_state));
}

CameraLink::CameraLink(CameraLinkOptions options, CameraProfile profile, bool own_state)
    : options_(std::move(options)),
      profile_(std::move(profile)),
      own_state_(own_state),
      clock_memory_(options_.state / "clock.json") {}

CameraLink::~CameraLink() {
  end_worker();
  std::error_code ignored;
  if (own_state_) fs::remove_all(options_.state, ignored);
}

Result<CameraFacts> CameraLink::connect() {
  end_worker();
  facts_ = {};
  last_image_number_.reset();
  wanted_.reset();
  const auto known = clock_memory_.recall(seconds_since_1970());
  clock_ = known ? std::optional(known->clock) : std::nullopt;
  Result<CameraFacts> facts = open(options_.serial, !known);
  is_clock_remembered_ = facts && known;
  if (!facts) clock_.reset();
  if (!is_clock_remembered_) return facts;
  const bool is_as_known =
      facts_.serial == known->serial && clock_ && clock_->offset_s == known->clock.offset_s;
  if (is_as_known) return facts;
  forget_clock();
  end_worker();
  return open(options_.serial, true);
}

void CameraLink::forget_clock() {
  clock_memory_.forget();
  clock_.reset();
  is_clock_remembered_ = false;
}

Result<CameraFacts> CameraLink::recover() {
  end_worker();
  // A body that was reset counts anew; by now its clock tells an older photograph.
  if (clock_) last_image_number_.reset();
  const std::string& serial = facts_.serial.empty() ? options_.serial : facts_.serial;
  const auto patience = Steady::now() + seconds(kComeBackS);
  Result<CameraFacts> opened = open(serial, !clock_);
  while (!opened && opened.error().kind == ErrorKind::kNoDevice && Steady::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    opened = open(serial, !clock_);
  }
  return opened && wanted_ ? set(*wanted_) : opened;
}

Result<CameraFacts> CameraLink::set(const ExposureSettings& exposure) {
  if (!ready_) return not_connected();
  const Result<Json> set = request({{"do", "set"}, {"exposure", line_of(exposure)}}, kSetS);
  if (!set) return set.error();
  JsonFields fields(*set, "set");
  const Result<ExposureSettings> read_back = exposure_of_line(fields.object("exposure"));
  const double battery = fields.number("battery");
  if (Result<void> ok = fields.status(); !ok) return wrong_line(ok.error().message());
  if (!read_back) return read_back.error();
  facts_.exposure = *read_back;
  facts_.battery = battery;
  wanted_ = exposure;
  return facts_;
}

Result<std::vector<double>> CameraLink::shutter_times_us() {
  if (!ready_) return not_connected();
  const Result<Json> told = request({{"do", "shutters"}}, kSetS);
  if (!told) return told.error();
  std::vector<double> times;
  JsonFields fields(*told, "shutters");
  for (const Json& time : fields.list("exposure_us")) {
    if (!time.is_number()) return wrong_line("a time is no number");
    times.push_back(time.get<double>());
  }
  if (Result<void> ok = fields.status(); !ok) return wrong_line(ok.error().message());
  return times;
}

Result<Photograph> CameraLink::take(const fs::path& file, const std::function<void()>& exposed) {
  if (!ready_) return not_connected();
  const double deadline_s = 1e-6 * facts_.exposure.exposure_us + profile_.readout_s;
  const Result<Json> landed = request({{"do", "take"}, {"file", file.string()}, {"deadline_s", deadline_s}},
                                      deadline_s + kOverdueS, [&](auto&) { exposed(); });
  if (!landed) return landed.error();
  const fs::path aside = file.string() + ".arrived";
  Result<Photograph> photograph = examined(aside, *landed);
  if (!photograph) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    // It may be the clock that is wrong.
    if (is_clock_remembered_ && photograph.error().kind == ErrorKind::kProtocol) forget_clock();
    // What is still to come from the camera is unknown.
    ready_ = photograph.error().kind == ErrorKind::kBadData;
    return photograph;
  }
  photograph->file = file.string() + "." + photograph->ending;
  std::error_code failed;
  fs::rename(aside, photograph->file, failed);
  if (failed) return cannot_write(photograph->file, failed.value());
  if (Result<void> synced = sync_path(fs::absolute(file).parent_path()); !synced)
    return std::move(synced).error();
  if (photograph->image_number) last_image_number_ = photograph->image_number;
  return photograph;
}

Result<std::string> CameraLink::look() {
  if (!ready_) return not_connected();
  const auto deadline = Steady::now() + seconds(kLookS);
  const Result<Json> told = request({{"do", "look"}}, kLookS);
  if (!told) return told.error();
  const Json bytes = told->value("bytes", Json());
  if (!bytes.is_number_unsigned() || bytes > kMostPictureBytes) return wrong_line(told->dump());
  Result<std::string> picture = worker_->read_bytes(bytes.get<std::size_t>(), deadline);
  if (!picture) end_worker();
  return picture;
}

Result<void> CameraLink::stop_looking() {
  if (!ready_) return not_connected();
  const Result<Json> done = request({{"do", "stop_looking"}}, kSetS);
  return done ? Result<void>() : done.error();
}

/// What the worker has landed, held against what was asked of the camera.
Result<Photograph> CameraLink::examined(const fs::path& aside, const Json& landed) const {
  Photograph photograph;
  JsonFields fields(landed, "take");
  photograph.sha256 = fields.text("sha256");
  photograph.bytes = static_cast<std::uint64_t>(fields.number("bytes"));
  photograph.triggered_s = fields.number("triggered_s");
  photograph.waited_s = fields.number("waited_s");
  if (Result<void> ok = fields.status(); !ok) return wrong_line(ok.error().message());
  const Result<PhotographFacts> facts = read_photograph_facts(aside);
  if (!facts) return facts.error();
  const AskedFor asked{facts_.exposure,      photograph.bytes, photograph.triggered_s,
                       seconds_since_1970(), clock_,           last_image_number_};
  if (Result<void> ours = check_photograph(*facts, asked); !ours) {
    Error error = std::move(ours).error();
    error.where = facts_.port;
    return error;
  }
  photograph.ending = facts->ending;
  photograph.image_number = facts->image_number;
  photograph.taken_s = taken_s(*facts, clock_);
  photograph.exposure = {facts->exposure_us, facts->iso, facts->f_number};
  return photograph;
}

Result<CameraFacts> CameraLink::open(const std::string& serial, bool watch_clock) {
  if (Result<void> started = start_worker(); !started) return std::move(started).error();
  Json asked = {{"do", "open"}, {"profile", options_.profile}, {"port", options_.port}, {"serial", serial}};
  if (watch_clock) asked["watch_clock"] = true;
  const bool is_network = options_.port.starts_with("ptpip:");
  bool is_asked = false;
  const Result<Json> opened = request(std::move(asked), kDriversS, [&](WorkerProcess::Deadline& deadline) {
    is_asked = true;
    deadline = Steady::now() + seconds(is_network ? kOpenNetworkS : kOpenUsbS);
  });
  if (!opened) {
    Error error = opened.error();
    if (worker_) return error;
    if (!is_asked && error.kind == ErrorKind::kTryAgain) return not_started(error);
    error.remedy = kNotOpenedRemedy;
    return error;
  }
  Result<CameraFacts> facts = note_opened(*opened);
  if (facts && watch_clock && clock_) clock_memory_.keep({facts_.serial, *clock_}, seconds_since_1970());
  return facts;
}

Result<CameraFacts> CameraLink::note_opened(const Json& opened) {
  JsonFields fields(opened, "open");
  facts_.model = fields.text("model");
  facts_.serial = fields.text("serial");
  facts_.port = fields.text("port");
  facts_.battery = fields.number("battery");
  const Result<ExposureSettings> exposure = exposure_of_line(fields.object("exposure"));
  if (Result<void> ok = fields.status(); !ok) return wrong_line(ok.error().message());
  if (!exposure) return exposure.error();
  facts_.exposure = *exposure;
  facts_.shutter_travel_s = profile_.shutter_travel_s;
  note_clock(opened.value("clock", Json()));
  ready_ = true;
  return facts_;
}

/// A clock that has been watched stays, as long as a glance at it agrees.
void CameraLink::note_clock(const Json& clock) {
  JsonFields fields(clock, "clock");
  const CameraClock read{fields.number("offset_s"), fields.number("uncertainty_s")};
  if (!fields.status()) {
    clock_.reset();
  } else if (!clock_ ||
             std::abs(clock_->offset_s - read.offset_s) > clock_->uncertainty_s + read.uncertainty_s) {
    clock_ = read;
  }
  facts_.clock_offset_s = clock_ ? clock_->offset_s - local_offset_s() : 0;
  facts_.clock_uncertainty_s = clock_ ? clock_->uncertainty_s : std::numeric_limits<double>::infinity();
}

Result<void> CameraLink::start_worker() {
  if (worker_) return {};
  Environment environment = options_.environment;
  environment.emplace_back("HOME", options_.state.string());
  // malloc is to keep what one photograph took for the next: giving 64 MB back and taking them again costs
  // 14 000 page faults a shot.
  environment.emplace_back("GLIBC_TUNABLES", "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=536870912");
  auto started = WorkerProcess::start(options_.worker, environment, options_.state / "weft-camera.log");
  if (!started) return std::move(started).error();
  worker_ = std::move(*started);
  return {};
}

void CameraLink::end_worker() {
  ready_ = false;
  if (worker_) worker_->end(Steady::now() + seconds(kEndS));
  worker_.reset();
}

/// Sends a request and waits for its answer. A worker that has ended or does not answer is not kept.
Result<Json> CameraLink::request(Json asked, double most_s, const OnEvent& on_event) {
  asked["id"] = ++id_;
  auto deadline = Steady::now() + seconds(most_s);
  const Result<void> sent = worker_->send(asked.dump(-1, ' ', false, Json::error_handler_t::replace));
  Result<Json> answer = sent ? answer_of(deadline, on_event) : Result<Json>(sent.error());
  if (answer) {
    const auto error = answer->find("error");
    if (error == answer->end()) return (*answer)["ok"];
    answer = error_of_json(*error, "weft-camera");
  } else {
    worker_.reset();
  }
  const ErrorKind kind = answer.error().kind;
  if (kind != ErrorKind::kBadData && kind != ErrorKind::kInputOutput && kind != ErrorKind::kCannotCreate)
    ready_ = false;
  return answer;
}

Result<Json> CameraLink::answer_of(WorkerProcess::Deadline& deadline, const OnEvent& on_event) {
  for (;;) {
    const Result<std::string> line = worker_->read_line(deadline);
    if (!line) return line.error();
    Json answer = Json::parse(*line, nullptr, false);
    if (!answer.is_object() || answer.value("id", Json()) != Json(id_)) return wrong_line(*line);
    if (answer.contains("ok") || answer.contains("error")) return answer;
    if (!answer.contains("event")) return wrong_line(*line);
    on_event(deadline);
  }
}

}  // namespace weft::capture
