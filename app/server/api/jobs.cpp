// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "app/server/api/scan_body.h"

namespace weft::app {
namespace {

constexpr int kMostJobs = 1000;

Error refused(const std::string& field, const std::string& rule) {
  return {ErrorKind::kUsage, "job cannot be read", field, rule, "see POST jobs in openapi.json"};
}

// A field of the body that becomes an option of the verb.
struct JobOption {
  const char* field;
  const char* option;
  bool is_number;
};
constexpr JobOption kOfSolve[] = {{"quality", "--quality", false},
                                  {"method", "--method", false},
                                  {"within_s", "--within", true},
                                  {"to_deg", "--to", true}};
constexpr JobOption kOfRectify[] = {
    {"solve", "--solve", false}, {"mm_per_pixel", "--mm-per-pixel", true}, {"turn_deg", "--turn", true}};

// A verb that works on one session.
struct JobKind {
  const char* name;
  const char* verb;
  std::span<const JobOption> options;
  std::vector<std::string> always;  // further arguments
};

const std::vector<JobKind>& job_kinds() {
  static const std::vector<JobKind> kinds = {{"solve", "solve", kOfSolve, {}},
                                             {"price", "solve", {}, {"--explain"}},
                                             {"rectify", "rectify", kOfRectify, {}}};
  return kinds;
}

// Words never begin with a dash, so none of them is taken for an option.
Result<std::string> word_of(const Json& body, const char* field) {
  const Json value = body.value(field, Json());
  if (!value.is_string() || value == "") return refused(field, "must be a text");
  std::string word = value.get<std::string>();
  const bool is_plain = word.size() <= 100 && std::ranges::all_of(word, [](unsigned char c) {
                          return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
                        });
  if (!is_plain || word.starts_with('-')) return refused(field, "must be a plain word");
  return word;
}

Result<JobSpec> spec_of(const RigParts& parts, const Json& body) {
  const Result<std::string> kind = word_of(body, "kind");
  if (!kind) return kind.error();
  const auto known = std::ranges::find(job_kinds(), *kind, &JobKind::name);
  if (known == job_kinds().end()) return refused("kind", "must be solve, price or rectify");
  const Result<std::string> name = word_of(body, "session");
  if (!name) return name.error();
  const Result<Session> session = parts.library.session(*name);
  if (!session) return session.error();
  JobSpec spec = {*kind, *name, {known->verb, session->folder.string()}, "", ""};
  spec.arguments.insert(spec.arguments.end(), known->always.begin(), known->always.end());
  for (const auto& [field, value] : body.items()) {
    if (field == "kind" || field == "session") continue;
    if (field == "request_id") {
      const Result<std::string> id = word_of(body, "request_id");
      if (!id) return id.error();
      spec.request_id = *id;
      continue;
    }
    const auto option = std::ranges::find(known->options, std::string_view(field),
                                          [](const JobOption& o) { return o.field; });
    if (option == known->options.end())
      return refused(field.substr(0, 40), fmt::format("is no field of a {} job", known->name));
    spec.arguments.emplace_back(option->option);
    if (option->is_number) {
      if (!value.is_number()) return refused(field, "must be a number");
      spec.arguments.push_back(fmt::format("{}", value.get<double>()));
    } else {
      const Result<std::string> word = word_of(body, option->field);
      if (!word) return word.error();
      spec.arguments.push_back(*word);
    }
  }
  return spec;
}

Result<Reply> add_job(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  Result<JobSpec> spec = spec_of(parts, *body);
  if (!spec) return std::move(spec).error();
  spec->by = parts.controls.name_of(call.control);
  const Result<JobStatus> job = parts.jobs.add(*spec);
  if (!job) return job.error();
  return json_reply(json_of(*job), kAccepted);
}

Result<int> number_of(const Call& call, const char* key, int otherwise) {
  const auto found = call.query.find(key);
  if (found == call.query.end()) return otherwise;
  int number = 0;
  const std::string& text = found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1)
    return refused(key, "must be a number from 1");
  return number;
}

// Newest first; `after` is the id that ended the page before.
Result<Reply> list_jobs(const RigParts& parts, const Call& call) {
  const Result<int> limit = number_of(call, "limit", 100);
  if (!limit) return limit.error();
  std::vector<JobStatus> all = parts.jobs.list();
  if (const auto after = call.query.find("after"); after != call.query.end())
    std::erase_if(all, [&](const JobStatus& job) { return job.id >= after->second; });
  const std::size_t count = std::min(all.size(), static_cast<std::size_t>(std::min(*limit, kMostJobs)));
  Json jobs = Json::array();
  for (std::size_t i = 0; i < count; ++i) jobs.push_back(json_of(all[i]));
  return json_reply(
      {{"jobs", std::move(jobs)}, {"after", count < all.size() ? Json(all[count - 1].id) : Json()}});
}

Result<Reply> one_job(const RigParts& parts, const Call& call) {
  const Result<JobStatus> job = parts.jobs.find(call.segments.at(0));
  if (!job) return job.error();
  return json_reply(json_of(*job));
}

Result<Reply> forget_job(const RigParts& parts, const Call& call) {
  const Result<JobStatus> job = parts.jobs.forget(call.segments.at(0));
  if (!job) return job.error();
  return json_reply(json_of(*job));
}

Result<Reply> log_of_job(const RigParts& parts, const Call& call) {
  Result<std::string> log = parts.jobs.log(call.segments.at(0));
  if (!log) return std::move(log).error();
  return Reply{200, "text/plain; charset=utf-8", std::move(*log)};
}

using JobStep = Result<JobStatus> (JobQueue::*)(const std::string&);

Route step_route(const RigParts& parts, const char* path, JobStep step) {
  return {"POST", path, [&parts, step](const Call& call) -> Result<Reply> {
            if (const Result<Json> body = parse_body(call.body); !body) return body.error();
            const Result<JobStatus> job = (parts.jobs.*step)(call.segments.at(0));
            if (!job) return job.error();
            return json_reply(json_of(*job), kAccepted);
          }};
}

}  // namespace

Resource jobs_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/jobs", [&parts](const Call& call) { return list_jobs(parts, call); }},
           {"POST", "/api/v1/jobs", [&parts](const Call& call) { return add_job(parts, call); }},
           {"GET", "/api/v1/jobs/{id}", [&parts](const Call& call) { return one_job(parts, call); }},
           {"DELETE", "/api/v1/jobs/{id}", [&parts](const Call& call) { return forget_job(parts, call); }},
           {"GET", "/api/v1/jobs/{id}/log", [&parts](const Call& call) { return log_of_job(parts, call); }},
           step_route(parts, "/api/v1/jobs/{id}/cancel", &JobQueue::cancel),
           step_route(parts, "/api/v1/jobs/{id}/retry", &JobQueue::retry),
           step_route(parts, "/api/v1/jobs/{id}/first", &JobQueue::first)},
          jobs_description()};
}

}  // namespace weft::app
