// SPDX-License-Identifier: Apache-2.0
#include "solve/input/session_input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "capture/frames/session_frames.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/image_io/linear_image.h"
#include "core/rig/exposure_words.h"
#include "core/rig/suits.h"
#include "solve/input/session_photos.h"
#include "solve/session/left_out_shots.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

// Takes away what a person left out.
void leave_out_by_person(SolvePlan& plan) {
  const std::vector<int> indices = left_out(plan.session);
  std::erase_if(plan.session.shots, [&](const Shot& shot) {
    if (std::ranges::find(indices, shot.index) == indices.end()) return false;
    plan.warnings.push_back(fmt::format("{} was left out: a person said so", shot.file));
    return true;
  });
}

// Warns of a rig that was known to have moved when the cloth was scanned.
void tell_of_moved_rig(SolvePlan& plan) {
  const Json accepted = plan.session.document.value("accepted_moved", Json());
  if (!accepted.is_object()) return;
  const Json degrees = accepted.value("degrees", Json()), why = accepted.value("why", Json());
  plan.warnings.push_back(fmt::format(
      "the rig had moved since its calibration when this was scanned ({}), which was accepted: {}",
      degrees.is_number() ? fmt::format("{:.2g} degrees", degrees.get<double>()) : "nobody knows how far",
      why.is_string() ? why.get<std::string>() : "no reason is given"));
}

// The lit shots of the named LEDs, or of all; through crossed films where there are such.
Result<std::vector<Shot>> choose_lit(const Session& session, const std::vector<int>& leds) {
  const std::vector<const Shot*> crossed = session.lit(Polariser::kCrossed);
  std::vector<Shot> chosen;
  for (const Shot* shot : crossed.empty() ? session.lit() : crossed) {
    if (leds.empty() || std::count(leds.begin(), leds.end(), shot->led) > 0) chosen.push_back(*shot);
  }
  for (const int led : leds) {
    if (std::count(leds.begin(), leds.end(), led) > 1) {
      return Error{ErrorKind::kUsage, "a light is named twice", fmt::format("LED {}", led), "",
                   "name every LED once"};
    }
    if (std::none_of(chosen.begin(), chosen.end(), [&](const Shot& s) { return s.led == led; })) {
      return Error{ErrorKind::kUsage, "no such light", fmt::format("LED {}", led),
                   fmt::format("{} has no lit shot of it", session.folder.string()),
                   "name LEDs that were lit"};
    }
  }
  if (chosen.size() < 3) {
    return Error{ErrorKind::kBadData, "too few lights", session.folder.string(),
                 fmt::format("{} lit shots; a normal and an albedo are three unknowns", chosen.size()),
                 "solve from at least three LEDs"};
  }
  return chosen;
}

// The other half of a pair: the lit shots once more through parallel films.
void choose_parallel(SolvePlan& plan) {
  if (plan.lit.front().polariser != Polariser::kCrossed) return;
  const std::vector<const Shot*> all = plan.session.lit(Polariser::kParallel);
  if (all.empty()) return;
  for (const Shot& lit : plan.lit) {
    const auto found = std::ranges::find(all, lit.led, &Shot::led);
    if (found != all.end()) {
      plan.parallel.push_back(**found);
      continue;
    }
    plan.warnings.push_back(
        fmt::format("the shots through parallel films were left out: there is none of LED {}", lit.led));
    plan.parallel.clear();
    return;
  }
}

// The repeats, brackets and the last blade of the lit shots, with a warning for each that says nothing.
void choose_more(SolvePlan& plan) {
  const Shot& lit = plan.lit.front();
  const std::optional<Response>& response = plan.calibration.response;
  for (const Shot& shot : plan.session.shots) {
    const bool is_repeat = shot.role == ShotRole::kRepeat;
    const bool is_bracket = shot.role == ShotRole::kBracket;
    const bool is_blade = shot.role == ShotRole::kBlade;
    const bool is_of_dark = is_repeat && shot.led == 0;
    if ((!is_repeat && !is_bracket && !is_blade) || is_of_dark) continue;
    if (shot.superseded_by || shot.polariser != lit.polariser) continue;
    const auto leave_out = [&](const std::string& why) {
      plan.warnings.push_back(fmt::format("{} was left out: {}", shot.file, why));
    };
    if (std::none_of(plan.lit.begin(), plan.lit.end(), [&](const Shot& s) { return s.led == shot.led; })) {
      leave_out(fmt::format("no lit shot of LED {} is solved", shot.led));
    } else if (shot.iso != lit.iso || (!is_bracket && shot.exposure_us != lit.exposure_us)) {
      leave_out(fmt::format("it was taken at {}, ISO {}, the lit shots at {}, ISO {}",
                            exposure_words(shot.exposure_us), shot.iso, exposure_words(lit.exposure_us),
                            lit.iso));
    } else if (is_repeat) {
      plan.repeats.push_back(shot);
    } else if (is_blade) {
      plan.blade = shot;
    } else if (!plan.raw) {
      leave_out("brackets are merged by the noise of raw frames, and these are developed");
    } else if (!response || !response->exposure_ratio(shot.exposure_us, lit.exposure_us)) {
      leave_out(
          fmt::format("response.json has no measured ratio of {} to {}; measure it with weft "
                      "calibrate response",
                      exposure_words(shot.exposure_us), exposure_words(lit.exposure_us)));
    } else {
      plan.brackets.push_back(shot);
    }
  }
}

// Two LEDs do not make one photograph.
Result<void> refuse_copies(const SolvePlan& plan) {
  std::map<std::string, const Shot*> seen;
  for (const Shot& shot : plan.lit) {
    if (shot.sha256.empty()) continue;
    const auto [same, is_new] = seen.emplace(shot.sha256, &shot);
    if (is_new) continue;
    return Error{ErrorKind::kBadData, "one photograph is under two LEDs", plan.session.path_of(shot).string(),
                 fmt::format("of LED {}; its bytes are those of {}, of LED {}", shot.led, same->second->file,
                             same->second->led),
                 "photograph the cloth again, or leave one of the two LEDs out with --lights"};
  }
  return {};
}

// All shots that are read. Their names tell whether they are raw.
Result<void> choose_shots(const std::vector<int>& leds, SolvePlan& plan) {
  Result<std::vector<Shot>> lit = choose_lit(plan.session, leds);
  if (!lit) return std::move(lit).error();
  plan.lit = std::move(*lit);
  if (const Shot* dark = plan.session.dark()) plan.dark = *dark;
  if (Result<void> ok = refuse_copies(plan); !ok) return ok;
  plan.raw = !is_linear_image(plan.session.path_of(plan.lit.front()));
  choose_parallel(plan);
  choose_more(plan);
  return {};
}

SolveInput input_of(const SolvePlan& plan) {
  SolveInput input = {.session = plan.session.fabric,
                      .calibration = plan.calibration.id,
                      .cloth_height_mm = plan.session.cloth_height_mm};
  for (const Shot& shot : plan.frames())
    input.shots.push_back({shot.led, shot.file, shot.sha256, shot.exposure_us, shot.iso, shot.f_number});
  if (!plan.session.pose.is_level()) input.pose = plan.session.pose;
  return input;
}

// The session, as far as it says itself what is solved.
Result<SolvePlan> begin_plan(const SessionOptions& options) {
  SolvePlan plan;
  Result<Session> session = capture::read_complete_session(options.folder);
  if (!session) return std::move(session).error();
  plan.session = std::move(*session);
  const fs::path& folder = plan.session.folder;
  plan.where = folder.string();
  plan.session_name = absolute_folder(folder).filename().string();
  plan.solves = folder / "solve";
  if (const fs::path truth = folder / "truth" / "normal.exr"; is_there(truth)) plan.truth = truth;
  leave_out_by_person(plan);
  if (!options.accepted_moved.is_null()) plan.session.document["accepted_moved"] = options.accepted_moved;
  tell_of_moved_rig(plan);
  return plan;
}

// The calibration that is named, or the session's own.
Result<Calibration> calibration_of(const Session& session, const fs::path& named) {
  if (!named.empty()) return read_calibration(named);
  Result<Calibration> own = read_calibration(session.calibration_folder());
  if (!own || own->id == session.calibration_id) return own;
  return Error{ErrorKind::kBadData, "calibration is not the one of the session",
               session.calibration_folder().string(),
               fmt::format("its id is {:.12}, session.json names {:.12}", own->id, session.calibration_id),
               "restore the session's calibration folder, or name another with --calibration"};
}

Result<SolvePlan> plan_of_photographs(const SessionOptions& options, SolvePlan begun) {
  const Result<std::vector<Shot>> lit = choose_lit(begun.session, options.leds);
  return lit ? plan_photographs(options, *lit, std::move(begun)) : lit.error();
}

Error reads_raws(const std::string& where) {
  return {
      ErrorKind::kUsage, "the session of a rig is read by its calibration", where,
      "a transfer, an orientation, lights turned round and a pixel's size are of photographs without a rig",
      "leave these options out"};
}

// The size that all frames have.
Result<Size> look_at_headers(SolvePlan& plan) {
  capture::FrameHeaders headers(
      plan.session, plan.calibration,
      "name the calibration of this rig with --calibration, or calibrate the rig as it is now");
  for (const Shot& shot : plan.frames()) {
    if (Result<void> ok = headers.look_at(shot); !ok) return std::move(ok).error();
  }
  if (!headers.opcodes().empty()) {
    plan.assumed.push_back(fmt::format("what the raws ask for is not done, as in the calibration's: {}",
                                       fmt::join(headers.opcodes(), ", ")));
  }
  return headers.size();
}

}  // namespace

Result<SolvePlan> plan_session(const SessionOptions& options) {
  Result<SolvePlan> plan = begin_plan(options);
  if (!plan) return plan;
  if (!plan->session.is_of_rig()) return plan_of_photographs(options, *std::move(plan));
  if (options.forgets_reading || options.reading != PhotoReading()) return reads_raws(plan->where);
  Result<Calibration> calibration = calibration_of(plan->session, options.calibration);
  if (!calibration) return std::move(calibration).error();
  plan->calibration = std::move(*calibration);
  if (Result<void> chosen = choose_shots(options.leds, *plan); !chosen) return std::move(chosen).error();
  const Result<Size> size = look_at_headers(*plan);
  if (!size) return size.error();
  plan->size = *size;
  plan->input = input_of(*plan);
  return plan;
}

Result<SolvePlan> plan_unopened(const SessionOptions& options, const Calibration& calibration) {
  Result<SolvePlan> plan = begin_plan(options);
  if (!plan) return plan;
  plan->calibration = calibration;
  if (Result<void> chosen = choose_shots(options.leds, *plan); !chosen) return std::move(chosen).error();
  if (Result<void> ok = suits(calibration, plan->session, {}); !ok) return std::move(ok).error();
  plan->size = calibration.camera->size;
  plan->input = input_of(*plan);
  return plan;
}

Result<void> plan_second_pose(const fs::path& folder, const solver::MethodName& method,
                              const SessionOptions& first, SolvePlan& plan) {
  const auto unfit = [&](ErrorKind kind, std::string why, std::string remedy) {
    return Error{kind, "second pose cannot be used", folder.string(), std::move(why), std::move(remedy)};
  };
  if (method.level != solver::Level::kRobust && method.level != solver::Level::kReference)
    return unfit(ErrorKind::kUsage, fmt::format("{} seeks no lobe", method.name),
                 "solve with --quality robust or reference");
  if (!plan.is_of_rig)
    return unfit(ErrorKind::kUsage, "photographs that no rig took have one pose", "leave --second-pose out");
  Result<SolvePlan> second =
      plan_session({.folder = folder, .calibration = first.calibration, .leds = first.leds});
  if (!second) return std::move(second).error();
  if (second->input == plan.input)
    return unfit(ErrorKind::kUsage, "it is the session that is solved", "name the scan of the other pose");
  if (second->calibration.id != plan.calibration.id)
    return unfit(ErrorKind::kBadData, "it was scanned with another calibration", "scan both poses in one go");
  if (second->parallel.empty() != plan.parallel.empty())
    return unfit(ErrorKind::kBadData,
                 "one of the two was scanned through crossed and parallel films, the other was not",
                 "scan both in the same way");
  second->cloth_spread = plan.cloth_spread;
  plan.input.second_pose = object_of(second->input);
  plan.second_pose = std::make_shared<const SolvePlan>(std::move(*second));
  return {};
}

}  // namespace weft::solve
