// SPDX-License-Identifier: Apache-2.0
#include "app/cli/solve.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/explain.h"
#include "app/cli/options.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/jobs/last_check.h"
#include "app/jobs/left_out_report.h"
#include "app/jobs/reflectance.h"
#include "capture/rig.h"
#include "core/files.h"
#include "core/session.h"
#include "library/current.h"
#include "solver/method.h"

namespace weft::app {
namespace {

std::string status_words(const StatusCounts& status) {
  std::string words;
  for (const StatusName& s : kStatusNames) {
    if (status.with(s.bit) > 0) words += fmt::format(" {} {}", s.name, status.with(s.bit));
  }
  return words.empty() ? " none" : words;
}

Json json_of(const SolveReport& report) {
  const SolveFacts& facts = report.facts;
  return {{"normal", (report.folder / "normal.exr").string()},
          {"albedo", (report.folder / "albedo.exr").string()},
          {"folder", report.folder.string()},
          {"id", facts.id},
          {"was_there", report.was_there},
          {"albedo_scale", name_of(facts.albedo_scale)},
          {"seconds",
           {{"read", report.seconds.read},
            {"solve", report.seconds.solve},
            {"write", report.seconds.write},
            {"pictures", report.seconds.pictures},
            {"report", report.seconds.report},
            {"sync", report.seconds.sync},
            {"total", report.seconds.total}}},
          {"peak_bytes", peak_memory_bytes()},
          {"pixels", facts.pixels},
          {"foretold", facts.foretold ? weft::json_of(*facts.foretold) : Json()},
          {"taken", facts.taken ? weft::json_of(*facts.taken) : Json()},
          {"status", json_of(facts.status)},
          {"check", facts.check ? json_of(*facts.check) : Json()},
          {"warnings", json_of(facts.warnings)},
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

void print_words(const SolveReport& report) {
  const SolveFacts& facts = report.facts;
  if (report.was_there) {
    print(fmt::format("{} is there already: same inputs, same options", report.folder.string()));
    return;
  }
  print(report.folder.string());
  print(fmt::format("  {} of {} pixels solved from {} lights; albedo is {}", facts.pixels,
                    facts.size.pixels(), facts.lights, name_of(facts.albedo_scale)));
  if (facts.taken) print_price(*facts.taken, facts.foretold);
  print("  pixels by status:" + status_words(facts.status));
  if (facts.reflectance.contains("family")) print("  gloss: " + reflectance_words(facts.reflectance));
  const SolveSeconds& s = report.seconds;
  print(fmt::format(
      "  {:.2f} s: read {:.2f}, prepare {:.2f}, solve {:.2f}, write {:.2f}, pictures {:.2f}, report {:.2f}, "
      "sync {:.2f}; "
      "peak {} MB",
      s.total, s.read, s.prepare, s.solve, s.write, s.pictures, s.report, s.sync, peak_memory_bytes() >> 20));
  print(fmt::format("  look at {}", (report.folder / "report.html").string()));
}

// Of a session that goes on making its maps of another solve: which, and how this one is chosen.
void print_other_current(const SolveReport& report, const std::filesystem::path& folder) {
  const Result<Session> session = read_session(folder);
  if (!session) return;
  const library::SessionSolves solves = library::solves_of(*session);
  const library::ChoosableSolve* const current = solves.current_one();
  const bool is_among = solves.find(report.facts.id) != nullptr;
  if (current == nullptr || !is_among || current->id == report.facts.id) return;
  print(fmt::format("  maps are made of {}{}; to choose this one: weft library tag {} --set current_solve={}",
                    words_of(*current), solves.is_chosen ? ", which a person chose" : "", folder.string(),
                    report.facts.id));
}

void print_check(const SolveFacts& facts) {
  print(facts.check ? left_out_words(*facts.check) : "  no light could be left out and predicted");
}

void print_warnings(const std::vector<Verdict>& warnings) {
  for (const Verdict& warning : warnings) {
    note(fmt::format("{}.{}", warning.text, warning.remedy.empty() ? "" : " To do: " + warning.remedy + "."));
  }
}

/// Whether the rig that this machine has is known to have moved before it scanned the session: its last check
/// did not pass, and none did since the session.
Result<void> check_moved(SolveArguments& arguments) {
  const Result<Session> session = read_session(arguments.session.folder);
  if (!session || session->shots.empty() || session->document.contains("accepted_moved")) return {};
  const Result<capture::Rig> rig = capture::read_rig(find_rig({}));
  if (!rig || rig->scan.calibration.empty() || rig->name != session->rig) return {};
  const std::optional<LastCheck> check = last_check_of(rig->scan.calibration, session->calibration_id);
  if (!check || check->passed || session->shots.front().time <= check->passed_last) return {};
  if (arguments.accept_moved.empty()) {
    return moved_since(
        *check,
        "solve by a newer calibration (--calibration), or give a reason to solve all the same: "
        "--accept-moved WHY");
  }
  arguments.session.accepted_moved = accepted_moved(*check, arguments.accept_moved);
  return {};
}

// Seconds, degrees and the share of the cloth that they hold for, as --explain prints them.
Result<std::optional<SolvePrice>> price_in(const std::vector<double>& said) {
  if (said.empty()) return std::optional<SolvePrice>();
  const bool is_price = said.size() == 3 && said[0] >= 0 && said[1] >= 0 && said[2] >= 0 && said[2] <= 1;
  if (is_price) return std::optional(SolvePrice{said[0], said[1], said[2], {}});
  return Error{ErrorKind::kUsage, "a price cannot be read", "--foretold",
               "three numbers from 0 are wanted, the last at most 1",
               "copy the line that weft solve --explain prints for the level"};
}

Result<int> solve(SolveArguments& arguments, const CommonArguments& common) {
  const bool is_session = !arguments.session.folder.empty();
  if (is_session && arguments.session.calibration.empty()) {
    if (Result<void> ok = check_moved(arguments); !ok) return std::move(ok).error();
  }
  if (!is_session && arguments.photos.folder.empty() && arguments.photos.light_file.empty())
    return Error{ErrorKind::kUsage, "solve needs a session, --photos or --lp", "", "", "See weft --help"};
  if (!arguments.ladder.empty()) return run_ladder(arguments, common);
  if (arguments.explain) return run_explain(arguments, common);
  SolveOptions options = arguments.options;
  Result<std::optional<SolvePrice>> foretold = price_in(arguments.foretold);
  if (!foretold) return std::move(foretold).error();
  options.foretold = std::move(*foretold);
  if (arguments.wish.is_one()) {
    const Result<LevelPrice> level = chosen_level(arguments, common);
    if (!level) return level.error();
    options.method = level->name();
    options.foretold = price_of(*level);
  }
  Result<SolveReport> report = [&] {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    return is_session ? solve_session(arguments.session, options, context)
                      : solve_photos(arguments.photos, options, context);
  }();
  if (!report) return std::move(report).error();
  if (report->transfer && !common.quiet) {
    note(fmt::format("photographs are taken as {}; --transfer overrides",
                     *report->transfer == Transfer::kAuto
                         ? "linear or srgb, each by its kind, as they are not all of one kind"
                         : name_of(*report->transfer)));
  }
  if (common.json) {
    print_json(json_of(*report));
  } else {
    print_words(*report);
    if (is_session) print_other_current(*report, arguments.session.folder);
    if (arguments.check) print_check(report->facts);
  }
  const SolveFacts& facts = report->facts;
  print_warnings(facts.warnings);
  const bool is_flawed = facts.status.with(kNoSolution) > 0 || !facts.warnings.empty();
  return arguments.strict && is_flawed ? kDoneWithWarnings : kDone;
}

// An option for the levels, or for the methods that they are compared with.
Option add_method(Options& options, const std::string& option, const std::string& what, bool quality,
                  std::string& method) {
  std::vector<std::string> names, words;
  for (const solver::MethodName& each : solver::method_names()) {
    if (each.level.has_value() != quality) continue;
    names.emplace_back(each.name);
    words.push_back(fmt::format("{} ({})", each.name, each.help));
  }
  return options.add(option, &method, fmt::format("{}: {}", what, fmt::join(words, ", "))).one_of(names);
}

struct Input {
  Option session, photos, light_file;
};

Input add_input(Options& options, SolveArguments& a) {
  const Input input = {
      options.add("session", &a.session.folder, "Session folder, NAME.weft"),
      options.add(
          "--photos", &a.photos.folder,
          "Folder of photographs under distant lights: filenames.txt, light_directions.txt (unit x y z, "
          "x right, y up, z to the camera), light_intensities.txt (R G B), mask.png"),
      options.add("--lp", &a.photos.light_file,
                  "RTI light file: a count, then a line \"file x y z\" a photograph")};
  input.session.excludes(input.photos).excludes(input.light_file);
  input.photos.excludes(input.light_file);
  return input;
}

struct Level {
  Option explain, ladder;  ///< they write no maps
};

Level add_level(Options& options, const Option& session, SolveArguments& a) {
  const Option level = add_method(options, "--quality", "Level", true, a.options.method);
  const Option by_name =
      add_method(options, "--method", "Method for comparison", false, a.options.method).excludes(level);
  const Option explain = options.add_flag(
      "--explain", &a.explain,
      "Solve nothing: predict, from a cut of the middle, each level's mean error in degrees, "
      "the share of the cloth that it holds for, and its seconds here");
  options
      .add("--crops", &a.crops,
           "With --explain: folder for what each level made of the same 512 x 256 pixels, LEVEL_relit.png, "
           "LEVEL_normal.png and LEVEL_normal.exr")
      .needs(explain);
  const Option within = options
                            .add("--within", &a.wish.within_seconds,
                                 "Choose the best level that takes so many seconds, by --explain")
                            .above_zero();
  const Option to =
      options
          .add("--to", &a.wish.to_deg, "Choose the cheapest level expected to be so many degrees off at most")
          .above_zero();
  const Option ladder =
      options
          .add("--ladder", &a.ladder,
               "Solve by every level, and draw the same 128 x 128 normals of each into this PNG")
          .needs(session);
  const Option foretold =
      options
          .add("--foretold", &a.foretold,
               "What --explain said of this solve, SECONDS,DEGREES,SHARE: solve.json keeps it beside what is "
               "taken")
          .by_commas()
          .one_at_a_time();
  for (const Option& priced : {explain, within, to, ladder}) foretold.excludes(priced);
  for (const Option& priced : {explain, within, to, ladder}) priced.excludes(level).excludes(by_name);
  ladder.excludes(explain).excludes(within).excludes(to);
  return {explain, ladder};
}

void add_readings(Options& options, const Option& session, SolveArguments& a) {
  options
      .add("--lights", &a.session.leds,
           "LEDs or photographs to solve from, numbered from 1: 1,4,7; default all")
      .by_commas()
      .above_zero();
  options.add("--calibration", &a.session.calibration, "Calibration folder; default the session's own")
      .needs(session);
  options
      .add(
          "--second-pose", &a.options.second_pose,
          "Session of the same cloth lying tilted (weft scan --tilt), in which robust and reference seek its "
          "lobe too")
      .needs(session);
  options
      .add(
          "--accept-moved", &a.accept_moved,
          "Solve although the last check of this rig's calibration did not pass before the scan: the reason, "
          "which is kept")
      .needs(session);
  options.add_choice(
      "--transfer", &a.photos.transfer, kTransferNames,
      "How photographs follow light: auto (16-bit and float linear, 8-bit and JPEG sRGB), linear, srgb");
}

void add_maps(Options& options, const Level& level, SolveArguments& a) {
  const Option output =
      options.add("-o,--output", &a.options.output,
                  "Folder for the maps; default SESSION/solve/ID, or ./NAME-solve/ID for photographs");
  for (const Option& unsaved : {level.explain, level.ladder}) unsaved.excludes(output);
  options.add_choice("--compress", &a.options.compression, kCompressionNames, "Of EXR files: none, zip, piz");
  options.add("--tile-width", &a.options.tile.width, "Columns a tile (changes no byte of the result)")
      .in_range(1, 1 << 20)
      .shows_default();
  options.add("--tile-height", &a.options.tile.height, "Rows a tile (changes no byte of the result)")
      .in_range(1, 1 << 20)
      .shows_default();
  options.add_flag("!--no-previews", &a.options.previews, "Write no pictures");
  options.add_flag("--check", &a.check,
                   "Print how well each light that is left out is predicted from the others");
  options.add_flag("!--no-deblur", &a.options.deblur, "Leave the blur of the lens as it is");
  options.add_flag("--condition", &a.options.condition,
                   "Also write condition.exr: the logarithm of the condition number of the lights that each "
                   "pixel was solved from");
  options.add_flag("--strict", &a.strict, "Exit with 2 where pixels have no solution");
}

Run add_solve(Options& options) {
  const auto a = std::make_shared<SolveArguments>();
  const Input input = add_input(options, *a);
  const Level level = add_level(options, input.session, *a);
  add_readings(options, input.session, *a);
  add_maps(options, level, *a);
  return [a](const CommonArguments& common) {
    a->photos.lights = a->session.leds;
    return solve(*a, common);
  };
}

}  // namespace

Verb solve_verb() {
  return {"solve", "Turn a session, or photographs under known lights, into albedo and normals", add_solve};
}

}  // namespace weft::app
