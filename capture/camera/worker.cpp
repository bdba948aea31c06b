// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/worker.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "capture/camera/camera_profile.h"
#include "capture/camera/camera_setup.h"
#include "capture/camera/gphoto_camera.h"
#include "capture/camera/worker_lines.h"
#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/base/sha256.h"
#include "core/describe/error_json.h"

namespace weft::capture {
namespace {

/// The lines that arrive on a descriptor, read by a thread of its own, so that the end of the parent is
/// noticed while a call into libgphoto2 blocks. (PR_SET_PDEATHSIG would follow the thread that started this
/// process, not the parent.)
class RequestLines {
 public:
  explicit RequestLines(int in);
  /// Within 3 s of the end of the input: the process ends otherwise.
  ~RequestLines();
  RequestLines(const RequestLines&) = delete;
  RequestLines& operator=(const RequestLines&) = delete;

  /// Waits for the next line; nothing at the end. A line that is too long comes as an empty one.
  std::optional<std::string> next();
  /// Whether the input has ended.
  bool ended() const;

 private:
  void read_all(int in);
  void take(std::string_view bytes);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> lines_;
  std::string part_;
  bool too_long_ = false;
  bool ended_ = false;
  bool done_ = false;  // nobody asks any more
  std::thread thread_;
};

constexpr std::size_t kLongestLine = std::size_t{64} << 10;
constexpr auto kPatience = std::chrono::seconds(3);

RequestLines::RequestLines(int in) : thread_([this, in] { read_all(in); }) {}

RequestLines::~RequestLines() {
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::optional<std::string> RequestLines::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ended_ || !lines_.empty(); });
  // What the parent asked for and will not hear of any more is left undone.
  if (ended_) return {};
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

bool RequestLines::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void RequestLines::read_all(int in) {
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t n = ::read(in, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    take({block.data(), static_cast<std::size_t>(n)});
  }
  std::unique_lock lock(mutex_);
  ended_ = true;
  changed_.notify_all();
  if (!changed_.wait_for(lock, kPatience, [this] { return done_; })) ::_exit(1);
}

void RequestLines::take(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  for (const char c : bytes) {
    if (c == '\n') {
      lines_.push_back(too_long_ ? std::string() : std::move(part_));
      part_.clear();
      too_long_ = false;
    } else if (part_.size() == kLongestLine) {
      too_long_ = true;
    } else {
      part_ += c;
    }
  }
  changed_.notify_all();
}

using Steady = std::chrono::steady_clock;

double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

Error bad_request(const std::string& why) {
  return {ErrorKind::kUsage, "weft-camera was asked for nothing it knows", "", why, "see docs/protocol.md"};
}

class Worker {
 public:
  Worker(int in, int out) : requests_(in), out_(out) {}

  void serve() {
    while (const std::optional<std::string> line = requests_.next()) answer(*line);
    camera_.reset();
  }

 private:
  void answer(const std::string& line) {
    const Json request = Json::parse(line, nullptr, false);
    id_ = request.is_object() && request.contains("id") ? request["id"] : Json();
    const Result<Json> done = request.is_object() ? perform(request) : bad_request("the line is no object");
    if (done) {
      say("ok", *done);
      write_all(std::exchange(picture_, {}));
    } else {
      say("error", json_of(done.error()));
    }
  }

  Result<Json> perform(const Json& request) {
    JsonFields fields(request, "request");
    const std::string what = fields.text("do");
    if (Result<void> ok = fields.status(); !ok) return bad_request(ok.error().why);
    if (what == "open") return open(fields);
    if (what == "close") {
      camera_.reset();
      return Json::object();
    }
    const bool known = what == "set" || what == "shutters" || what == "take" || what == "bare" ||
                       what == "look" || what == "stop_looking";
    if (!known) return bad_request("\"do\" is \"" + what + "\"");
    if (!camera_) return bad_request("no camera is open");
    if (what == "look") return look();
    if (what == "shutters") return shutters();
    if (Result<void> ended = stop_looking(); !ended) return std::move(ended).error();
    if (what == "stop_looking") return Json::object();
    if (what == "set") return set(fields);
    return what == "take" ? take(fields) : bare(fields);
  }

  Result<Json> open(JsonFields& fields) {
    camera_.reset();
    prepared_.reset();
    is_looking_ = false;
    const std::string name = fields.text("profile");
    const WantedCamera wanted{fields.text("port"), fields.text("serial")};
    const bool watched = fields.has("watch_clock");
    if (Result<void> ok = fields.status(); !ok) return bad_request(ok.error().why);
    Result<CameraProfile> profile = read_camera_profile(name);
    if (!profile) return std::move(profile).error();
    profile_ = std::move(*profile);

    if (Result<void> loaded = GphotoCamera::load_drivers(); !loaded) return std::move(loaded).error();
    say("event", "asking");
    auto opened = open_camera(profile_, wanted);
    if (!opened) return std::move(opened).error();
    GphotoCamera& camera = **opened;
    const Result<std::string> serial = serial_of(camera, profile_);
    if (!serial) return serial.error();
    const Result<int> dropped = drop_old_photographs(camera);
    if (!dropped) return dropped.error();
    if (Result<void> right = check_body(camera, profile_); !right) return std::move(right).error();
    if (Result<void> locked = lock_settings(camera, profile_); !locked) return std::move(locked).error();
    const Result<double> battery = battery_of(camera, profile_);
    if (!battery) return battery.error();
    const Result<ExposureSettings> exposure = exposure_of(camera, profile_);
    if (!exposure) return exposure.error();
    const auto clock = read_clock(camera, profile_, watched);
    exposure_us_ = exposure->exposure_us;
    camera_ = std::move(*opened);
    return Json{{"model", profile_.model},
                {"serial", *serial},
                {"port", camera_->address().port},
                {"battery", *battery},
                {"exposure", line_of(*exposure)},
                {"clock", clock ? Json{{"offset_s", clock->offset_s}, {"uncertainty_s", clock->uncertainty_s}}
                                : Json()},
                {"dropped", *dropped}};
  }

  Result<Json> set(JsonFields& fields) {
    const Result<ExposureSettings> wanted = exposure_of_line(fields.object("exposure"));
    if (!wanted) return bad_request(wanted.error().why);
    const Result<ExposureSettings> exposure = set_exposure(*camera_, profile_, *wanted);
    if (!exposure) return exposure.error();
    exposure_us_ = exposure->exposure_us;
    const Result<double> battery = battery_of(*camera_, profile_);
    if (!battery) return battery.error();
    return Json{{"exposure", line_of(*exposure)}, {"battery", *battery}};
  }

  Result<Json> look() {
    if (!std::exchange(is_looking_, true)) {
      prepared_.reset();
      if (Result<void> quiet = drain(); !quiet) return std::move(quiet).error();
    }
    const Result<FetchedFile> picture = camera_->preview();
    if (!picture) return picture.error();
    const std::span<const std::uint8_t> bytes = picture->bytes();
    picture_.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return Json{{"bytes", bytes.size()}};
  }

  /// Live view warms the sensor that the dark shot is to measure, and a trigger would start it again.
  Result<void> stop_looking() {
    if (!std::exchange(is_looking_, false)) return {};
    prepared_.reset();
    if (Result<void> ended = camera_->end_live(); !ended) return ended;
    return drain();
  }

  Result<Json> shutters() {
    const auto times = shutter_times_us(*camera_, profile_);
    if (!times) return times.error();
    return Json{{"exposure_us", *times}};
  }

  Result<Json> take(JsonFields& fields) {
    const std::string file = fields.text("file");
    const double deadline_s = fields.number("deadline_s");
    if (Result<void> ok = fields.status(); !ok) return bad_request(ok.error().why);
    if (Result<void> ready = prepare(); !ready) return std::move(ready).error();

    const double triggered_s = seconds_since_1970();
    const auto triggered = Steady::now();
    if (Result<void> released = camera_->trigger(); !released) return std::move(released).error();
    const Result<CameraFileName> name = arrival(triggered, deadline_s);
    if (!name) return name.error();
    const double waited_s = seconds_since(triggered);
    const Result<FetchedFile> fetched = camera_->fetch(*name);
    if (!fetched) return fetched.error();
    // While the disk is at work, what would hold up the next shot.
    auto landing = std::async(std::launch::async, [&] { return land(file + ".arrived", fetched->bytes()); });
    put_in_order(*name);
    Result<Json> landed = landing.get();
    if (!landed) return landed;
    (*landed)["triggered_s"] = triggered_s;
    (*landed)["waited_s"] = waited_s;
    return landed;
  }

  void put_in_order(const CameraFileName& name) {
    camera_->forget(name);
    prepared_ = prepare_now();
    prepared_at_ = Steady::now();
  }

  /// Nobody has turned anything, and nothing is left of the shot before.
  Result<void> prepare() {
    const auto before = std::exchange(prepared_, std::nullopt);
    return before && seconds_since(prepared_at_) < kFreshS ? *before : prepare_now();
  }
  Result<void> prepare_now() {
    Result<void> quiet = drain();
    return quiet ? check_body(*camera_, profile_) : quiet;
  }

  /// Takes the events that are still there from the shot before, and drops what must not be taken for the
  /// next photograph.
  Result<void> drain() {
    for (int events = 0; events < 100; ++events) {
      const auto event = camera_->wait_for_event(1);
      if (!event) return event.error();
      if (event->quiet) return {};
      if (event->file) camera_->forget(*event->file);
    }
    return Error{ErrorKind::kProtocol, "the camera never stops reporting", camera_->address().port,
                 "100 events without a pause", "switch the camera off and on"};
  }

  /// Waits for the photograph, and says as soon as its shutter must have closed: at once where the trigger
  /// has waited for that, else when the photograph is there or its time is over, whichever comes first.
  Result<CameraFileName> arrival(Steady::time_point triggered, double deadline_s) {
    const bool has_closed = profile_.trigger == CameraProfile::Trigger::kBlocks;
    const double closed_s =
        seconds_since(triggered) + (has_closed ? 0 : kLongestShutterLagS + 1e-6 * exposure_us_);
    bool is_told = false;
    const auto tell = [&] {
      if (!std::exchange(is_told, true)) say("event", "exposed");
    };
    while (seconds_since(triggered) < deadline_s && !requests_.ended()) {
      if (seconds_since(triggered) >= closed_s) tell();
      const auto event = camera_->wait_for_event(kPollMs);
      if (!event) return event.error();
      if (!event->file) continue;
      tell();
      return *event->file;
    }
    Error none = {ErrorKind::kTryAgain, "no photograph came", camera_->address().port,
                  "the camera was busy or lost it", "take it again"};
    if (exposure_us_ > kLongExposureUs) {
      none.remedy =
          "switch the camera's noise reduction of long exposures off, which takes as long again, and take it "
          "again";
    }
    return none;
  }

  /// The bytes in a file, synced, while another thread sums them up.
  static Result<Json> land(const std::string& file, std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto sum = std::async(std::launch::async, [text] { return sha256_of(text); });
    const Result<void> written = write_file(file, text);
    const std::string sha256 = sum.get();
    if (!written) return written.error();
    return Json{{"file", file}, {"sha256", sha256}, {"bytes", bytes.size()}};
  }

  Result<Json> bare(JsonFields& fields) {
    const int shots = fields.integer("shots");
    if (Result<void> ok = fields.status(); !ok) return bad_request(ok.error().why);
    Json seconds = Json::array();
    for (int shot = 0; shot < shots && !requests_.ended(); ++shot) {
      const auto begin = Steady::now();
      if (Result<void> released = camera_->trigger(); !released) return std::move(released).error();
      std::optional<CameraFileName> name;
      while (!name && seconds_since(begin) < kBareDeadlineS) {
        auto event = camera_->wait_for_event(kBareWaitMs);
        if (!event) return std::move(event).error();
        name = std::move(event->file);
      }
      if (!name) return Error{ErrorKind::kTryAgain, "no photograph came", camera_->address().port, "", ""};
      if (const auto fetched = camera_->fetch(*name); !fetched) return fetched.error();
      seconds.push_back(seconds_since(begin));
      camera_->forget(*name);
    }
    return Json{{"seconds", seconds}};
  }

  void say(const char* key, const Json& value) {
    write_all(Json{{"id", id_}, {key, value}}.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n');
  }

  void write_all(const std::string& bytes) const {
    std::string_view rest = bytes;
    while (!rest.empty()) {
      const ssize_t n = ::write(out_, rest.data(), rest.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return;  // the parent is gone, which the end of the input tells as well
      rest.remove_prefix(static_cast<std::size_t>(n));
    }
  }

  static constexpr int kPollMs = 10;
  static constexpr double kLongExposureUs = 1e6;    // beyond, bodies reduce noise by a dark picture
  static constexpr double kLongestShutterLagS = 2;  // a mirror that is locked up first, a slow focal plane
  static constexpr double kFreshS = 1;
  static constexpr int kBareWaitMs = 200;
  static constexpr double kBareDeadlineS = 60;

  RequestLines requests_;
  int out_;
  Json id_;
  CameraProfile profile_;
  std::unique_ptr<GphotoCamera> camera_;
  bool is_looking_ = false;
  std::string picture_;                   // that follows the answer
  double exposure_us_ = 0;                // that the camera is set to
  std::optional<Result<void>> prepared_;  // how the next shot was prepared since
  Steady::time_point prepared_at_;
};

}  // namespace

void serve_camera(int in, int out) {
  Worker(in, out).serve();
}

}  // namespace weft::capture
