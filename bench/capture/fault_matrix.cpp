// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/fault_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <tuple>

#include "bench/capture/process_size.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/process.h"
#include "core/base/temporary_folder.h"
#include "core/rig/session.h"
#include "virtual_rig/rig_process.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr int kLeds = 10;
constexpr int kShots = kLeds + 2;  // the first once more, the dark one
constexpr int kFilmsEvery = 4;     // runs: one whose scan has the films' other state and the light below
constexpr double kScan_s = 90;     // a scan that takes longer hangs
constexpr double kUsual_s = 5;     // moments are drawn from this

/// What is done to a rig, and when.
enum class When { kAtShot, kAtMoment };
enum class What { kSay, kKillHost, kKillDaemon, kKillWorker, kKillRig };

struct Fault {
  const char* name;
  What what;
  When when;
  const char* say;         ///< to the rig; {shot}, {led}, {other} and {share} are drawn
  const char* mends = "";  ///< said to the rig after two seconds
  bool usb = false;        ///< the camera hangs on USB
};

// Faults of a shot choose the step themselves: before, in the exposure, in the transfer. What comes at a
// moment comes at any step, and while a frame is checked and kept.
constexpr std::array kFaults = {
    Fault{"camera link breaks in the exposure", What::kSay, When::kAtShot, "camera drop_in_exposure {shot}"},
    Fault{"camera link breaks before the picture", What::kSay, When::kAtShot,
          "camera drop_before_object {shot}"},
    Fault{"camera link breaks in the transfer", What::kSay, When::kAtShot, "camera drop_in_data {shot}"},
    Fault{"an old shot comes after a reconnect", What::kSay, When::kAtShot, "camera old_shot {shot}"},
    Fault{"camera does not answer", What::kSay, When::kAtShot, "camera no_answer {shot}"},
    Fault{"transfer stalls", What::kSay, When::kAtShot, "camera data_stalls {shot}"},
    Fault{"transfer ends early", What::kSay, When::kAtShot, "camera data_ends_early {shot}"},
    Fault{"camera busy for a second", What::kSay, When::kAtShot, "camera capture_busy {shot}"},
    Fault{"camera busy for ever", What::kSay, When::kAtShot, "camera busy_for_ever {shot}"},
    Fault{"picture is never announced", What::kSay, When::kAtShot, "camera no_object {shot}"},
    Fault{"picture's size is a lie", What::kSay, When::kAtShot, "camera object_size_lie {shot}"},
    Fault{"file is cut short", What::kSay, When::kAtShot, "camera short_data {shot}"},
    Fault{"capture is never complete", What::kSay, When::kAtShot, "camera no_capture_complete {shot}"},
    Fault{"noise of events", What::kSay, When::kAtShot, "camera property_noise {shot}"},
    Fault{"event of an unknown property", What::kSay, When::kAtShot, "camera unsupported_property {shot}"},
    Fault{"file comes late", What::kSay, When::kAtShot, "camera file_late {shot}"},
    Fault{"frame comes twice", What::kSay, When::kAtShot, "camera duplicate_frame {shot}"},
    Fault{"camera off and on", What::kSay, When::kAtShot, "camera power_cycle {shot}"},
    Fault{"camera off in the exposure", What::kSay, When::kAtShot, "camera power_off {shot}",
          "camera power_on"},
    Fault{"camera off in the transfer", What::kSay, When::kAtShot, "camera power_off_in_data {shot}",
          "camera power_on"},
    Fault{"camera off between exposures", What::kSay, When::kAtMoment, "camera power_off_now",
          "camera power_on"},
    Fault{"camera turns the host away", What::kSay, When::kAtShot, "camera init_fail"},
    Fault{"camera opens no session", What::kSay, When::kAtShot, "camera open_session_silent"},
    Fault{"camera's port is closed for a while", What::kSay, When::kAtShot, "camera refused"},
    Fault{"USB cable pulled in the exposure", What::kSay, When::kAtShot, "camera usb_unplug {shot}",
          "camera usb_replug", true},
    Fault{"USB cable pulled in the transfer", What::kSay, When::kAtShot, "camera usb_unplug_in_data {shot}",
          "camera usb_replug", true},
    Fault{"USB cable pulled between exposures", What::kSay, When::kAtMoment, "camera usb_unplug_now",
          "camera usb_replug", true},
    Fault{"USB cable out and in", What::kSay, When::kAtMoment, "camera usb_replug", "", true},
    Fault{"USB transfer times out", What::kSay, When::kAtShot, "camera usb_timeout {shot}", "", true},
    Fault{"another program has the USB camera", What::kSay, When::kAtShot, "camera usb_claimed", "", true},
    Fault{"USB session left open by a kill", What::kSay, When::kAtShot, "camera usb_stale_session", "", true},
    Fault{"dial turned", What::kSay, When::kAtMoment, "camera dial_turned"},
    Fault{"battery falls", What::kSay, When::kAtMoment, "camera battery_low"},
    Fault{"exposure changed by hand", What::kSay, When::kAtMoment, "camera exposure_changed"},
    Fault{"camera's clock set back", What::kSay, When::kAtMoment, "camera clock_back"},
    Fault{"camera's clock set ahead", What::kSay, When::kAtMoment, "camera clock_ahead"},
    Fault{"camera's clock begins anew", What::kSay, When::kAtMoment, "camera clock_reset"},
    Fault{"raw switched off", What::kSay, When::kAtMoment, "camera raw_off"},
    Fault{"auto ISO switched on", What::kSay, When::kAtMoment, "camera auto_iso"},
    Fault{"board unplugged and plugged in", What::kSay, When::kAtMoment, "board unplug", "board replug"},
    Fault{"board reset", What::kSay, When::kAtMoment, "board reset"},
    Fault{"board's firmware hangs", What::kSay, When::kAtMoment, "board hang"},
    Fault{"garbage on the line", What::kSay, When::kAtMoment, "board garbage"},
    Fault{"board hears nothing for a while", What::kSay, When::kAtMoment, "board deaf", "board hear"},
    Fault{"board is slow", What::kSay, When::kAtMoment, "board slow", "board hear"},
    Fault{"wrong baud rate for a while", What::kSay, When::kAtMoment, "board wrong_baud", "board hear"},
    Fault{"LED dies", What::kSay, When::kAtMoment, "light dead {led}"},
    Fault{"LED stays lit", What::kSay, When::kAtMoment, "light stuck {led}"},
    Fault{"wires swapped", What::kSay, When::kAtMoment, "light swap {led} {other}"},
    Fault{"room light goes on", What::kSay, When::kAtMoment, "light ambient {share:.2f}"},
    Fault{"disk is full", What::kSay, When::kAtMoment, "disk full"},
    Fault{"weft is killed", What::kKillHost, When::kAtMoment, ""},
    Fault{"weft serve is killed", What::kKillDaemon, When::kAtMoment, ""},
    Fault{"weft-camera is killed", What::kKillWorker, When::kAtMoment, ""},
    Fault{"power cut of camera and board", What::kKillRig, When::kAtMoment, ""},
};

const Fault* fault_named(const std::string& name) {
  const auto* const found =
      std::find_if(kFaults.begin(), kFaults.end(), [&](const Fault& f) { return f.name == name; });
  return found == kFaults.end() ? nullptr : found;
}

/// What each frame of an undisturbed scan shows, and what its session says but for times and numbers.
struct Frames {
  std::map<std::tuple<int, ShotRole, Polariser>, RawFrame> shown;
  std::string record;
};
/// What is asked for: an exposure, or that it is metered, or all that the rig can: films crossed and parallel
/// and the light below.
enum class Asked { kExposure, kMetered, kFilms };
using Truth = std::map<Asked, Frames>;

/// What two scans of one cloth have in common: everything but times, counts of shots, what follows from them,
/// and what was seen on the way, as by the meter.
Result<std::string> record_of(const Session& session) {
  Json exposure = session.document.value("exposure", Json::object());
  exposure.erase("meter");
  Json record = {{"rig", session.rig},
                 {"fabric", session.fabric},
                 {"cloth_height_mm", session.cloth_height_mm},
                 {"state", session.state},
                 {"plan", session.document.value("plan", Json())},
                 {"exposure", std::move(exposure)},
                 {"shots", Json::array()},
                 {"calibration", Json::object()}};
  for (const Shot& shot : session.shots) {
    record["shots"].push_back({shot.index, shot.led, static_cast<int>(shot.role), shot.file, shot.exposure_us,
                               shot.iso, shot.f_number});
  }
  std::error_code failed;
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(session.calibration_folder(), failed)) {
    if (!entry.is_regular_file()) continue;
    const Result<std::string> digest = sha256_of_file(entry.path());
    if (!digest) return digest.error();
    files[fs::relative(entry.path(), session.folder).string()] = *digest;
  }
  for (const auto& [file, digest] : files) record["calibration"][file] = digest;
  return record.dump();
}

Result<Frames> frames_of(const Session& session) {
  Frames frames;
  Result<std::string> record = record_of(session);
  if (!record) return std::move(record).error();
  frames.record = std::move(*record);
  for (const Shot& shot : session.shots) {
    Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
    if (!frame) return std::move(frame).error();
    frames.shown.insert_or_assign({shot.led, shot.role, shot.polariser}, std::move(*frame));
  }
  return frames;
}

bool same_counts(const RawFrame& a, const RawFrame& b) {
  const View<const std::uint16_t> x = a.counts.plane(), y = b.counts.plane();
  if (x.size() != y.size()) return false;
  for (int row = 0; row < x.size().height; ++row) {
    if (!std::equal(x.row(row), x.row(row) + x.size().width, y.row(row))) return false;
  }
  return true;
}

/// One run of the matrix.
struct Run {
  int number = 0;
  const Fault* fault = nullptr;
  int shot = 1;
  double moment_s = 0;
  Asked asked = Asked::kExposure;
  int led = 1, other_led = 2;
  double share = 0.2;

  std::string line() const {
    return fmt::format(fmt::runtime(fault->say), fmt::arg("shot", shot), fmt::arg("led", led),
                       fmt::arg("other", other_led), fmt::arg("share", share));
  }
};

std::vector<Run> runs_of(const FaultMatrixOptions& options) {
  std::vector<const Fault*> faults;
  for (const std::string& name : options.faults) {
    if (const Fault* fault = fault_named(name)) faults.push_back(fault);
  }
  if (options.faults.empty()) {
    for (const Fault& fault : kFaults) faults.push_back(&fault);
  }
  std::mt19937_64 random(options.seed);
  std::uniform_int_distribution<int> shot(1, kShots);
  std::uniform_real_distribution<double> moment(0.05, kUsual_s);
  std::bernoulli_distribution metered(0.5);
  std::uniform_int_distribution<int> led(1, kLeds), further(1, kLeds - 1);
  std::uniform_real_distribution<double> share(0.2, 1);
  std::vector<Run> runs;
  for (int i = 0; i < options.runs && !faults.empty(); ++i) {
    Run& run = runs.emplace_back();
    run.number = i;
    run.fault = faults[static_cast<std::size_t>(i) % faults.size()];
    run.shot = shot(random);
    run.moment_s = moment(random);
    run.asked = metered(random) ? Asked::kMetered : Asked::kExposure;
    run.led = led(random);
    run.other_led = 1 + (run.led - 1 + further(random)) % kLeds;
    run.share = share(random);
    if (i % kFilmsEvery != kFilmsEvery - 1) continue;
    run.asked = Asked::kFilms;
    run.shot += kShots;  // where these differ from the others
  }
  return runs;
}

/// One rig of the matrix, which takes run after run.
class Bench {
 public:
  Bench(const FaultMatrixOptions& options, fs::path folder) : options_(options), folder_(std::move(folder)) {}

  /// What scans without any fault show.
  Result<Truth> truth() {
    if (Result<void> ok = start(false); !ok) return std::move(ok).error();
    Truth truth;
    for (const Asked asked : {Asked::kExposure, Asked::kMetered, Asked::kFilms}) {
      const Result<Session> session = undisturbed(asked);
      if (!session) return session.error();
      Result<Frames> frames = frames_of(*session);
      if (!frames) return std::move(frames).error();
      truth[asked] = std::move(*frames);
    }
    return truth;
  }

  Result<void> run(Run run, const Truth& truths, FaultTally& tally) {
    if (Result<void> ok = start(run.fault->usb); !ok) return ok;
    const Frames& truth = truths.at(run.asked);
    const fs::path session = (*rig_)->folder() / "scans" / fmt::format("run{:04}.weft", run.number);
    ++tally.runs;
    Steady::time_point began = Steady::now();
    Result<std::optional<int>> code = disturbed(run, session);
    while (code && !has_befallen_) {  // the scan had ended before
      fs::remove_all(session);
      run.moment_s /= 2;
      began = Steady::now();
      code = disturbed(run, session);
    }
    if (!code) return code.error();
    tally.most_s = std::max(tally.most_s, std::chrono::duration<double>(Steady::now() - began).count());
    const std::size_t wrong_before = tally.wrong.size();
    judge_end(run, *code, tally);
    if (Result<void> ok = make_well(); !ok) return ok;
    bool ended_well = *code == 0;
    if (!ended_well) {
      const Result<bool> resumed = resume(run, session, tally);
      if (!resumed) return resumed.error();
      ended_well = *resumed;
    }
    const bool right = judge_session(run, session, truth, tally) && ended_well;
    if (right) ++(*code == 0 ? tally.complete : tally.resumed);
    clear(run, session, tally.wrong.size() > wrong_before);
    return {};
  }

 private:
  /// The rig with its camera on USB or on the network; the other one rests.
  Result<void> start(bool usb) {
    rig_ = &rigs_[usb ? 1 : 0];
    if (*rig_) return {};
    auto rig = virtual_rig::RigProcess::start({.programs = options_.programs,
                                               .scene = options_.scene,
                                               .folder = folder_ / (usb ? "usb" : "network"),
                                               .megapixels = options_.megapixels,
                                               .usb = usb,
                                               .has_more_outputs = true,
                                               .same_noise = true});
    if (!rig) return std::move(rig).error();
    *rig_ = std::move(*rig);
    return {};
  }

  Result<Session> undisturbed(Asked asked) {
    const fs::path session =
        (*rig_)->folder() / "scans" / fmt::format("truth{:d}.weft", static_cast<int>(asked));
    auto weft = scan(session, asked);
    if (!weft) return std::move(weft).error();
    const std::optional<int> code = (*weft)->wait(kScan_s);
    if (code == 0) return read_session(session);
    return Error{ErrorKind::kTryAgain, "an undisturbed scan fails", session.string(), (*weft)->said(),
                 "mend that first"};
  }

  Result<std::unique_ptr<ChildProcess>> scan(const fs::path& session, Asked asked) const {
    std::vector<std::string> command = {"scan", "-o", session.string(), "--fabric", "matrix", "--no-preview"};
    if (asked != Asked::kMetered) command.insert(command.end(), {"--exposure", "20000"});
    if (asked != Asked::kFilms) command.insert(command.end(), {"--polariser", "crossed", "--no-below"});
    return (*rig_)->weft(std::move(command), "scan.log");
  }

  static void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

  /// Exit code of the scan that the fault befalls; nothing where it had to be killed.
  Result<std::optional<int>> disturbed(const Run& run, const fs::path& session) {
    const Fault& fault = *run.fault;
    if (fault.when == When::kAtShot) {
      if (auto said = (*rig_)->say(run.line()); !said) return std::move(said).error();
    }
    if (fault.what == What::kKillDaemon) {
      if (Result<void> ok = serve(); !ok) return ok.error();
    }
    auto weft = scan(session, run.asked);
    if (!weft) return std::move(weft).error();
    has_befallen_ = fault.when == When::kAtShot || !(*weft)->wait(run.moment_s);
    if (fault.when == When::kAtMoment && has_befallen_) {
      if (Result<void> ok = befall(run, **weft); !ok) return ok.error();
    }
    if (*fault.mends != '\0' && !(*weft)->wait(2)) {
      if (auto said = (*rig_)->say(fault.mends); !said) return std::move(said).error();
    }
    const std::optional<int> code = (*weft)->wait(kScan_s);
    if (!code) (*weft)->signal(SIGKILL);
    (*weft)->wait(kScan_s);
    said_ = (*weft)->said();
    daemon_.reset();
    return code;
  }

  /// A daemon for the rig, which scans from here on.
  Result<void> serve() {
    auto daemon = (*rig_)->weft({"serve"}, "serve.log");
    if (!daemon) return std::move(daemon).error();
    daemon_ = std::move(*daemon);
    const Steady::time_point deadline = Steady::now() + std::chrono::seconds(10);
    while (daemon_->said().find("http://") == std::string::npos) {
      if (daemon_->wait(0.02) || Steady::now() > deadline)
        return Error{ErrorKind::kTryAgain, "weft serve does not start", folder_.string(), daemon_->said(),
                     "mend that first"};
    }
    return {};
  }

  Result<void> befall(const Run& run, const ChildProcess& weft) {
    switch (run.fault->what) {
      case What::kSay:
        if (auto said = (*rig_)->say(run.line()); !said) return std::move(said).error();
        return {};
      case What::kKillHost:
        weft.signal(SIGKILL);
        return {};
      case What::kKillDaemon:
        daemon_->signal(SIGKILL);
        return {};
      case What::kKillWorker:
        if (const std::optional<pid_t> worker = child_of(weft.pid(), "weft-camera")) ::kill(*worker, SIGKILL);
        return {};
      case What::kKillRig:
        // Its terminal's number may be given to another rig's board at once: no link may lead there.
        fs::remove((*rig_)->folder() / "board");
        ::kill((*rig_)->pid(), SIGKILL);
        rig_->reset();
        return start(run.fault->usb);
    }
    return {};
  }

  Result<void> make_well() {
    for (const char* line :
         {"board replug", "board hear", "light normal", "disk room", "camera power_on", "camera well"}) {
      if (auto said = (*rig_)->say(line); !said && said.error().kind != ErrorKind::kUsage)
        return std::move(said).error();
    }
    return {};
  }

  void judge_end(const Run& run, std::optional<int> code, FaultTally& tally) const {
    const bool killed = run.fault->what == What::kKillHost && code == 128 + SIGKILL;
    const bool has_sentence = code != 0 && said_.find("weft: ") != std::string::npos;
    if (code == 0 || killed || has_sentence) return;
    ++tally.silent;
    tally.wrong.push_back(fmt::format("run {}: {}: {}", run.number,
                                      code ? fmt::format("ended with {}", *code) : "did not end", said_));
  }

  /// Whether the same command finishes the scan.
  Result<bool> resume(const Run& run, const fs::path& session, FaultTally& tally) {
    auto weft = scan(session, run.asked);
    if (!weft) return std::move(weft).error();
    const std::optional<int> code = (*weft)->wait(kScan_s);
    if (code != 0) tally.wrong.push_back(fmt::format("run {}: not resumed: {}", run.number, (*weft)->said()));
    return code == 0;
  }

  /// Whether the session is complete and every frame right.
  static bool judge_session(const Run& run, const fs::path& folder, const Frames& truth, FaultTally& tally) {
    const Result<Session> session = read_session(folder);
    if (!session) {
      tally.lost += static_cast<int>(truth.shown.size());
      tally.wrong.push_back(fmt::format("run {}: {}", run.number, session.error().message()));
      return false;
    }
    const Result<std::string> record = record_of(*session);
    tally.differing += record && *record == truth.record ? 0 : 1;
    const int before = tally.lost + tally.mislabelled + tally.half_written;
    std::set<fs::path> named;
    std::set<std::tuple<int, ShotRole, Polariser>> seen;
    for (const Shot& shot : session->shots) {
      named.insert(session->path_of(shot));
      seen.insert({shot.led, shot.role, shot.polariser});
      judge_frame(run, *session, shot, truth, tally);
    }
    for (const auto& [what, frame] : truth.shown) tally.lost += seen.contains(what) ? 0 : 1;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "raw", ignored))
      tally.half_written += named.contains(entry.path()) ? 0 : 1;
    if (tally.lost + tally.mislabelled + tally.half_written == before && tally.differing == 0) return true;
    tally.wrong.push_back(fmt::format("run {} (shot {}, {:.2f} s): state {}, {} of {} frames", run.number,
                                      run.shot, run.moment_s, session->state, session->shots.size(),
                                      truth.shown.size()));
    return false;
  }

  static void judge_frame(const Run& run, const Session& session, const Shot& shot, const Frames& truth,
                          FaultTally& tally) {
    const fs::path file = session.path_of(shot);
    const Result<std::string> digest = sha256_of_file(file);
    const Result<RawFrame> frame = capture::decode_raw(file);
    if (!digest || *digest != shot.sha256 || !frame) {
      ++tally.half_written;
      tally.wrong.push_back(fmt::format("run {}: {} is not whole", run.number, shot.file));
      return;
    }
    const auto expected = truth.shown.find({shot.led, shot.role, shot.polariser});
    if (expected != truth.shown.end() && same_counts(*frame, expected->second)) return;
    ++tally.mislabelled;
    tally.wrong.push_back(fmt::format("run {} (shot {}, {:.2f} s): {} is not what LED {} shows", run.number,
                                      run.shot, run.moment_s, shot.file, shot.led));
  }

  void clear(const Run& run, const fs::path& session, bool wrong) const {
    std::error_code ignored;
    if (wrong && !options_.keep.empty()) {
      fs::create_directories(options_.keep, ignored);
      fs::copy(session, options_.keep / fmt::format("run{:04}.weft", run.number), fs::copy_options::recursive,
               ignored);
      fs::copy((*rig_)->folder() / "scan.log", options_.keep / fmt::format("run{:04}.log", run.number),
               ignored);
    }
    fs::remove_all(session, ignored);
  }

  const FaultMatrixOptions& options_;
  fs::path folder_;
  std::array<std::unique_ptr<virtual_rig::RigProcess>, 2> rigs_;  ///< made when first needed
  std::unique_ptr<virtual_rig::RigProcess>* rig_ = nullptr;       ///< the one that a run is at
  std::unique_ptr<ChildProcess> daemon_;
  std::string said_;
  bool has_befallen_ = false;
};

}  // namespace

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const Fault& fault : kFaults) names.emplace_back(fault.name);
  return names;
}

Result<std::vector<FaultTally>> fault_matrix(const FaultMatrixOptions& options) {
  const TemporaryFolder scratch;
  const std::vector<Run> runs = runs_of(options);
  Bench first(options, scratch.path() / "rig0");
  const Result<Truth> truth = first.truth();
  if (!truth) return truth.error();

  std::mutex mutex;
  std::map<std::string, FaultTally> tallies;
  std::optional<Error> failure;
  std::atomic<std::size_t> next = 0;
  int done = 0;
  const auto work = [&](Bench& bench) {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      FaultTally tally;
      const Result<void> ran = bench.run(runs[i], *truth, tally);
      const std::lock_guard lock(mutex);
      if (!ran) {
        failure = ran.error();
        next = runs.size();
        return;
      }
      FaultTally& sum = tallies[runs[i].fault->name];
      sum.fault = runs[i].fault->name;
      for (int FaultTally::*const count :
           {&FaultTally::runs, &FaultTally::complete, &FaultTally::resumed, &FaultTally::lost,
            &FaultTally::mislabelled, &FaultTally::half_written, &FaultTally::differing,
            &FaultTally::silent}) {
        sum.*count += tally.*count;
      }
      sum.most_s = std::max(sum.most_s, tally.most_s);
      sum.wrong.insert(sum.wrong.end(), tally.wrong.begin(), tally.wrong.end());
      options.progress(++done, static_cast<int>(runs.size()));
    }
  };
  std::vector<std::jthread> threads;
  for (int r = 1; r < options.rigs; ++r) {
    threads.emplace_back([&, r] {
      Bench bench(options, scratch.path() / fmt::format("rig{}", r));
      work(bench);
    });
  }
  work(first);
  threads.clear();
  if (failure) return *failure;
  std::vector<FaultTally> all;
  for (const Fault& fault : kFaults) {
    if (const auto found = tallies.find(fault.name); found != tallies.end()) all.push_back(found->second);
  }
  return all;
}

Rows rows_of(const std::vector<FaultTally>& tallies) {
  Rows rows;
  for (const FaultTally& t : tallies) {
    rows.push_back({{"fault", t.fault},
                    {"runs", t.runs},
                    {"complete", t.complete},
                    {"resumed", t.resumed},
                    {"lost", t.lost},
                    {"mislabelled", t.mislabelled},
                    {"half_written", t.half_written},
                    {"differing", t.differing},
                    {"silent", t.silent},
                    {"most_s", t.most_s}});
  }
  return rows;
}

}  // namespace weft::bench
