// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/batch_body.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "app/server/api/bodies/batch_place.h"
#include "library/run/plan_file.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Error no_place() {
  return {ErrorKind::kNoInput, "there is no place for plans", "", "", "start weft serve"};
}

Result<std::vector<fs::path>> folders_named(const Json& names, const JobPlaces& places) {
  std::vector<fs::path> folders;
  for (const Json& name : names) {
    Result<fs::path> folder = places.session_folder(name.get<std::string>());
    if (!folder) return std::move(folder).error();
    folders.push_back(std::move(*folder));
  }
  return folders;
}

Result<std::vector<fs::path>> folders_found(const Json& find, const JobPlaces& places) {
  std::map<std::string, std::string> asked;
  for (const auto& [key, value] : find.items()) {
    if (!value.is_string()) return unfit_job("find." + key.substr(0, 40), "must be a text");
    if (key == "limit" || key == "after") return unfit_job("find." + key, "all that is found is planned");
    asked[key] = value.get<std::string>();
  }
  Result<std::vector<fs::path>> folders = places.sessions_found(asked);
  if (folders && folders->empty())
    return Error{ErrorKind::kNoInput, "there is nothing to plan", "find", "no session is like that",
                 "take a word or a filter away"};
  return folders;
}

}  // namespace

Result<void> add_batch_plan(JobSpec& spec, const JobPlaces& places) {
  const std::string name = spec.wants.value("name", "");
  if (places.batches.empty()) return no_place();
  Result<std::vector<fs::path>> folders = spec.wants.contains("find")
                                              ? folders_found(spec.wants["find"], places)
                                              : folders_named(spec.wants["sessions"], places);
  if (!folders) return std::move(folders).error();
  std::vector<std::string> sessions;
  for (const fs::path& folder : *folders) sessions.push_back(folder.string());
  std::ranges::sort(sessions);
  sessions.erase(std::unique(sessions.begin(), sessions.end()), sessions.end());
  const Result<std::string> begun = begin_batch(places.batches, name, sessions);
  if (!begun) return begun.error();
  spec.of = *begun;
  spec.wants["sessions"] = sessions.size();
  spec.arguments.insert(spec.arguments.end(), {"--list", list_of_batch(places.batches, *begun).string(),
                                               "--plan", plan_of_batch(places.batches, *begun).string()});
  return {};
}

Result<void> add_batch_run(JobSpec& spec, const JobPlaces& places) {
  const std::string name = spec.wants["batch"].get<std::string>();
  if (places.batches.empty()) return no_place();
  const Result<fs::path> folder = find_batch(places.batches, name);
  if (!folder) return folder.error();
  const Result<library::PlanFile> plan = library::open_plan(plan_of_batch(places.batches, name));
  if (!plan && plan.error().kind == ErrorKind::kNoInput)
    return Error{ErrorKind::kNoInput, "batch cannot be run", name, "its plan is not made",
                 "wait for its job"};
  if (!plan) return plan.error();
  double seconds = 0;
  for (const library::TaskPlace& task : plan->header.tasks) seconds += task.seconds;
  if (seconds > 0) spec.wants[kPlannedSeconds] = seconds;
  spec.of = name;
  spec.needs.push_back(plan->file.string());
  spec.arguments.push_back(plan->file.string());
  return {};
}

}  // namespace weft::app
