// SPDX-License-Identifier: Apache-2.0
#include "batch/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/files.h"

namespace weft::batch {
namespace {

namespace fs = std::filesystem;

std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<std::string> texts_of(JsonFields& fields, const char* key) {
  std::vector<std::string> texts;
  for (const Json& each : fields.list(key)) {
    if (each.is_string()) {
      texts.push_back(each.get<std::string>());
    } else {
      fields.reject(key, "holds something other than texts");
    }
  }
  return texts;
}

std::uint64_t count_of(JsonFields& fields, const char* key) {
  const double number = fields.number(key);
  if (number < 0 || number > 9e15) fields.reject(key, "is no count");
  return static_cast<std::uint64_t>(std::clamp(number, 0.0, 9e15));
}

Json json_of(const Product& product) {
  return {{"keep", product.keep},
          {"half", product.half},
          {"compression", product.compression},
          {"then", product.then}};
}

Result<Product> product_from(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  Product product;
  product.keep = texts_of(fields, "keep");
  product.half = json.value("half", Json()) == true;
  product.compression = fields.text("compression");
  product.then = texts_of(fields, "then");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return product;
}

Json json_of(const Forecast& forecast) {
  Json json = {{"seconds", forecast.seconds},
               {"seconds_spread", forecast.seconds_spread},
               {"predicted_deg", forecast.degrees},
               {"predicted_deg_spread", forecast.degrees_spread},
               {"from", forecast.is_measured ? "measured" : "carried_over"}};
  if (forecast.turn_deg) json["turn_deg"] = *forecast.turn_deg;
  if (forecast.solve_seconds > 0) {
    json["predicted_solved"] = forecast.solved;
    json["solve_seconds"] = forecast.solve_seconds;
  }
  return json;
}

Json json_of(const Job& job) {
  Json json = {{"session", job.session},         {"task", job.task},   {"quality", job.quality},
               {"digest", job.digest},           {"solve", job.solve}, {"before", job.before},
               {"calibration", job.calibration}, {"rig", job.rig},     {"fabric", job.fabric},
               {"megapixels", job.megapixels}};
  json.update(json_of(job.forecast));
  json["memory_bytes"] = job.memory_bytes;
  json["read_bytes"] = job.read_bytes;
  json["write_bytes"] = job.write_bytes;
  return json;
}

Result<Job> job_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  Job job;
  job.session = fields.text("session");
  job.task = fields.integer("task");
  job.quality = fields.text("quality");
  job.digest = fields.text("digest");
  job.solve = fields.text("solve");
  job.before = fields.text("before");
  job.calibration = fields.text("calibration");
  job.rig = fields.text("rig");
  job.fabric = fields.text("fabric");
  job.megapixels = fields.number("megapixels");
  Forecast& forecast = job.forecast;
  forecast.seconds = fields.number("seconds");
  forecast.seconds_spread = fields.number("seconds_spread");
  forecast.degrees = fields.number("predicted_deg");
  forecast.degrees_spread = fields.number("predicted_deg_spread");
  forecast.is_measured = fields.one_of<int, 2>("from", {"carried_over", "measured"}) == 1;
  forecast.turn_deg = fields.optional_number("turn_deg");
  forecast.solved = fields.optional_number("predicted_solved").value_or(1);
  forecast.solve_seconds = fields.optional_number("solve_seconds").value_or(0);
  job.memory_bytes = count_of(fields, "memory_bytes");
  job.read_bytes = count_of(fields, "read_bytes");
  job.write_bytes = count_of(fields, "write_bytes");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return job;
}

Json json_of(const LeftOut& left) {
  return {{"session", left.session},
          {"left_out", kReasonNames[static_cast<std::size_t>(left.reason)]},
          {"kind", left.kind},
          {"said", left.said},
          {"seconds", left.seconds}};
}

Result<LeftOut> left_out_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  LeftOut left;
  left.session = fields.text("session");
  left.reason = fields.one_of<Reason>("left_out", kReasonNames);
  left.kind = fields.text("kind");
  left.said = fields.text("said");
  left.seconds = fields.number("seconds");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return left;
}

// A list for each number of a task: a header of 10 000 tasks is then short.
Json json_of(const std::vector<TaskPlace>& tasks) {
  Json offset = Json::array(), bytes = Json::array(), sessions = Json::array(), seconds = Json::array(),
       memory = Json::array();
  for (const TaskPlace& task : tasks) {
    offset.push_back(task.offset);
    bytes.push_back(task.bytes);
    sessions.push_back(task.sessions);
    seconds.push_back(task.seconds);
    memory.push_back(task.memory_bytes);
  }
  return {{"offset", std::move(offset)},
          {"bytes", std::move(bytes)},
          {"sessions", std::move(sessions)},
          {"seconds", std::move(seconds)},
          {"memory_bytes", std::move(memory)}};
}

std::vector<TaskPlace> tasks_from(JsonFields& header) {
  JsonFields fields(header.object("tasks"), header.where() + ": tasks");
  const std::array lists = {&fields.list("offset"), &fields.list("bytes"), &fields.list("sessions"),
                            &fields.list("seconds"), &fields.list("memory_bytes")};
  std::vector<TaskPlace> tasks(lists.front()->size());
  for (const Json* list : lists) {
    const double most = list == lists[2] ? 1e9 : 1e15;
    const bool fits = list->size() == tasks.size() && std::ranges::all_of(*list, [most](const Json& v) {
                        return v.is_number() && v >= 0 && v <= most;
                      });
    if (fits) continue;
    header.reject("tasks", "has lists that do not belong together");
    return {};
  }
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    tasks[i] = {(*lists[0])[i].get<std::uint64_t>(), (*lists[1])[i].get<std::uint64_t>(),
                (*lists[2])[i].get<int>(), (*lists[3])[i].get<double>(), (*lists[4])[i].get<std::uint64_t>()};
  }
  return tasks;
}

Json json_of(const Header& header) {
  Json levels = Json::array(), curve = Json::array(), calibrations = Json::array();
  bool has_shares = false;
  for (const LevelTotal& level : header.levels) {
    levels.push_back({{"quality", level.quality},
                      {"hours", level.hours},
                      {"mean_deg", level.mean_deg},
                      {"spread_deg", level.spread_deg},
                      {"sessions", level.sessions}});
    if (level.solved) levels.back()["solved"] = *level.solved;
    has_shares |= level.solved.has_value();
  }
  for (const Spent& spent : header.curve)
    curve.push_back({{"hours", spent.hours}, {"mean_deg", spent.mean_deg}});
  for (const NamedCalibration& each : header.calibrations)
    calibrations.push_back({{"folder", each.folder}, {"id", each.id}, {"rig", each.rig}});
  return {{"schema", fmt::format("{}{}", kPlanSchema, has_shares ? ".1" : "")},
          {"id", header.id},
          {"archive", header.archive},
          {"output", header.output},
          {"product", json_of(header.product)},
          {"calibrations", std::move(calibrations)},
          {"solver_version", header.solver_version},
          {"threads", header.threads},
          {"sampled", header.sampled},
          {"sample_seconds", header.sample_seconds},
          {"sessions", header.sessions},
          {"left_out", header.left_out},
          {"levels", std::move(levels)},
          {"curve", std::move(curve)},
          {"tasks", json_of(header.tasks)}};
}

std::string id_of(Json header, std::string_view lines) {
  header.erase("id");
  return sha256_of(line_of(header) + std::string(lines)).substr(0, 16);
}

Error no_plan(const std::string& where, std::string why,
              std::string remedy = "make it again with weft batch plan") {
  return {ErrorKind::kBadData, "plan cannot be used", where, std::move(why), std::move(remedy)};
}

// Calibrations, levels and the curve.
Result<void> read_lists(JsonFields& fields, const std::string& where, Header& header) {
  for (const Json& each : fields.list("calibrations")) {
    JsonFields named(each, where + ": calibrations");
    header.calibrations.push_back({named.text("folder"), named.text("id"), named.text("rig")});
    if (Result<void> ok = named.status(); !ok) return ok;
  }
  for (const Json& each : fields.list("levels")) {
    JsonFields level(each, where + ": levels");
    header.levels.push_back({level.text("quality"), level.number("hours"), level.number("mean_deg"),
                             level.number("spread_deg"), level.integer("sessions"),
                             level.optional_number("solved")});
    if (Result<void> ok = level.status(); !ok) return ok;
  }
  for (const Json& each : fields.list("curve")) {
    JsonFields spent(each, where + ": curve");
    header.curve.push_back({spent.number("hours"), spent.number("mean_deg")});
    if (Result<void> ok = spent.status(); !ok) return ok;
  }
  return {};
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

}  // namespace

MeanError error_of(std::span<const Job> jobs) {
  MeanError error;
  for (const Job& job : jobs) error.add(job.forecast.degrees, job.forecast.solved);
  return error;
}

std::string digest_of_session(Json document) {
  for (const char* said : {"fabric", "metadata", "current_solve", "current_solve_for", "copy"})
    document.erase(said);
  return sha256_of(document.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void share_out(std::vector<Job>& jobs, double task_seconds) {
  int task = -1, sessions = 0;
  double seconds = 0;
  for (Job& job : jobs) {
    const bool is_full = seconds + job.forecast.seconds > task_seconds || sessions == kMostOfTask;
    if (task < 0 || (sessions > 0 && is_full)) ++task, seconds = 0, sessions = 0;
    seconds += job.forecast.seconds;
    ++sessions;
    job.task = task;
  }
}

std::string text_of(Plan& plan) {
  Header& header = plan.header;
  std::string lines;
  header.tasks.clear();
  for (const Job& job : plan.jobs) {
    if (static_cast<std::size_t>(job.task) == header.tasks.size()) header.tasks.push_back({lines.size()});
    const std::string line = line_of(json_of(job));
    TaskPlace& task = header.tasks.back();
    task.bytes += line.size();
    task.sessions += 1;
    task.seconds += job.forecast.seconds;
    task.memory_bytes = std::max(task.memory_bytes, job.memory_bytes);
    lines += line;
  }
  for (const LeftOut& left : plan.left_out) lines += line_of(json_of(left));
  header.sessions = static_cast<int>(plan.jobs.size());
  header.left_out = static_cast<int>(plan.left_out.size());
  header.id = id_of(json_of(header), lines);
  return line_of(json_of(header)) + lines;
}

Result<Header> header_from_line(std::string_view line, const std::string& where) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return no_plan(where, "its first line is no JSON object");
  const std::string schema =
      json.value("schema", Json()).is_string() ? json["schema"].get<std::string>() : "";
  if (schema != kPlanSchema && !schema.starts_with(std::string(kPlanSchema) + ".")) {
    return no_plan(where, fmt::format("its schema is \"{}\"; this program reads {}", schema, kPlanSchema),
                   "make it again with weft batch plan of this version");
  }
  JsonFields fields(json, where);
  Header header;
  header.id = fields.text("id");
  header.archive = fields.text("archive");
  header.output = fields.text("output");
  Result<Product> product = product_from(fields.object("product"), where + ": product");
  if (!product) return std::move(product).error();
  header.product = std::move(*product);
  header.solver_version = fields.integer("solver_version");
  header.threads = fields.integer("threads");
  header.sampled = fields.integer("sampled");
  header.sample_seconds = fields.number("sample_seconds");
  header.sessions = fields.integer("sessions");
  header.left_out = fields.integer("left_out");
  if (Result<void> ok = read_lists(fields, where, header); !ok) return std::move(ok).error();
  header.tasks = tasks_from(fields);
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return header;
}

Result<std::vector<Job>> jobs_from_lines(std::string_view lines, const std::string& where) {
  std::vector<Job> jobs;
  std::optional<Error> wrong;
  for_each_line(lines, [&](std::string_view line) {
    if (wrong) return;
    const Json json = Json::parse(line, nullptr, false);
    Result<Job> job = job_from_json(json, where);
    if (job) {
      jobs.push_back(std::move(*job));
    } else {
      wrong = std::move(job).error();
    }
  });
  if (wrong) return *wrong;
  return jobs;
}

Result<Plan> plan_from_text(std::string_view text, const std::string& where) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  Result<Header> header = header_from_line(text.substr(0, end), where);
  if (!header) return std::move(header).error();
  const std::string_view lines = text.substr(std::min(end + 1, text.size()));
  if (id_of(Json::parse(text.substr(0, end)), lines) != header->id)
    return no_plan(where, "it was changed since it was written, or its end is missing");
  Plan plan;
  plan.header = std::move(*header);
  std::optional<Error> wrong;
  for_each_line(lines, [&](std::string_view line) {
    if (wrong) return;
    const Json json = Json::parse(line, nullptr, false);
    if (json.is_object() && json.contains("left_out")) {
      Result<LeftOut> left = left_out_from_json(json, where);
      if (!left) wrong = std::move(left).error();
      if (left) plan.left_out.push_back(std::move(*left));
      return;
    }
    Result<Job> job = job_from_json(json, where);
    if (!job) wrong = std::move(job).error();
    if (job) plan.jobs.push_back(std::move(*job));
  });
  if (wrong) return *wrong;
  return plan;
}

std::string solve_parent(const Header& header, const std::string& session) {
  if (header.output.empty()) return (fs::path(session) / "solve").string();
  const fs::path below = fs::path(session).lexically_relative(header.archive);
  const bool leads_out = below.empty() || *below.begin() == "..";
  return (fs::path(header.output) / (leads_out ? fs::path(session).relative_path() : below) / "solve")
      .string();
}

}  // namespace weft::batch
