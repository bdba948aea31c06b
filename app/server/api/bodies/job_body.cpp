// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/job_body.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/server/api/bodies/job_arguments.h"
#include "app/server/api/bodies/job_kinds.h"

namespace weft::app {
namespace {

Result<std::string> word_in(const Json& body, const char* field) {
  const auto value = body.find(field);
  if (value == body.end() || !value->is_string()) return unfit_job(field, "must be a text");
  std::string text = value->get<std::string>();
  if (!is_plain(text)) return unfit_job(field, "must be a plain word");
  return text;
}

Result<const JobKind*> kind_in(const Json& body) {
  const Result<std::string> name = word_in(body, "kind");
  if (!name) return name.error();
  const auto kind = std::ranges::find(job_kinds(), *name, &JobKind::name);
  if (kind != job_kinds().end()) return &*kind;
  std::vector<std::string> names;
  for (const JobKind& each : job_kinds()) names.emplace_back(each.name);
  return unfit_job("kind", rule_of_words(names, *name));
}

}  // namespace

Result<JobSpec> read_job_body(const Json& body, const JobPlaces& places) {
  const Result<const JobKind*> kind = kind_in(body);
  if (!kind) return kind.error();
  JobSpec spec = {(*kind)->name, "", (*kind)->verb, "", ""};
  spec.wants = body;
  for (const char* told : {"kind", "request_id"}) spec.wants.erase(told);
  if (body.contains("request_id")) {
    Result<std::string> id = word_in(body, "request_id");
    if (!id) return std::move(id).error();
    spec.request_id = std::move(*id);
  }
  JobArguments arguments(body, places, spec);
  for (const auto& walk : (*kind)->fields) walk(arguments);
  if (Result<void> fits = arguments.status(); !fits) return std::move(fits).error();
  if ((*kind)->add != nullptr) {
    if (Result<void> added = (*kind)->add(spec, places); !added) return std::move(added).error();
  }
  // An option that takes a list would take the words behind it too.
  spec.arguments.insert(spec.arguments.end(), arguments.options().begin(), arguments.options().end());
  return spec;
}

}  // namespace weft::app
