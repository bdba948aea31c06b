// SPDX-License-Identifier: Apache-2.0
#include "app/server/jobs/job.h"

#include <array>
#include <cstddef>
#include <utility>

#include "core/describe/field_json.h"

namespace weft::app {
namespace {

constexpr std::array<const char*, 5> kStates = {"queued", "running", "done", "failed", "cancelled"};

/// What lies on the disk.
struct JobDocument {
  JobStatus job;
};

void describe(Fields& fields, JobDocument& d) {
  describe(fields, d.job);
  fields.value({"arguments", "Of weft", {}, kMustSay}, d.job.spec.arguments);
  fields.value({"request_id", "The same again is the same job"}, d.job.spec.request_id);
  fields.value({"needs", "Files and folders that must be there when it begins"}, d.job.spec.needs);
}

}  // namespace

const char* name_of(JobState state) {
  return kStates[static_cast<std::size_t>(state)];
}

void describe(Fields& fields, JobStatus& j) {
  fields.value({"id", "In the order they were asked for", {}, kMustSay}, j.id);
  fields.value({"kind", "What it does", {}, kMustSay}, j.spec.kind);
  fields.value({"of", "The session; of batch_plan and batch_run the batch", {}, kMustSay}, j.spec.of);
  fields.value({"wants", "What was asked of it beside its kind: quality, session, ..."}, j.spec.wants);
  fields.value({"by", "Who asked for it", {}, kMustSay}, j.spec.by);
  fields.choice({"state", "How it is", {}, kMustSay}, j.state, kStates);
  fields.value({"held", "It stands still until the scan has ended"}, j.is_held);
  fields.value({"place", "Among those that wait, from 1; null: it does not wait", {}, kOrNull}, j.place);
  fields.value({"phase", "Of a running one, as its verb calls it"}, j.phase);
  fields.value({"share", "Of the phase, 0 to 1"}, j.share);
  fields.value(
      {"left_s",
       "Until its end: of a solve by the newest price of its session, of a batch_run by its plan and "
       "then by its pace, else by how long the last job took that differs in nothing but what it "
       "worked on; null where neither is known, and where it takes longer",
       {},
       kOrNull},
      j.left_s);
  fields.value({"asked", "ISO 8601", {}, kMustSay}, j.asked);
  fields.value({"began", "Empty: not yet", {}, kMustSay}, j.began);
  fields.value({"ended", "Empty: not yet", {}, kMustSay}, j.ended);
  fields.value({"seconds", "That it ran, without those that it was held for", {}, kMustSay}, j.seconds);
  fields.value({"exit_code", "Of its verb", {}, kOrNull}, j.exit_code);
  fields.value({"notes", "What it said to people", {}, kMustSay}, j.notes);
  fields.value({"error", "Why it failed", {}, kOrNull}, j.error);
  fields.value({"result", "What its verb prints with --json", {}, kOrNull}, j.result);
}

Json document_of(const JobStatus& job) {
  Json document = {{"schema", "weft.job/1"}};
  write_fields(document, JobDocument{job});
  return document;
}

Result<JobStatus> job_from_json(const Json& document, const std::string& where) {
  Result<JobDocument> read = read_fields<JobDocument>(document, where);
  if (!read) return std::move(read).error();
  JobStatus& job = read->job;
  job.is_held = false;
  job.place.reset();
  job.left_s.reset();
  job.phase.clear();
  job.share = 0;
  return std::move(job);
}

}  // namespace weft::app
