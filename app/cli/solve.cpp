// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "calibration/run/last_check.h"
#include "capture/rig.h"
#include "core/base/files.h"
#include "core/base/result.h"
#include "core/describe/field_check.h"
#include "core/describe/field_json.h"
#include "core/rig/session.h"
#include "solve/report/left_out_report.h"
#include "solve/report/reflectance_report.h"
#include "solve/run/explain.h"
#include "solve/run/ladder_picture.h"
#include "solve/run/solve_request.h"
#include "solve/session/current.h"

namespace weft::app {
namespace {

Result<solve::Ladder> price(const solve::SolveRequest& a, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  const JobContext context = {common.threads, stop_on_signal(), line.callback()};
  const solve::PriceOptions wanted = {.crops = a.crops};
  return a.session.folder.empty() ? solve::explain_photos(a.photos, a.options, wanted, context)
                                  : solve::explain_session(a.session, a.options, wanted, context);
}

void print_words(const solve::Ladder& ladder, std::optional<std::size_t> chosen) {
  const Result<std::size_t> recommended = solve::choose_level(ladder, {});
  const auto mark_of = [&](std::size_t level) {
    if (chosen) return chosen == level ? "<- chosen" : "";
    return recommended && *recommended == level ? "<- the one to buy" : "";
  };
  print(
      "level       degrees        of  seconds     read  prepare    solve    write pictures   report     "
      "sync");
  for (std::size_t i = 0; i < ladder.levels.size(); ++i) {
    const solve::LevelPrice& level = ladder.levels[i];
    const solve::LevelSeconds& s = level.seconds;
    print(fmt::format(
        "{:<10} {:>8} {:>9} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g} {:>8.3g}  {}",
        level.name(), level.error.solved > 0 ? fmt::format("{:.3g}", level.error.total_deg) : "-",
        share_in_words(level.error.solved), s.total(), s.read, s.prepare, s.solve, s.write, s.pictures,
        s.report, s.sync, mark_of(i)));
    if (!level.note.empty()) print("           " + level.note);
  }
  print(
      "degrees hold for that share of the cloth; so that solve.json keeps what is foretold here, solve with");
  for (const solve::LevelPrice& level : ladder.levels) {
    const SolvePrice price = solve::price_of(level);
    print(fmt::format("  --quality {} --foretold {:.4g},{:.4g},{:.4g}", level.name(), price.seconds,
                      price.mean_deg, price.solved));
  }
}

/// Prints what each level would give and cost, and which one the wishes choose.
Result<int> run_explain(const solve::SolveRequest& arguments, const CommonArguments& common) {
  const Result<solve::Ladder> ladder = price(arguments, common);
  if (!ladder) return ladder.error();
  std::optional<std::size_t> chosen;
  if (arguments.wish.is_one()) {
    const Result<std::size_t> level = solve::choose_level(*ladder, arguments.wish);
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

/// The level that the wishes choose, with a note of what is expected of it.
Result<solve::LevelPrice> chosen_level(const solve::SolveRequest& arguments, const CommonArguments& common) {
  const Result<solve::Ladder> ladder = price(arguments, common);
  if (!ladder) return ladder.error();
  const Result<std::size_t> chosen = solve::choose_level(*ladder, arguments.wish);
  if (!chosen) return chosen.error();
  const solve::LevelPrice& level = ladder->levels[*chosen];
  if (!common.quiet) {
    note(fmt::format("chose {}: {} and {:.3g} s expected", level.name(),
                     error_in_words(level.error.total_deg, level.error.solved), level.seconds.total()));
  }
  return level;
}

/// Solves a session by every level and draws them side by side.
Result<int> run_ladder(const solve::SolveRequest& arguments, const CommonArguments& common) {
  const Result<std::vector<solve::LadderStep>> steps = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    return solve::draw_ladder(arguments.session, arguments.options, arguments.ladder, context);
  }();
  if (!steps) return steps.error();
  const std::string picture = std::filesystem::absolute(arguments.ladder).lexically_normal().string();
  if (common.json) {
    Json levels = Json::array();
    for (const solve::LadderStep& step : *steps) {
      levels.push_back({{"quality", step.quality},
                        {"folder", step.folder.string()},
                        {"error_deg", step.error_deg ? Json(*step.error_deg) : Json()}});
    }
    print_json({{"picture", picture}, {"levels", std::move(levels)}});
    return kDone;
  }
  print(picture);
  for (const solve::LadderStep& step : *steps) {
    print(fmt::format("  {:<10} {}", step.quality,
                      step.error_deg ? fmt::format("{:.3f} degrees off in the crop", *step.error_deg)
                                     : step.folder.string()));
  }
  return kDone;
}

std::string status_words(const StatusCounts& status) {
  std::string words;
  for (const StatusName& s : kStatusNames) {
    if (status.with(s.bit) > 0) words += fmt::format(" {} {}", s.name, status.with(s.bit));
  }
  return words.empty() ? " none" : words;
}

Json json_of(const solve::SolveReport& report) {
  const SolveFacts& facts = report.facts;
  return {{"normal", (report.folder / "normal.exr").string()},
          {"albedo", (report.folder / "albedo.exr").string()},
          {"folder", report.folder.string()},
          {"id", facts.id},
          {"was_there", report.was_there},
          {"albedo_scale", name_of(facts.albedo_scale)},
          {"seconds",
           {{"read", report.seconds.read},
            {"conditions", report.seconds.conditions},
            {"solve", report.seconds.solve},
            {"write", report.seconds.write},
            {"pictures", report.seconds.pictures},
            {"report", report.seconds.report},
            {"sync", report.seconds.sync},
            {"total", report.seconds.total}}},
          {"peak_bytes", peak_memory_bytes()},
          {"pixels", facts.pixels},
          {"foretold", facts.foretold ? object_of(*facts.foretold) : Json()},
          {"taken", facts.taken ? object_of(*facts.taken) : Json()},
          {"status", object_of(facts.status)},
          {"check", facts.check ? object_of(*facts.check) : Json()},
          {"warnings", json_of(facts.warnings)},
          {"assumed", facts.assumed},
          {"pictures", facts.pictures}};
}

// What was got and paid, beside what was said before.
void print_price(const SolvePrice& taken, const std::optional<SolvePrice>& foretold) {
  print(fmt::format("  expected: {}", error_in_words(taken.mean_deg, taken.solved)));
  if (!foretold) return;
  print(fmt::format("  foretold {} in {:.3g} s, {:.2f} times the {:.3g} s that it took",
                    error_in_words(foretold->mean_deg, foretold->solved), foretold->seconds,
                    foretold->seconds / taken.seconds, taken.seconds));
}

void print_words(const solve::SolveReport& report) {
  const SolveFacts& facts = report.facts;
  if (report.was_there) {
    print(fmt::format("{} is there already: same inputs, same options", report.folder.string()));
    return;
  }
  print(report.folder.string());
  print(fmt::format("  {} of {} pixels solved from {} lights; albedo is {}", facts.pixels,
                    facts.size.pixels(), facts.lights, name_of(facts.albedo_scale)));
  if (!facts.assumed.empty()) print(fmt::format("  assumed: {}", fmt::join(facts.assumed, "; ")));
  if (facts.taken) print_price(*facts.taken, facts.foretold);
  print("  pixels by status:" + status_words(facts.status));
  if (facts.reflectance && !facts.reflectance->lobe.family.empty())
    print("  gloss: " + solve::reflectance_words(*facts.reflectance));
  const solve::SolveSeconds& s = report.seconds;
  print(fmt::format(
      "  {:.2f} s: read {:.2f}, prepare {:.2f}, solve {:.2f}, write {:.2f}, pictures {:.2f}, report {:.2f}, "
      "sync {:.2f}; "
      "peak {} MB",
      s.total, s.read, s.prepare, s.solve, s.write, s.pictures, s.report, s.sync, peak_memory_bytes() >> 20));
  print(fmt::format("  look at {}", (report.folder / "report.html").string()));
}

// Says which other solve a session goes on making its maps of, and how this one is chosen.
void print_other_current(const solve::SolveReport& report, const std::filesystem::path& folder) {
  const Result<Session> session = read_session(folder);
  if (!session) return;
  const solve::SessionSolves solves = solve::solves_of(*session);
  const solve::ChoosableSolve* const current = solves.current_one();
  const bool is_among = solves.find(report.facts.id) != nullptr;
  if (current == nullptr || !is_among || current->id == report.facts.id) return;
  print(fmt::format("  maps are made of {}{}; to choose this one: weft library tag {} --set current_solve={}",
                    words_of(*current), solves.is_chosen ? ", which a person chose" : "", folder.string(),
                    report.facts.id));
}

void print_check(const SolveFacts& facts) {
  print(facts.check ? solve::left_out_words(*facts.check) : "  no light could be left out and predicted");
}

void print_warnings(const std::vector<Verdict>& warnings) {
  for (const Verdict& warning : warnings) {
    note(fmt::format("{}.{}", warning.text, warning.remedy.empty() ? "" : " To do: " + warning.remedy + "."));
  }
}

/// Whether the rig that this machine has is known to have moved before it scanned the session: its last check
/// did not pass, and none did since the session.
Result<void> check_moved(solve::SolveRequest& arguments) {
  const Result<Session> session = read_session(arguments.session.folder);
  if (!session || session->shots.empty() || session->document.contains("accepted_moved")) return {};
  const Result<capture::Rig> rig = capture::read_rig(find_rig({}));
  if (!rig || rig->scan.calibration.empty() || rig->name != session->rig) return {};
  const std::optional<calibration::LastCheck> check =
      calibration::last_check_of(rig->scan.calibration, session->calibration_id);
  if (!check || check->passed || session->shots.front().time <= check->passed_last) return {};
  if (arguments.accept_moved.empty()) {
    return calibration::moved_since(
        *check,
        "solve by a newer calibration (--calibration), or give a reason to solve all the same: "
        "--accept-moved WHY");
  }
  arguments.session.accepted_moved = calibration::accepted_moved(*check, arguments.accept_moved);
  return {};
}

Result<int> solve(solve::SolveRequest& arguments, const CommonArguments& common) {
  if (Result<void> fits = check_fields(arguments); !fits) return std::move(fits).error();
  const bool is_session = !arguments.session.folder.empty();
  if (is_session && arguments.session.calibration.empty()) {
    if (Result<void> ok = check_moved(arguments); !ok) return std::move(ok).error();
  }
  if (!arguments.ladder.empty()) return run_ladder(arguments, common);
  if (arguments.explain) return run_explain(arguments, common);
  solve::SolveOptions options = arguments.options;
  if (const std::vector<double>& f = arguments.foretold; !f.empty())
    options.foretold = SolvePrice{f[0], f[1], f[2], {}};
  if (arguments.wish.is_one()) {
    const Result<solve::LevelPrice> level = chosen_level(arguments, common);
    if (!level) return level.error();
    options.method = level->name();
    options.foretold = solve::price_of(*level);
  }
  Result<solve::SolveReport> report = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    return is_session ? solve::solve_session(arguments.session, options, context)
                      : solve::solve_photos(arguments.photos, options, context);
  }();
  if (!report) return std::move(report).error();
  if (common.json) {
    print_json(json_of(*report));
  } else {
    print_words(*report);
    if (is_session) {
      print_other_current(*report, arguments.session.folder);
    } else {
      print(fmt::format("  to go on: weft export {} --preset glb", report->folder.string()));
    }
    if (arguments.check) print_check(report->facts);
  }
  const SolveFacts& facts = report->facts;
  print_warnings(facts.warnings);
  const bool is_flawed = facts.status.with(kNoSolution) > 0 || !facts.warnings.empty();
  return arguments.strict && is_flawed ? kDoneWithWarnings : kDone;
}

Run add_solve(Options& options) {
  const auto a = std::make_shared<solve::SolveRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) {
    a->photos.lights = a->session.leds;
    a->photos.reading = a->session.reading;
    a->options.method = a->method_asked();
    return solve(*a, common);
  };
}

}  // namespace

Verb solve_verb() {
  return {"solve", "Turn a session, or photographs under known lights, into albedo and normals", add_solve};
}

}  // namespace weft::app
