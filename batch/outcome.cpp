// SPDX-License-Identifier: Apache-2.0
#include "batch/outcome.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error_json.h"

namespace weft::batch {
namespace {

constexpr const char* kSchema = "weft.batch-result/1";

std::vector<std::string> texts_in(JsonFields& fields, const char* key) {
  std::vector<std::string> texts;
  if (!fields.has(key)) return texts;
  for (const Json& each : fields.list(key)) {
    if (each.is_string()) texts.push_back(each.get<std::string>());
  }
  return texts;
}

}  // namespace

bool operator==(const Outcome& a, const Outcome& b) {
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

std::string line_of(const Outcome& o) {
  Json json = {{"schema", fmt::format("{}{}", kSchema, o.solved ? ".1" : "")},
               {"plan", o.plan},
               {"session", o.session},
               {"state", kStateNames[static_cast<std::size_t>(o.state)]},
               {"attempt", o.attempt},
               {"host", o.host},
               {"seconds", o.seconds},
               {"node_seconds", o.node_seconds},
               {"peak_bytes", o.peak_bytes}};
  if (o.error) json["error"] = json_of(*o.error);
  if (o.is_done()) {
    json["solve"] = o.solve;
    json["folder"] = o.folder;
    json["stored"] = o.is_stored;
    json["read_s"] = o.read_s;
    json["solve_s"] = o.solve_s;
    json["compare_s"] = o.compare_s;
    json["expected_deg"] = o.expected_deg;
    json["sigma_deg"] = o.sigma_deg;
    json["sigma_p95_deg"] = o.sigma_p95_deg;
    json["unsolved"] = o.unsolved;
    if (o.solved) json["solved"] = *o.solved;
    if (o.left_out) json["left_out"] = *o.left_out;
    json["warnings"] = o.warnings;
    json["made"] = o.made;
    if (o.change) json["change"] = json_of(*o.change);
    if (!o.no_change.empty()) json["no_change"] = o.no_change;
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::optional<Outcome> outcome_from_line(std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return {};
  JsonFields fields(json, "result");
  Outcome o;
  o.plan = fields.text("plan");
  o.session = fields.text("session");
  o.state = fields.one_of<State>("state", kStateNames);
  o.attempt = fields.integer("attempt");
  o.host = fields.text("host");
  o.seconds = fields.number("seconds");
  o.node_seconds = fields.number("node_seconds");
  o.peak_bytes = static_cast<std::uint64_t>(std::max(0.0, fields.number("peak_bytes")));
  if (fields.has("error")) o.error = error_of_json(json["error"], "result");
  if (!fields.status()) return {};
  if (!o.is_done()) return o;
  o.solve = fields.text("solve");
  o.folder = fields.text("folder");
  o.is_stored = json.value("stored", Json()) == true;
  o.read_s = fields.number("read_s");
  o.solve_s = fields.number("solve_s");
  o.compare_s = fields.number("compare_s");
  o.expected_deg = fields.number("expected_deg");
  o.sigma_deg = fields.number("sigma_deg");
  o.sigma_p95_deg = fields.number("sigma_p95_deg");
  o.unsolved = fields.number("unsolved");
  o.solved = fields.optional_number("solved");
  o.left_out = fields.optional_number("left_out");
  o.warnings = texts_in(fields, "warnings");
  o.made = texts_in(fields, "made");
  o.no_change = fields.text_or("no_change", "");
  if (fields.has("change")) {
    Result<Change> change = change_from_json(json["change"], "result");
    if (!change) return {};
    o.change = std::move(*change);
  }
  if (!fields.status()) return {};
  return o;
}

void add_histories(std::string_view lines, const std::string& plan, std::map<std::string, History>& all) {
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    std::optional<Outcome> outcome = outcome_from_line(lines.substr(0, end));
    lines.remove_prefix(std::min(end + 1, lines.size()));
    if (!outcome || outcome->plan != plan) continue;
    History& history = all[outcome->session];
    ++history.attempts;
    if (outcome->is_result()) {
      history.result = std::move(*outcome);
      history.lost.reset();
    } else {
      history.lost = std::move(*outcome);
    }
  }
}

std::map<std::string, History> histories_of(std::string_view lines, const std::string& plan) {
  std::map<std::string, History> all;
  add_histories(lines, plan, all);
  return all;
}

}  // namespace weft::batch
