// SPDX-License-Identifier: Apache-2.0
#include "app/server/jobs/job.h"

#include <array>
#include <cstddef>
#include <utility>

namespace weft::app {
namespace {

constexpr std::array<const char*, 5> kStates = {"queued", "running", "done", "failed", "cancelled"};

Result<std::vector<std::string>> texts_of(JsonFields& fields, const char* key) {
  std::vector<std::string> texts;
  for (const Json& text : fields.list(key)) {
    if (!text.is_string()) {
      fields.reject(key, "must be a list of texts");
      break;
    }
    texts.push_back(text.get<std::string>());
  }
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return texts;
}

}  // namespace

const char* name_of(JobState state) {
  return kStates[static_cast<std::size_t>(state)];
}

Json json_of(const JobStatus& job) {
  return {{"id", job.id},
          {"kind", job.spec.kind},
          {"of", job.spec.of},
          {"wants", job.spec.wants},
          {"by", job.spec.by},
          {"state", name_of(job.state)},
          {"held", job.is_held},
          {"place", job.place ? Json(*job.place) : Json()},
          {"phase", job.phase},
          {"share", job.share},
          {"left_s", job.left_s ? Json(*job.left_s) : Json()},
          {"asked", job.asked},
          {"began", job.began},
          {"ended", job.ended},
          {"seconds", job.seconds},
          {"exit_code", job.exit_code ? Json(*job.exit_code) : Json()},
          {"notes", job.notes},
          {"error", job.error},
          {"result", job.result}};
}

Json document_of(const JobStatus& job) {
  Json document = {{"schema", "weft.job/1"}};
  document.update(json_of(job));
  document["arguments"] = job.spec.arguments;
  document["request_id"] = job.spec.request_id;
  document["needs"] = job.spec.needs;
  return document;
}

Result<JobStatus> job_from_json(const Json& document, const std::string& where) {
  JsonFields fields(document, where);
  JobStatus job;
  job.id = fields.text("id");
  job.spec.kind = fields.text("kind");
  job.spec.of = fields.text("of");
  job.spec.by = fields.text("by");
  job.spec.request_id = fields.text_or("request_id", "");
  job.state = fields.one_of<JobState>("state", kStates);
  job.asked = fields.text("asked");
  job.began = fields.text("began");
  job.ended = fields.text("ended");
  job.seconds = fields.number("seconds");
  Result<std::vector<std::string>> arguments = texts_of(fields, "arguments"),
                                   notes = texts_of(fields, "notes");
  if (!arguments) return std::move(arguments).error();
  if (!notes) return std::move(notes).error();
  job.spec.arguments = std::move(*arguments);
  job.notes = std::move(*notes);
  if (document.contains("needs")) {
    Result<std::vector<std::string>> needs = texts_of(fields, "needs");
    if (!needs) return std::move(needs).error();
    job.spec.needs = std::move(*needs);
  }
  job.spec.wants = document.value("wants", Json::object());
  if (const Json code = document.value("exit_code", Json()); code.is_number_integer())
    job.exit_code = code.get<int>();
  job.error = document.value("error", Json());
  job.result = document.value("result", Json());
  return job;
}

}  // namespace weft::app
