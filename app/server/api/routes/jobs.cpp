// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/batch_place.h"
#include "app/server/api/bodies/job_body.h"
#include "app/server/api/bodies/job_kinds.h"
#include "app/server/api/bodies/library_materials.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/api/bodies/session_query.h"
#include "calibration/guide/walk.h"
#include "calibration/run/board_photographs.h"
#include "calibration/run/chart_pictures.h"
#include "calibration/run/sheet_files.h"
#include "core/base/number.h"
#include "core/base/sha256.h"
#include "core/describe/field_json.h"
#include "library/catalogue/session_name.h"

namespace weft::app {
namespace {

constexpr int kMostJobs = 1000;
constexpr int kPageOfSessions = 1000;

// The sessions of all pages.
Result<std::vector<std::filesystem::path>> all_folders(LibraryService& library,
                                                       const std::map<std::string, std::string>& asked) {
  Result<library::Query> query = session_query(asked);
  if (!query) return std::move(query).error();
  query->limit = kPageOfSessions;
  std::vector<std::filesystem::path> folders;
  do {
    const Result<library::CataloguePage> page = library.find(*query);
    if (!page) return page.error();
    for (const library::Entry& entry : page->entries) folders.push_back(entry.folder);
    query->after = page->after;
  } while (query->after);
  return folders;
}

JobPlaces places_of(const RigParts& parts) {
  const auto session = [&parts](const std::string& name) -> Result<std::filesystem::path> {
    const Result<Session> found = parts.library.session(name);
    if (!found) return found.error();
    return found->folder;
  };
  const capture::Rig& rig = parts.rig;
  const auto build = [](const std::string& key, const std::string& id) -> Result<std::filesystem::path> {
    const Result<Product> found = find_build(key, id);
    if (!found) return found.error();
    return found->folder;
  };
  JobPlaces places = {session,       rig.folder(), rig.name,         rig.scan.sessions,
                      rig.scan.copy, rig.file,     library_material, build};
  places.session_folder = [&parts](const std::string& name) { return parts.library.folder_of(name); };
  places.sessions_found = [&parts](const std::map<std::string, std::string>& asked) {
    return all_folders(parts.library, asked);
  };
  places.batches = parts.state / kBatchFolder;
  return places;
}

Result<Reply> add_job(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  Result<JobSpec> spec = read_job_body(*body, places_of(parts));
  if (!spec) return std::move(spec).error();
  spec->by = parts.controls.name_of(call.control);
  const Result<JobStatus> job = parts.jobs.add(*spec);
  // The batch that was begun for it is another's, or nobody's.
  const bool has_begun = spec->kind == "batch_plan" && (!job || job->spec.of != spec->of);
  if (has_begun) remove_batch(parts.state / kBatchFolder, spec->of);
  if (!job) return job.error();
  return json_reply(object_of(*job), kAccepted);
}

Result<int> number_of(const Call& call, const char* key, int otherwise) {
  const auto found = call.query.find(key);
  if (found == call.query.end()) return otherwise;
  const auto number = as_whole_number<int>(found->second);
  if (!number || *number < 1)
    return Error{ErrorKind::kUsage, "jobs cannot be listed so", key, "must be a number from 1", ""};
  return *number;
}

// What a plan leaves out may be ten thousand sessions, and is asked for with the batch.
Json job_as_told(const JobStatus& job) {
  Json json = object_of(job);
  if (job.spec.kind == "batch_plan" && job.result.is_object()) json["result"].erase("left_out");
  return json;
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
  for (std::size_t i = 0; i < count; ++i) jobs.push_back(job_as_told(all[i]));
  return json_reply(
      {{"jobs", std::move(jobs)}, {"after", count < all.size() ? Json(all[count - 1].id) : Json()}});
}

Result<Reply> one_job(const RigParts& parts, const Call& call) {
  const Result<JobStatus> job = parts.jobs.find(call.segments.at(0));
  if (!job) return job.error();
  return json_reply(job_as_told(*job));
}

Result<Reply> forget_job(const RigParts& parts, const Call& call) {
  const Result<JobStatus> job = parts.jobs.forget(call.segments.at(0));
  if (!job) return job.error();
  return json_reply(object_of(*job));
}

Result<Reply> log_of_job(const RigParts& parts, const Call& call) {
  Result<std::string> log = parts.jobs.log(call.segments.at(0));
  if (!log) return std::move(log).error();
  return Reply{200, "text/plain; charset=utf-8", std::move(*log)};
}

// No picture of a job runs anything, opened by itself or not.
constexpr const char* kPicturePolicy = "default-src 'none'; style-src 'unsafe-inline'";

/// A picture that the job made.
Result<Reply> file_of_job(const RigParts& parts, const Call& call) {
  const Result<JobStatus> job = parts.jobs.find(call.segments.at(0));
  if (!job) return job.error();
  const std::string& name = call.segments.at(1);
  const bool is_drawing = name.ends_with(".svg");
  const bool is_picture = library::is_session_name(name) && (is_drawing || name.ends_with(".png"));
  Result<std::shared_ptr<const FileBody>> file =
      is_picture ? open_file_body(parts.jobs.files_of(job->id) / name)
                 : Error{ErrorKind::kNoInput, "the job made no such picture", name.substr(0, 40), "", ""};
  if (!file) return std::move(file).error();
  Reply reply = {200, is_drawing ? "image/svg+xml" : "image/png"};
  reply.headers.emplace_back("Content-Security-Policy", kPicturePolicy);
  reply.file = std::move(*file);
  reply.keeping = Keeping::kForever;
  return reply;
}

using JobStep = Result<JobStatus> (JobQueue::*)(const std::string&);

Route step_route(const RigParts& parts, const char* path, JobStep step) {
  return {"POST", path, [&parts, step](const Call& call) -> Result<Reply> {
            if (const Result<Json> body = parse_body(call.body); !body) return body.error();
            const Result<JobStatus> job = (parts.jobs.*step)(call.segments.at(0));
            if (!job) return job.error();
            return json_reply(object_of(*job), kAccepted);
          }};
}

}  // namespace

Resource jobs_resource(const RigParts& parts) {
  const Json things = {{"board", schema_of<calibration::BoardDescription>()},
                       {"sheet", schema_of<calibration::SheetDescription>()},
                       {"chart", schema_of<calibration::ChartEdition>()}};
  Reply forms =
      json_reply({{"jobs", job_forms()}, {"walks", calibration::json_of_walks()}, {"things", things}});
  forms.keeping = Keeping::kAskAgain;
  forms.tag = sha256_of(forms.body);
  return {
      {{"GET", "/api/v1/forms", [forms](const Call&) -> Result<Reply> { return forms; }, false, Pool::kQuick},
       {"GET", "/api/v1/jobs", [&parts](const Call& call) { return list_jobs(parts, call); }},
       {"POST", "/api/v1/jobs", [&parts](const Call& call) { return add_job(parts, call); }},
       {"GET", "/api/v1/jobs/{id}", [&parts](const Call& call) { return one_job(parts, call); }},
       {"DELETE", "/api/v1/jobs/{id}", [&parts](const Call& call) { return forget_job(parts, call); }},
       {"GET", "/api/v1/jobs/{id}/log", [&parts](const Call& call) { return log_of_job(parts, call); }},
       {"GET", "/api/v1/jobs/{id}/files/{name}",
        [&parts](const Call& call) { return file_of_job(parts, call); }, false, Pool::kFiles},
       step_route(parts, "/api/v1/jobs/{id}/cancel", &JobQueue::cancel),
       step_route(parts, "/api/v1/jobs/{id}/retry", &JobQueue::retry),
       step_route(parts, "/api/v1/jobs/{id}/first", &JobQueue::first)}};
}

}  // namespace weft::app
