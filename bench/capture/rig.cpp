// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/capture_studies.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "bench/capture/process_size.h"
#include "calibration/checks/rig_movement.h"
#include "capture/board/led_board.h"
#include "capture/camera/camera_link.h"
#include "capture/camera/worker_lines.h"
#include "capture/camera/worker_process.h"
#include "capture/raw/decode_raw.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "capture/scan/scan.h"
#include "core/base/files.h"
#include "core/base/job_context.h"
#include "core/base/sha256.h"
#include "core/base/statistics.h"
#include "core/base/temporary_folder.h"
#include "core/describe/error_json.h"
#include "core/rig/calibration.h"
#include "simulator/scene/resolution.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"
#include "virtual_rig/rig_process.h"

namespace weft::bench {

/// One row: commands sent, lost, their median, 99th percentile and greatest time in ms, and what the board
/// itself counts as bad frames and overruns. Lights every LED in turn. Errors: those of LedBoard::open().
Result<Rows> capture_board_table(const StudyOptions& options) {
  const Result<capture::Rig> rig = capture::read_rig(options.rig);
  if (!rig) return rig.error();
  auto board = capture::LedBoard::open({rig->board.port});
  if (!board) return std::move(board).error();
  const auto before = (*board)->status();
  if (!before) return before.error();

  std::vector<double> times_ms;
  for (int i = 0; i < options.runs; ++i) {
    const int led = 1 + i % (*board)->leds();
    const auto begin = std::chrono::steady_clock::now();
    const auto lit = (*board)->light({&led, 1}, 1);
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (lit && *lit == 0) times_ms.push_back(time_ms.count());
  }
  static_cast<void>((*board)->light({}, 0));
  const auto after = (*board)->status();
  if (!after) return after.error();

  const Json row = {{"commands", options.runs},
                    {"lost", options.runs - static_cast<int>(times_ms.size())},
                    {"median_ms", lower_quantile(times_ms, 0.5)},
                    {"p99_ms", lower_quantile(times_ms, 0.99)},
                    {"most_ms", lower_quantile(times_ms, 1)},
                    {"bad_frames", after->bad_frames - before->bad_frames},
                    {"overruns", after->overruns - before->overruns}};
  return Rows{row};
}

namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr double kBar = 1.15;
constexpr int kRounds = 3;
constexpr auto kPatience = std::chrono::seconds(10);

/// A camera that photographs so often at one exposure.
struct ShotLoop {
  std::string port;  ///< of a running camera: "ptpip:127.0.0.1:15740:15740"
  std::string profile;
  int shots = 0;
  capture::ExposureSettings exposure;
};

Result<Json> ask(capture::WorkerProcess& worker, const Json& request, steady_clock::duration patience) {
  if (Result<void> sent = worker.send(request.dump()); !sent) return std::move(sent).error();
  const auto by = steady_clock::now() + patience;
  for (;;) {  // an answer stands behind lines of what the program does meanwhile
    const Result<std::string> line = worker.read_line(by);
    if (!line) return line.error();
    const Json answer = Json::parse(*line, nullptr, false);
    if (!answer.is_object()) return error_of_json(answer, "weft-camera");
    if (answer.contains("ok")) return answer["ok"];
    if (answer.contains("error")) return error_of_json(answer["error"], "weft-camera");
  }
}

Result<void> add_bare(const ShotLoop& loop, const fs::path& home, std::vector<double>& seconds) {
  const auto worker =
      capture::WorkerProcess::start(capture::weft_camera_program(), {{"HOME", home.string()}});
  if (!worker) return worker.error();
  const Json open = {
      {"id", 1}, {"do", "open"}, {"profile", loop.profile}, {"port", loop.port}, {"serial", ""}};
  if (const auto opened = ask(**worker, open, kPatience); !opened) return opened.error();
  const Json set = {{"id", 2}, {"do", "set"}, {"exposure", capture::line_of(loop.exposure)}};
  if (const auto done = ask(**worker, set, kPatience); !done) return done.error();
  const Json bare = {{"id", 3}, {"do", "bare"}, {"shots", loop.shots}};
  const Result<Json> taken = ask(**worker, bare, loop.shots * kPatience);
  if (!taken) return taken.error();
  for (const Json& each : (*taken)["seconds"]) seconds.push_back(each.get<double>());
  (*worker)->end(steady_clock::now() + std::chrono::seconds(1));
  return {};
}

Result<void> add_ours(const ShotLoop& loop, const fs::path& home, std::vector<double>& seconds) {
  capture::CameraLinkOptions link_options;
  link_options.port = loop.port;
  link_options.profile = loop.profile;
  link_options.state = home;
  const auto link = capture::CameraLink::make(std::move(link_options));
  if (!link) return link.error();
  if (const auto facts = (*link)->connect(); !facts) return facts.error();
  if (const auto facts = (*link)->set(loop.exposure); !facts) return facts.error();
  for (int shot = 0; shot < loop.shots; ++shot) {
    const auto begin = steady_clock::now();
    const auto taken = (*link)->take(home / ("shot" + std::to_string(shot)), [] {});
    if (!taken) return taken.error();
    seconds.push_back(std::chrono::duration<double>(steady_clock::now() - begin).count());
    std::error_code ignored;
    fs::remove(taken->file, ignored);
  }
  return {};
}

/// Seconds of each turn of a bare loop of trigger, wait_for_event and file_get.
Result<std::vector<double>> bare_shots_s(const ShotLoop& loop) {
  const TemporaryFolder scratch;
  std::vector<double> seconds;
  if (Result<void> ok = add_bare(loop, scratch.path(), seconds); !ok) return std::move(ok).error();
  return seconds;
}

}  // namespace

/// What a photograph through CameraLink costs, in its file, synced, summed up and proved to be the one asked
/// for, against a bare loop of trigger, wait_for_event and file_get through the same libgphoto2 and camera.
/// The loops take turns. Medians over all shots: `seconds` a shot, `ratio` to the bare loop; `bar` is what is
/// asked for.
Result<Rows> capture_camera_table(const StudyOptions& options) {
  const Result<capture::Rig> rig = capture::read_rig(options.rig);
  if (!rig) return rig.error();
  const ShotLoop loop = {rig->camera.port, rig->camera.profile, options.runs, {1e6 / 60, 100, 8}};
  const TemporaryFolder scratch;
  std::vector<double> bare, ours;
  for (int round = 0; round < kRounds; ++round) {
    if (Result<void> ok = add_bare(loop, scratch.path(), bare); !ok) return std::move(ok).error();
    if (Result<void> ok = add_ours(loop, scratch.path(), ours); !ok) return std::move(ok).error();
  }
  const double yardstick = median(bare);
  return Rows{
      {{"loop", "bare"}, {"shots", bare.size()}, {"seconds", yardstick}, {"ratio", 1.0}, {"bar", kBar}},
      {{"loop", "weft"},
       {"shots", ours.size()},
       {"seconds", median(ours)},
       {"ratio", median(ours) / yardstick},
       {"bar", kBar}}};
}

namespace {

constexpr double kLooks_s = 3, kExposure_us = 20000;
constexpr double kAskedFirst_s = 1.5, kAskedRate = 10;

double since_s(steady_clock::time_point began) {
  return std::chrono::duration<double>(steady_clock::now() - began).count();
}

class Finder {
 public:
  Finder(int rounds, capture::RigDevices devices) : rounds_(rounds), devices_(std::move(devices)) {}

  Result<Rows> table() {
    if (const auto facts = devices_.camera->connect(); !facts) return facts.error();
    for (int round = 0; round < rounds_; ++round) {
      if (Result<void> ok = look(); !ok) return ok.error();
      if (Result<void> ok = photograph(after_live_s_); !ok) return ok.error();
      if (Result<void> ok = photograph(plain_s_); !ok) return ok.error();
    }
    return Rows{{{"what", "first picture, s"}, {"reached", worst_first_s_}, {"asked", kAskedFirst_s}},
                {{"what", "pictures a second"}, {"reached", pictures_ / looked_s_}, {"asked", kAskedRate}},
                {{"what", "photograph after live view, s"}, {"reached", median(after_live_s_)}},
                {{"what", "photograph, s"}, {"reached", median(plain_s_)}}};
  }

 private:
  Result<void> look() {
    const auto asked = steady_clock::now();
    if (const auto first = devices_.camera->look(); !first) return first.error();
    worst_first_s_ = std::max(worst_first_s_, since_s(asked));
    const auto began = steady_clock::now();
    for (; since_s(began) < kLooks_s; ++pictures_) {
      if (const auto picture = devices_.camera->look(); !picture) return picture.error();
    }
    looked_s_ += since_s(began);
    return {};
  }

  Result<void> photograph(std::vector<double>& seconds) {
    const auto began = steady_clock::now();
    if (const auto set = devices_.camera->set({kExposure_us, 100, 8}); !set) return set.error();
    const auto taken = devices_.camera->take(scratch_.path() / "shot", [] {});
    if (!taken) return taken.error();
    seconds.push_back(since_s(began));
    std::error_code ignored;
    std::filesystem::remove(taken->file, ignored);
    return {};
  }

  const int rounds_;
  capture::RigDevices devices_;
  const TemporaryFolder scratch_;
  double worst_first_s_ = 0, pictures_ = 0, looked_s_ = 0;
  std::vector<double> after_live_s_, plain_s_;
};

}  // namespace

/// How soon and how often a camera's finder shows something through CameraLink, and that a photograph between
/// two rounds costs what it costs without. Rows: "first picture" (seconds, the longest of the rounds),
/// "pictures"
/// ("a_second", over all rounds), "photograph after live view" and "photograph" (seconds, medians); "asked"
/// is what is asked for.
Result<Rows> capture_live_view_table(const StudyOptions& options) {
  const Result<capture::Rig> rig = capture::read_rig(options.rig);
  if (!rig) return rig.error();
  Result<capture::RigDevices> devices = capture::open_devices(*rig);
  if (!devices) return std::move(devices).error();
  return Finder(options.runs, std::move(*devices)).table();
}

namespace {

constexpr int kRows = 10, kTurns = 13;

/// What frames show, whatever their times and numbers.
using Digests = std::map<std::string, std::string>;

Result<Digests> digests_of(const Session& session) {
  Digests digests;
  for (const Shot& shot : session.shots) {
    const Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
    if (!frame) return frame.error();
    const View<const std::uint16_t> counts = frame->counts.plane();
    std::string bytes;
    for (int y = 0; y < counts.size().height; ++y) {
      bytes.append(reinterpret_cast<const char*>(counts.row(y)),
                   static_cast<std::size_t>(counts.size().width) * sizeof(std::uint16_t));
    }
    digests[shot.file] = sha256_of(bytes);
  }
  return digests;
}

struct OneScan {
  double seconds = 0;
  std::size_t frames = 0;
  Digests digests;
  ProcessSize camera;  ///< weft-camera at its end
};

/// Seconds of a turn of the bare loop, in the mean.
Result<double> bare_s(const capture::Rig& rig) {
  const Result<std::vector<double>> turns =
      bare_shots_s({rig.camera.port, rig.camera.profile, kTurns, {kExposure_us, 100, 8}});
  if (!turns) return turns.error();
  return std::accumulate(turns->begin(), turns->end(), 0.0) / kTurns;
}

Result<OneScan> scan_once(const capture::Rig& rig, const std::stop_token& stop, const fs::path& folder) {
  Stopwatch watch;
  Result<capture::RigDevices> devices = capture::open_devices(rig);
  if (!devices) return std::move(devices).error();
  capture::ScanRequest request;
  request.session = folder;
  request.fabric = "bench";
  request.rig = rig.name;
  request.calibration = rig.scan.calibration;
  request.exposure = {kExposure_us, rig.scan.iso, rig.scan.f_number};
  const Result<capture::ScanOutcome> outcome =
      capture::scan(request, *devices->lamps, *devices->camera, {}, {.cancel = stop, .pause = nullptr});
  if (!outcome) return outcome.error();
  OneScan one;
  one.seconds = watch.lap();
  one.frames = outcome->session.shots.size();
  if (const auto worker = child_of(::getpid(), "weft-camera"))
    one.camera = size_of(*worker).value_or(ProcessSize{});
  Result<Digests> digests = digests_of(outcome->session);
  if (!digests) return std::move(digests).error();
  one.digests = std::move(*digests);
  return one;
}

}  // namespace

/// Scans the same cloth again and again, each time with the devices opened anew, looks whether every frame
/// shows what it showed in the first scan (so the rig's noise must depend on the light alone), and removes
/// the session. Rows, at about ten points along the way: scans, seconds a scan (least, median) and the median
/// over as many turns of a bare loop as a scan has frames, measured before; memory and open descriptors of
/// this process and of weft-camera; frames that differ.
Result<Rows> capture_scans_table(const StudyOptions& options) {
  const Result<capture::Rig> rig = capture::read_rig(options.rig);
  if (!rig) return rig.error();
  const TemporaryFolder scratch;
  const Result<double> bare = bare_s(*rig);
  if (!bare) return bare.error();
  Rows rows;
  Digests first;
  std::vector<double> seconds;
  int differ = 0;
  for (int i = 1; i <= options.runs; ++i) {
    const fs::path session = scratch.path() / "scan.weft";
    const Result<OneScan> one = scan_once(*rig, options.stop, session);
    if (!one) return one.error();
    if (i == 1) first = one->digests;
    for (const auto& [file, digest] : one->digests) differ += first[file] == digest ? 0 : 1;
    seconds.push_back(one->seconds);
    std::error_code failed;
    fs::remove_all(session, failed);
    if (failed) return cannot_write(session, failed.value());
    options.progress(i, options.runs);
    if (i != 1 && i != options.runs && i % std::max(1, options.runs / kRows) != 0) continue;
    const double middle = median(seconds);
    const ProcessSize size = size_of(::getpid()).value_or(ProcessSize{});
    rows.push_back({{"scans", i},
                    {"frames", one->frames},
                    {"least_s", *std::ranges::min_element(seconds)},
                    {"median_s", middle},
                    {"over_bare_loop", middle / (*bare * static_cast<double>(one->frames))},
                    {"resident_mb", static_cast<double>(size.resident_bytes) / 1e6},
                    {"descriptors", size.descriptors},
                    {"camera_resident_mb", static_cast<double>(one->camera.resident_bytes) / 1e6},
                    {"camera_descriptors", one->camera.descriptors},
                    {"frames_that_differ", differ}});
  }
  return rows;
}

namespace {

constexpr double kPatience_s = 300;
constexpr double kLaying_s = 20;  // that a person takes to lay a thing on the table

/// A thing that is laid, and the row that follows from its photograph; none: the next thing follows.
struct Step {
  const char* lays;
  const char* after = nullptr;
  const char* result = nullptr;  ///< of the walk; null: lights by the sheets there are
  bool is_enough = false;        ///< of this part's photographs
};

const std::vector<Step>& steps() {
  static const std::vector<Step> kSteps = {
      {"board"},
      {"board tilt=40 azimuth=225 x=17 y=-14 height=57"},
      {"board tilt=40 azimuth=0 x=20 y=11 height=57"},
      {"board tilt=40 azimuth=180 x=-20 y=11 height=57"},
      {"board tilt=40 azimuth=45 x=-18 y=-14 height=57"},
      {"board tilt=15 azimuth=135 x=-25 y=-19 height=57", "the board in six poses", "camera", true},
      {"sheet"},
      {"empty", "pairs of photographs, lit and dark", "response"},
      {"sheet", "one sheet"},
      {"sheet tilt=20 azimuth=0", "two sheets"},
      {"sheet tilt=20 azimuth=180", "three sheets"},
      {"sheet tilt=20 azimuth=90", "four sheets"},
      {"sheet tilt=20 azimuth=270", "five sheets", "lights"}};
  return kSteps;
}

class RigMinutes {
 public:
  explicit RigMinutes(const StudyOptions& options) : options_(options) {}

  Result<Rows> table() {
    if (Result<void> ok = begin(); !ok) return std::move(ok).error();
    if (Result<void> ok = add_row("a tape and data sheets", rig_->folder() / "calibration"); !ok)
      return std::move(ok).error();
    int done = 0, sheets = 0;
    for (const Step& step : steps()) {
      if (Result<void> ok = take(step, ++sheets); !ok) return std::move(ok).error();
      options_.progress(++done, static_cast<int>(steps().size()));
    }
    return std::move(rows_);
  }

 private:
  Result<void> begin() {
    auto rig = virtual_rig::RigProcess::start({.programs = options_.programs,
                                               .scene = scene_,
                                               .folder = scratch_.path() / "rig",
                                               .megapixels = options_.megapixels,
                                               .is_bare = true});
    if (!rig) return std::move(rig).error();
    rig_ = std::move(*rig);
    Result<simulator::Scene> scene = simulator::read_scene(scene_);
    if (!scene) return scene.error();
    simulator::resize(scene->camera, options_.megapixels);
    const Result<simulator::SceneRig> exact = simulator::rig_of(*scene);
    if (!exact) return exact.error();
    exact_ = simulator::exact_calibration(*scene, *exact);
    return {};
  }

  /// Lays a thing, has it photographed, and tells what came of it.
  Result<void> take(const Step& step, int number) {
    if (const auto laid = rig_->say(std::string("table ") + step.lays); !laid) return laid.error();
    laid_s_ += kLaying_s;
    const auto began = steady_clock::now();
    if (Result<void> ok = walk({}); !ok) return ok;
    if (step.is_enough) {
      if (Result<void> ok = walk({"--enough"}); !ok) return ok;
    }
    weft_s_ += std::chrono::duration<double>(steady_clock::now() - began).count();
    if (step.after == nullptr) return {};
    const fs::path calibrations = rig_->folder() / "calibrations";
    if (step.result != nullptr)
      return add_row(step.after, calibrations / (std::string("minutes-") + step.result));
    const fs::path partial = scratch_.path() / fmt::format("sheets{}", number);
    const Result<void> fitted =
        weft({"calibrate", "lights", (rig_->folder() / "sets/minutes-sheet").string(), "--from",
              (calibrations / "minutes-response").string(), "-o", partial.string(), "--accept-misfit"});
    return fitted ? add_row(step.after, partial) : fitted;
  }

  Result<void> walk(const std::vector<std::string>& more) const {
    const fs::path targets = rig_->folder() / "targets";
    std::vector<std::string> arguments = {"calibrate", "all",
                                          "--name",    "minutes",
                                          "--board",   (targets / "board.toml").string(),
                                          "--sheet",   (targets / "sheet.toml").string(),
                                          "--once"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return weft(arguments);
  }

  Result<void> weft(const std::vector<std::string>& arguments) const {
    const auto process = rig_->weft(arguments, "minutes.log");
    if (!process) return process.error();
    const auto code = (*process)->wait(kPatience_s);
    if (code == 0) return {};
    return Error{ErrorKind::kTryAgain, "weft ended in a way that it should not",
                 fmt::format("{}", arguments[1]), (*process)->said(), "mend that first"};
  }

  Result<void> add_row(const char* after, const fs::path& folder) {
    const Result<Calibration> measured = read_calibration(folder);
    if (!measured) return measured.error();
    if (measured->lights) lights_ = std::get<NearLights>(*measured->lights);
    const auto status = rig_->say("status");
    if (!status) return status.error();
    const calibration::MovementCost cost = calibration::cost_of(*measured->camera, lights_, *exact_.camera,
                                                                std::get<NearLights>(*exact_.lights));
    rows_.push_back({{"after", after},
                     {"photographs", Json::parse(*status).value("shots", 0)},
                     {"minutes", (weft_s_ + laid_s_) / 60},
                     {"mean_deg", cost.mean_deg},
                     {"worst_deg", cost.worst_deg},
                     {"albedo", cost.albedo_factor}});
    return {};
  }

  const StudyOptions& options_;
  const fs::path scene_ = options_.scenes / "rig.toml";
  const TemporaryFolder scratch_;
  std::unique_ptr<virtual_rig::RigProcess> rig_;
  Calibration exact_;
  NearLights lights_;  ///< as far as they are known
  double weft_s_ = 0, laid_s_ = 0;
  Rows rows_;
};

}  // namespace

/// What each further minute at a rig takes away of the error of its normals: a rig that nobody has calibrated
/// is led through `weft calibrate all` by its own virtual camera. A row a step: "after", "photographs" until
/// then, "minutes" (the commands' wall time and laying_s for each thing laid), "mean_deg" and "worst_deg" of
/// normals level and 20 degrees steep over the frame against the exact rig (calibration::cost_of()), "albedo"
/// over the true one. After fewer than five sheets lights are fitted to those there are, beside the walk;
/// that time does not count. Errors: those of the rig's start and of the commands.
Result<Rows> capture_minutes_table(const StudyOptions& options) {
  return RigMinutes(options).table();
}

}  // namespace weft::bench
