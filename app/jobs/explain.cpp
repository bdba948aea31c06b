// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/explain.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/jobs/facts_json.h"
#include "pipeline/cut.h"
#include "pipeline/shifts.h"
#include "report/downsampler.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using pipeline::ErrorForecast;
using pipeline::Photographs;

constexpr Size kCut = {512, 256};

// The middle of a frame, on whole cells of the colour filter.
Rect timed_area(Size size) {
  const Size cut = {std::min(size.width, kCut.width), std::min(size.height, kCut.height)};
  const int x0 = (size.width - cut.width) / 2 / 2 * 2, y0 = (size.height - cut.height) / 2 / 2 * 2;
  return {x0, y0, x0 + cut.width, y0 + cut.height};
}

// A folder that is gone afterwards.
struct Scratch {
  fs::path path = fs::temp_directory_path() / fmt::format("weft-explain-{}", getpid());
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

// What the level takes for the middle of the frame: the quicker of two solves unless the first is long.
Result<SolveSeconds> cut_seconds(const Photographs& photographs, const std::string& level,
                                 const SolveOptions& options, const JobContext& context) {
  constexpr double kLong_s = 0.5;
  SolveSeconds least;
  for (int run = 0; run < 2; ++run) {
    const Scratch scratch;
    Result<Photographs> part = cut(photographs, timed_area(photographs.size));
    if (!part) return std::move(part).error();
    SolveOptions one = options;
    one.method = level;
    one.output = scratch.path;
    const Result<SolveReport> solved = solve_loaded(std::move(*part), one, context);
    if (!solved) return solved.error();
    if (run == 0 || solved->seconds.total < least.total) least = solved->seconds;
    if (least.total > kLong_s) break;
  }
  return least;
}

// Of the whole frame, from those of its cut.
LevelSeconds scaled(const SolveSeconds& cut, Size frame, bool is_half) {
  const Rect area = timed_area(frame);
  const auto pixels = static_cast<double>(Size{area.width(), area.height()}.pixels());
  const double whole = static_cast<double>(frame.pixels()) / pixels;
  const int longest = is_half ? 2 * report::kPreviewSide : report::kPreviewSide;
  const double shrunk = std::min(1.0, static_cast<double>(longest) / std::max(frame.width, frame.height));
  LevelSeconds seconds;
  seconds.solve = whole * cut.solve;
  seconds.write = whole * cut.write;
  seconds.pictures = std::max(1.0, whole * shrunk * shrunk) * cut.pictures;
  seconds.report = cut.report;
  seconds.sync = whole * cut.sync;
  return seconds;
}

std::string words_of(const solver::Gates& gates) {
  std::string words;
  for (const solver::Gate& gate : gates.measured()) {
    words += fmt::format("{}{} {:.3g} of {:.3g}{}{}", words.empty() ? "" : ", ", gate.name, gate.value,
                         gate.limit, gate.unit.empty() ? "" : " ", gate.unit);
  }
  return words;
}

// The cheapest of the levels that are better than all others by less than they are worth.
std::size_t best_of(const Ladder& ladder, const std::vector<std::size_t>& from_cheapest) {
  std::size_t best = from_cheapest.front();
  for (const std::size_t i : from_cheapest) {
    const double error = ladder.levels[i].error.total_deg(), before = ladder.levels[best].error.total_deg();
    if (error < (1 - kWorthwhileGain) * before) best = i;
  }
  return best;
}

std::vector<std::size_t> from_cheapest(const Ladder& ladder) {
  std::vector<std::size_t> order(ladder.levels.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return ladder.levels[a].seconds.total() < ladder.levels[b].seconds.total();
  });
  return order;
}

void add_notes(Ladder& ladder) {
  std::vector<std::size_t> cheaper;
  for (const std::size_t i : from_cheapest(ladder)) {
    LevelPrice& level = ladder.levels[i];
    if (!cheaper.empty()) {
      const LevelPrice& best = ladder.levels[best_of(ladder, cheaper)];
      if (level.error.total_deg() > (1 - kWorthwhileGain) * best.error.total_deg())
        level.note = "nothing to gain over " + best.name();
    }
    cheaper.push_back(i);
  }
  LevelPrice& reference = ladder.levels.back();
  const bool open = ladder.gates.shadows() || ladder.gates.interreflection();
  const char* gates = open                            ? "gates open"
                      : ladder.gates.specular.is_over ? "gates shut, as this cloth is no Lambertian one"
                                                      : "gates shut";
  reference.note +=
      fmt::format("{}{}: {}", reference.note.empty() ? "" : "; ", gates, words_of(ladder.gates));
}

Result<Ladder> price(const Photographs& photographs, double read, double prepare, const SolveOptions& options,
                     const JobContext& context) {
  const JobContext silent = {context.threads, context.stop};
  context.progress("explain", 0);
  const Result<pipeline::Forecast> forecast = forecast_errors(photographs, context.threads);
  if (!forecast) return forecast.error();
  Ladder ladder = {forecast->gates, {}};
  for (const ErrorForecast& error : forecast->levels) {
    const solver::MethodName& level = solver::method_of(error.level);
    const bool is_half = level.extent == solver::Extent::kHalfSize;
    const Result<SolveSeconds> cut = cut_seconds(photographs, level.name, options, silent);
    if (!cut) return cut.error();
    LevelSeconds seconds = scaled(*cut, photographs.size, is_half);
    seconds.read = read;
    seconds.prepare = is_half ? 0 : prepare;
    ladder.levels.push_back({error, seconds, ""});
    if (context.stop.stop_requested()) return interrupted();
    context.progress(
        "explain", static_cast<double>(ladder.levels.size()) / static_cast<double>(forecast->levels.size()));
  }
  add_notes(ladder);
  return ladder;
}

Result<Ladder> explain(Photographs photographs, double read, const SolveOptions& options,
                       const JobContext& context) {
  Stopwatch watch;
  Result<pipeline::SessionShifts> shifts = register_shots(photographs, context);
  if (!shifts) return std::move(shifts).error();
  photographs.shifts = std::move(shifts->corrections);
  const double prepare = watch.lap();
  return price(photographs, read, prepare, options, context);
}

Error nothing_fits(const Ladder& ladder, const LevelWish& wish) {
  const auto& levels = ladder.levels;
  const auto quickest = std::min_element(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
    return a.seconds.total() < b.seconds.total();
  });
  const auto closest = std::min_element(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
    return a.error.total_deg() < b.error.total_deg();
  });
  const std::string quick =
      fmt::format("the quickest, {}, takes {:.3g} s at {:.3g} degrees", quickest->name(),
                  quickest->seconds.total(), quickest->error.total_deg());
  const std::string close =
      fmt::format("the closest, {}, is expected to be off by {:.3g} degrees in {:.3g} s", closest->name(),
                  closest->error.total_deg(), closest->seconds.total());
  std::string where, why, remedy;
  if (wish.within_seconds) {
    where = fmt::format("--within {:g}", *wish.within_seconds);
    why = quick;
    remedy = "allow more seconds";
  }
  if (wish.to_deg) {
    where += fmt::format("{}--to {:g}", where.empty() ? "" : " ", *wish.to_deg);
    why += (why.empty() ? "" : "; ") + close;
    remedy += remedy.empty() ? "allow more degrees" : ", or more degrees";
  }
  return {ErrorKind::kUsage, wish.to_deg ? "no level is that good" : "no level is that quick", where, why,
          remedy + "; --explain lists all levels"};
}

}  // namespace

Result<Ladder> explain_session(const SessionOptions& input, const SolveOptions& options,
                               const JobContext& context) {
  const Result<SessionPlan> plan = plan_session(input);
  if (!plan) return plan.error();
  Stopwatch watch;
  Result<LoadedSession> loaded = load_session(*plan, context);
  if (!loaded) return std::move(loaded).error();
  return explain(std::move(loaded->photographs), watch.lap(), options, context);
}

Result<Ladder> explain_photos(const PhotoOptions& input, const SolveOptions& options,
                              const JobContext& context) {
  const Result<PhotoPlan> plan = plan_photos(input);
  if (!plan) return plan.error();
  Stopwatch watch;
  Result<Photographs> photographs = load_photos(*plan, context);
  if (!photographs) return std::move(photographs).error();
  return explain(std::move(*photographs), watch.lap(), options, context);
}

Result<std::size_t> choose_level(const Ladder& ladder, const LevelWish& wish) {
  std::vector<std::size_t> fitting;
  for (const std::size_t i : from_cheapest(ladder)) {
    const LevelPrice& level = ladder.levels[i];
    const bool is_quick = !wish.within_seconds || level.seconds.total() <= *wish.within_seconds;
    const bool is_close = !wish.to_deg || level.error.total_deg() <= *wish.to_deg;
    if (is_quick && is_close) fitting.push_back(i);
  }
  if (fitting.empty()) return nothing_fits(ladder, wish);
  return wish.to_deg ? fitting.front() : best_of(ladder, fitting);
}

Json json_of(const Ladder& ladder, std::optional<std::size_t> chosen) {
  Json levels = Json::array();
  for (const LevelPrice& level : ladder.levels) {
    const ErrorForecast& error = level.error;
    const LevelSeconds& seconds = level.seconds;
    levels.push_back({{"quality", level.name()},
                      {"predicted_deg", error.total_deg()},
                      {"parts_deg",
                       {{"noise", error.noise_deg},
                        {"misfit", error.misfit_deg},
                        {"indirect", error.indirect_deg},
                        {"shortcut", error.shortcut_deg},
                        {"calibration", error.calibration_deg}}},
                      {"seconds",
                       {{"read", seconds.read},
                        {"prepare", seconds.prepare},
                        {"solve", seconds.solve},
                        {"write", seconds.write},
                        {"pictures", seconds.pictures},
                        {"report", seconds.report},
                        {"sync", seconds.sync},
                        {"total", seconds.total()}}},
                      {"note", level.note}});
  }
  return {{"levels", std::move(levels)},
          {"gates", json_of(ladder.gates)},
          {"chosen", chosen ? Json(ladder.levels[*chosen].name()) : Json()}};
}

}  // namespace weft::app
