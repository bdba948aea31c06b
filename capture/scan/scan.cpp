// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/scan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <future>
#include <iterator>
#include <map>
#include <new>
#include <utility>

#include "capture/scan/frame_check.h"
#include "capture/scan/histogram.h"
#include "capture/scan/journal.h"
#include "capture/scan/light_evidence.h"
#include "capture/scan/meter.h"
#include "capture/scan/request_check.h"
#include "capture/scan/scan_plan.h"
#include "capture/scan/second_copy.h"
#include "capture/scan/shooter.h"
#include "core/rig/exposed.h"
#include "core/rig/exposure_words.h"
#include "core/rig/suits.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

constexpr int kTimesWrong = 2;                     // a shot whose light is wrong ends the scan
constexpr double kMostRoom = 1e6;                  // of a frame without any light
constexpr std::int64_t kUsualPixels = 16'500'000;  // of a camera that no calibration tells of

/// What became of a frame on its way into the session.
struct Kept {
  std::optional<Error> error;   ///< it is not in the session
  std::vector<int> take_again;  ///< these shots, if the error may pass
  bool was_light_right = true;  ///< of the shots until now, the one taken meanwhile among them
};

/// What the frames so far say of the next one. The thread of a frame on its way owns it.
struct FramesSoFar {
  std::optional<PatchLights> model;  ///< until the first frame has come
  std::optional<RawFrame> first;     ///< without its counts
  Size first_size;
  std::optional<ScanEvidence> evidence;  ///< once the first frame has come
  std::vector<std::string> warnings;
};

/// A frame at the end of its way.
struct Arrived {
  Kept kept;
  FramesSoFar so_far;
};

class Scan {
 public:
  Scan(const ScanRequest& request, Lamps& lamps, Camera& camera, const ScanEvents& events,
       const ScanControl& control, const ScanOptions& options)
      : request_(request),
        report_(events),
        shooter_(lamps, camera, request.polariser, control, options, report_),
        leds_of_board_(lamps.leds()),
        has_more_outputs_(lamps.has_more_outputs()) {}

  Result<ScanOutcome> run() {
    Result<void> done = steps();
    const Result<void> off = shooter_.lamps_off();
    if (!done && request_.again && journal_) journal_->forget_incoming();
    if (is_useless_ && frames_resumed_ == 0) {
      journal_.reset();
      std::error_code ignored;
      fs::remove_all(request_.session, ignored);
    }
    if (done && !off) warnings_.push_back("LEDs could not be switched off: " + off.error().message());
    if (!done) {
      const bool stopped = done.error().kind == ErrorKind::kInterrupted;
      report_.phase(stopped ? ScanPhase::kCancelled : ScanPhase::kFailed, done.error().message());
      return done.error();
    }
    report_.phase(ScanPhase::kComplete);
    return ScanOutcome{journal_->session(), frames_resumed_, shooter_.retaken() + frames_wrong_, warnings_};
  }

 private:
  Result<void> steps() {
    using Step = Result<void> (Scan::*)();
    for (const Step step : {&Scan::check_request, &Scan::connect, &Scan::open_session, &Scan::choose_exposure,
                            &Scan::look_at_kept, &Scan::photograph_missing, &Scan::finish}) {
      if (Result<void> ok = (this->*step)(); !ok) return ok;
    }
    return {};
  }

  Result<void> check_request() {
    if (!request_.calibration.empty()) {
      Result<Calibration> calibration = read_calibration(request_.calibration);
      if (!calibration) return calibration.error();
      calibration_ = std::move(*calibration);
    }
    Result<ShotList> list = checked_shots(request_, leds_of_board_, has_more_outputs_, calibration_);
    if (!list) return list.error();
    list_ = std::move(*list);
    report_.change([&](ScanStatus& status) { status.frames_planned = list_.count(); });
    const Result<int> missing =
        request_.again ? Result<int>(1) : Journal::check(request_, calibration_id(), list_);
    if (!missing) return missing.error();
    // What the frames will take is known well enough before the first one: 16 bits a photosite.
    const std::int64_t pixels =
        calibration_ && calibration_->camera ? calibration_->camera->size.pixels() : kUsualPixels;
    if (Result<void> room =
            check_room(request_, *missing, list_.count(), static_cast<std::uint64_t>(2 * pixels));
        !room)
      return room;
    return make_light_model();
  }

  Result<void> make_light_model() {
    if (!calibration_ || !calibration_->lights || !calibration_->camera) {
      warnings_.push_back(
          "there is no calibration of camera and lights: frames are not held against the LEDs");
      return {};
    }
    if (!request_.again && list_.leds.size() < kEnoughForPatterns) {
      warnings_.push_back(
          fmt::format("with {} LEDs nothing tells that two of them are exchanged: that takes {} or more",
                      list_.leds.size(), kEnoughForPatterns));
    }
    Result<PatchLights> model = PatchLights::make(*calibration_, request_.cloth_height_mm, request_.pose);
    if (!model) return model.error();
    so_far_.model = std::move(*model);
    return {};
  }

  std::string calibration_id() const { return calibration_ ? calibration_->id : ""; }

  Result<void> connect() {
    Result<CameraFacts> facts = shooter_.connect();
    if (!facts) return facts.error();
    if (calibration_) {
      if (Result<void> ok = check_calibration(request_, *facts, *calibration_); !ok) return ok;
    }
    shutter_travel_s_ = facts->shutter_travel_s;
    Result<std::vector<double>> times = shooter_.shutter_times_us();
    if (!times) return times.error();
    shutter_times_us_ = std::move(*times);
    return settle_times();
  }

  /// What is asked for in the camera's own times, before a session is made for it; 0: metered.
  Result<void> settle_times() {
    const auto settle = [this](double wanted_us, double& settled_us) -> Result<void> {
      if (wanted_us <= 0) return {};
      const Result<double> settable = settable_time_us(shutter_times_us_, wanted_us);
      if (!settable) return settable.error();
      settled_us = *settable;
      if (std::string words = nearest_time_words(wanted_us, *settable); !words.empty())
        warnings_.push_back(std::move(words));
      return {};
    };
    if (Result<void> ok = settle(request_.exposure.exposure_us, asked_us_); !ok) return ok;
    return list_.below ? settle(request_.below_us, below_asked_us_) : Result<void>();
  }

  Result<void> open_session() {
    Result<Journal> journal = request_.again ? Journal::reopen(request_, calibration_id())
                                             : Journal::open(request_, calibration_id(), list_);
    if (!journal) return journal.error();
    journal_.emplace(std::move(*journal));
    frames_resumed_ = static_cast<int>(journal_->session().shots.size());
    report_.change([&](ScanStatus& status) {
      status.frames = frames_resumed_;
      if (request_.again) status.frames_planned = frames_resumed_ + 1;
    });
    return {};
  }

  /// The exposure of the session's frames, else the one asked for, else a metered one. What was metered
  /// before any frame was kept may have been metered in the wrong light.
  Result<void> choose_exposure() {
    exposure_ = request_.exposure;
    const Session& session = journal_->session();
    if (session.document.contains("exposure") && !session.shots.empty())
      return take_up_exposure(session.document["exposure"]);
    if (request_.again) {
      return Error{ErrorKind::kBadData, "no shot of the session can be taken again",
                   request_.session.string(), "it does not say what the camera was set to",
                   "take again what weft scan took"};
    }
    Json record = {{"from", "request"}};
    if (asked_us_ > 0) {
      exposure_.exposure_us = asked_us_;
    } else {
      Result<Metering> metering = metered();
      if (!metering) return metering.error();
      exposure_.exposure_us = metering->exposure_us;
      warnings_.insert(warnings_.end(), metering->warnings.begin(), metering->warnings.end());
      record = {{"from", "meter"}, {"meter", to_json(*metering)}};
    }
    times_.bracket_us = nearest_time_us(shutter_times_us_, exposure_.exposure_us * list_.bracket.value_or(1));
    record.update(
        {{"exposure_us", exposure_.exposure_us}, {"iso", exposure_.iso}, {"f_number", exposure_.f_number}});
    if (list_.bracket) record["bracket_us"] = times_.bracket_us;
    if (list_.below) {
      const Result<double> below_us = time_of_light_below();
      if (!below_us) return below_us.error();
      record["below_us"] = times_.below_us = *below_us;
    }
    std::ranges::move(bracket_warnings(list_, exposure_.exposure_us, times_.bracket_us, calibration_),
                      std::back_inserter(warnings_));
    if (report_.phase() == ScanPhase::kMetering) report_.phase(ScanPhase::kExposing);
    report_.change([&](ScanStatus& status) { status.exposure_us = exposure_.exposure_us; });
    return journal_->set_exposure(record, shutter_travel_s_);
  }

  Result<void> take_up_exposure(const Json& record) {
    JsonFields fields(record, (request_.session / "session.json").string() + ": exposure");
    const ExposureSettings of_session = {fields.number("exposure_us"), fields.number("iso"),
                                         fields.number("f_number")};
    times_.bracket_us = fields.optional_number("bracket_us").value_or(of_session.exposure_us);
    times_.below_us = fields.optional_number("below_us").value_or(of_session.exposure_us);
    if (Result<void> ok = fields.status(); !ok) return ok;
    const bool other_time = asked_us_ > 0 && !request_.again && asked_us_ != of_session.exposure_us;
    if (other_time || of_session.iso != exposure_.iso || of_session.f_number != exposure_.f_number) {
      return Error{ErrorKind::kCannotCreate, "session was begun with another exposure",
                   request_.session.string(),
                   fmt::format("its frames are taken at {}, ISO {:g}, f/{:g}",
                               exposure_words(of_session.exposure_us), of_session.iso, of_session.f_number),
                   "scan under another name, or leave the exposure as it was"};
    }
    exposure_ = of_session;
    report_.change([&](ScanStatus& status) { status.exposure_us = exposure_.exposure_us; });
    return {};
  }

  Result<Metering> metered() {
    report_.phase(ScanPhase::kMetering);
    const MeterInput input = meter_input(list_.leds, shutter_times_us_, so_far_.model, exposure_.iso);
    return meter(input, [&](int led, double exposure_us) -> Result<Brightness> {
      return tested({led, ShotRole::kLit, solved_state()}, exposure_us);
    });
  }

  Polariser solved_state() const {
    return list_.polariser.empty() ? Polariser::kNone : list_.polariser.front();
  }

  /// The time asked for, else a metered one; that of the lit shots where the cloth lets no light through.
  Result<double> time_of_light_below() {
    if (below_asked_us_ > 0) return below_asked_us_;
    report_.phase(ScanPhase::kMetering);
    const Result<Metering> metering =
        meter({{1}, {}, shutter_times_us_, exposure_.exposure_us}, [&](int, double exposure_us) {
          return tested({0, ShotRole::kBelow, solved_state()}, exposure_us);
        });
    if (metering) return metering->exposure_us;
    if (metering.error().kind != ErrorKind::kBadData) return metering.error();
    warnings_.push_back("the light below the cloth could not be metered and is taken as the LEDs are: " +
                        metering.error().why);
    return exposure_.exposure_us;
  }

  /// How bright a test shot is; it is not kept.
  Result<Brightness> tested(const ShotLight& light, double exposure_us) {
    const ExposureSettings exposure = {exposure_us, exposure_.iso, exposure_.f_number};
    Result<Photograph> photograph = shoot(light, exposure, "test");
    if (!photograph) return photograph.error();
    Result<RawFrame> frame = decode_as_calibrated(photograph->file, calibration_);
    if (!frame) return frame.error();
    if (Result<void> cleared = journal_->clear_incoming(); !cleared) return cleared.error();
    return test_shots_.read(std::move(*frame));
  }

  Result<Photograph> shoot(const ShotLight& light, const ExposureSettings& exposure,
                           const std::string& stem) {
    return shooter_.take(light, exposure, journal_->incoming(stem), [&] {
      std::error_code ignored;
      for (const auto& entry : fs::directory_iterator(journal_->incoming("").parent_path(), ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(stem)) fs::remove_all(entry.path(), ignored);
      }
    });
  }

  /// Frames of an earlier run are evidence for those of this one.
  Result<void> look_at_kept() {
    plan_ = request_.again ? plan_of(journal_->session(), exposure_, times_)
                           : plan_shots(list_, exposure_, times_);
    std::optional<std::uint32_t> last;
    for (const Shot& shot : journal_->session().shots) {
      if (shot.document.contains("image_number") && shot.document["image_number"].is_number_unsigned()) {
        last = std::max(last.value_or(0), shot.document["image_number"].get<std::uint32_t>());
      }
      Result<RawFrame> frame = decode_as_calibrated(journal_->session().path_of(shot), calibration_);
      if (!frame) return frame.error();
      const auto& first = so_far_.first;
      if (Result<void> ok = first ? check_alike(*frame, *first, so_far_.first_size, shot.file)
                                  : accept_first(*frame, shot.file, so_far_);
          !ok)
        return ok;
      ScanEvidence& evidence = *so_far_.evidence;
      if (!shot.superseded_by && shot.index != request_.again)
        evidence.accept(planned(shot.index), evidence.glance(*frame));
    }
    shooter_.follow(last);
    return request_.again ? plan_again() : Result<void>();
  }

  const DueShot& planned(int index) const { return *std::ranges::find(plan_, index, &DueShot::index); }

  Result<void> plan_again() {
    std::optional<double> bracket_us;
    if (asked_us_ > 0 && asked_us_ != exposure_.exposure_us) bracket_us = asked_us_;
    const Response response = calibration_ && calibration_->response ? *calibration_->response : Response();
    if (bracket_us && !response.exposure_ratio(*bracket_us, exposure_.exposure_us)) {
      std::vector<std::string> measured;
      for (const double us : response.exposures_beside(exposure_.exposure_us))
        measured.push_back(exposure_words(us));
      return Error{
          ErrorKind::kUsage, "the shot cannot be taken again at another exposure", request_.session.string(),
          fmt::format("nobody measured the ratio of {} to the session's {}", exposure_words(*bracket_us),
                      exposure_words(exposure_.exposure_us)),
          measured.empty() ? "scan the cloth again at another exposure: weft calibrate response measures the "
                             "ratios of its own exposures only, and the session's is none of them"
                           : fmt::format("take it at one that was measured: {}", fmt::join(measured, ", "))};
    }
    Result<DueShot> again = shot_again(journal_->session(), *request_.again, exposure_, bracket_us);
    if (!again) return again.error();
    plan_.push_back(*again);
    return {};
  }

  std::vector<DueShot> shots_to_take() const {
    if (request_.again) return {plan_.back()};
    return missing_shots(plan_, journal_->session());
  }

  /// The first frame says what all are like.
  Result<void> accept_first(const RawFrame& frame, const std::string& where, FramesSoFar& so_far) const {
    const Size size = frame.counts.size();
    if (so_far.model && so_far.model->grid.frame != size) {
      const Size calibrated = so_far.model->grid.frame;
      return Error{ErrorKind::kBadData, "calibration is not of this camera", where,
                   fmt::format("its camera has {} x {} pixels, the frame {} x {}", calibrated.width,
                               calibrated.height, size.width, size.height),
                   "name the calibration of this camera"};
    }
    if (Result<void> ok = check_body(frame.shot, where); !ok) return ok;
    const PatchGrid grid = so_far.model ? so_far.model->grid : PatchGrid::over(size);
    so_far.evidence.emplace(grid, std::exchange(so_far.model, std::nullopt), plan_.front().polariser);
    so_far.first_size = size;
    so_far.first = RawFrame{{}, frame.cfa, frame.black, frame.white, frame.shot};
    return {};
  }

  /// As the solver will ask.
  Result<void> check_body(const ShotMetadata& shot, const std::string& where) const {
    if (!calibration_) return {};
    const std::optional<std::string> why = subject_difference(calibration_->subject, shot);
    if (!why) return {};
    return Error{ErrorKind::kBadData, "calibration does not suit the frame", where, *why,
                 "set the camera as it was calibrated, or name its calibration"};
  }

  /// While a shot is taken, the frame before it is decoded, checked and kept on another thread.
  Result<void> photograph_missing() {
    const std::vector<DueShot> missing = shots_to_take();
    std::deque<DueShot> queue(missing.begin(), missing.end());
    std::future<Arrived> on_its_way;
    while (!queue.empty() || on_its_way.valid()) {
      std::optional<Photograph> photograph;
      std::optional<Error> fault;
      DueShot shot;
      if (!queue.empty()) {
        shot = queue.front();
        queue.pop_front();
        // A name of its own: the one before may still be read while this one lands.
        Result<Photograph> taken = shoot({shot.led, shot.role, shot.polariser}, shot.exposure,
                                         file_stem(shot) + (is_odd_ ? "_b" : "_a"));
        is_odd_ = !is_odd_;
        if (taken)
          photograph = std::move(*taken);
        else
          fault = taken.error();
      }
      if (on_its_way.valid()) {
        Arrived before = on_its_way.get();
        so_far_ = std::move(before.so_far);
        if (photograph && !before.kept.was_light_right) {
          queue.push_front(shot);
          photograph.reset();
        }
        if (before.kept.error && !fault) {
          if (Result<void> ok = take_again(before.kept, queue); !ok) fault = ok.error();
        }
      }
      if (fault) return *fault;
      if (!photograph) continue;
      if (Result<void> room = check_room_once(*photograph, queue.size()); !room) return room;
      on_its_way = std::async(std::launch::async, [this, shot, taken = std::move(*photograph),
                                                   so_far = std::move(so_far_)]() mutable {
        Kept kept = checked_and_kept(shot, taken, so_far);
        return Arrived{std::move(kept), std::move(so_far)};
      });
    }
    return {};
  }

  Result<void> take_again(const Kept& kept, std::deque<DueShot>& queue) {
    if (kept.take_again.empty()) return *kept.error;
    report_.phase(ScanPhase::kRecovering, kept.error->message());
    // In the order of the plan: a repeat is held against its first frame.
    std::vector<int> again = kept.take_again;
    std::ranges::sort(again, std::greater{});
    for (const int index : again) {
      if (++times_wrong_[index] >= kTimesWrong) return *kept.error;
      ++frames_wrong_;
      queue.push_front(planned(index));
    }
    return {};
  }

  Result<void> check_room_once(const Photograph& photograph, std::size_t more) {
    if (std::exchange(has_room_, true)) return {};
    return check_room(request_, static_cast<int>(more), list_.count(), photograph.bytes);
  }

  Kept checked_and_kept(const DueShot& shot, const Photograph& photograph, FramesSoFar& so_far) try {
    const std::string where = fmt::format("{} ({})", name_of(shot), file_stem(shot));
    if (Result<void> is_new = check_new(photograph, journal_->session().shots, where); !is_new)
      return unusable(shot, "unlike", is_new.error(), {shot.index});
    Result<RawFrame> frame = decode_as_calibrated(photograph.file, calibration_);
    if (!frame) return unusable(shot, "damaged", frame.error(), {shot.index});
    if (!so_far.first) {
      if (Result<void> suits = accept_first(*frame, where, so_far); !suits)
        return unusable(shot, "unlike", suits.error(), {});
    } else if (Result<void> alike = check_alike(*frame, *so_far.first, so_far.first_size, where); !alike) {
      return unusable(shot, "unlike", alike.error(), {shot.index});
    }

    std::vector<double> light = so_far.evidence->glance(*frame);
    const ShotVerdict verdict = so_far.evidence->judge(shot, light);
    if (verdict.finding != LightFinding::kAgrees) return refused(shot, verdict, so_far);

    KeptFrame kept = {
        {}, histogram_rgb(*frame), verdict.warnings, {code_of(verdict.doubt), verdict.level, verdict.misfit}};
    Json notes = Json::object();
    if (verdict.level) notes["level"] = *verdict.level;
    note_exposure(shot, *frame, kept, notes);
    if (const std::string useless = useless_words(shot, notes); !useless.empty()) {
      is_useless_ = true;
      return unusable(shot, "clipped",
                      {ErrorKind::kUsage, "the cloth cannot be scanned at this exposure", where, useless,
                       "scan it without an exposure, which is then metered"},
                      {});
    }
    if (!kept.warnings.empty()) notes["warnings"] = kept.warnings;
    Result<Shot> in_session = journal_->keep(shot, photograph, notes);
    if (!in_session) {
      const bool may_pass = in_session.error().kind == ErrorKind::kTryAgain;
      return {in_session.error(), may_pass ? std::vector<int>{shot.index} : std::vector<int>()};
    }
    kept.shot = std::move(*in_session);
    so_far.evidence->accept(shot, std::move(light));
    so_far.warnings.insert(so_far.warnings.end(), kept.warnings.begin(), kept.warnings.end());
    report_.kept(kept);
    return {};
  } catch (const std::bad_alloc&) {
    return {Error{ErrorKind::kTryAgain, "not enough memory", file_stem(shot), "the system refused some",
                  "close other programs and run the same command again"},
            {}};
  }

  Kept unusable(const DueShot& shot, const char* code, const Error& error, std::vector<int> take_again) {
    report_.refused({shot.index, shot.led, shot.role, shot.polariser, {code, {}, {}}, error.message()});
    return {error, std::move(take_again)};
  }

  std::vector<int> accused_by(const ShotVerdict& verdict, const DueShot& shot) const {
    if (!verdict.accuses_all) return verdict.accused;
    std::vector<int> all;
    for (const Shot& kept : journal_->session().shots) {
      if (kept.role != ShotRole::kDark) all.push_back(kept.index);
    }
    all.push_back(shot.index);
    return all;
  }

  /// Takes what is accused out of the session, so that it is taken again, now or by the next scan.
  Kept refused(const DueShot& shot, const ShotVerdict& verdict, FramesSoFar& so_far) {
    const std::vector<int> indices = accused_by(verdict, shot);
    Kept kept = {Error{ErrorKind::kBadData, verdict.sentence, names_of(indices),
                       "the photograph does not agree with the calibrated light",
                       verdict.finding == LightFinding::kChanged
                           ? "leave cloth, camera and light alone, then run the same command again"
                           : "mend the light, then run the same command again"},
                 {}};
    // What is taken again adds to a session and takes nothing out.
    const Result<void> out = request_.again ? Result<void>() : journal_->discard(indices);
    if (!out) return {out.error(), {}};
    for (const int index : indices) {
      so_far.evidence->forget(index);
      const DueShot& accused = planned(index);
      report_.refused({index,
                       accused.led,
                       accused.role,
                       accused.polariser,
                       {code_of(verdict.finding), verdict.level, verdict.misfit},
                       kept.error->message()});
    }
    report_.change(
        [&](ScanStatus& status) { status.frames = static_cast<int>(journal_->session().shots.size()); });
    if (!verdict.may_pass() || request_.again) return kept;
    kept.take_again = indices;
    kept.was_light_right = !verdict.accuses_all;
    return kept;
  }

  std::string names_of(const std::vector<int>& shots) const {
    std::string names;
    for (const int index : shots) names += (names.empty() ? "" : ", ") + file_stem(planned(index));
    return names;
  }

  static void note_exposure(const DueShot& shot, const RawFrame& frame, KeptFrame& kept, Json& notes) {
    double clipped = 0;
    for (const RawHistogram& histogram : kept.histogram_rgb) clipped = std::max(clipped, histogram.clipped);
    if (clipped > kMostClipped && shot.role != ShotRole::kBracket) kept.finding.code = "clipped";
    if (shot.role != ShotRole::kLit && shot.role != ShotRole::kBracket) return;
    const MeteredShot of_its_time = {shot.led, 1, brightness_of(frame)};
    set_exposed({clipped, std::min(of_its_time.longest_us(), kMostRoom)}, notes);
  }

  /// Why the first lit frame says that all would be for nothing. A metered exposure is as good as can be.
  std::string useless_words(const DueShot& shot, const Json& notes) const {
    const bool is_first = shot.role == ShotRole::kLit && journal_->session().lit().empty();
    if (!is_first || asked_us_ <= 0 || request_.any_exposure || request_.again) return "";
    return why_useless(*exposed_in(notes), shot.exposure.exposure_us, list_.bracket.value_or(1));
  }

  Result<void> finish() {
    report_.phase(ScanPhase::kFinishing);
    warnings_.insert(warnings_.end(), so_far_.warnings.begin(), so_far_.warnings.end());
    shooter_.long_waits().warn(warnings_);
    const Result<void> done = journal_->finish(warnings_, request_.copy.empty() ? Json() : second_copy());
    // Not among those of the record: its shots say it, and one that is taken again may mend it.
    if (const std::string exposure = exposure_warning(journal_->session()); !exposure.empty())
      warnings_.insert(warnings_.begin(), exposure);
    return done;
  }

  /// Before the end of the session, so that a scan that is killed meanwhile makes it when it is run again.
  Json second_copy() {
    if (const auto one_disk = warning_of_one_disk(request_.session, request_.copy))
      warnings_.push_back(*one_disk);
    const Result<void> copied = copy_session(journal_->finished(warnings_), request_.copy);
    if (!copied) {
      warnings_.push_back(fmt::format("there is no second copy: {} Then make it: weft copy {}",
                                      copied.error().message(), request_.session.string()));
    }
    return record_of_copy(request_.copy, copied);
  }

  const ScanRequest& request_;
  Report report_;
  Shooter shooter_;
  int leds_of_board_;
  bool has_more_outputs_;
  std::optional<Calibration> calibration_;
  ShotList list_;
  std::optional<Journal> journal_;
  std::vector<double> shutter_times_us_;
  double asked_us_ = 0, below_asked_us_ = 0;  ///< of the camera's own; 0: metered
  double shutter_travel_s_ = 0;
  ExposureSettings exposure_;
  OtherTimes times_;
  std::vector<DueShot> plan_;
  int frames_resumed_ = 0, frames_wrong_ = 0;
  std::map<int, int> times_wrong_;
  TestShotReader test_shots_;
  std::vector<std::string> warnings_;
  bool has_room_ = false, is_odd_ = false, is_useless_ = false;
  FramesSoFar so_far_;  ///< away while a frame is on its way
};

}  // namespace

Result<ScanOutcome> scan(const ScanRequest& request, Lamps& lamps, Camera& camera, const ScanEvents& events,
                         const ScanControl& control, const ScanOptions& options) {
  ScanRequest normal = request;
  if (!normal.session.has_filename()) normal.session = normal.session.parent_path();
  return Scan(normal, lamps, camera, events, control, options).run();
}

}  // namespace weft::capture
