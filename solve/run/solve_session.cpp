// SPDX-License-Identifier: Apache-2.0
#include "solve/run/solve_session.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/product.h"
#include "core/describe/field_json.h"
#include "core/solve/solve.h"
#include "core/solve/solve_record.h"
#include "solve/bands/albedo_color.h"
#include "solve/bands/bands.h"
#include "solve/bands/calibration_channels.h"
#include "solve/bands/sigma_channels.h"
#include "solve/conditions/exposure.h"
#include "solve/files/condition_map.h"
#include "solve/files/gloss_maps.h"
#include "solve/files/map_files.h"
#include "solve/files/pictures.h"
#include "solve/input/load.h"
#include "solve/input/session_photos.h"
#include "solve/levels/frame.h"
#include "solve/levels/shifts.h"
#include "solve/levels/stages.h"
#include "solve/report/left_out_report.h"
#include "solve/report/reflectance_report.h"
#include "solve/report/solve_report.h"
#include "solve/run/facts_json.h"
#include "solve/session/left_out_shots.h"
#include "solve/session/solved.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

// Pixels by status, gathered band by band.
class StatusTally {
 public:
  void add(View<const std::uint16_t> status) {
    for (int y = 0; y < status.height(); ++y) {
      const std::uint16_t* row = status.row(y);
      for (int x = 0; x < status.width(); ++x) ++seen_[row[x] % seen_.size()];
    }
  }
  std::int64_t with_both(StatusBit a, StatusBit b) const {
    std::int64_t count = 0;
    for (std::size_t status = 0; status < seen_.size(); ++status) {
      if ((status & a) && (status & b)) count += seen_[status];
    }
    return count;
  }
  StatusCounts counts() const {
    StatusCounts counts;
    for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
      for (std::size_t status = 0; status < seen_.size(); ++status) {
        if (status & kStatusNames[i].bit) counts.pixels[i] += seen_[status];
      }
    }
    return counts;
  }

 private:
  std::array<std::int64_t, std::size_t{1} << kStatusNames.size()> seen_ = {};
};

// All that the bytes of the maps depend on.
Json inputs_of(const SolveInput& input, const SolveOptions& options) {
  Json read = object_of(input);
  read.erase("session");  // the cloth's name is for people, who may change it
  Json inputs = {{"input", std::move(read)},
                 {"method", options.method},
                 {"compression", name_of(options.compression)},
                 {"solver_version", kSolverVersion}};
  if (!options.deblur) inputs["deblur"] = false;
  if (!options.registration) inputs["registration"] = false;
  if (options.condition) inputs["condition"] = true;
  if (const auto spread = said_spread(options)) inputs["cloth_spread"] = {spread->share, spread->mean_mm};
  return inputs;
}

// Room for the maps: normal 12, albedo 6, sigma 32, residual 2, status and pictures 4 bytes a pixel.
std::uint64_t bytes_of_maps(Size size) {
  return 56 * static_cast<std::uint64_t>(size.pixels());
}

Result<solver::MethodName> method_named(const std::string& name) {
  if (const solver::MethodName* found = solver::find_method(name)) return *found;
  return Error{ErrorKind::kUsage, "no such method", name, "", "see weft solve --help for their names"};
}

Json seconds_json(const SolveSeconds& seconds) {
  return {{"read", seconds.read},   {"prepare", seconds.prepare},   {"solve", seconds.solve},
          {"write", seconds.write}, {"pictures", seconds.pictures}, {"report", seconds.report}};
}

double seconds_until_published(const SolveSeconds& s) {
  return s.read + s.prepare + s.solve + s.write + s.pictures + s.report;
}

// A band as it is written.
struct FinishedBand {
  MapBand maps;
  std::vector<View<const float>> sigma;  // the channels of sigma.exr
  View<const float> calibration_deg;     // the calibration's share in the angle, if sigma has one
};

// What is done to a band on its way from the solver to the files: colours, the calibration's share, and the
// sum of all shares.
class Finish {
 public:
  // `photographs` must outlive it.
  static Result<Finish> make(const Photographs& photographs, int threads) {
    Finish finish;
    if (photographs.light_covariance) {
      Result<CalibrationChannels> made = CalibrationChannels::make(photographs, threads);
      if (!made) return std::move(made).error();
      finish.calibration_.emplace(std::move(*made));
    }
    if (photographs.color) finish.color_.emplace(*photographs.color, photographs.size.width, threads);
    finish.sigma_.emplace(photographs.size.width, finish.share_names());
    return finish;
  }

  const std::vector<std::string>& sigma_names() const { return sigma_->names(); }

  // Valid until the next call.
  FinishedBand of(const MapBand& solved) {
    std::vector<View<const float>> shares;
    if (calibration_) {
      const auto channels = calibration_->of(solved);
      shares.assign(channels.begin(), channels.end());
    }
    const MapBand band = color_ ? color_->of(solved, shares) : solved;
    return {band, sigma_->of(band, shares), calibration_ ? shares.back() : View<const float>()};
  }

 private:
  // Where the calibration has a share.
  std::vector<std::string> share_names() const {
    if (calibration_) return {"R", "G", "B", "normal_deg"};
    if (color_ && color_->has_covariance()) return {"R", "G", "B"};
    return {};
  }

  std::optional<CalibrationChannels> calibration_;
  std::optional<AlbedoColor> color_;
  std::optional<SigmaChannels> sigma_;
};

// Photographs as they are solved, and what was found on the way there.
struct Prepared {
  Photographs photographs;
  std::vector<std::string> warnings;
  std::vector<Verdict> of_frames, doubts;
  Fullness fullness;         // of the photographs as they were read
  SessionShifts shifts;      // of the photographs too
  std::vector<int> numbers;  // of photographs without a rig, by light
};

// What the maps leave behind for those who tell of them.
struct Made {
  explicit Made(Size size) : pictures(size), maps(size) {}

  Pictures pictures;
  MapSummary maps;
  PhotographsSummary summary;
  std::int64_t lost = 0;                        // pixels without a solution that have a saturated reading
  std::optional<ReflectanceFacts> reflectance;  // where a lobe was looked for
  std::vector<solver::BlockFacts> blocks;
};

// A solve under way. Its steps hand on what they found; all of them fill in the document and the seconds.
class Run {
 public:
  Run(const solver::MethodName& method, const SolvePlan& plan, const SolveOptions& options,
      const JobContext& context, const Product& product)
      : method_(method),
        plan_(plan),
        options_(options),
        context_(context),
        product_(product),
        partial_(product.folder) {
    facts_.id = product.id;
    facts_.solver_version = kSolverVersion;
    facts_.method = options.method;
    facts_.compression = options.compression;
    facts_.input = plan.input;
    facts_.assumed = plan.assumed;
    facts_.foretold = options.foretold;
  }

  // `loaded` are photographs that are in memory, registered; else those of the plan are read.
  Result<SolveReport> run(std::optional<Photographs> loaded) {
    Stopwatch total;
    const bool is_part = loaded.has_value();
    Result<Prepared> prepared = prepare(std::move(loaded));
    if (!prepared) return std::move(prepared).error();
    const Result<Made> made = make_maps(*prepared);
    if (!made) return made.error();
    // A part that is solved for a price may lie where no cloth is.
    if (facts_.pixels == 0 && !is_part)
      return nothing_solved(plan_.where, facts_.size, prepared->fullness, made->summary.of_session);
    if (Result<void> ok = describe(*made, prepared->fullness); !ok) return std::move(ok).error();
    if (Result<void> ok = publish(); !ok) return std::move(ok).error();
    seconds_.total = total.lap();
    return SolveReport{product_.folder,       false,    std::move(facts_),
                       made->maps.expected(), seconds_, made->blocks};
  }

 private:
  bool is_half() const { return method_.extent == solver::Extent::kHalfSize; }

  // Reads the photographs, and does with them what does not need their normals.
  Result<Prepared> prepare(std::optional<Photographs> loaded) {
    if (Result<void> begun = begin(partial_, bytes_of_maps(plan_.size)); !begun)
      return std::move(begun).error();
    const bool is_registered = loaded.has_value();
    if (!loaded) {
      Result<Photographs> read = load_photographs(plan_, context_);
      if (!read) return std::move(read).error();
      loaded = std::move(*read);
    }
    Prepared prepared;
    Photographs& photographs = prepared.photographs;
    photographs = *std::move(loaded);
    if (!options_.deblur) photographs.spread.reset();
    facts_.conditions = photographs.conditions.facts;
    prepared.warnings = photographs.conditions.warnings;
    prepared.of_frames = photographs.conditions.of_frames;
    prepared.doubts = photographs.conditions.doubts;
    std::ranges::copy(photographs.conditions.assumed, std::back_inserter(facts_.assumed));
    prepared.fullness = fullness_of(photographs);
    if (!plan_.is_of_rig) {
      prepared.numbers = plan_.numbers();
      for (const UnusedLed& left : facts_.conditions->left_out) std::erase(prepared.numbers, left.led);
    }
    seconds_.read = watch_.lap();
    seconds_.conditions = photographs.conditions.seconds;

    facts_.registration.emplace();
    if (is_half()) {
      Result<Photographs> half = half_size(photographs, context_.threads);
      if (!half) return std::move(half).error();
      photographs = std::move(*half);
    } else if (!is_registered && options_.registration) {
      if (Result<void> ok = register_cloth(prepared); !ok) return std::move(ok).error();
    }
    facts_.size = photographs.size;
    facts_.lights = static_cast<int>(photographs.count());
    facts_.albedo_scale = photographs.albedo_scale;
    facts_.is_rec709 = photographs.color.has_value();
    return prepared;
  }

  // Finds how the cloth lay in each shot, and leaves out those in which it lay elsewhere.
  Result<void> register_cloth(Prepared& prepared) {
    Result<SessionShifts> found = register_shots(prepared.photographs, context_);
    if (!found) return std::move(found).error();
    prepared.shifts = std::move(*found);
    facts_.registration = facts_of(prepared.shifts, prepared.photographs.leds);
    const std::vector<std::size_t> moved = prepared.shifts.with(ShiftVerdict::kLeftOut);
    for (auto k = moved.rbegin(); k != moved.rend(); ++k) {
      if (*k < prepared.numbers.size())
        prepared.numbers.erase(prepared.numbers.begin() + static_cast<std::ptrdiff_t>(*k));
    }
    return leave_out(moved, prepared.photographs);
  }

  // Solves into the files, and says of the photographs what must be said while they are in memory: they are
  // gone afterwards.
  Result<Made> make_maps(Prepared& prepared) {
    Photographs& photographs = prepared.photographs;
    Result<Finish> finish = Finish::make(photographs, context_.threads);
    if (!finish) return std::move(finish).error();
    const PixelPitch pitch_mm = pitch_in_the_middle(photographs);
    Result<MapFiles> files =
        MapFiles::open(partial_.path(), facts_.size, options_.compression, finish->sigma_names(), pitch_mm);
    if (!files) return std::move(files).error();
    seconds_.prepare = watch_.lap();

    Made made(facts_.size);
    const Result<FrameFacts> frame = solve_bands_into(*files, *finish, photographs, made);
    if (!frame) return frame.error();
    take_facts(*frame, made);
    if (Result<void> ok = judge(prepared, *frame, made); !ok) return std::move(ok).error();
    seconds_.report = watch_.lap();
    if (Result<void> ok = write_condition(photographs); !ok) return std::move(ok).error();
    photographs = {};

    if (Result<void> ok = files->finish(); !ok) return std::move(ok).error();
    if (frame->gloss) {
      Result<void> written = write_gloss_maps(partial_.path(), *frame->gloss, facts_.albedo_scale,
                                              options_.compression, pitch_mm, options_.previews);
      if (!written) return std::move(written).error();
    }
    seconds_.write = frame->waited_seconds + watch_.lap();
    return made;
  }

  // Band by band.
  Result<FrameFacts> solve_bands_into(MapFiles& files, Finish& finish, const Photographs& photographs,
                                      Made& made) {
    StatusTally tally;
    const auto keep = [&](const MapBand& solved) -> Result<void> {
      const FinishedBand band = finish.of(solved);
      tally.add(band.maps.status);
      made.maps.add(band.maps, band.sigma[kSumOfAngle], band.calibration_deg);
      if (options_.previews) made.pictures.add(band.maps);
      return files.write(band.maps, band.sigma);
    };
    Result<FrameFacts> frame =
        solve_frame(photographs, method_, options_.tile, context_, keep, options_.looks_at_blocks);
    if (!frame) return frame;
    seconds_.work = frame->work;
    seconds_.solve = watch_.lap() - frame->waited_seconds;
    facts_.status = tally.counts();
    facts_.pixels = facts_.size.pixels() - facts_.status.with(kNoSolution);
    made.lost = tally.with_both(kNoSolution, kSaturated);
    return frame;
  }

  void take_facts(const FrameFacts& frame, Made& made) {
    facts_.solved_by = facts_of(frame.tally);
    facts_.solved_by->robust_share = frame.robust_share;
    made.blocks = frame.blocks;
    if (frame.deblur) facts_.sharpening = facts_of(*frame.deblur);
    if (frame.lateral_corner_px) facts_.lateral_color = {*frame.lateral_corner_px};
    if (frame.gloss) {
      made.reflectance = reflectance_facts(*frame.gloss, facts_.albedo_scale);
      facts_.reflectance = summary_of(*made.reflectance);
    }
    if (frame.reference) {
      facts_.gates = facts_of(frame.reference->gates);
      facts_.reference = facts_of(*frame.reference);
    }
  }

  // What the photographs say of the rig and of themselves.
  Result<void> judge(const Prepared& prepared, const FrameFacts& frame, Made& made) {
    std::vector<std::string> warnings = prepared.warnings;
    if (frame.against_robust) warnings.push_back(in_words(*frame.against_robust, "by a robust solve"));
    if (frame.gloss && frame.gloss->metal_share > 0)
      warnings.push_back(
          fmt::format("metal: not solved here. {:.0f} percent of the cloth mirrors as no fibre does, and its "
                      "normals are those of a matt one",
                      100 * frame.gloss->metal_share));
    if (frame.gloss && frame.gloss->against)
      warnings.push_back(in_words(*frame.gloss->against, "with the lobe that fits best"));
    if (frame.reference) std::ranges::move(warnings_of(*frame.reference), std::back_inserter(warnings));
    PhotographsSummary& summary = made.summary;
    summary = summarize_photographs(prepared.photographs, prepared.numbers, warnings, context_);
    summary.of_frames = prepared.of_frames;
    summary.doubts = prepared.doubts;
    summary.session = plan_.session_name;
    summary.left_out = left_out(plan_.session);
    for (const Shot& shot : plan_.lit) summary.shot_of_led[shot.led] = shot.index;
    summary.shifts = prepared.shifts;
    if (frame.gloss) summary.glossy_share = frame.gloss->share;
    // Where shots could not be registered and readings do not fit, the cloth may have moved by far.
    if (may_have_moved_far(summary)) {
      Result<MovedShots> far = find_far_shifts(prepared.photographs, context_);
      if (!far) return std::move(far).error();
      summary.far_shifts = std::move(*far);
    }
    summary.shadow_reach_is_capped = frame.reference && frame.reference->shadow_reach_is_capped;
    if (frame.left_out) facts_.check = facts_of(*frame.left_out, summary.numbers);
    return {};
  }

  Result<void> write_condition(const Photographs& photographs) {
    if (!options_.condition) return {};
    Result<void> written = write_condition_map(photographs, facts_.method, partial_.path() / "condition.exr",
                                               options_.compression, context_);
    const double seconds = watch_.lap();
    seconds_.solve += seconds;
    seconds_.work.frame += seconds;
    return written;
  }

  // Writes the pictures beside the maps, with their error where there is a truth.
  Result<void> draw(const Pictures& pictures) {
    std::optional<TruthError> error;
    if (!plan_.truth.empty() && facts_.size == plan_.size) {
      Result<TruthError> measured =
          error_against(plan_.truth, partial_.path() / "normal.exr", context_.threads);
      if (!measured) return std::move(measured).error();
      error = std::move(*measured);
      const NormalComparison& normal = error->normal;
      facts_.error = {normal.mean_deg, normal.median_deg, normal.p95_deg, normal.max_deg};
    }
    Result<std::vector<std::string>> names =
        pictures.write(partial_.path(), plan_.session.fabric, facts_.albedo_scale == AlbedoScale::kAbsolute,
                       error ? &*error : nullptr, context_.threads);
    if (!names) return std::move(names).error();
    facts_.pictures = std::move(*names);
    if (is_there(partial_.path() / "reflectance.png")) facts_.pictures.emplace_back("reflectance.png");
    return {};
  }

  // Everything to be warned of, the exposure first.
  std::vector<Verdict> verdicts(const Made& made, const Fullness& fullness) const {
    // What leaves no shadow out takes much for a highlight.
    const bool tells_highlights = method_.level && !is_half();
    const auto pixels = static_cast<double>(facts_.size.pixels());
    const double specular = static_cast<double>(facts_.status.with(kSpecular)) / pixels;
    std::vector<Verdict> all = verdicts_of(made.summary, tells_highlights ? specular : 0,
                                           tells_highlights ? facts_.check : std::nullopt, method_.level);
    const std::optional<AngleMiddle>& noise = facts_.sigma_normal_deg->noise;
    const std::optional<Verdict> exposure =
        exposure_verdict(fullness, static_cast<double>(made.lost) / pixels, noise ? noise->median : 0,
                         made.summary.of_session);
    if (exposure) all.insert(all.begin(), *exposure);
    return all;
  }

  // What people look at, and solve.json.
  Result<void> describe(const Made& made, const Fullness& fullness) {
    if (options_.previews) {
      if (Result<void> drawn = draw(made.pictures); !drawn) return drawn;
    }
    seconds_.pictures = watch_.lap();
    facts_.sigma_normal_deg = made.maps.sigma_facts();
    facts_.warnings = verdicts(made, fullness);
    SolveReportFacts report =
        report_facts(plan_.session.fabric, facts_, made.summary, made.maps, seconds_json(seconds_));
    if (made.reflectance) {
      Result<void> ok = write_json(partial_.path() / "reflectance.json", object_of(*made.reflectance));
      if (!ok) return ok;
      report.reflectance = made.reflectance;
      report.gloss = reflectance_said(*made.reflectance);
    }
    if (Result<void> ok = write_report(partial_.path(), report); !ok) return ok;
    seconds_.report += watch_.lap();
    const ExpectedError expected = made.maps.expected();
    facts_.taken = {seconds_until_published(seconds_), expected.total_deg, expected.solved,
                    seconds_json(seconds_)};
    Json said = json_of(facts_);
    if (!options_.plan.empty()) said["plan"] = options_.plan;
    return write_json(partial_.path() / kSolveProduct.document, said);
  }

  Result<void> publish() {
    if (context_.stop.stop_requested()) return interrupted();
    if (Result<void> ok = partial_.publish(); !ok) return ok;
    seconds_.sync = watch_.lap();
    return {};
  }

  const solver::MethodName& method_;
  const SolvePlan& plan_;
  const SolveOptions& options_;
  const JobContext& context_;
  const Product& product_;
  PartialFolder partial_;
  Stopwatch watch_;
  SolveFacts facts_;
  SolveSeconds seconds_;
};

// A person asks for what a batch made: it waits no longer, and is as new as if it were made now.
void end_waiting(const Product& product, Json document) {
  document.erase("plan");
  if (!write_json(product.folder / kSolveProduct.document, document)) return;  // of an archive
  std::error_code ignored;
  fs::last_write_time(product.folder.parent_path(), fs::file_time_type::clock::now(), ignored);
}

Result<SolveReport> solve(const solver::MethodName& method, const SolvePlan& plan,
                          const SolveOptions& options, const JobContext& context,
                          std::optional<Photographs> loaded = {}) {
  const Product product =
      product_of(kSolveProduct, inputs_of(plan.input, options), plan.solves, options.output);
  Result<std::optional<Json>> finished = find_finished(product);
  if (!finished) return std::move(finished).error();
  if (*finished) {
    Result<SolveFacts> facts =
        solve_facts_from_json(**finished, (product.folder / kSolveProduct.document).string());
    if (!facts) return std::move(facts).error();
    if (options.plan.empty() && (*finished)->contains("plan")) end_waiting(product, **finished);
    return SolveReport{product.folder, true, std::move(*facts), {}, {}};
  }
  return Run(method, plan, options, context, product).run(std::move(loaded));
}

}  // namespace

std::optional<solver::ClothSpread> said_spread(const SolveOptions& options) {
  if (!options.cloth_spread) return std::nullopt;
  return solver::ClothSpread{*options.cloth_spread, options.spread_distance_mm};
}

std::string id_of_solve(const SolvePlan& plan, const SolveOptions& options) {
  return product_id(inputs_of(plan.input, options));
}

Result<SolveReport> solve_session(const SessionOptions& input, const SolveOptions& options,
                                  const JobContext& context) {
  const Result<solver::MethodName> method = method_named(options.method);
  if (!method) return method.error();
  SessionOptions session = input;
  session.clipped = method->keeps_clipped ? Clipped::kKeep : Clipped::kMark;
  Result<SolvePlan> plan = plan_session(session);
  if (!plan) return std::move(plan).error();
  plan->extent = method->extent;
  plan->asks_frames = true;
  plan->cloth_spread = said_spread(options);
  if (!options.second_pose.empty()) {
    Result<void> second = plan_second_pose(options.second_pose, *method, input, *plan);
    if (!second) return std::move(second).error();
  }
  Result<SolveReport> report = solve(*method, *plan, options, context);
  if (!report || plan->is_of_rig) return report;
  const PhotoReading reading = reading_of(input, plan->session);
  if (Result<void> kept = keep_reading(input.folder, reading); !kept) return std::move(kept).error();
  return report;
}

Result<SolveReport> solve_photos(const PhotoOptions& input, const SolveOptions& options,
                                 const JobContext& context) {
  const Result<solver::MethodName> method = method_named(options.method);
  if (!method) return method.error();
  PhotoOptions photos = input;
  photos.clipped = method->keeps_clipped ? Clipped::kKeep : Clipped::kMark;
  Result<SolvePlan> plan = plan_photos(photos);
  if (!plan) return plan.error();
  plan->asks_frames = true;
  plan->cloth_spread = said_spread(options);
  Result<SolveReport> report = solve(*method, *plan, options, context);
  if (!report) return report;
  std::optional<double> mm_per_pixel = photos.reading.mm_per_pixel;
  if (Result<void> kept = keep_pixel(report->folder, mm_per_pixel); !kept) return std::move(kept).error();
  return report;
}

Result<SolveReport> solve_loaded(Photographs photographs, const SolveOptions& options,
                                 const JobContext& context) {
  const Result<solver::MethodName> method = method_named(options.method);
  if (!method) return method.error();
  SolvePlan plan;
  plan.size = photographs.size;
  return solve(*method, plan, options, context, std::move(photographs));
}

}  // namespace weft::solve
