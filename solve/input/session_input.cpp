// SPDX-License-Identifier: Apache-2.0
#include "solve/input/session_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "capture/frames/session_frames.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/image_io/linear_image.h"
#include "core/rig/suits.h"
#include "solve/input/session_conditions.h"
#include "solve/levels/reference.h"
#include "solve/photographs/plane_weights.h"
#include "solve/session/left_out_shots.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// Takes away what a person left out.
void leave_out_by_person(SessionPlan& plan) {
  const std::vector<int> indices = library::left_out(plan.session);
  std::erase_if(plan.session.shots, [&](const Shot& shot) {
    if (std::ranges::find(indices, shot.index) == indices.end()) return false;
    plan.warnings.push_back(fmt::format("{} was left out: a person said so", shot.file));
    return true;
  });
}

// Of a rig that was known to have moved when the cloth was scanned.
void tell_of_moved_rig(SessionPlan& plan) {
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
void choose_parallel(SessionPlan& plan) {
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

// The repeats and brackets of the lit shots, with a warning for each that says nothing.
void choose_more(SessionPlan& plan) {
  const Shot& lit = plan.lit.front();
  for (const Shot& shot : plan.session.shots) {
    const bool is_repeat = shot.role == ShotRole::kRepeat;
    const bool is_bracket = shot.role == ShotRole::kBracket;
    const bool is_of_dark = is_repeat && shot.led == 0;
    if ((!is_repeat && !is_bracket) || is_of_dark) continue;
    if (shot.superseded_by || shot.polariser != lit.polariser) continue;
    const auto leave_out = [&](const std::string& why) {
      plan.warnings.push_back(fmt::format("{} was left out: {}", shot.file, why));
    };
    if (std::none_of(plan.lit.begin(), plan.lit.end(), [&](const Shot& s) { return s.led == shot.led; })) {
      leave_out(fmt::format("no lit shot of LED {} is solved", shot.led));
    } else if (shot.iso != lit.iso || (is_repeat && shot.exposure_us != lit.exposure_us)) {
      leave_out(fmt::format("it was taken at {} us, ISO {}, the lit shots at {} us, ISO {}", shot.exposure_us,
                            shot.iso, lit.exposure_us, lit.iso));
    } else if (is_repeat) {
      plan.repeats.push_back(shot);
    } else if (!plan.raw) {
      leave_out("brackets are merged by the noise of raw frames, and these are developed");
    } else if (!plan.calibration.response->exposure_ratio(shot.exposure_us, lit.exposure_us)) {
      leave_out(
          fmt::format("response.json has no measured ratio of {} us to {} us; measure it with weft "
                      "calibrate response",
                      shot.exposure_us, lit.exposure_us));
    } else {
      plan.brackets.push_back(shot);
    }
  }
}

// Frames of one body have one set of levels.
Result<void> check_levels(const RawFrame& frame, const RawFrame& first, const fs::path& file) {
  if (frame.black == first.black && frame.white == first.white) return {};
  return Error{
      ErrorKind::kBadData, "frame does not belong to its session", file.string(),
      fmt::format("its black levels are {} {} {} {} and its white level is {}, the first frame's are {} {} "
                  "{} {} and {}",
                  frame.black[0][0], frame.black[0][1], frame.black[1][0], frame.black[1][1], frame.white,
                  first.black[0][0], first.black[0][1], first.black[1][0], first.black[1][1], first.white),
      "scan the cloth again with fixed camera settings"};
}

// Moves the first `count` of `frames` away.
template <typename Frame>
std::vector<Frame> take(std::vector<Frame>& frames, std::size_t count) {
  const auto end = frames.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<Frame> taken(std::make_move_iterator(frames.begin()), std::make_move_iterator(end));
  frames.erase(frames.begin(), end);
  return taken;
}

template <typename Frame>
Result<std::vector<Frame>> read_frames(const std::vector<Shot>& shots, const JobContext& context,
                                       const std::function<Result<Frame>(const Shot&)>& read) {
  std::vector<Frame> frames(shots.size());
  const auto read_one = [&](std::size_t i) -> Result<void> {
    Result<Frame> frame = read(shots[i]);
    if (!frame) return std::move(frame).error();
    frames[i] = std::move(*frame);
    return {};
  };
  if (Result<void> ok = for_each_frame(shots.size(), context, read_one); !ok) return std::move(ok).error();
  return frames;
}

// `shots` are those of plan.frames().
Result<pipeline::Frames> read_mosaics(const SessionPlan& plan, const std::vector<Shot>& shots,
                                      const JobContext& context, MoreFrames& more) {
  Result<std::vector<RawFrame>> frames = read_frames<RawFrame>(
      shots, context, [&](const Shot& shot) { return read_raw_shot(plan.session, shot, plan.size); });
  if (!frames) return std::move(frames).error();
  for (std::size_t i = 1; i < frames->size(); ++i) {
    if (Result<void> ok = check_levels((*frames)[i], frames->front(), plan.session.path_of(shots[i])); !ok)
      return std::move(ok).error();
  }
  std::vector<RawFrame> lit = take(*frames, plan.lit.size());
  std::optional<RawFrame> dark;
  if (plan.dark) dark = std::move(take(*frames, 1).front());
  const Shot& first = plan.lit.front();
  pipeline::Mosaics mosaics(std::move(lit), std::move(dark), *plan.calibration.response,
                            {first.exposure_us, first.iso});
  more.repeats = mosaics.alike(take(*frames, plan.repeats.size()));
  more.parallel = mosaics.alike(take(*frames, plan.parallel.size()));
  more.brackets = std::move(*frames);
  return pipeline::Frames(std::move(mosaics));
}

Result<pipeline::Frames> read_developed(const SessionPlan& plan, const std::vector<Shot>& shots,
                                        const JobContext& context, MoreFrames& more) {
  Result<std::vector<Image<float>>> frames = read_frames<Image<float>>(
      shots, context, [&](const Shot& shot) { return read_developed_shot(plan.session, shot); });
  if (!frames) return std::move(frames).error();
  std::vector<Image<float>> lit = take(*frames, plan.lit.size());
  const std::vector<Image<float>> dark = take(*frames, plan.dark ? 1 : 0);
  const Shot& first = plan.lit.front();
  for (auto* list : {&lit, &*frames}) {
    for (Image<float>& image : *list) {
      if (!dark.empty()) subtract(image, dark.front());
      scale(image, 1 / (first.exposure_us * 1e-6 * first.iso / 100));
    }
  }
  more.repeats = pipeline::Developed{take(*frames, plan.repeats.size())};
  more.parallel = pipeline::Developed{std::move(*frames)};
  return pipeline::Frames(pipeline::Developed{std::move(lit)});
}

// Of what the surface mirrors, over the share of what it scatters.
double lobe_share_of(Polariser polariser, const Films& films) {
  switch (polariser) {
    case Polariser::kNone:
      break;
    case Polariser::kParallel:
      return solver::kParallelLobeShare;
    case Polariser::kCrossed:
      return solver::kParallelLobeShare * films.leak;
  }
  return 1;
}

// Before an hour of work.
Result<void> check_memory(const SessionPlan& plan, int threads) {
  const std::uint64_t needed = memory_needed(plan, threads);
  const std::uint64_t free = available_memory_bytes();
  if (free == 0 || needed <= free) return {};
  return Error{ErrorKind::kTryAgain, "not enough memory", plan.session.folder.string(),
               fmt::format("{} MB are needed, {} MB are free", needed >> 20, free >> 20),
               "close other programs, or solve on a larger machine"};
}

// From here on the cloth is level and the rig tilted: maps are those of the cloth's own plane.
Result<void> lay_level(const Session& session, pipeline::Photographs& photographs) {
  const ClothPose& pose = session.pose;
  if (pose.is_level()) return {};
  const double height_mm = session.cloth_height_mm;
  if (photographs.camera) photographs.camera = seen_from(pose, height_mm, *photographs.camera);
  if (photographs.light_covariance)
    photographs.light_covariance = seen_from(pose, *std::move(photographs.light_covariance));
  Result<LightField> field = LightField::make(seen_from(pose, height_mm, photographs.field->lights()),
                                              photographs.camera, photographs.size, height_mm);
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  return {};
}

SolveInput input_of(const SessionPlan& plan) {
  SolveInput input = {.session = plan.session.fabric,
                      .calibration = plan.calibration.id,
                      .cloth_height_mm = plan.session.cloth_height_mm};
  for (const Shot& shot : plan.frames())
    input.shots.push_back({shot.led, shot.file, shot.sha256, shot.exposure_us, shot.iso, shot.f_number});
  if (!plan.session.pose.is_level()) input.pose = plan.session.pose;
  return input;
}

// The session, as far as it says itself what is solved.
Result<SessionPlan> begin_plan(const SessionOptions& options) {
  SessionPlan plan;
  Result<Session> session = read_complete_session(options.folder);
  if (!session) return std::move(session).error();
  plan.session = std::move(*session);
  leave_out_by_person(plan);
  if (!options.accepted_moved.is_null()) plan.session.document["accepted_moved"] = options.accepted_moved;
  tell_of_moved_rig(plan);
  return plan;
}

// Lit shots and the dark one.
Result<void> choose_first(const SessionOptions& options, SessionPlan& plan) {
  Result<std::vector<Shot>> lit = choose_lit(plan.session, options.leds);
  if (!lit) return std::move(lit).error();
  plan.lit = std::move(*lit);
  if (const Shot* dark = plan.session.dark()) plan.dark = *dark;
  return {};
}

}  // namespace

std::vector<Shot> SessionPlan::frames() const {
  std::vector<Shot> all = lit;
  if (dark) all.push_back(*dark);
  all.insert(all.end(), repeats.begin(), repeats.end());
  all.insert(all.end(), parallel.begin(), parallel.end());
  all.insert(all.end(), brackets.begin(), brackets.end());
  return all;
}

std::uint64_t memory_needed(const SessionPlan& plan, int threads) {
  const auto pixels = static_cast<std::uint64_t>(plan.size.pixels());
  const std::size_t frames = plan.frames().size();
  const std::size_t decoding = std::min(static_cast<std::size_t>(threads), frames);
  const std::uint64_t bytes_a_pixel = plan.raw ? 2 : 12;
  const std::uint64_t of_level = plan.extent == solver::Extent::kWholeFrame
                                     ? pixels * pipeline::reference_bytes_a_pixel(plan.raw ? 1 : 3)
                                     : 0;
  return pixels * bytes_a_pixel * (frames + decoding) + of_level +
         static_cast<std::uint64_t>(plan.size.width) * 128 * 150 + (std::uint64_t{64} << 20);
}

Result<SessionPlan> plan_session(const SessionOptions& options) {
  Result<SessionPlan> begun = begin_plan(options);
  if (!begun) return begun;
  SessionPlan plan = std::move(*begun);
  const bool own = options.calibration.empty();
  Result<Calibration> calibration =
      read_calibration(own ? plan.session.calibration_folder() : options.calibration);
  if (!calibration) return std::move(calibration).error();
  plan.calibration = std::move(*calibration);
  if (own && plan.calibration.id != plan.session.calibration_id) {
    return Error{ErrorKind::kBadData, "calibration is not the one of the session",
                 plan.session.calibration_folder().string(),
                 fmt::format("its id is {:.12}, session.json names {:.12}", plan.calibration.id,
                             plan.session.calibration_id),
                 "restore the session's calibration folder, or name another with --calibration"};
  }

  if (Result<void> chosen = choose_first(options, plan); !chosen) return std::move(chosen).error();
  FrameHeaders headers(
      plan.session, plan.calibration,
      "name the calibration of this rig with --calibration, or calibrate the rig as it is now");
  if (Result<void> ok = headers.look_at(plan.lit.front()); !ok) return std::move(ok).error();
  plan.raw = headers.is_raw();
  plan.size = headers.size();
  choose_parallel(plan);
  choose_more(plan);
  for (const Shot& shot : plan.frames()) {
    if (Result<void> ok = headers.look_at(shot); !ok) return std::move(ok).error();
  }
  plan.input = input_of(plan);
  return plan;
}

Result<SessionPlan> plan_unopened(const SessionOptions& options, const Calibration& calibration) {
  Result<SessionPlan> begun = begin_plan(options);
  if (!begun) return begun;
  SessionPlan plan = std::move(*begun);
  plan.calibration = calibration;
  if (Result<void> chosen = choose_first(options, plan); !chosen) return std::move(chosen).error();
  if (Result<void> ok = suits(calibration, plan.session, {}); !ok) return std::move(ok).error();
  plan.raw = !is_linear_image(plan.session.path_of(plan.lit.front()));
  plan.size = calibration.camera->size;
  choose_parallel(plan);
  choose_more(plan);
  plan.input = input_of(plan);
  return plan;
}

Result<LoadedSession> load_session(const SessionPlan& plan, const JobContext& context) {
  const std::vector<Shot> shots = plan.frames();
  const int threads = std::min(resolved_threads(context.threads), static_cast<int>(shots.size()));
  if (Result<void> room = check_memory(plan, threads); !room) return std::move(room).error();

  LoadedSession loaded;
  loaded.warnings = plan.warnings;
  pipeline::Photographs& photographs = loaded.photographs;
  photographs.size = plan.size;
  photographs.albedo_scale = plan.calibration.subject.albedo_scale;
  for (const Shot& shot : plan.lit) photographs.leds.push_back(shot.led);
  Result<Lights> lights = select_lights(*plan.calibration.lights, photographs.leds);
  if (!lights) return std::move(lights).error();
  if (plan.lit.front().polariser != Polariser::kNone && plan.session.films.scattered != 1)
    lights =
        brightened(std::move(*lights), std::vector<double>(plan.lit.size(), plan.session.films.scattered));
  Result<LightField> field =
      LightField::make(std::move(*lights), plan.calibration.camera, plan.size, plan.session.cloth_height_mm);
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  photographs.camera = plan.calibration.camera;
  photographs.spread = plan.calibration.spread;
  photographs.lateral = plan.calibration.lateral;
  photographs.light_covariance = plan.calibration.light_covariance;
  photographs.color = plan.calibration.color;

  MoreFrames more;
  Result<pipeline::Frames> frames =
      plan.raw ? read_mosaics(plan, shots, context, more) : read_developed(plan, shots, context, more);
  if (!frames) return std::move(frames).error();
  photographs.frames = std::move(*frames);
  photographs.lobe_share = lobe_share_of(plan.lit.front().polariser, plan.session.films);
  if (plan.raw && plan.calibration.response->veil)
    loaded.conditions.veil = plan.calibration.response->veil->share;
  if (Result<void> ok = replace_bad_photosites(plan, context, loaded, more); !ok) {
    return std::move(ok).error();
  }
  if (!plan.parallel.empty()) photographs.parallel = std::move(more.parallel);
  join_brackets(plan, loaded, more);
  if (Result<void> ok = leave_out_useless_lights(plan, loaded); !ok) return std::move(ok).error();
  if (Result<void> ok = follow_drift(plan, context, loaded, more); !ok) return std::move(ok).error();
  if (Result<void> ok = lay_level(plan.session, photographs); !ok) return std::move(ok).error();
  if (Result<void> ok = follow_cloth(context, loaded); !ok) return std::move(ok).error();
  photographs.plane_weights = pipeline::measure_plane_weights(photographs);
  return loaded;
}

}  // namespace weft::app
