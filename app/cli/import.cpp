// SPDX-License-Identifier: Apache-2.0
#include "library/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "core/describe/field_check.h"
#include "library/import/import_request.h"
#include "library/import/oddities.h"

namespace weft::app {
namespace {

constexpr std::size_t kSessionsShown = 5;  // sessions of a state, each with its frames
constexpr double kManyTimes = 999;

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
  for (const library::ImportDoubt& doubt : session.warnings) print("  warning: " + doubt.words);
}

void print_photographs(const library::ProposedPhotographs& each) {
  const std::string name = each.session.folder.filename().string();
  if (each.refusal) {
    print(fmt::format("{}: refused. {}", name, each.refusal->message()));
    return;
  }
  print(fmt::format(
      "{}: {} photographs of {}{}, \"{}\"", name, each.lights.lights.size(), each.source.string(),
      each.state == library::ImportState::kThere ? ", is there already" : "", each.session.fabric));
  for (const std::string& assumed : each.assumed) print("  " + assumed);
}

/// What is shown whole: the first of each state, and the first that is refused or doubted for a reason.
class Shown {
 public:
  bool is_shown(const library::ProposedSession& session) {
    bool shown = is_first(session.state, session.refusal);
    for (const library::ImportDoubt& doubt : session.warnings) shown |= reasons_.insert(doubt.kind).second;
    return count(shown);
  }
  bool is_shown(const library::ProposedPhotographs& each) {
    return count(is_first(each.state, each.refusal));
  }
  std::size_t passed_over() const { return passed_over_; }

 private:
  bool is_first(library::ImportState state, const std::optional<Error>& refusal) {
    return refusal ? reasons_.insert(refusal->what).second : ++states_[state] <= kSessionsShown;
  }
  bool count(bool shown) {
    passed_over_ += shown ? 0 : 1;
    return shown;
  }

  std::map<library::ImportState, std::size_t> states_;
  std::set<std::string> reasons_;
  std::size_t passed_over_ = 0;
};

void print_import(const library::ImportProposal& plan) {
  Shown shown;
  for (const library::ProposedSession& session : plan.sessions)
    if (shown.is_shown(session)) print_session(session);
  for (const library::ProposedPhotographs& each : plan.photographs)
    if (shown.is_shown(each)) print_photographs(each);
  if (shown.passed_over() > 0) print(fmt::format("{} more sessions, all in --json", shown.passed_over()));
  for (const library::ImportOddity& oddity : library::oddities_of(plan)) {
    const bool is_told = oddity.count == 1 && oddity.kind != library::OddityKind::kLeftOver;
    if (!is_told) print(words_of(oddity));
  }
  print(fmt::format("{} new, {} there already, {} refused", plan.count(library::ImportState::kNew),
                    plan.count(library::ImportState::kThere), plan.count(library::ImportState::kRefused)));
}

int ending_of(const library::ImportProposal& plan) {
  const std::optional<Error> refusal = plan.first_refusal();
  return refusal ? exit_code_of(refusal->kind) : kDone;
}

Result<void> ask(const library::ImportProposal& plan) {
  const std::size_t made = plan.count(library::ImportState::kNew),
                    refused = plan.count(library::ImportState::kRefused);
  note(fmt::format("import into {}: {} session{}{}? [y/N]", plan.archive.string(), made, made == 1 ? "" : "s",
                   refused == 0 ? "" : fmt::format(", without the {} refused", refused)));
  const std::optional<std::string> answer = typed_line(stop_on_signal());
  if (answer && (*answer == "y" || *answer == "yes")) return {};
  if (stop_on_signal().stop_requested()) return interrupted();
  return Error{ErrorKind::kUsage, "nothing was imported", "",
               answer ? "the answer was no" : "there was no answer", "say --yes, or --dry-run to look only"};
}

Result<int> import_folders(library::ImportRequest& a, const CommonArguments& common) {
  if (Result<void> fits = check_fields(a); !fits) return std::move(fits).error();
  const std::filesystem::path usual_rig = find_rig({});
  if (a.import.rig.empty() && a.import.calibration.empty() && is_there(usual_rig)) a.import.rig = usual_rig;
  if (common.json && !a.yes && !a.dry_run) {
    return Error{ErrorKind::kUsage, "--json asks nothing", "--json", "",
                 "say --yes to import, or --dry-run to look only"};
  }
  const Result<library::ImportProposal> plan = [&] {
    ProgressLine line(common.quiet);
    return library::plan_import(a.options(), {common.threads, stop_on_signal(), line.callback()});
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
    if (const std::optional<Error> refusal = plan->first_refusal()) note(refusal->message());
  } else if (goes_on) {
    print(
        fmt::format("{} imported into {}", plan->count(library::ImportState::kNew), plan->archive.string()));
  }
  return ending_of(*plan);
}

Run add_import(Options& options) {
  const auto a = std::make_shared<library::ImportRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return import_folders(*a, common); };
}

}  // namespace

Verb import_verb() {
  return {"import", "Make sessions of folders of photographs that other rigs and programs left", add_import};
}

}  // namespace weft::app
