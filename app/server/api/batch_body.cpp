// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/batch_body.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "app/jobs/batch/plan_file.h"
#include "app/server/api/batch_place.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNamed = 2000;

Error unfit_batch(const std::string& field, const std::string& rule) {
  return {ErrorKind::kUsage, "job cannot be read", field, rule, "see POST jobs in openapi.json"};
}

Error no_place() {
  return {ErrorKind::kNoInput, "there is no place for plans", "", "", "start weft serve"};
}

Result<std::vector<fs::path>> folders_named(const Json& names, const JobPlaces& places) {
  if (!names.is_array() || names.empty() || names.size() > kMostNamed)
    return unfit_batch("sessions", "must be a list of 1 to 2000 names; find takes more");
  std::vector<fs::path> folders;
  for (const Json& name : names) {
    if (!name.is_string()) return unfit_batch("sessions", "must be names of sessions");
    Result<fs::path> folder = places.session_folder(name.get<std::string>());
    if (!folder) return std::move(folder).error();
    folders.push_back(std::move(*folder));
  }
  return folders;
}

Result<std::vector<fs::path>> folders_found(const Json& find, const JobPlaces& places) {
  if (!find.is_object()) return unfit_batch("find", "must be an object of the words of a search");
  std::map<std::string, std::string> asked;
  for (const auto& [key, value] : find.items()) {
    if (!value.is_string()) return unfit_batch("find." + key.substr(0, 40), "must be a text");
    if (key == "limit" || key == "after") return unfit_batch("find." + key, "all that is found is planned");
    asked[key] = value.get<std::string>();
  }
  Result<std::vector<fs::path>> folders = places.sessions_found(asked);
  if (folders && folders->empty())
    return Error{ErrorKind::kNoInput, "there is nothing to plan", "find", "no session is like that",
                 "take a word or a filter away"};
  return folders;
}

Result<std::string> text_or_none(const Json& wants, const char* field) {
  const Json text = wants.value(field, Json(""));
  if (!text.is_string()) return unfit_batch(field, "must be a text");
  return text.get<std::string>();
}

}  // namespace

Result<void> add_batch_plan(JobSpec& spec, const JobPlaces& places) {
  const Result<std::string> name = text_or_none(spec.wants, "name");
  if (!name) return name.error();
  if (spec.wants.contains("name") && name->empty()) return unfit_batch("name", "must not be empty");
  if (places.batches.empty()) return no_place();
  Result<std::vector<fs::path>> folders = spec.wants.contains("find")
                                              ? folders_found(spec.wants["find"], places)
                                              : folders_named(spec.wants["sessions"], places);
  if (!folders) return std::move(folders).error();
  std::vector<std::string> sessions;
  for (const fs::path& folder : *folders) sessions.push_back(folder.string());
  std::ranges::sort(sessions);
  sessions.erase(std::unique(sessions.begin(), sessions.end()), sessions.end());
  const Result<std::string> begun = begin_batch(places.batches, *name, sessions);
  if (!begun) return begun.error();
  spec.of = *begun;
  spec.wants["sessions"] = sessions.size();
  spec.arguments.insert(spec.arguments.end(), {"--list", list_of_batch(places.batches, *begun).string(),
                                               "--plan", plan_of_batch(places.batches, *begun).string()});
  return {};
}

Result<void> add_batch_run(JobSpec& spec, const JobPlaces& places) {
  const Result<std::string> name = text_or_none(spec.wants, "batch");
  if (!name) return name.error();
  if (places.batches.empty()) return no_place();
  const Result<fs::path> folder = find_batch(places.batches, *name);
  if (!folder) return folder.error();
  const Result<PlanFile> plan = open_plan(plan_of_batch(places.batches, *name));
  if (!plan && plan.error().kind == ErrorKind::kNoInput)
    return Error{ErrorKind::kNoInput, "batch cannot be run", *name, "its plan is not made",
                 "wait for its job"};
  if (!plan) return plan.error();
  double seconds = 0;
  for (const batch::TaskPlace& task : plan->header.tasks) seconds += task.seconds;
  if (seconds > 0) spec.wants[kPlannedSeconds] = seconds;
  spec.of = *name;
  spec.needs.push_back(plan->file.string());
  spec.arguments.push_back(plan->file.string());
  return {};
}

}  // namespace weft::app
