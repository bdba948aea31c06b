// SPDX-License-Identifier: Apache-2.0
#include "app/cli/print_ladder.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "solve/run/explain.h"
#include "solve/run/ladder_picture.h"

namespace weft::app {
namespace {

Result<Ladder> price(const SolveRequest& a, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  const JobContext context = {common.threads, stop_on_signal(), line.callback()};
  const PriceOptions wanted = {.crops = a.crops};
  return a.session.folder.empty() ? explain_photos(a.photos, a.options, wanted, context)
                                  : explain_session(a.session, a.options, wanted, context);
}

void print_words(const Ladder& ladder, std::optional<std::size_t> chosen) {
  print(
      "level       degrees        of  seconds     read  prepare    solve    write pictures   report     "
      "sync");
  for (std::size_t i = 0; i < ladder.levels.size(); ++i) {
    const LevelPrice& level = ladder.levels[i];
    const LevelSeconds& s = level.seconds;
    print(fmt::format(
        "{:<10} {:>8} {:>9} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g}  {}",
        level.name(), level.error.solved > 0 ? fmt::format("{:.3g}", level.error.total_deg) : "-",
        share_in_words(level.error.solved), s.total(), s.read, s.prepare, s.solve, s.write, s.pictures,
        s.report, s.sync, chosen == i ? "<- chosen" : ""));
    if (!level.note.empty()) print("           " + level.note);
  }
  print(
      "degrees hold for that share of the cloth; so that solve.json keeps what is foretold here, solve with");
  for (const LevelPrice& level : ladder.levels) {
    const SolvePrice price = price_of(level);
    print(fmt::format("  --quality {} --foretold {:.4g},{:.4g},{:.4g}", level.name(), price.seconds,
                      price.mean_deg, price.solved));
  }
}

}  // namespace

Result<int> run_explain(const SolveRequest& arguments, const CommonArguments& common) {
  const Result<Ladder> ladder = price(arguments, common);
  if (!ladder) return ladder.error();
  std::optional<std::size_t> chosen;
  if (arguments.wish.is_one()) {
    const Result<std::size_t> level = choose_level(*ladder, arguments.wish);
    if (!level) return level.error();
    chosen = *level;
  }
  if (common.json) {
    print_json(json_of(*ladder, chosen));
  } else {
    print_words(*ladder, chosen);
  }
  return kDone;
}

Result<LevelPrice> chosen_level(const SolveRequest& arguments, const CommonArguments& common) {
  const Result<Ladder> ladder = price(arguments, common);
  if (!ladder) return ladder.error();
  const Result<std::size_t> chosen = choose_level(*ladder, arguments.wish);
  if (!chosen) return chosen.error();
  const LevelPrice& level = ladder->levels[*chosen];
  if (!common.quiet) {
    note(fmt::format("chose {}: {} and {:.3g} s expected", level.name(),
                     error_in_words(level.error.total_deg, level.error.solved), level.seconds.total()));
  }
  return level;
}

Result<int> run_ladder(const SolveRequest& arguments, const CommonArguments& common) {
  const Result<std::vector<LadderStep>> steps = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    return draw_ladder(arguments.session, arguments.options, arguments.ladder, context);
  }();
  if (!steps) return steps.error();
  const std::string picture = std::filesystem::absolute(arguments.ladder).lexically_normal().string();
  if (common.json) {
    Json levels = Json::array();
    for (const LadderStep& step : *steps) {
      levels.push_back({{"quality", step.quality},
                        {"folder", step.folder.string()},
                        {"error_deg", step.error_deg ? Json(*step.error_deg) : Json()}});
    }
    print_json({{"picture", picture}, {"levels", std::move(levels)}});
    return kDone;
  }
  print(picture);
  for (const LadderStep& step : *steps) {
    print(fmt::format("  {:<10} {}", step.quality,
                      step.error_deg ? fmt::format("{:.3f} degrees off in the crop", *step.error_deg)
                                     : step.folder.string()));
  }
  return kDone;
}

}  // namespace weft::app
