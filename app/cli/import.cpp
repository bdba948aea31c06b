// SPDX-License-Identifier: Apache-2.0
#include "library/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

constexpr std::size_t kMostLeftOver = 20;  // lines
constexpr double kManyTimes = 999;

struct ImportArguments {
  library::ImportOptions import;
  bool yes = false, dry_run = false;
};

std::string sure_words(const std::optional<double>& sure) {
  if (!sure) return "";
  return *sure > kManyTimes ? fmt::format("over {:.0f} x", kManyTimes) : fmt::format("{:.1f} x", *sure);
}

std::string led_words(int led) {
  return led == 0 ? "dark" : std::to_string(led);
}

// A line a frame: its LED where there is a decision, else what each opinion says.
void print_frames(const library::ProposedSession& session) {
  const library::LedDecision& decision = session.decision;
  if (decision.leds.empty() && decision.opinions.empty()) return;
  std::size_t width = 5;
  for (const library::SourceFrame& frame : session.frames) width = std::max(width, frame.label.size());
  std::string head = fmt::format("  {:{}}  {:23}", "frame", width, "taken");
  if (!decision.leds.empty()) head += fmt::format("  {:>4}  {:16}  {}", "LED", "by", "sure");
  for (const library::LedOpinion& opinion : decision.opinions) head += fmt::format("  {:>13}", opinion.by);
  print(head);
  for (std::size_t f = 0; f < session.frames.size(); ++f) {
    const library::SourceFrame& frame = session.frames[f];
    std::string line = fmt::format("  {:{}}  {:23}", frame.label, width, library::time_words(frame));
    if (!decision.leds.empty()) {
      const bool is_by_level = decision.leds[f] == 0 && frame.said.led != 0;
      line += fmt::format("  {:>4}  {:16}  {}", led_words(decision.leds[f]),
                          is_by_level ? "its level" : decision.by, sure_words(decision.sure[f]));
    }
    for (const library::LedOpinion& opinion : decision.opinions)
      line += fmt::format("  {:>13}", led_words(opinion.leds[f]));
    print(line);
  }
}

void print_session(const library::ProposedSession& session) {
  const std::string name = session.session.folder.filename().string();
  switch (session.state) {
    case library::ImportState::kNew:
      print(fmt::format("{}: {} frames of {}, \"{}\"", name, session.frames.size(), session.source.string(),
                        session.session.fabric));
      break;
    case library::ImportState::kThere:
      print(fmt::format("{}: is there already, of the {} frames of {}", name, session.frames.size(),
                        session.source.string()));
      break;
    case library::ImportState::kRefused:
      print(fmt::format("{}: refused. {}", name, session.refusal->message()));
      break;
  }
  if (session.state != library::ImportState::kThere) print_frames(session);
  if (!session.decision.light_says.empty() && session.state == library::ImportState::kNew)
    print("  " + session.decision.light_says);
  for (const std::string& warning : session.warnings) print("  warning: " + warning);
}

void print_import(const library::ImportProposal& plan) {
  for (const library::ProposedSession& session : plan.sessions) print_session(session);
  for (const library::ProposedPhotographs& each : plan.photographs) {
    const std::string name = each.folder.filename().string();
    if (each.refusal) {
      print(fmt::format("{}: refused. {}", name, each.refusal->message()));
    } else {
      print(fmt::format("{}: {} photographs under distant lights of {}{}", name, each.photos.lit.size(),
                        each.source.string(),
                        each.state == library::ImportState::kThere ? ", is there already" : ""));
      for (const std::string& assumed : each.photos.assumed) print("  " + assumed);
    }
  }
  const std::size_t shown = std::min(plan.left_over.size(), kMostLeftOver);
  for (std::size_t i = 0; i < shown; ++i)
    print(fmt::format("left over: {}: {}", plan.left_over[i].file.string(), plan.left_over[i].why));
  if (plan.left_over.size() > shown)
    print(fmt::format("left over: {} more, all in --json", plan.left_over.size() - shown));
  print(fmt::format("{} new, {} there already, {} refused", plan.count(library::ImportState::kNew),
                    plan.count(library::ImportState::kThere), plan.count(library::ImportState::kRefused)));
}

int ending_of(const library::ImportProposal& plan) {
  const std::optional<Error> refusal = plan.first_refusal();
  return refusal ? exit_code_of(refusal->kind) : kDone;
}

Result<void> ask(const library::ImportProposal& plan) {
  note(fmt::format("import into {}? [y/N]", plan.archive.string()));
  const std::optional<std::string> answer = typed_line(stop_on_signal());
  if (answer && (*answer == "y" || *answer == "yes")) return {};
  if (stop_on_signal().stop_requested()) return interrupted();
  return Error{ErrorKind::kUsage, "nothing was imported", "",
               answer ? "the answer was no" : "there was no answer", "say --yes, or --dry-run to look only"};
}

Result<int> import_folders(ImportArguments& a, const CommonArguments& common) {
  const std::filesystem::path usual_rig = find_rig({});
  if (a.import.rig.empty() && a.import.calibration.empty() && is_there(usual_rig)) a.import.rig = usual_rig;
  if (common.json && !a.yes && !a.dry_run) {
    return Error{ErrorKind::kUsage, "--json asks nothing", "--json", "",
                 "say --yes to import, or --dry-run to look only"};
  }
  const Result<library::ImportProposal> plan = [&] {
    ProgressLine line(common.quiet);
    return library::plan_import(a.import, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!plan) return plan.error();
  if (!common.json) print_import(*plan);
  const bool goes_on = !a.dry_run && plan->count(library::ImportState::kNew) > 0;
  if (goes_on && !a.yes) {
    if (Result<void> flushed = flush_output(); !flushed) return std::move(flushed).error();
    if (Result<void> answer = ask(*plan); !answer) return std::move(answer).error();
  }
  if (goes_on) {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    if (Result<void> done = library::run_import(*plan, context); !done) return std::move(done).error();
  }
  if (common.json) {
    Json document = json_of(*plan);
    document["imported"] = goes_on ? plan->count(library::ImportState::kNew) : 0;
    print_json(document);
  } else if (goes_on) {
    print(
        fmt::format("{} imported into {}", plan->count(library::ImportState::kNew), plan->archive.string()));
  }
  return ending_of(*plan);
}

Run add_import(Options& options) {
  const auto a = std::make_shared<ImportArguments>();
  library::ImportOptions& import = a->import;
  options
      .add("folders", &import.folders,
           "Folders of raws (NEF, CR2, DNG ...), linear TIFF or EXR frames, or photographs with a light file")
      .required();
  options.add("--rig", &import.rig,
              "Rig file: its calibration, its folder of sessions, its cloth height, where none is named");
  options.add("--calibration", &import.calibration,
              "Calibration folder of the rig that took the photographs");
  options.add("-o,--output", &import.archive, "Archive: the folder for sessions; default the rig's");
  options.add("--pattern", &import.pattern,
              "What names say: {session}/{fabric}_{led}.{ext}; also {index}, {any}; LED 0 or dark is no LED");
  options.add_choice("--order", &import.order, library::kFrameOrderNames,
                     "What tells LEDs: auto (numbers in names, else times and names where they agree), time, "
                     "name, light (the LED that explains a frame's brightness)");
  options.add_choice("--link", &import.link, library::kFrameLinkNames,
                     "How a session has its frames: hard (links), copy, symbolic");
  options.add("--gap", &import.gap_s, "Seconds between two sessions in one folder")
      .above_zero()
      .shows_default();
  options.add(
      "--height", &import.cloth_height_mm,
      "Of the cloth's surface above the table, mm, where no import.toml says it; default the rig's, or 0");
  options.add_flag("--missing", &import.takes_missing,
                   "Take sessions that lack LEDs, where names or the light tell which");
  const Option dry_run =
      options.add_flag("--dry-run", &a->dry_run, "Print the table of what was decided, and import nothing");
  options.add_flag("--yes", &a->yes, "Import without a question").excludes(dry_run);
  return [a](const CommonArguments& common) { return import_folders(*a, common); };
}

}  // namespace

Verb import_verb() {
  return {"import", "Make sessions of folders of photographs that other rigs and programs left", add_import};
}

}  // namespace weft::app
