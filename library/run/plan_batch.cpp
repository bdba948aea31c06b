// SPDX-License-Identifier: Apache-2.0
#include "library/run/plan_batch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error_kind.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/solve/solve.h"
#include "core/solve/solve_record.h"
#include "exchange/export/preset_files.h"
#include "library/batch/choice.h"
#include "library/batch/forecast.h"
#include "library/batch/outcome.h"
#include "library/run/follow_ups.h"
#include "library/run/lean.h"
#include "library/run/plan_file.h"
#include "library/run/sample.h"
#include "library/run/survey.h"
#include "solve/report/solve_report.h"
#include "solver/method.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// The folder that holds all of them.
fs::path archive_of(const std::vector<fs::path>& sessions) {
  if (sessions.empty()) return {};
  fs::path common = sessions.front().parent_path();
  for (const fs::path& session : sessions) {
    while (session.lexically_relative(common).empty() || *session.lexically_relative(common).begin() == "..")
      common = common.parent_path();
  }
  return common;
}

// The levels that a plan knows: where one is asked for that one, else all.
Result<std::vector<std::size_t>> levels_of(const PlanBatchOptions& options) {
  const std::vector<std::string> names = level_names();
  std::vector<std::size_t> levels;
  const bool is_fixed = !options.to_deg && !options.within_seconds;
  for (std::size_t l = 0; l < names.size(); ++l) {
    if (!is_fixed || names[l] == options.quality) levels.push_back(l);
  }
  if (!levels.empty()) return levels;
  return Error{ErrorKind::kUsage, "no such level", options.quality, fmt::format("{}", fmt::join(names, ", ")),
               "name one of them"};
}

bool can_follow(const std::string& then) {
  constexpr std::string_view kExport = "export:";
  return then == "maps" || (then.starts_with(kExport) && then.size() > kExport.size());
}

// A batch under plan. Candidates that can be solved have a forecast for each of levels_.
class Planning {
 public:
  Planning(const PlanBatchOptions& options, std::vector<std::size_t> levels, const JobContext& context)
      : options_(options), context_(context), levels_(std::move(levels)) {}

  Result<PlanBatchReport> plan() {
    Stopwatch watch;
    if (Result<void> ok = look(); !ok) return std::move(ok).error();
    double seconds = watch.lap();
    if (Result<void> ok = measure(); !ok) return std::move(ok).error();
    plan_.header.sample_seconds = watch.lap();
    if (Result<void> ok = decide(); !ok) return std::move(ok).error();
    add_totals();
    share_out(plan_.solves, 60 * options_.task_minutes);
    const std::string text = text_of(plan_);
    if (const Result<void> written = write_plan(options_.plan, text); !written) return written.error();
    seconds += watch.lap();
    return PlanBatchReport{std::move(plan_), absolute_folder(options_.plan), seconds};
  }

 private:
  Result<void> look() {
    Result<std::vector<fs::path>> sessions = sessions_below(options_.sessions);
    if (!sessions) return std::move(sessions).error();
    if (sessions->empty()) {
      return Error{ErrorKind::kNoInput, "there is nothing to plan",
                   options_.sessions.empty() ? "" : options_.sessions.front(), "no session lies there",
                   "name folders of sessions, or folders that hold some"};
    }
    Result<std::vector<NamedCalibration>> named = read_named(options_.calibrations);
    if (!named) return std::move(named).error();
    BatchHeader& header = plan_.header;
    header.archive = archive_of(*sessions).string();
    header.output = options_.output.empty() ? "" : absolute_folder(options_.output).string();
    header.product = options_.product;
    header.calibrations = std::move(*named);
    header.solver_version = kSolverVersion;
    header.threads = resolved_threads(context_.threads);
    Result<std::vector<Candidate>> found = survey(*sessions, {header, header.threads}, context_);
    if (!found) return std::move(found).error();
    for (Candidate& candidate : *found) {
      if (candidate.error) {
        leave_out(candidate, *candidate.error);
      } else {
        candidates_.push_back(std::move(candidate));
      }
    }
    return check_named();
  }

  // A calibration that no session is of is named by mistake.
  Result<void> check_named() const {
    for (const NamedCalibration& named : plan_.header.calibrations) {
      const bool is_used = std::ranges::any_of(
          candidates_, [&](const Candidate& each) { return each.traits.calibration == named.id; });
      if (is_used) continue;
      std::string why = fmt::format("no session can be solved by it; it is of rig \"{}\"", named.rig);
      if (!plan_.left_out.empty()) why += "; " + plan_.left_out.front().said;
      return Error{ErrorKind::kBadData, "calibration suits no session", named.folder, why,
                   "name the calibration of these sessions' rig"};
    }
    return {};
  }

  void leave_out(const Candidate& candidate, const Error& error) {
    plan_.left_out.push_back(
        {candidate.input.folder.string(), SkipReason::kUnsolvable, name_of(error.kind), error.message(), 0});
  }

  // Sessions that would be solved, whatever the level, are worth measuring.
  Result<void> measure() {
    std::vector<SessionTraits> traits, open;
    std::vector<std::size_t> of_open;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      traits.push_back(candidates_[i].traits);
      if (is_done(candidates_[i])) continue;
      open.push_back(candidates_[i].traits);
      of_open.push_back(i);
    }
    std::vector<MeasuredSession> measured;
    std::vector<std::size_t> unfit, sample = choose_sample(open, static_cast<std::size_t>(options_.sample));
    for (std::size_t& each : sample) each = of_open[each];
    const JobContext silent = {context_.threads, context_.stop};
    std::optional<solve::SharedSeconds> shared;
    const std::optional<solver::Level> only =
        is_fixed() ? solver::find_method(level_names()[levels_.front()])->level : std::nullopt;
    for (std::size_t k = 0; k < sample.size(); ++k) {
      context_.progress("measure", static_cast<double>(k) / static_cast<double>(sample.size()));
      Result<std::vector<Forecast>> levels = measure_session(
          candidates_[sample[k]], {.product = options_.product, .only = only, .shared = shared}, silent);
      if (context_.stop.stop_requested()) return interrupted();
      if (levels) {
        measured.push_back({sample[k], std::move(*levels)});
        if (Result<void> ok = measure_follow_ups(candidates_[sample[k]]); !ok) return ok;
      } else if (levels.error().kind == ErrorKind::kTryAgain ||
                 levels.error().kind == ErrorKind::kInputOutput) {
        return std::move(levels).error();
      } else {
        leave_out(candidates_[sample[k]], levels.error());
        unfit.push_back(sample[k]);
      }
    }
    if (!sample.empty()) context_.progress("measure", 1);
    if (follow_ups_.empty() && refused_) return *refused_;
    plan_.header.sampled = static_cast<int>(measured.size());
    forecasts_ = carry_over(traits, measured);
    if (forecasts_.empty()) forecasts_.assign(candidates_.size(), std::vector<Forecast>(levels_.size()));
    for (auto i = unfit.rbegin(); i != unfit.rend(); ++i) {
      candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(*i));
      forecasts_.erase(forecasts_.begin() + static_cast<std::ptrdiff_t>(*i));
    }
    add_follow_ups();
    return {};
  }

  // What is made of a solve takes its time by pixels, whatever the cloth: one session of each size tells. An
  // error where it is none of the session's, or nothing can be made of the first few.
  Result<void> measure_follow_ups(const Candidate& candidate) {
    if (options_.product.then.empty()) return {};
    constexpr double kAlike = 1.25;
    constexpr int kMostRefusals = 3;
    const double megapixels = candidate.traits.megapixels;
    const FollowUpPrice* const near = nearest_follow_up(megapixels);
    if (near != nullptr && size_ratio(*near, megapixels) < kAlike) return {};
    Result<FollowUpPrice> price =
        price_follow_ups(candidate, options_.product, {context_.threads, context_.stop});
    if (price) {
      follow_ups_.push_back(*price);
      return {};
    }
    refused_ = std::move(price).error();
    const bool is_of_all = ++refusals_ == kMostRefusals && follow_ups_.empty();
    if (is_of_all || !is_of_session(refused_->kind)) return *refused_;
    return {};
  }

  static double size_ratio(const FollowUpPrice& price, double megapixels) {
    return std::max(price.megapixels, megapixels) / std::min(price.megapixels, megapixels);
  }

  const FollowUpPrice* nearest_follow_up(double megapixels) const {
    const auto nearest = std::ranges::min_element(
        follow_ups_, {}, [&](const FollowUpPrice& each) { return size_ratio(each, megapixels); });
    return nearest == follow_ups_.end() ? nullptr : &*nearest;
  }

  // The follow-up of a session at a level; nothing where none was measured.
  FollowUpPrice follow_up_of(std::size_t i, std::size_t level) const {
    const double megapixels = candidates_[i].traits.megapixels;
    const FollowUpPrice* const nearest = nearest_follow_up(megapixels);
    return nearest == nullptr ? FollowUpPrice() : nearest->of(megapixels * level_of(i, level).pixels_share);
  }

  void add_follow_ups() {
    for (std::size_t i = 0; i < forecasts_.size(); ++i) {
      for (std::size_t l = 0; l < forecasts_[i].size(); ++l)
        forecasts_[i][l].seconds += follow_up_of(i, l).seconds;
    }
  }

  bool is_fixed() const { return levels_.size() == 1; }
  // The level of a session, `level` being an index into levels_.
  const LevelOfSession& level_of(std::size_t i, std::size_t level) const {
    return candidates_[i].levels[levels_[level]];
  }

  // Whether there is nothing to do at the level that was asked for.
  bool is_done(const Candidate& candidate) const {
    return is_fixed() && candidate.levels[levels_.front()].is_there;
  }

  bool turns_little(const Forecast& forecast) const {
    return options_.least_change_deg && forecast.turn_deg && *forecast.turn_deg < *options_.least_change_deg;
  }

  // What is there, or is left out for turning little, costs nothing.
  bool is_free(std::size_t i, std::size_t level) const {
    return level_of(i, level).is_there || turns_little(forecasts_[i][level]);
  }

  // Nobody makes maps of a preview unawares.
  std::size_t first_level() const { return is_fixed() || options_.product.then.empty() ? 0 : 1; }

  // From the first level on that may be chosen.
  std::vector<LevelOption> options_of(std::size_t i) const {
    std::vector<LevelOption> options;
    for (std::size_t l = first_level(); l < forecasts_[i].size(); ++l) {
      const Forecast& forecast = forecasts_[i][l];
      options.push_back(
          {is_free(i, l) ? 0 : forecast.seconds, deg_of_whole(forecast.degrees, forecast.solved)});
    }
    return options;
  }

  Result<void> decide() {
    const std::vector<std::string> names = level_names();
    if ((options_.within_seconds || options_.to_deg) && plan_.header.sampled == 0 && !candidates_.empty()) {
      return Error{ErrorKind::kUsage, "levels cannot be chosen", "--within, --to", "no session was measured",
                   "measure at least one with --sample, or name a level with --quality"};
    }
    if (options_.within_seconds) return decide_by_hours();
    if (is_fixed() && levels_.front() == 0 && !options_.product.then.empty()) {
      return Error{ErrorKind::kUsage, "a preview feeds no maps", "--then",
                   "it has half the size and no masks", "plan with --quality standard, or without --then"};
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (!options_.to_deg) {
        take(i, 0);
        continue;
      }
      const std::vector<LevelOption> options = options_of(i);
      const std::optional<std::size_t> level = cheapest_within(options, *options_.to_deg);
      if (level) {
        take(i, first_level() + *level);
        continue;
      }
      const auto closest = std::ranges::min_element(options, {}, &LevelOption::degrees);
      const auto closest_level = first_level() + static_cast<std::size_t>(closest - options.begin());
      const Forecast& forecast = forecasts_[i][closest_level];
      plan_.left_out.push_back({candidates_[i].input.folder.string(), SkipReason::kNotGoodEnough, "",
                                fmt::format("the closest level, {}: {}", names[levels_[closest_level]],
                                            error_in_words(forecast.degrees, forecast.solved)),
                                closest->seconds});
    }
    return {};
  }

  Result<void> decide_by_hours() {
    std::vector<std::vector<LevelOption>> options;
    for (std::size_t i = 0; i < candidates_.size(); ++i) options.push_back(options_of(i));
    const Result<Spending> spending = spend(options, *options_.within_seconds);
    if (!spending) return spending.error();
    plan_.header.curve = spending->curve;
    for (std::size_t i = 0; i < candidates_.size(); ++i) take(i, first_level() + spending->chosen[i]);
    return {};
  }

  // Plans a session at a level, unless there is nothing to be done for it.
  void take(std::size_t i, std::size_t level) {
    const Candidate& candidate = candidates_[i];
    const Forecast& forecast = forecasts_[i][level];
    const std::string session = candidate.input.folder.string();
    const LevelOfSession& of_level = level_of(i, level);
    if (of_level.is_there) {
      plan_.left_out.push_back({session, SkipReason::kThere, "",
                                fmt::format("solve {} is there", of_level.solve), forecast.seconds});
      return;
    }
    if (turns_little(forecast)) {
      plan_.left_out.push_back({session, SkipReason::kTurnsLittle, "",
                                fmt::format("its maps would turn by {:.3g} degrees{}", *forecast.turn_deg,
                                            forecast.is_measured ? "" : ", as those of others solved alike"),
                                forecast.seconds});
      return;
    }
    PlannedSolve planned;
    planned.session = session;
    planned.digest = candidate.digest;
    planned.quality = level_names()[levels_[level]];
    planned.calibration = candidate.traits.calibration;
    planned.solve = of_level.solve;
    planned.before = candidate.before;
    planned.rig = candidate.rig;
    planned.fabric = candidate.traits.fabric;
    planned.megapixels = candidate.traits.megapixels;
    planned.forecast = forecast;
    const FollowUpPrice follows = follow_up_of(i, level);
    planned.memory_bytes = std::max(of_level.memory_bytes, with_room(follows.memory_bytes));
    planned.read_bytes = candidate.read_bytes;
    planned.write_bytes = of_level.write_bytes + follows.write_bytes;
    plan_.solves.push_back(std::move(planned));
  }

  // All sessions at each level, so that the price of each is known before one is paid.
  void add_totals() {
    const std::vector<std::string> names = level_names();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      LevelTotal total;
      total.quality = names[levels_[l]];
      MeanError error, squares;
      for (const std::vector<Forecast>& levels : forecasts_) {
        total.hours += levels[l].seconds / 3600;
        error.add(levels[l].degrees, levels[l].solved);
        squares.add(levels[l].degrees * levels[l].degrees, levels[l].solved);
      }
      total.mean_deg = error.degrees();
      total.solved = error.solved();
      total.spread_deg = std::sqrt(std::max(0.0, squares.degrees() - total.mean_deg * total.mean_deg));
      total.sessions =
          static_cast<int>(std::ranges::count(plan_.solves, total.quality, &PlannedSolve::quality));
      plan_.header.levels.push_back(total);
    }
  }

  const PlanBatchOptions& options_;
  const JobContext& context_;
  const std::vector<std::size_t> levels_;  // of level_names(), what `level` is an index into
  BatchPlan plan_;
  std::vector<Candidate> candidates_;
  std::vector<std::vector<Forecast>> forecasts_;
  std::vector<FollowUpPrice> follow_ups_;  // of sizes that differ
  std::optional<Error> refused_;           // why follow-ups of a session could not be made
  int refusals_ = 0;
};

Result<void> check_plan_options(const PlanBatchOptions& options) {
  const auto refused = [](const char* where, const char* why, const char* remedy) {
    return Error{ErrorKind::kUsage, "batch cannot be planned so", where, why, remedy};
  };
  const bool has_then = !options.product.then.empty();
  if (has_then && !options.product.is_whole())
    return refused("--then", "maps and exports want all maps of a solve", "plan without --keep and --half");
  if (has_then && !options.output.empty())
    return refused("--then", "maps and exports are made in the session", "plan without --output");
  for (const std::string& each : options.product.then) {
    if (!each.starts_with("export:")) continue;
    if (auto preset = exchange::read_preset(each.substr(each.find(':') + 1)); !preset)
      return std::move(preset).error();
  }
  const auto keeps = [&](const char* name) {
    return options.product.keep.empty() ||
           std::ranges::find(options.product.keep, name) != options.product.keep.end();
  };
  if (!keeps("normal") || !keeps("albedo"))
    return refused("--keep", "solves are compared by their normals and albedo", "keep normal and albedo too");
  const Result<bool> there = look_for(options.plan);
  if (there && *there) {
    return Error{ErrorKind::kCannotCreate, "there is a file of this name", options.plan.string(),
                 "a plan never changes once it is written", "name another file with -o, or remove it"};
  }
  return {};
}

}  // namespace

void describe(Fields& fields, PlanBatchOptions& o) {
  fields.value({.name = "quality", .says = "Level of all of them", .words = level_names()}, o.quality);
  fields.value({.name = "to_deg",
                .says = "Of each the cheapest level expected to be so many degrees off at most",
                .range = kAboveZero},
               o.to_deg);
  fields.value(
      {.name = "within_s",
       .says = "Node-hours for all of them, spent where a second buys most degrees: 8h, 30m, 90s, 2d",
       .range = kAboveZero,
       .units = {{"s"}, {"m", 60}, {"h", 3600}, {"d", 86400}}},
      o.within_seconds);
  fields.exclude("quality", "to_deg");
  fields.exclude("quality", "within_s");
  fields.exclude("to_deg", "within_s");
  fields.value({.name = "least_change_deg",
                .says = "Leave out sessions whose maps would turn by less than so many degrees, as measured "
                        "on the sample",
                .range = kAboveZero},
               o.least_change_deg);
  fields.value(
      {.name = "calibration",
       .says = "Calibration folder in place of the own ones of the sessions of its rig; may be given "
               "again",
       .path = PathTo::kFolder,
       .is_said_again = true},
      o.calibrations);
  fields.value({"then", "Made of each solve, by commas: maps, export:PRESET"}, o.product.then);
  fields.require(std::ranges::all_of(o.product.then, can_follow), "then", "must be maps, or export:PRESET");
  describe_kept_maps(fields, o.product.keep, o.product.half);
  fields.value({.name = "compress",
                .says = "Of EXR files: none, zip, piz",
                .words = {kCompressionNames.begin(), kCompressionNames.end()}},
               o.product.compression);
  fields.value({"sample", "Sessions whose levels are measured", {0, 100000}}, o.sample);
  fields.require(o.sample > 0 || !(o.to_deg || o.within_seconds), "sample",
                 "must be above 0 where levels are chosen by what was measured");
  fields.value(
      {.name = "task_minutes", .says = "Of a task", .range = {0.001, 10000}, .option = "--task-minutes"},
      o.task_minutes);
  fields.value({.name = "output",
                .says = "Folder for solves, where the archive cannot be written",
                .said = Said::kAtThisMachine},
               o.output);
  fields.value(
      {.name = "plan", .says = "File of the plan", .option = "-o,--plan", .said = Said::kAtThisMachine},
      o.plan);
}

void describe_kept_maps(Fields& fields, std::vector<std::string>& keep, bool& half) {
  fields.value({.name = "keep",
                .says = "Maps of a solve that stay, by commas; default all: normal, albedo, sigma, residual, "
                        "status",
                .words = {kMapNames.begin(), kMapNames.end()}},
               keep);
  fields.value({"half", "Normals as half floats, true to 0.03 degrees"}, half);
}

Result<PlanBatchReport> plan_batch(const PlanBatchOptions& options, const JobContext& context) {
  if (Result<void> ok = check_plan_options(options); !ok) return std::move(ok).error();
  Result<std::vector<std::size_t>> levels = levels_of(options);
  if (!levels) return std::move(levels).error();
  return Planning(options, std::move(*levels), context).plan();
}

}  // namespace weft::library
