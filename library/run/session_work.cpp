// SPDX-License-Identifier: Apache-2.0
#include "library/run/session_work.h"
#include "library/catalogue/session_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve_record.h"
#include "library/catalogue/session_verdict.h"
#include "library/run/follow_ups.h"
#include "library/run/lean.h"
#include "library/run/solve_change.h"
#include "solve/run/solve_session.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// The calibration that it is solved by, in place of its own; refuses what is not as planned.
Result<fs::path> check_session(const SessionWork& work) {
  const fs::path& folder = work.session;
  if (folder == work.planned.session && !is_there(work.header->archive)) {
    return Error{ErrorKind::kTryAgain, "archive is not there", work.header->archive,
                 "this machine does not see it", "mount it, then run the same command again"};
  }
  if (!is_there(folder / "session.json")) {
    return Error{ErrorKind::kNoInput, "session is not where the plan has it", folder.string(),
                 "there is no session.json", "bring it back, or plan again"};
  }
  const Result<Session> session = read_session(folder);
  if (!session) return session.error();
  if (digest_of_session(session->document) != work.planned.digest) {
    return Error{ErrorKind::kBadData, "session was changed since the plan", folder.string(),
                 "its session.json differs in what a solve depends on", "plan again"};
  }
  if (!session->is_of_rig()) return fs::path();
  const auto& named = work.header->calibrations;
  const auto found = std::ranges::find(named, work.planned.calibration, &NamedCalibration::id);
  const fs::path own = found == named.end() ? fs::path() : fs::path(found->folder);
  const fs::path used = own.empty() ? session->calibration_folder() : own;
  const Result<Calibration> calibration = read_calibration(used);
  if (!calibration) return calibration.error();
  if (calibration->id == work.planned.calibration) return own;
  return Error{
      ErrorKind::kBadData, "calibration was changed since the plan", used.string(),
      fmt::format("its id is {:.12}, the plan names {:.12}", calibration->id, work.planned.calibration),
      "plan again"};
}

// The whole solve, where it belongs.
Result<solve::SolveReport> solve_whole(const solve::SessionOptions& input, solve::SolveOptions options,
                                       const SessionWork& work, const JobContext& context) {
  options.output = work.solves / work.planned.solve;
  Result<solve::SolveReport> report = solve::solve_session(input, options, context);
  const bool was_second = !report && report.error().kind == ErrorKind::kCannotCreate &&
                          is_there(options.output / kSolveProduct.document);
  return was_second ? solve::solve_session(input, options, context) : std::move(report);
}

// Only what is kept, made of a whole solve aside.
Result<solve::SolveReport> solve_lean(const solve::SessionOptions& input, solve::SolveOptions options,
                                      const SessionWork& work, const JobContext& context) {
  const Product target = {kSolveProduct, work.planned.solve, work.solves / work.planned.solve};
  const Result<std::optional<Json>> finished = find_finished(target);
  if (!finished) return finished.error();
  if (*finished) {
    Result<SolveFacts> facts = solve_facts_from_json(**finished, target.folder.string());
    if (!facts) return std::move(facts).error();
    return solve::SolveReport{target.folder, true, std::move(*facts), {}, {}};
  }
  PartialFolder partial(target.folder);
  options.output = partial.path() / "solve";
  Result<solve::SolveReport> report = solve::solve_session(input, options, context);
  if (!report) return report;
  if (Result<void> ok = make_lean(options.output, work.product, target.id); !ok) return std::move(ok).error();
  Result<void> published = publish_folder(options.output, target.folder);
  if (!published && !is_there(target.folder / kSolveProduct.document)) return std::move(published).error();
  report->folder = target.folder;
  report->facts.id = target.id;
  return report;
}

void add_facts_of(const solve::SolveReport& report, TaskOutcome& outcome) {
  const SolveFacts& facts = report.facts;
  outcome.state = report.was_there ? TaskState::kThere : TaskState::kSolved;
  outcome.solve = facts.id;
  outcome.folder = report.folder.string();
  outcome.read_s = report.seconds.read;
  outcome.solve_s = report.seconds.solve;
  outcome.expected_deg = report.expected.total_deg;
  const SigmaFacts sigma = facts.sigma_normal_deg.value_or(SigmaFacts());
  outcome.sigma_deg = sigma.median.value_or(0);
  outcome.sigma_p95_deg = sigma.p95.value_or(0);
  outcome.unsolved = static_cast<double>(facts.status.with(kNoSolution)) /
                     static_cast<double>(std::max<std::int64_t>(1, facts.size.pixels()));
  outcome.solved = facts.taken ? facts.taken->solved : 1 - outcome.unsolved;
  if (facts.check) outcome.left_out = facts.check->all.rms;
  for (const Verdict& warning : facts.warnings) {
    outcome.warnings.push_back(warning.name);
    if (is_of_frames(warning)) outcome.frames.push_back(warning.text);
  }
}

void compare_with_before(const SessionWork& work, const JobContext& context, TaskOutcome& outcome) {
  const std::string& before = work.planned.before;
  if (before.empty() || before == outcome.solve) return;
  const fs::path folder = work.session / "solve" / before;
  if (!is_there(folder / kSolveProduct.document)) {
    outcome.no_change = "the solve before is gone";
    return;
  }
  Stopwatch watch;
  const Result<MapChange> change = compare_solves(folder, outcome.folder, context.threads);
  outcome.compare_s = watch.lap();
  if (change) {
    outcome.change = *change;
  } else {
    outcome.no_change = change.error().message();
  }
}

}  // namespace

TaskOutcome ended_by(const SessionWork& work, Error error) {
  // Readers of images and LibRaw catch it, and what they then say is of a file.
  if (error.why.find("bad_alloc") != std::string::npos)
    error = {ErrorKind::kTryAgain, "out of memory", work.session.string(), error.what,
             "run it with more --memory, or on a larger machine"};
  TaskOutcome outcome;
  outcome.plan = work.header->id;
  outcome.session = work.planned.session;
  outcome.state = is_of_session(error.kind) ? TaskState::kFailed : TaskState::kLost;
  outcome.error = std::move(error);
  return outcome;
}

TaskOutcome work_on_session(const SessionWork& work, const JobContext& context) {
  Stopwatch watch;
  const Result<fs::path> calibration = check_session(work);
  if (!calibration) return ended_by(work, calibration.error());
  solve::SolveOptions options;
  options.method = work.planned.quality;
  options.plan = work.header->id;
  options.compression = compression_of(work.product);
  const Forecast& forecast = work.planned.forecast;
  if (forecast.solve_seconds > 0)
    options.foretold = SolvePrice{forecast.solve_seconds, forecast.degrees, forecast.solved, {}};
  const solve::SessionOptions input = {.folder = work.session, .calibration = *calibration, .leds = {}};
  const Result<solve::SolveReport> report = work.product.is_whole()
                                                ? solve_whole(input, options, work, context)
                                                : solve_lean(input, options, work, context);
  if (!report) return ended_by(work, report.error());
  TaskOutcome outcome;
  outcome.plan = work.header->id;
  outcome.session = work.planned.session;
  add_facts_of(*report, outcome);
  if (const Result<Session> session = read_session(work.session))
    outcome.verdict = verdict_with(*session, report->facts);
  const SolveOfSession solved = {work.session, work.solves / outcome.solve, *calibration};
  Result<std::vector<std::string>> made = make_follow_ups(solved, work.product, context);
  if (!made) return ended_by(work, std::move(made).error());
  outcome.made = std::move(*made);
  compare_with_before(work, context, outcome);
  outcome.seconds = watch.lap();
  return outcome;
}

}  // namespace weft::library
