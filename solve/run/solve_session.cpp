// SPDX-License-Identifier: Apache-2.0
#include "solve/run/solve_session.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
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
#include "solve/conditions/fullness.h"
#include "solve/files/condition_map.h"
#include "solve/files/gloss_maps.h"
#include "solve/files/map_files.h"
#include "solve/files/pictures.h"
#include "solve/gloss/sample_gloss.h"
#include "solve/levels/frame.h"
#include "solve/levels/shifts.h"
#include "solve/levels/stages.h"
#include "solve/report/left_out_report.h"
#include "solve/report/reflectance_report.h"
#include "solve/report/solve_report.h"
#include "solve/run/exposure_verdict.h"
#include "solve/run/facts_json.h"
#include "solve/session/left_out_shots.h"

namespace weft::app {
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

// One solve, whatever it starts from.
struct Input {
  std::string title;
  SolveInput input;  // all that the id depends on besides the options
  Size size;
  fs::path default_parent;  // of the output
  fs::path truth;           // normal.exr of a simulated session, or empty
  std::vector<int> picked;  // numbers of photographs picked from a list
  std::function<Result<LoadedSession>()> load;
  bool is_registered = false;  // photographs come with their shifts
  const SessionPlan* of = nullptr;
};

Json seconds_json(const SolveSeconds& seconds) {
  return {{"read", seconds.read},   {"prepare", seconds.prepare},   {"solve", seconds.solve},
          {"write", seconds.write}, {"pictures", seconds.pictures}, {"report", seconds.report}};
}

double seconds_until_published(const SolveSeconds& s) {
  return s.read + s.prepare + s.solve + s.write + s.pictures + s.report;
}

// A band as it is written.
struct FinishedBand {
  pipeline::MapBand maps;
  std::vector<View<const float>> sigma;  // the channels of sigma.exr
  View<const float> calibration_deg;     // of them the calibration's share in the angle, if it has one
};

// What is done to a band on its way from the solver to the files: colours, the calibration's share, and the
// sum of all shares.
class Finish {
 public:
  // `photographs` must outlive it.
  static Result<Finish> make(const pipeline::Photographs& photographs, int threads) {
    Finish finish;
    if (photographs.light_covariance) {
      Result<pipeline::CalibrationChannels> made = pipeline::CalibrationChannels::make(photographs, threads);
      if (!made) return std::move(made).error();
      finish.calibration_.emplace(std::move(*made));
    }
    if (photographs.color) finish.color_.emplace(*photographs.color, photographs.size.width, threads);
    finish.sigma_.emplace(photographs.size.width, finish.share_names());
    return finish;
  }

  const std::vector<std::string>& sigma_names() const { return sigma_->names(); }

  // Valid until the next call.
  FinishedBand of(const pipeline::MapBand& solved) {
    std::vector<View<const float>> shares;
    if (calibration_) {
      const auto channels = calibration_->of(solved);
      shares.assign(channels.begin(), channels.end());
    }
    const pipeline::MapBand band = color_ ? color_->of(solved, shares) : solved;
    return {band, sigma_->of(band, shares), calibration_ ? shares.back() : View<const float>()};
  }

 private:
  // Where the calibration has a share.
  std::vector<std::string> share_names() const {
    if (calibration_) return {"R", "G", "B", "normal_deg"};
    if (color_ && color_->has_covariance()) return {"R", "G", "B"};
    return {};
  }

  std::optional<pipeline::CalibrationChannels> calibration_;
  std::optional<pipeline::AlbedoColor> color_;
  std::optional<pipeline::SigmaChannels> sigma_;
};

// A solve under way: its steps in their order.
class Run {
 public:
  Run(const solver::MethodName& method, const Input& input, const SolveOptions& options,
      const JobContext& context, const Product& product)
      : method_(method),
        input_(input),
        options_(options),
        context_(context),
        product_(product),
        partial_(product.folder),
        picked_(input.picked) {
    facts_.id = product.id;
    facts_.solver_version = kSolverVersion;
    facts_.method = options.method;
    facts_.compression = options.compression;
    facts_.input = input.input;
    facts_.foretold = options.foretold;
  }

  Result<SolveReport> run() {
    Stopwatch total;
    if (Result<void> ok = prepare(); !ok) return std::move(ok).error();
    if (Result<void> ok = solve_into_files(); !ok) return std::move(ok).error();
    // A part that is solved for a price may lie where no cloth is.
    if (facts_.pixels == 0 && !input_.is_registered)
      return nothing_solved(input_.of != nullptr ? input_.of->session.folder.string() : input_.title,
                            facts_.size, fullness_, summary_.of_session);
    if (Result<void> ok = describe(); !ok) return std::move(ok).error();
    if (Result<void> ok = publish(); !ok) return std::move(ok).error();
    seconds_.total = total.lap();
    return SolveReport{product_.folder, false, std::move(facts_), maps_->expected(), {}, seconds_};
  }

 private:
  bool is_half() const { return method_.extent == solver::Extent::kHalfSize; }

  // Reads the photographs, and does with them what does not need their normals.
  Result<void> prepare() {
    if (Result<void> begun = begin(partial_, bytes_of_maps(input_.size)); !begun) return begun;
    Result<LoadedSession> loaded = input_.load();
    if (!loaded) return std::move(loaded).error();
    photographs_ = std::move(loaded->photographs);
    facts_.conditions = facts_of(loaded->conditions);
    warnings_ = std::move(loaded->warnings);
    fullness_ = pipeline::fullness_of(photographs_);
    seconds_.read = watch_.lap();

    facts_.registration.emplace();
    if (is_half()) {
      Result<pipeline::Photographs> half = half_size(photographs_, context_.threads);
      if (!half) return std::move(half).error();
      photographs_ = std::move(*half);
    } else if (!input_.is_registered && options_.registration) {
      if (Result<void> ok = register_cloth(); !ok) return ok;
    }
    facts_.size = photographs_.size;
    facts_.lights = static_cast<int>(photographs_.count());
    facts_.albedo_scale = photographs_.albedo_scale;
    facts_.is_rec709 = photographs_.color.has_value();
    return {};
  }

  // Finds how the cloth lay in each shot, and leaves out those in which it lay elsewhere.
  Result<void> register_cloth() {
    Result<pipeline::SessionShifts> found = register_shots(photographs_, context_);
    if (!found) return std::move(found).error();
    shifts_ = std::move(*found);
    facts_.registration = facts_of(shifts_, photographs_.leds);
    const std::vector<std::size_t> moved = shifts_.with(pipeline::ShiftVerdict::kLeftOut);
    for (std::size_t k = picked_.size(); k < photographs_.count(); ++k)
      picked_.push_back(static_cast<int>(k) + 1);
    for (auto k = moved.rbegin(); k != moved.rend(); ++k)
      picked_.erase(picked_.begin() + static_cast<std::ptrdiff_t>(*k));
    return leave_out(moved, photographs_);
  }

  Result<void> solve_into_files() {
    Result<Finish> finish = Finish::make(photographs_, context_.threads);
    if (!finish) return std::move(finish).error();
    const PixelPitch pitch_mm = pitch_in_the_middle(photographs_);
    Result<MapFiles> files =
        MapFiles::open(partial_.path(), facts_.size, options_.compression, finish->sigma_names(), pitch_mm);
    if (!files) return std::move(files).error();
    seconds_.prepare = watch_.lap();

    pictures_.emplace(facts_.size);
    maps_.emplace(facts_.size);
    StatusTally tally;
    const auto keep = [&](const pipeline::MapBand& solved) -> Result<void> {
      const FinishedBand band = finish->of(solved);
      tally.add(band.maps.status);
      maps_->add(band.maps, band.sigma[pipeline::kSumOfAngle], band.calibration_deg);
      if (options_.previews) pictures_->add(band.maps);
      return files->write(band.maps, band.sigma);
    };
    std::vector<pipeline::Stage> stages = pipeline::stages_of(method_);
    if (!options_.deblur) stages = pipeline::without("sharpen", std::move(stages));
    Result<pipeline::FrameFacts> frame = solve_by(stages, photographs_, options_.tile, context_, keep);
    if (!frame) return std::move(frame).error();
    seconds_.work = frame->work;
    seconds_.solve = watch_.lap() - frame->waited_seconds;
    facts_.status = tally.counts();
    lost_ = tally.with_both(kNoSolution, kSaturated);
    facts_.pixels = facts_.size.pixels() - facts_.status.with(kNoSolution);
    take_facts(*frame);
    summary_ = summarize_photographs(photographs_, picked_, warnings_, context_);
    if (input_.of != nullptr) {
      summary_.session = absolute_folder(input_.of->session.folder).filename().string();
      summary_.left_out = library::left_out(input_.of->session);
      for (const Shot& shot : input_.of->lit) summary_.shot_of_led[shot.led] = shot.index;
    }
    summary_.shifts = std::move(shifts_);
    if (Result<void> ok = look_for_far_shifts(); !ok) return ok;
    if (frame->gloss) summary_.glossy_share = frame->gloss->share;
    summary_.shadow_reach_is_capped = frame->reference && frame->reference->shadow_reach_is_capped;
    if (frame->left_out) facts_.check = facts_of(*frame->left_out, summary_.numbers);
    seconds_.report = watch_.lap();
    if (Result<void> ok = write_condition(); !ok) return ok;
    photographs_ = {};  // their memory is needed for nothing more

    if (Result<void> ok = files->finish(); !ok) return ok;
    if (frame->gloss) {
      const Result<void> written = write_gloss_maps(partial_.path(), *frame->gloss, facts_.albedo_scale,
                                                    options_.compression, pitch_mm, options_.previews);
      if (!written) return written;
    }
    seconds_.write = frame->waited_seconds + watch_.lap();
    return {};
  }

  void take_facts(const pipeline::FrameFacts& frame) {
    facts_.solved_by = facts_of(frame.tally);
    facts_.solved_by->robust_share = frame.robust_share;
    if (frame.deblur) facts_.sharpening = facts_of(*frame.deblur);
    if (frame.lateral_corner_px) facts_.lateral_color = {*frame.lateral_corner_px};
    if (frame.gloss) {
      reflectance_ = reflectance_facts(*frame.gloss, facts_.albedo_scale);
      facts_.reflectance = summary_of(*reflectance_);
    }
    if (frame.reference) {
      facts_.gates = facts_of(frame.reference->gates);
      facts_.reference = facts_of(*frame.reference);
      for (std::string& said : warnings_of(*frame.reference)) warnings_.push_back(std::move(said));
    }
  }

  // Where shots could not be registered and readings do not fit, the cloth may have moved by far.
  Result<void> look_for_far_shifts() {
    if (!may_have_moved_far(summary_)) return {};
    Result<pipeline::FarShifts> far = find_far_shifts(photographs_, context_);
    if (!far) return std::move(far).error();
    summary_.far_shifts = std::move(*far);
    return {};
  }

  Result<void> write_condition() {
    if (!options_.condition) return {};
    Result<void> written = write_condition_map(photographs_, facts_.method, partial_.path() / "condition.exr",
                                               options_.compression, context_);
    const double seconds = watch_.lap();
    seconds_.solve += seconds;
    seconds_.work.frame += seconds;
    return written;
  }

  // Writes the pictures beside the maps, with their error where there is a truth.
  Result<void> draw() {
    std::optional<TruthError> error;
    if (!input_.truth.empty() && facts_.size == input_.size) {
      Result<TruthError> measured = error_against(input_.truth, partial_.path() / "normal.exr");
      if (!measured) return std::move(measured).error();
      error = std::move(*measured);
      const NormalComparison& normal = error->normal;
      facts_.error = {normal.mean_deg, normal.median_deg, normal.p95_deg, normal.max_deg};
    }
    Result<std::vector<std::string>> names =
        pictures_->write(partial_.path(), input_.title, facts_.albedo_scale == AlbedoScale::kAbsolute,
                         error ? &*error : nullptr);
    if (!names) return std::move(names).error();
    facts_.pictures = std::move(*names);
    if (is_there(partial_.path() / "reflectance.png")) facts_.pictures.emplace_back("reflectance.png");
    return {};
  }

  // What people look at, and solve.json.
  Result<void> describe() {
    if (options_.previews) {
      if (Result<void> drawn = draw(); !drawn) return drawn;
    }
    seconds_.pictures = watch_.lap();
    // What leaves no shadow out takes much for a highlight.
    const bool tells_highlights = method_.level && !is_half();
    const double specular =
        static_cast<double>(facts_.status.with(kSpecular)) / static_cast<double>(facts_.size.pixels());
    const ExpectedError expected = maps_->expected();
    facts_.sigma_normal_deg = maps_->sigma_facts();
    facts_.warnings = verdicts_of(summary_, tells_highlights ? specular : 0,
                                  tells_highlights ? facts_.check : std::nullopt, method_.level);
    const std::optional<AngleMiddle>& noise = facts_.sigma_normal_deg->noise;
    const std::optional<Verdict> exposure =
        exposure_verdict(fullness_, static_cast<double>(lost_) / static_cast<double>(facts_.size.pixels()),
                         noise ? noise->median : 0, summary_.of_session);
    if (exposure) facts_.warnings.insert(facts_.warnings.begin(), *exposure);
    SolveReportFacts report = report_facts(input_.title, facts_, summary_, *maps_, seconds_json(seconds_));
    if (reflectance_) {
      Result<void> ok = write_json(partial_.path() / "reflectance.json", object_of(*reflectance_));
      if (!ok) return ok;
      report.reflectance = reflectance_;
      report.gloss = reflectance_said(*reflectance_);
    }
    if (Result<void> ok = write_report(partial_.path(), report); !ok) return ok;
    seconds_.report += watch_.lap();
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
  const Input& input_;
  const SolveOptions& options_;
  const JobContext& context_;
  const Product& product_;
  PartialFolder partial_;
  Stopwatch watch_;
  pipeline::Photographs photographs_;
  std::vector<int> picked_;  // numbers of the photographs of a list, by light
  pipeline::SessionShifts shifts_;
  pipeline::Fullness fullness_;  // of the photographs as they were read
  std::int64_t lost_ = 0;        // pixels without a solution that have a saturated reading
  std::vector<std::string> warnings_;
  std::optional<ReflectanceFacts> reflectance_;  // where a lobe was looked for
  SolveFacts facts_;
  SolveSeconds seconds_;
  std::optional<Pictures> pictures_;
  std::optional<MapSummary> maps_;
  PhotographsSummary summary_;
};

// A person asks for what a batch made: it waits no longer, and is as new as if it were made now.
void end_waiting(const Product& product, Json document) {
  document.erase("plan");
  if (!write_json(product.folder / kSolveProduct.document, document)) return;  // of an archive
  std::error_code ignored;
  fs::last_write_time(product.folder.parent_path(), fs::file_time_type::clock::now(), ignored);
}

Result<SolveReport> solve(const solver::MethodName& method, const Input& input, const SolveOptions& options,
                          const JobContext& context) {
  const Product product =
      product_of(kSolveProduct, inputs_of(input.input, options), input.default_parent, options.output);
  Result<std::optional<Json>> finished = find_finished(product);
  if (!finished) return std::move(finished).error();
  if (*finished) {
    Result<SolveFacts> facts =
        solve_facts_from_json(**finished, (product.folder / kSolveProduct.document).string());
    if (!facts) return std::move(facts).error();
    if (options.plan.empty() && (*finished)->contains("plan")) end_waiting(product, **finished);
    return SolveReport{product.folder, true, std::move(*facts), {}, {}, {}};
  }
  return Run(method, input, options, context, product).run();
}

Result<std::optional<SessionPlan>> plan_second_pose(const solver::MethodName& method,
                                                    const SessionPlan& first, const SessionOptions& input,
                                                    const SolveOptions& options) {
  if (options.second_pose.empty()) return std::optional<SessionPlan>();
  const auto unfit = [&](ErrorKind kind, std::string why, std::string remedy) {
    return Error{kind, "second pose cannot be used", options.second_pose.string(), std::move(why),
                 std::move(remedy)};
  };
  if (method.level != solver::Level::kRobust && method.level != solver::Level::kReference)
    return unfit(ErrorKind::kUsage, options.method + " seeks no lobe",
                 "solve with --quality robust or reference");
  Result<SessionPlan> second =
      plan_session({.folder = options.second_pose, .calibration = input.calibration, .leds = input.leds});
  if (!second) return std::move(second).error();
  if (second->input == first.input)
    return unfit(ErrorKind::kUsage, "it is the session that is solved", "name the scan of the other pose");
  if (second->calibration.id != first.calibration.id)
    return unfit(ErrorKind::kBadData, "it was scanned with another calibration", "scan both poses in one go");
  if (second->parallel.empty() != first.parallel.empty())
    return unfit(ErrorKind::kBadData,
                 "one of the two was scanned through crossed and parallel films, the other was not",
                 "scan both in the same way");
  return std::optional(std::move(*second));
}

// The frames of one pose at a time.
Result<LoadedSession> load_poses(const SessionPlan& plan, const std::optional<SessionPlan>& second,
                                 const JobContext& context) {
  if (!second) return load_session(plan, context);
  std::optional<pipeline::GlossSamples> samples;
  std::vector<std::string> warnings;
  {
    const Result<LoadedSession> other = load_session(*second, context);
    if (!other) return other.error();
    for (const std::string& warning : other->warnings) warnings.push_back("second pose: " + warning);
    const std::unique_ptr<solver::Method> robust = solver::robust_method();
    Result<pipeline::GlossSamples> sampled =
        sample_gloss(other->photographs, *robust, nullptr, context.threads);
    if (!sampled) return std::move(sampled).error();
    samples = std::move(*sampled);
  }
  Result<LoadedSession> loaded = load_session(plan, context);
  if (!loaded) return loaded;
  loaded->photographs.second_pose = std::move(samples);
  std::ranges::move(warnings, std::back_inserter(loaded->warnings));
  return loaded;
}

}  // namespace

std::string id_of_solve(const SessionPlan& plan, const SolveOptions& options) {
  return product_id(inputs_of(plan.input, options));
}

Result<SolveReport> solve_session(const SessionOptions& input, const SolveOptions& options,
                                  const JobContext& context) {
  const Result<solver::MethodName> method = method_named(options.method);
  if (!method) return method.error();
  Result<SessionPlan> plan = plan_session(input);
  if (!plan) return std::move(plan).error();
  plan->extent = method->extent;
  Result<std::optional<SessionPlan>> second = plan_second_pose(*method, *plan, input, options);
  if (!second) return std::move(second).error();
  if (*second) plan->input.second_pose = object_of((*second)->input);
  const fs::path truth = plan->session.folder / "truth" / "normal.exr";
  return solve(*method,
               {.title = plan->session.fabric,
                .input = plan->input,
                .size = plan->size,
                .default_parent = plan->session.folder / "solve",
                .truth = is_there(truth) ? truth : fs::path(),
                .picked = {},
                .load = [&] { return load_poses(*plan, *second, context); },
                .of = &*plan},
               options, context);
}

Result<SolveReport> solve_photos(const PhotoOptions& input, const SolveOptions& options,
                                 const JobContext& context) {
  const Result<solver::MethodName> method = method_named(options.method);
  if (!method) return method.error();
  PhotoOptions photos = input;
  photos.clipped = method->keeps_clipped ? Clipped::kKeep : Clipped::kMark;
  Result<PhotoPlan> plan = plan_photos(photos);
  if (!plan) return std::move(plan).error();
  const fs::path source =
      fs::absolute(input.light_file.empty() ? input.folder : input.light_file).lexically_normal();
  const fs::path name = source.has_filename() ? source.stem() : source.parent_path().filename();
  Result<SolveReport> report = solve(*method,
                                     {.title = name.string(),
                                      .input = plan->input,
                                      .size = plan->size,
                                      .default_parent = fs::current_path() / (name.string() + "-solve"),
                                      .truth = {},
                                      .picked = input.lights,
                                      .load = [&]() -> Result<LoadedSession> {
                                        Result<pipeline::Photographs> photographs =
                                            load_photos(*plan, context);
                                        if (!photographs) return std::move(photographs).error();
                                        return LoadedSession{std::move(*photographs), {}, {}};
                                      }},
                                     options, context);
  if (report) report->transfer = plan->transfer;
  return report;
}

Result<SolveReport> solve_loaded(pipeline::Photographs photographs, const SolveOptions& options,
                                 const JobContext& context) {
  const Result<solver::MethodName> method = method_named(options.method);
  if (!method) return method.error();
  return solve(*method,
               {.title = {},
                .input = {},
                .size = photographs.size,
                .default_parent = {},
                .truth = {},
                .picked = {},
                .load = [&]() -> Result<LoadedSession> {
                  return LoadedSession{std::move(photographs), {}, {}};
                },
                .is_registered = true},
               options, context);
}

}  // namespace weft::app
