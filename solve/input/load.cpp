// SPDX-License-Identifier: Apache-2.0
#include "solve/input/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "capture/frames/session_frames.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/image/page_out.h"
#include "core/image_io/image_io.h"
#include "core/image_io/linear_image.h"
#include "core/rig/filter_phase.h"
#include "solve/conditions/conditions.h"
#include "solve/gloss/sample_gloss.h"
#include "solve/input/photo_mask.h"
#include "solve/levels/reference.h"
#include "solve/photographs/count_levels.h"
#include "solve/photographs/plane_weights.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

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

// A picture that was written a row or a column off has its colours behind other filters than its file says.
Result<void> check_filters(std::span<const RawFrame> lit, const SolvePlan& plan, int threads) {
  std::vector<std::optional<SiteLight>> light(lit.size());
  parallel_for(lit.size(), threads, [&](std::size_t k, int) { light[k] = site_light(lit[k]); });
  const std::vector<FilterShift> shifts = filter_shifts(light, lit.front().cfa);
  const auto off =
      std::ranges::find_if(shifts, [](FilterShift shift) { return shift != FilterShift::kNone; });
  if (off == shifts.end()) return {};
  const Shot& shot = plan.lit[static_cast<std::size_t>(off - shifts.begin())];
  if (*off == FilterShift::kRowOrColumn) {
    return Error{
        ErrorKind::kBadData, "the colour filters are not where the files say",
        plan.session.path_of(shot).string(),
        "the two greens of their pattern differ, and red and blue are alike: it lies one row or column off",
        "convert the camera's raw files again, with their active area as it is"};
  }
  return Error{ErrorKind::kBadData, "frame does not belong to its session",
               plan.session.path_of(shot).string(),
               fmt::format("the filters of LED {}'s picture lie one {} off against the other frames",
                           shot.led, *off == FilterShift::kRow ? "row" : "column"),
               fmt::format("scan that LED again, or leave it out: weft library tag {} --set left_out={}",
                           plan.session_name, shot.index)};
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

Result<std::vector<Photosite>> photosites_named_by(const std::filesystem::path& hot_picture, Size size) {
  const Result<LoadedImage> image = read_image(hot_picture);
  if (!image) return image.error();
  const Size found = image->planes.size();
  if (found != size) {
    return Error{ErrorKind::kBadData, "hot.png differs in size from the frames", hot_picture.string(),
                 fmt::format("it has {} x {} pixels, the frames {} x {}", found.width, found.height,
                             size.width, size.height),
                 "name the calibration of this camera with --calibration"};
  }
  std::vector<Photosite> named;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (image->planes(x, y) > 0) named.push_back({y, x});
    }
  }
  return named;
}

Result<std::optional<Image<std::uint8_t>>> mask_of(const SolvePlan& plan) {
  if (plan.mask.empty()) return std::optional<Image<std::uint8_t>>();
  Result<Image<std::uint8_t>> mask = read_mask(plan.mask, plan.size, plan.mask_orientation);
  if (!mask) return std::move(mask).error();
  return std::optional(std::move(*mask));
}

// What a sensor of today has where no calibration measured it.
Response usual_response(const RawFrame& frame) {
  constexpr double kFullWell = 40000, kReadNoise = 4;  // electrons at ISO 100
  const double iso = frame.shot.iso > 0 ? frame.shot.iso : 100;
  Response response;
  response.electrons_per_count =
      kFullWell / (static_cast<double>(frame.white) - static_cast<double>(frame.black[0][0])) * 100 / iso;
  response.read_noise_counts = std::max(kReadNoise / response.electrons_per_count, std::sqrt(1.0 / 12));
  return response;
}

// As a photograph says, or one that it is compared with.
Radiometry::Exposure exposure_of(const Shot& shot) {
  constexpr double kSecond_us = 1e6, kIso = 100;
  return {shot.exposure_us > 0 ? shot.exposure_us : kSecond_us, shot.iso > 0 ? shot.iso : kIso};
}

// Counts of raw frames.
Result<void> read_mosaics(const SolvePlan& plan, const JobContext& context, Photographs& photographs,
                          FramesBeside& beside) {
  const std::vector<Shot> shots = plan.frames();
  Result<std::vector<RawFrame>> frames = read_frames<RawFrame>(shots, context, [&](const Shot& shot) {
    return capture::read_raw_shot(plan.session, shot, plan.size);
  });
  if (!frames) return std::move(frames).error();
  for (std::size_t i = 1; i < frames->size(); ++i) {
    if (Result<void> ok = check_levels((*frames)[i], frames->front(), plan.session.path_of(shots[i])); !ok)
      return ok;
  }
  Result<SettledLevels> settled = settle_levels(*frames, plan.lit.size(), plan.dark.has_value(),
                                                plan.calibration.response, context.threads);
  if (!settled) {
    Error error = std::move(settled).error();
    error.where = plan.session.path_of(plan.lit.front()).string();
    return error;
  }
  photographs.conditions.assumed = std::move(settled->said);
  std::vector<RawFrame> lit = take(*frames, plan.lit.size());
  if (Result<void> ok = check_filters(lit, plan, context.threads); !ok) return ok;
  std::optional<RawFrame> dark;
  if (plan.dark) dark = std::move(take(*frames, 1).front());
  const Response response = plan.calibration.response ? scaled(*plan.calibration.response, settled->scale)
                                                      : usual_response(lit.front());
  Mosaics mosaics(std::move(lit), std::move(dark), response, exposure_of(plan.lit.front()));
  Result<std::optional<Image<std::uint8_t>>> mask = mask_of(plan);
  if (!mask) return std::move(mask).error();
  mosaics.inside = std::move(*mask);
  beside.repeats = mosaics.alike(take(*frames, plan.repeats.size()));
  if (!plan.parallel.empty()) photographs.parallel = mosaics.alike(take(*frames, plan.parallel.size()));
  beside.brackets = take(*frames, plan.brackets.size());
  if (plan.blade) beside.blade = mosaics.alike(std::move(*frames));
  photographs.frames = std::move(mosaics);
  if (!plan.calibration.hot_picture) return {};
  Result<std::vector<Photosite>> known = photosites_named_by(*plan.calibration.hot_picture, plan.size);
  if (!known) return std::move(known).error();
  beside.known_bad = std::move(*known);
  return {};
}

void hide_outside(const Image<std::uint8_t>& mask, Image<float>& rgb) {
  for (int y = 0; y < rgb.height(); ++y) {
    for (int x = 0; x < rgb.width(); ++x) {
      if (mask(x, y) != 0) continue;
      for (int c = 0; c < 3; ++c) rgb(x, y, c) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

// Photographs beyond this lie on disk: a hundred lights are as many frames as ten scans have.
constexpr std::uint64_t kMostInMemory = std::uint64_t{1} << 30;

bool lie_on_disk(const SolvePlan& plan) {
  return !plan.raw &&
         12 * static_cast<std::uint64_t>(plan.size.pixels()) * plan.frames().size() > kMostInMemory;
}

// The folder for large files that may be lost; /tmp is often memory.
std::string scratch_folder() {
  const char* said = std::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe)
  return said != nullptr && *said != 0 ? said : "/var/tmp";
}

Result<Image<float>> moved_to_disk(const Image<float>& image) {
  const std::string folder = scratch_folder();
  std::optional<Image<float>> kept = Image<float>::on_disk(image.size(), image.planes(), folder.c_str());
  if (!kept) {
    return Error{ErrorKind::kCannotCreate, "there is no room for the photographs", folder,
                 "beyond 1 GB they are kept on disk, 12 bytes a pixel",
                 "free some room there, or name another folder in TMPDIR"};
  }
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < image.height(); ++y)
      std::copy_n(image.plane(p).row(y), image.width(), kept->plane(p).row(y));
  }
  page_out(*kept);
  return std::move(*kept);
}

// Readings of photographs that somebody developed: of a session over the light that its exposure gathers.
Result<void> read_developed(const SolvePlan& plan, const JobContext& context, Photographs& photographs,
                            FramesBeside& beside) {
  const Result<std::optional<Image<std::uint8_t>>> mask = mask_of(plan);
  if (!mask) return mask.error();
  const bool on_disk = lie_on_disk(plan);
  const auto read_one = [&](const Shot& shot) -> Result<Image<float>> {
    Result<Image<float>> image =
        plan.is_of_rig ? capture::read_developed_shot(plan.session, shot)
                       : read_linear_image(plan.session.path_of(shot), plan.transfer, plan.clipped);
    if (!image) return image;
    *image = as_shown(std::move(*image), plan.orientation);
    if (*mask) hide_outside(**mask, *image);
    return on_disk ? moved_to_disk(*image) : std::move(image);
  };
  Result<std::vector<Image<float>>> frames = read_frames<Image<float>>(plan.frames(), context, read_one);
  if (!frames) return std::move(frames).error();
  std::vector<Image<float>> lit = take(*frames, plan.lit.size());
  const std::vector<Image<float>> dark = take(*frames, plan.dark ? 1 : 0);
  const Shot& first = plan.lit.front();
  for (auto* list : {&lit, &*frames}) {
    for (Image<float>& image : *list) {
      if (!dark.empty()) subtract(image, dark.front());
      if (plan.ambient != 0) brighten(image, -plan.ambient);
      if (plan.is_of_rig) scale(image, 1 / (first.exposure_us * 1e-6 * first.iso / 100));
      if (on_disk) page_out(image);
    }
  }
  photographs.frames = Developed(std::move(lit), on_disk);
  beside.repeats = Developed(take(*frames, plan.repeats.size()), on_disk);
  if (!plan.parallel.empty()) photographs.parallel = Developed(take(*frames, plan.parallel.size()), on_disk);
  if (plan.blade) beside.blade = Developed(std::move(*frames), on_disk);
  return {};
}

// The share of what the surface mirrors, over that of what it scatters.
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
Result<void> check_memory(const SolvePlan& plan, int threads) {
  const std::uint64_t needed = memory_needed(plan, threads);
  const std::uint64_t free = available_memory_bytes();
  if (free == 0 || needed <= free) return {};
  const bool of_rig = plan.is_of_rig;
  return Error{ErrorKind::kTryAgain, "not enough memory",
               of_rig ? plan.where : plan.session.path_of(plan.lit.front()).string(),
               fmt::format("{} MB are needed, {} MB are free", needed >> 20, free >> 20),
               of_rig ? "close other programs, or solve on a larger machine"
                      : "use fewer or smaller photographs, or a larger machine"};
}

// The lights of the shots that are solved.
Result<LightField> field_of(const SolvePlan& plan) {
  Result<Lights> lights = select_lights(*plan.calibration.lights, plan.numbers());
  if (!lights) return std::move(lights).error();
  const double scattered = plan.session.films.scattered;
  if (plan.lit.front().polariser != Polariser::kNone && scattered != 1)
    lights = brightened(std::move(*lights), std::vector<double>(plan.lit.size(), scattered));
  return LightField::make(std::move(*lights), plan.calibration.camera, plan.size,
                          plan.session.cloth_height_mm);
}

// All but the frames.
Result<Photographs> described_by(const SolvePlan& plan) {
  Photographs photographs;
  photographs.size = plan.size;
  photographs.lobe_share = lobe_share_of(plan.lit.front().polariser, plan.session.films);
  photographs.albedo_scale = plan.calibration.subject.albedo_scale;
  if (plan.is_of_rig) photographs.leds = plan.numbers();
  Result<LightField> field = field_of(plan);
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  photographs.camera = plan.calibration.camera;
  photographs.spread = plan.calibration.spread;
  photographs.lateral = plan.calibration.lateral;
  photographs.light_covariance = plan.calibration.light_covariance;
  photographs.color = plan.calibration.color;
  photographs.conditions.warnings = plan.warnings;
  return photographs;
}

Result<Photographs> load_pose(const SolvePlan& plan, const JobContext& context) {
  const int threads = std::min(resolved_threads(context.threads), static_cast<int>(plan.frames().size()));
  if (Result<void> room = check_memory(plan, threads); !room) return std::move(room).error();
  Result<Photographs> photographs = described_by(plan);
  if (!photographs) return photographs;
  FramesBeside beside;
  const auto read = plan.raw ? read_mosaics : read_developed;
  if (Result<void> ok = read(plan, context, *photographs, beside); !ok) return std::move(ok).error();
  Stopwatch watch;
  if (Result<void> met = meet_conditions({plan, beside, *photographs, context}); !met)
    return std::move(met).error();
  photographs->conditions.seconds = watch.lap();
  photographs->plane_weights = measure_plane_weights(*photographs);
  return photographs;
}

// What the other pose says of the lobe, and is warned of in it.
Result<GlossSamples> sample_pose(const SolvePlan& plan, const JobContext& context,
                                 std::vector<std::string>& warnings) {
  const Result<Photographs> photographs = load_pose(plan, context);
  if (!photographs) return photographs.error();
  for (const std::string& warning : photographs->conditions.warnings)
    warnings.push_back("second pose: " + warning);
  const std::unique_ptr<solver::Method> robust = solver::robust_method();
  return sample_gloss(*photographs, *robust, nullptr, context.threads);
}

}  // namespace

std::uint64_t memory_needed(const SolvePlan& plan, int threads) {
  const auto pixels = static_cast<std::uint64_t>(plan.size.pixels());
  const std::size_t frames = plan.frames().size();
  if (!plan.is_of_rig) {
    const std::size_t held = lie_on_disk(plan) ? static_cast<std::size_t>(threads) : frames;
    return pixels * 12 * (held + 4);
  }
  const std::size_t decoding = std::min(static_cast<std::size_t>(threads), frames);
  const std::uint64_t bytes_a_pixel = plan.raw ? 2 : 12;
  const std::uint64_t of_level =
      plan.extent == solver::Extent::kWholeFrame ? pixels * reference_bytes_a_pixel(plan.raw ? 1 : 3) : 0;
  return pixels * bytes_a_pixel * (frames + decoding) + of_level +
         static_cast<std::uint64_t>(plan.size.width) * 128 * 150 + (std::uint64_t{64} << 20);
}

Result<Photographs> load_photographs(const SolvePlan& plan, const JobContext& context) {
  if (!plan.second_pose) return load_pose(plan, context);
  std::vector<std::string> warnings;
  Result<GlossSamples> samples = sample_pose(*plan.second_pose, context, warnings);
  if (!samples) return std::move(samples).error();
  Result<Photographs> photographs = load_pose(plan, context);
  if (!photographs) return photographs;
  photographs->second_pose = std::move(*samples);
  for (std::string& warning : warnings) photographs->conditions.warnings.push_back(std::move(warning));
  return photographs;
}

}  // namespace weft::solve
