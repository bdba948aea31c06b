// SPDX-License-Identifier: Apache-2.0
#include "library/batch/outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/describe/error_json.h"
#include "core/describe/field_json.h"

namespace weft::library {
namespace {

constexpr const char* kSchema = "weft.batch-result/1";

void describe_done(Fields& fields, TaskOutcome& o) {
  fields.value({"solve", "Its id", {}, kMustSay}, o.solve);
  fields.value({"folder", "Where it is", {}, kMustSay}, o.folder);
  fields.value({"stored", "The folder is where it was sent to, which this machine may not see"}, o.is_stored);
  fields.value({"read_s", "Seconds of reading", {}, kMustSay}, o.read_s);
  fields.value({"solve_s", "Seconds of solving", {}, kMustSay}, o.solve_s);
  fields.value({"compare_s", "Seconds of comparing", {}, kMustSay}, o.compare_s);
  fields.value({"expected_deg", "Mean error to expect; 0 where it was there", {}, kMustSay}, o.expected_deg);
  fields.value({"sigma_deg", "Median angle that sigma.exr predicts, degrees", {}, kMustSay}, o.sigma_deg);
  fields.value({"sigma_p95_deg", "Its 95th percentile, degrees", {}, kMustSay}, o.sigma_p95_deg);
  fields.value({"unsolved", "Share of pixels", {}, kMustSay}, o.unsolved);
  fields.value({"solved", "Share of the cloth that has a normal; since 1.1"}, o.solved);
  fields.value({"left_out", "Rms of how left-out lights are predicted, a share"}, o.left_out);
  fields.value({"warnings", "By name"}, o.warnings);
  fields.value({"frames", "What is said of frames that lie", {}, kUnlessEmpty}, o.frames);
  fields.object({"verdict", "What the scan is worth with this solve", {}, kUnlessEmpty}, o.verdict);
  fields.value({"made", "Folders of maps and exports"}, o.made);
  fields.object({"change", "From the solve before", {}, kUnlessEmpty}, o.change);
  fields.value({"no_change", "Why it could not be compared with the solve before", {}, kUnlessEmpty},
               o.no_change);
}

}  // namespace

bool operator==(const TaskOutcome& a, const TaskOutcome& b) {
  return line_of(a) == line_of(b);
}

bool is_of_session(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kBadData:
    case ErrorKind::kNoInput:
    case ErrorKind::kInternal:
    case ErrorKind::kUsage:
      return true;
    case ErrorKind::kNoDevice:
    case ErrorKind::kCannotCreate:
    case ErrorKind::kInputOutput:
    case ErrorKind::kTryAgain:
    case ErrorKind::kProtocol:
    case ErrorKind::kInterrupted:
      return false;
  }
  return false;
}

void describe(Fields& fields, TaskOutcome& o) {
  fields.value({"plan", "Id of the plan", {}, kMustSay}, o.plan);
  fields.value({"session", "Its folder", {}, kMustSay}, o.session);
  fields.choice({"state", "What became of it", {}, kMustSay}, o.state, kStateNames);
  fields.value({"attempt", "From 1", {}, kMustSay}, o.attempt);
  fields.value({"host", "Where it ran", {}, kMustSay}, o.host);
  fields.value({"seconds", "Wall", {}, kMustSay}, o.seconds);
  fields.value({"node_seconds", "The same of a machine that has all threads to itself", {}, kMustSay},
               o.node_seconds);
  fields.value({"peak_bytes", "Of memory", {}, kMustSay}, o.peak_bytes);
  fields.object({"error", "Why it failed, or was lost", {}, kUnlessEmpty}, o.error);
  fields.only_if(o.is_done(), [&] { describe_done(fields, o); });
}

std::string line_of(const TaskOutcome& outcome) {
  Json json = {{"schema", fmt::format("{}{}", kSchema, outcome.solved ? ".1" : "")}};
  write_fields(json, outcome);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<TaskOutcome> outcome_from_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return {};
  const Json schema = json.value("schema", Json());
  if (!schema.is_string() || !schema.get<std::string>().starts_with(kSchema)) return {};
  Result<TaskOutcome> outcome = read_fields<TaskOutcome>(json, "result");
  return outcome ? std::optional(std::move(*outcome)) : std::nullopt;
}

void add_histories(std::string_view lines, const std::string& plan, std::map<std::string, TaskHistory>& all) {
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    std::optional<TaskOutcome> outcome = outcome_from_line(lines.substr(0, end));
    lines.remove_prefix(std::min(end + 1, lines.size()));
    if (!outcome || outcome->plan != plan) continue;
    TaskHistory& history = all[outcome->session];
    ++history.attempts;
    if (outcome->is_result()) {
      history.result = std::move(*outcome);
      history.lost.reset();
    } else {
      history.lost = std::move(*outcome);
    }
  }
}

}  // namespace weft::library
