// SPDX-License-Identifier: Apache-2.0
#include "library/batch/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/sha256.h"
#include "core/describe/field_json.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string id_of(Json header, std::string_view lines) {
  header.erase("id");
  return sha256_of(line_of(header) + std::string(lines)).substr(0, 16);
}

Error no_plan(const std::string& where, std::string why,
              std::string remedy = "make it again with weft batch plan") {
  return {ErrorKind::kBadData, "plan cannot be used", where, std::move(why), std::move(remedy)};
}

// Calls take(line) for each line.
template <typename Take>
void for_each_line(std::string_view text, const Take& take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// A list for each number of a task: a header of 10 000 tasks is then short.
class TaskLists {
 public:
  explicit TaskLists(const std::vector<TaskPlace>& tasks) {
    for (const TaskPlace& task : tasks) {
      offset.push_back(task.offset);
      bytes.push_back(task.bytes);
      sessions.push_back(task.sessions);
      seconds.push_back(task.seconds);
      memory.push_back(task.memory_bytes);
    }
  }

  bool fit() const {
    const auto fits = [&](const Json& list, double most) {
      return list.size() == offset.size() && std::ranges::all_of(list, [most](const Json& each) {
               return each.is_number() && each >= 0 && each <= most;
             });
    };
    return fits(offset, 1e15) && fits(bytes, 1e15) && fits(sessions, 1e9) && fits(seconds, 1e15) &&
           fits(memory, 1e15);
  }

  std::vector<TaskPlace> tasks() const {
    std::vector<TaskPlace> tasks(offset.size());
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      tasks[i] = {offset[i].get<std::uint64_t>(), bytes[i].get<std::uint64_t>(), sessions[i].get<int>(),
                  seconds[i].get<double>(), memory[i].get<std::uint64_t>()};
    }
    return tasks;
  }

  Json offset = Json::array(), bytes = Json::array(), sessions = Json::array(), seconds = Json::array(),
       memory = Json::array();
};

void describe(Fields& fields, TaskLists& t) {
  fields.value({"offset", "From the end of the header's line, by task", {}, kMustSay}, t.offset);
  fields.value({"bytes", "By task", {}, kMustSay}, t.bytes);
  fields.value({"sessions", "By task", {}, kMustSay}, t.sessions);
  fields.value({"seconds", "By task", {}, kMustSay}, t.seconds);
  fields.value({"memory_bytes", "By task, of its largest", {}, kMustSay}, t.memory);
}

template <typename Described>
Result<Described> from_line(std::string_view line, const std::string& where) {
  return read_fields<Described>(Json::parse(line, nullptr, false), where);
}

}  // namespace

void describe(Fields& fields, BatchProduct& p) {
  fields.value({"keep", "Maps that stay, by name; none: all", {}, kMustSay}, p.keep);
  fields.value({"half", "Normals as half floats"}, p.half);
  fields.value({"compression", "Of EXR files", {}, kMustSay}, p.compression);
  fields.value({"then", "Made of it afterwards: \"maps\", \"export:unreal\"", {}, kMustSay}, p.then);
}

void describe(Fields& fields, NamedCalibration& c) {
  fields.value({"folder", "Where it is", {}, kMustSay}, c.folder);
  fields.value({"id", "Its id", {}, kMustSay}, c.id);
  fields.value({"rig", "In place of those of this rig's sessions", {}, kMustSay}, c.rig);
}

void describe(Fields& fields, Forecast& f) {
  constexpr std::array<const char*, 2> kFrom = {"carried_over", "measured"};
  fields.value({"seconds", "That it is expected to take", {}, kMustSay}, f.seconds);
  fields.value({"seconds_spread", "A standard deviation; 0: not known", {}, kMustSay}, f.seconds_spread);
  fields.value({"predicted_deg", "Mean error of the normals, degrees", {}, kMustSay}, f.degrees);
  fields.value({"predicted_deg_spread", "A standard deviation, degrees", {}, kMustSay}, f.degrees_spread);
  fields.choice({"from", "Measured on this very session, or on others", {}, kMustSay}, f.is_measured, kFrom);
  fields.value({"turn_deg", "Mean angle to the solve before, degrees"}, f.turn_deg);
  std::optional<double> solved = f.solve_seconds > 0 ? std::optional(f.solved) : std::nullopt;
  fields.value({"predicted_solved", "Share of the cloth that has a normal; since 1.1"}, solved);
  f.solved = solved.value_or(1);
  fields.value({"solve_seconds", "Of the solve alone; since 1.1", {}, kUnlessEmpty}, f.solve_seconds);
}

void describe(Fields& fields, PlannedSolve& j) {
  fields.value({"session", "Its folder", {}, kMustSay}, j.session);
  fields.value({"task", "From 0", {}, kMustSay}, j.task);
  fields.value({"quality", "Level", {}, kMustSay}, j.quality);
  fields.value({"digest",
                "SHA-256 of session.json but fabric, metadata, current_solve, current_solve_for, copy",
                {},
                kMustSay},
               j.digest);
  fields.value({"solve", "Id that its solve will have", {}, kMustSay}, j.solve);
  fields.value({"before", "Id of the solve that it is compared with; empty: none", {}, kMustSay}, j.before);
  fields.value({"calibration", "Its id", {}, kMustSay}, j.calibration);
  fields.value({"rig", "Its name", {}, kMustSay}, j.rig);
  fields.value({"fabric", "What was scanned", {}, kMustSay}, j.fabric);
  fields.value({"megapixels", "Of a frame", {}, kMustSay}, j.megapixels);
  describe(fields, j.forecast);
  fields.value({"memory_bytes", "That it needs, with a quarter and 200 MB added", {}, kMustSay},
               j.memory_bytes);
  fields.value({"read_bytes", "That it reads", {}, kMustSay}, j.read_bytes);
  fields.value({"write_bytes", "That it writes", {}, kMustSay}, j.write_bytes);
}

void describe(Fields& fields, SkippedSession& l) {
  fields.value({"session", "Its folder", {}, kMustSay}, l.session);
  fields.choice({"left_out", "Why it is not solved", {}, kMustSay}, l.reason, kReasonNames);
  fields.value({"kind", "Of an error", {}, kMustSay}, l.kind);
  fields.value({"said", "One sentence", {}, kMustSay}, l.said);
  fields.value({"seconds", "That are saved", {}, kMustSay}, l.seconds);
}

void describe(Fields& fields, LevelTotal& l) {
  fields.value({"quality", "Level", {}, kMustSay}, l.quality);
  fields.value({"hours", "Of all sessions at it", {}, kMustSay}, l.hours);
  fields.value({"mean_deg", "Mean error of the normals, degrees", {}, kMustSay}, l.mean_deg);
  fields.value({"spread_deg", "A standard deviation, degrees", {}, kMustSay}, l.spread_deg);
  fields.value({"sessions", "That are solved at it", {}, kMustSay}, l.sessions);
  fields.value({"solved", "Share of the cloth that mean_deg holds for; since 1.1"}, l.solved);
}

void describe(Fields& fields, Spent& s) {
  fields.value({"hours", "Given out", {}, kMustSay}, s.hours);
  fields.value({"mean_deg", "That they buy, over the whole cloth, degrees", {}, kMustSay}, s.mean_deg);
}

void describe(Fields& fields, BatchHeader& h) {
  fields.value({"id", "16 digits of the SHA-256 of all else", {}, kMustSay}, h.id);
  fields.value({"archive", "The folder that holds all sessions", {}, kMustSay}, h.archive);
  fields.value(
      {"output", "Folder for solves that mirrors the archive; empty: each in its session", {}, kMustSay},
      h.output);
  fields.object({"product", "What becomes of each solve", {}, kMustSay}, h.product);
  fields.list({"calibrations", "In place of the sessions' own", {}, kMustSay}, h.calibrations);
  fields.value({"solver_version", "As solve.json has it", {}, kMustSay}, h.solver_version);
  fields.value({"threads", "That the seconds hold for", {}, kMustSay}, h.threads);
  fields.value({"sampled", "Sessions that were measured", {}, kMustSay}, h.sampled);
  fields.value({"sample_seconds", "That this took", {}, kMustSay}, h.sample_seconds);
  fields.value({"sessions", "That are solved", {}, kMustSay}, h.sessions);
  fields.value({"left_out", "Sessions that are not", {}, kMustSay}, h.left_out);
  fields.list({"levels", "Those that were measured", {}, kMustSay}, h.levels);
  fields.list({"curve", "Of --within: where hours were given out", {}, kMustSay}, h.curve);
  TaskLists lists(h.tasks);
  fields.object({"tasks", "Where the lines of each lie, and what they cost", {}, kMustSay}, lists);
  fields.require(lists.fit(), "tasks", "has lists that do not belong together");
  if (lists.fit()) h.tasks = lists.tasks();
}

namespace {

Json document_of(const BatchHeader& header) {
  const bool has_shares =
      std::ranges::any_of(header.levels, [](const LevelTotal& each) { return each.solved.has_value(); });
  Json json = {{"schema", fmt::format("{}{}", kPlanSchema, has_shares ? ".1" : "")}};
  write_fields(json, header);
  return json;
}

}  // namespace

MeanError error_of(std::span<const PlannedSolve> solves) {
  MeanError error;
  for (const PlannedSolve& planned : solves) error.add(planned.forecast.degrees, planned.forecast.solved);
  return error;
}

std::string digest_of_session(Json document) {
  for (const char* said : {"fabric", "metadata", "current_solve", "current_solve_for", "copy"})
    document.erase(said);
  return sha256_of(document.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void share_out(std::vector<PlannedSolve>& solves, double task_seconds) {
  int task = -1, sessions = 0;
  double seconds = 0;
  for (PlannedSolve& planned : solves) {
    const bool is_full = seconds + planned.forecast.seconds > task_seconds || sessions == kMostOfTask;
    if (task < 0 || (sessions > 0 && is_full)) ++task, seconds = 0, sessions = 0;
    seconds += planned.forecast.seconds;
    ++sessions;
    planned.task = task;
  }
}

std::string text_of(BatchPlan& plan) {
  BatchHeader& header = plan.header;
  std::string lines;
  header.tasks.clear();
  for (const PlannedSolve& planned : plan.solves) {
    if (static_cast<std::size_t>(planned.task) == header.tasks.size()) header.tasks.push_back({lines.size()});
    const std::string line = line_of(object_of(planned));
    TaskPlace& task = header.tasks.back();
    task.bytes += line.size();
    task.sessions += 1;
    task.seconds += planned.forecast.seconds;
    task.memory_bytes = std::max(task.memory_bytes, planned.memory_bytes);
    lines += line;
  }
  for (const SkippedSession& left : plan.left_out) lines += line_of(object_of(left));
  header.sessions = static_cast<int>(plan.solves.size());
  header.left_out = static_cast<int>(plan.left_out.size());
  header.id = id_of(document_of(header), lines);
  return line_of(document_of(header)) + lines;
}

Result<BatchHeader> header_from_line(std::string_view line, const std::string& where) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return no_plan(where, "its first line is no JSON object");
  const std::string schema =
      json.value("schema", Json()).is_string() ? json["schema"].get<std::string>() : "";
  if (schema != kPlanSchema && !schema.starts_with(std::string(kPlanSchema) + ".")) {
    return no_plan(where, fmt::format("its schema is \"{}\"; this program reads {}", schema, kPlanSchema),
                   "make it again with weft batch plan of this version");
  }
  return read_fields<BatchHeader>(json, where);
}

Result<std::vector<PlannedSolve>> solves_from_lines(std::string_view lines, const std::string& where) {
  std::vector<PlannedSolve> solves;
  std::optional<Error> wrong;
  for_each_line(lines, [&](std::string_view line) {
    if (wrong) return;
    Result<PlannedSolve> planned = from_line<PlannedSolve>(line, where);
    if (planned) {
      solves.push_back(std::move(*planned));
    } else {
      wrong = std::move(planned).error();
    }
  });
  if (wrong) return *wrong;
  return solves;
}

Result<BatchPlan> plan_from_text(std::string_view text, const std::string& where) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  Result<BatchHeader> header = header_from_line(text.substr(0, end), where);
  if (!header) return std::move(header).error();
  const std::string_view lines = text.substr(std::min(end + 1, text.size()));
  if (id_of(Json::parse(text.substr(0, end)), lines) != header->id)
    return no_plan(where, "it was changed since it was written, or its end is missing");
  BatchPlan plan;
  plan.header = std::move(*header);
  std::optional<Error> wrong;
  for_each_line(lines, [&](std::string_view line) {
    if (wrong) return;
    const Json json = Json::parse(line, nullptr, false);
    if (json.is_object() && json.contains("left_out")) {
      Result<SkippedSession> left = read_fields<SkippedSession>(json, where);
      if (!left) wrong = std::move(left).error();
      if (left) plan.left_out.push_back(std::move(*left));
      return;
    }
    Result<PlannedSolve> planned = read_fields<PlannedSolve>(json, where);
    if (!planned) wrong = std::move(planned).error();
    if (planned) plan.solves.push_back(std::move(*planned));
  });
  if (wrong) return *wrong;
  return plan;
}

std::string solve_parent(const BatchHeader& header, const std::string& session) {
  if (header.output.empty()) return (fs::path(session) / "solve").string();
  const fs::path below = fs::path(session).lexically_relative(header.archive);
  const bool leads_out = below.empty() || *below.begin() == "..";
  return (fs::path(header.output) / (leads_out ? fs::path(session).relative_path() : below) / "solve")
      .string();
}

}  // namespace weft::library
