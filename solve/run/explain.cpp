// SPDX-License-Identifier: Apache-2.0
#include "solve/run/explain.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "report/downsampler.h"
#include "solve/input/load.h"
#include "solve/levels/shifts.h"
#include "solve/photographs/cut.h"
#include "solve/report/reflectance_report.h"
#include "solve/run/facts_json.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr Size kCut = {512, 256};
constexpr Size kLargeCut = {1024, 1024};  // of which pictures and files are timed too

// The middle of a frame, on whole cells of the colour filter.
Rect timed_area(Size size, Size most = kCut) {
  const Size cut = {std::min(size.width, most.width), std::min(size.height, most.height)};
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

Result<void> keep_cut(const fs::path& solve, const std::string& level, const fs::path& crops) {
  if (crops.empty()) return {};
  if (Result<void> made = make_writable_folder(crops); !made) return made;
  for (const char* name : {"relit.png", "normal.png", "normal.exr"}) {
    const fs::path kept = crops / fmt::format("{}_{}", level, name);
    std::error_code failed;
    fs::copy_file(solve / name, kept, fs::copy_options::overwrite_existing, failed);
    if (failed) return cannot_write(kept, failed.value());
  }
  return {};
}

Result<SolveReport> solve_area(const Photographs& photographs, Rect area, const std::string& level,
                               const SolveOptions& options, const fs::path& crops,
                               const JobContext& context) {
  const Scratch scratch;
  Result<Photographs> part = cut(photographs, area);
  if (!part) return std::move(part).error();
  SolveOptions one = options;
  one.method = level;
  one.output = scratch.path;
  Result<SolveReport> solved = solve_loaded(std::move(*part), one, context);
  if (!solved) return solved;
  if (Result<void> kept = keep_cut(solved->folder, level, crops); !kept) return kept.error();
  return solved;
}

// What the level makes of the middle of the frame: the quicker of two solves unless the first is long.
Result<SolveReport> solve_cut(const Photographs& photographs, const std::string& level,
                              const SolveOptions& options, const fs::path& crops, const JobContext& context) {
  constexpr double kLong_s = 0.5;
  std::optional<SolveReport> quickest;
  for (int run = 0; run < 2; ++run) {
    Result<SolveReport> solved =
        solve_area(photographs, timed_area(photographs.size), level, options, crops, context);
    if (!solved) return solved;
    if (!quickest || solved->seconds.total < quickest->seconds.total) quickest = std::move(*solved);
    if (quickest->seconds.total > kLong_s) break;
  }
  return std::move(*quickest);
}

Result<SharedSeconds> shared_seconds(const Photographs& photographs, const SolveOptions& options,
                                     const JobContext& context) {
  std::array<SolveSeconds, 2> quickest;
  std::array<double, 2> pixels = {};
  for (const std::size_t i : {0U, 1U}) {
    const Rect area = timed_area(photographs.size, i == 0 ? kLargeCut : kCut);
    pixels[i] = static_cast<double>(Size{area.width(), area.height()}.pixels());
    for (int run = 0; run < 2; ++run) {
      const Result<SolveReport> solved =
          solve_area(photographs, area, solver::method_of(solver::Level::kFast).name, options, {}, context);
      if (!solved) return solved.error();
      SolveSeconds& best = quickest[i];
      if (run == 0) best = solved->seconds;
      best.solve = std::min(best.solve, solved->seconds.solve);
      best.write = std::min(best.write, solved->seconds.write);
      best.pictures = std::min(best.pictures, solved->seconds.pictures);
      best.sync = std::min(best.sync, solved->seconds.sync);
    }
  }
  const auto growing = [&](double SolveSeconds::*part) {
    const double more = quickest[0].*part - quickest[1].*part;
    // A frame that is no larger than the cut is its own measure.
    const double a_pixel = pixels[0] > pixels[1] ? std::max(0.0, more) / (pixels[0] - pixels[1]) : 0;
    return Growing{quickest[0].*part, a_pixel, pixels[0]};
  };
  return SharedSeconds{growing(&SolveSeconds::solve), growing(&SolveSeconds::write),
                       growing(&SolveSeconds::pictures), growing(&SolveSeconds::sync)};
}

// Seconds of the whole frame, from those of its cut; reading and registering it aside.
LevelSeconds scaled(const SolveSeconds& cut, const SharedSeconds& shared, Size frame, bool is_half) {
  const Rect area = timed_area(frame);
  const Size in_cut = {area.width(), area.height()};
  const auto pixels = static_cast<double>(frame.pixels()), of_maps = is_half ? pixels / 4 : pixels;
  const Size maps = is_half ? Size{frame.width / 2, frame.height / 2} : frame;
  const double square = report::Downsampler(maps, 1).square();
  LevelSeconds seconds;
  seconds.prepare = is_half ? cut.prepare * pixels / static_cast<double>(in_cut.pixels()) : cut.prepare;
  // No level takes less a pixel than `fast` does, of which the two cuts are.
  const double least = shared.solve.a_pixel * static_cast<double>(in_cut.pixels()) / (is_half ? 4 : 1);
  const double begin = std::clamp(shared.solve.at(0), 0.0, std::max(0.0, cut.work.frame - least));
  SolveWork growing = cut.work;
  growing.frame -= begin;
  const SolveWork work = carried_over(growing, in_cut, frame);
  seconds.fixed = work.lobe + begin;
  seconds.solve = work.total() + begin;
  seconds.write = shared.write.at(of_maps);
  seconds.pictures = shared.pictures.at(of_maps / (square * square));
  seconds.report = cut.report;
  seconds.sync = shared.sync.at(of_maps);
  return seconds;
}

// What the reference level takes out of the readings, and why, as solve.json says it.
std::string words_of(const ReferenceLevelFacts& reference, const std::vector<GateFacts>& gates) {
  std::string words;
  for (const std::string& stage : reference.stages)
    words += fmt::format("{}{}", words.empty() ? "takes out " : ", ", stage);
  const bool was_tried = !reference.left_out.empty();
  if (words.empty())
    words = was_tried ? "left-out light is predicted no better without its effects" : "gates shut";
  const char* before = ": ";
  for (const GateFacts& gate : gates) {
    words += fmt::format("{}{} {:.3g} of {:.3g}{}{}", before, gate.name, gate.value, gate.limit,
                         gate.unit.empty() ? "" : " ", gate.unit);
    before = ", ";
  }
  return words;
}

// What looking for the cloth's lobe came to in the cut.
std::string gloss_words(const std::optional<ReflectanceSummary>& reflectance) {
  if (!reflectance) return "";
  const std::string words = lobes_in_words(*reflectance);
  return words.empty() ? fmt::format("gloss of the middle: no lobe ({})", reflectance->lobe.said)
                       : "gloss of the middle: " + words;
}

void add_note(const std::string& words, LevelPrice& level) {
  if (words.empty()) return;
  level.note += (level.note.empty() ? "" : "; ") + words;
}

// The cheapest of the levels that are better than all others by less than they are worth.
std::size_t best_of(const Ladder& ladder, const std::vector<std::size_t>& from_cheapest) {
  std::size_t best = from_cheapest.front();
  for (const std::size_t i : from_cheapest) {
    const double error = ladder.levels[i].error.of_whole_deg(),
                 before = ladder.levels[best].error.of_whole_deg();
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

std::string another_scan(bool of_session) {
  return of_session ? "scan it again with the exposure that the meter takes"
                    : "photograph it again with another exposure";
}

void add_notes(Ladder& ladder) {
  std::vector<std::size_t> cheaper;
  for (const std::size_t i : from_cheapest(ladder)) {
    LevelPrice& level = ladder.levels[i];
    if (!level.is_solved())
      level.note = "most of the cloth has no normal: " + another_scan(ladder.of_session);
    if (!cheaper.empty()) {
      const LevelPrice& best = ladder.levels[best_of(ladder, cheaper)];
      if (level.is_solved() && level.error.of_whole_deg() > (1 - kWorthwhileGain) * best.error.of_whole_deg())
        level.note = "nothing to gain over " + best.name();
    }
    cheaper.push_back(i);
  }
}

// What pricing a level in the cut came to.
struct Priced {
  LevelPrice price;
  Json gates;
  std::vector<std::string> notes;
};

Result<Priced> price_level(const Photographs& photographs, const solver::MethodName& level,
                           const SharedSeconds& shared, const SolveOptions& options, const fs::path& crops,
                           const JobContext& context) {
  const Result<SolveReport> cut = solve_cut(photographs, level.name, options, crops, context);
  if (!cut) return cut.error();
  const bool is_half = level.extent == solver::Extent::kHalfSize;
  Priced priced;
  priced.price = {*level.level, cut->expected, scaled(cut->seconds, shared, photographs.size, is_half), ""};
  if (level.level == solver::Level::kReference) {
    priced.gates = list_of(cut->facts.gates);
    priced.notes.push_back(words_of(*cut->facts.reference, cut->facts.gates));
  }
  priced.notes.push_back(gloss_words(cut->facts.reflectance));
  return priced;
}

// What is known of photographs before one level is priced.
struct Frame {
  bool of_session = true;
  double read = 0, prepare = 0;  ///< seconds
};

Result<Ladder> price(const Photographs& photographs, const Frame& frame, const SolveOptions& options,
                     const PriceOptions& wanted, const JobContext& context) {
  const JobContext silent = {context.threads, context.stop};
  context.progress("explain", 0);
  std::optional<SharedSeconds> own;
  std::optional<SharedSeconds>& shared = wanted.shared != nullptr ? *wanted.shared : own;
  if (!shared) {
    Result<SharedSeconds> measured = shared_seconds(photographs, options, silent);
    if (!measured) return std::move(measured).error();
    shared = *measured;
  }
  std::vector<const solver::MethodName*> levels;
  for (const solver::MethodName& level : solver::method_names()) {
    if (level.level && (!wanted.only || level.level == wanted.only)) levels.push_back(&level);
  }
  Ladder ladder;
  ladder.of_session = frame.of_session;
  std::vector<std::vector<std::string>> notes;
  for (const solver::MethodName* level : levels) {
    Result<Priced> priced = price_level(photographs, *level, *shared, options, wanted.crops, silent);
    if (!priced) return std::move(priced).error();
    priced->price.seconds.read = frame.read;
    if (level->extent != solver::Extent::kHalfSize) priced->price.seconds.prepare += frame.prepare;
    ladder.levels.push_back(std::move(priced->price));
    notes.push_back(std::move(priced->notes));
    if (!priced->gates.is_null()) ladder.gates = std::move(priced->gates);
    if (context.stop.stop_requested()) return interrupted();
    context.progress("explain",
                     static_cast<double>(ladder.levels.size()) / static_cast<double>(levels.size()));
  }
  add_notes(ladder);
  for (std::size_t i = 0; i < notes.size(); ++i) {
    for (const std::string& note : notes[i]) add_note(note, ladder.levels[i]);
  }
  return ladder;
}

Result<Ladder> explain(Photographs photographs, bool of_session, double read, const SolveOptions& options,
                       const PriceOptions& wanted, const JobContext& context) {
  Stopwatch watch;
  Result<SessionShifts> shifts = register_shots(photographs, context);
  if (!shifts) return std::move(shifts).error();
  if (Result<void> ok = leave_out(shifts->with(ShiftVerdict::kLeftOut), photographs); !ok)
    return std::move(ok).error();
  return price(photographs, {of_session, read, watch.lap()}, options, wanted, context);
}

Error nothing_fits(const Ladder& ladder, const LevelWish& wish) {
  const auto& levels = ladder.levels;
  const auto quickest =
      std::ranges::min_element(levels, {}, [](const LevelPrice& level) { return level.seconds.total(); });
  const auto closest = std::ranges::min_element(
      levels, {}, [](const LevelPrice& level) { return level.error.of_whole_deg(); });
  const auto error_of = [](const LevelPrice& level) {
    return error_in_words(level.error.total_deg, level.error.solved);
  };
  const std::string quick = fmt::format("the quickest, {}, takes {:.3g} s at {}", quickest->name(),
                                        quickest->seconds.total(), error_of(*quickest));
  const std::string close = fmt::format("the closest, {}, is expected to be off by {} in {:.3g} s",
                                        closest->name(), error_of(*closest), closest->seconds.total());
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

Error no_level_solved(const Ladder& ladder) {
  const auto most =
      std::ranges::max_element(ladder.levels, {}, [](const LevelPrice& level) { return level.error.solved; });
  return {
      ErrorKind::kBadData, "no level solves this cloth", "the middle of the frame",
      fmt::format("the most, {} of it, has a normal by {}", share_in_words(most->error.solved), most->name()),
      another_scan(ladder.of_session) + "; --explain lists all levels"};
}

Result<Ladder> explain_plan(const Result<SolvePlan>& plan, const SolveOptions& options,
                            const PriceOptions& wanted, const JobContext& context) {
  if (!plan) return plan.error();
  Stopwatch watch;
  SolvePlan asked = *plan;
  asked.asks_frames = true;
  asked.cloth_spread = said_spread(options);
  Result<Photographs> photographs = load_photographs(asked, context);
  if (!photographs) return std::move(photographs).error();
  return explain(std::move(*photographs), plan->is_of_rig, watch.lap(), options, wanted, context);
}

}  // namespace

Result<Ladder> explain_session(const SessionOptions& input, const SolveOptions& options,
                               const PriceOptions& wanted, const JobContext& context) {
  return explain_plan(plan_session(input), options, wanted, context);
}

Result<Ladder> explain_photos(const PhotoOptions& input, const SolveOptions& options,
                              const PriceOptions& wanted, const JobContext& context) {
  return explain_plan(plan_photos(input), options, wanted, context);
}

Result<std::size_t> choose_level(const Ladder& ladder, const LevelWish& wish) {
  if (std::ranges::none_of(ladder.levels, &LevelPrice::is_solved)) return no_level_solved(ladder);
  std::vector<std::size_t> fitting;
  for (const std::size_t i : from_cheapest(ladder)) {
    const LevelPrice& level = ladder.levels[i];
    const bool is_quick = !wish.within_seconds || level.seconds.total() <= *wish.within_seconds;
    const bool is_close = !wish.to_deg || level.error.of_whole_deg() <= *wish.to_deg;
    if (level.is_solved() && is_quick && is_close) fitting.push_back(i);
  }
  if (fitting.empty()) return nothing_fits(ladder, wish);
  return wish.to_deg ? fitting.front() : best_of(ladder, fitting);
}

SolvePrice price_of(const LevelPrice& level) {
  const LevelSeconds& seconds = level.seconds;
  return {seconds.total() - seconds.sync, level.error.total_deg, level.error.solved,
          Json{{"read", seconds.read},
               {"prepare", seconds.prepare},
               {"solve", seconds.solve},
               {"write", seconds.write},
               {"pictures", seconds.pictures},
               {"report", seconds.report}}};
}

Json json_of(const Ladder& ladder, std::optional<std::size_t> chosen) {
  Json levels = Json::array();
  for (const LevelPrice& level : ladder.levels) {
    const ExpectedError& error = level.error;
    const LevelSeconds& seconds = level.seconds;
    levels.push_back(
        {{"quality", level.name()},
         {"predicted_deg", error.total_deg},
         {"solved", error.solved},
         {"parts_deg",
          {{"noise", error.noise_deg}, {"model", error.model_deg}, {"calibration", error.calibration_deg}}},
         {"seconds",
          {{"read", seconds.read},
           {"prepare", seconds.prepare},
           {"solve", seconds.solve},
           {"fixed", seconds.fixed},
           {"write", seconds.write},
           {"pictures", seconds.pictures},
           {"report", seconds.report},
           {"sync", seconds.sync},
           {"total", seconds.total()}}},
         {"note", level.note}});
  }
  const Result<std::size_t> recommended = choose_level(ladder, {});
  return {{"levels", std::move(levels)},
          {"gates", ladder.gates},
          {"recommended", recommended ? Json(ladder.levels[*recommended].name()) : Json()},
          {"chosen", chosen ? Json(ladder.levels[*chosen].name()) : Json()}};
}

}  // namespace weft::solve
