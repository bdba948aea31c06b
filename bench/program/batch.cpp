// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/batch/parts.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

Result<Rows> measure_batch(const std::string& name, const BatchBenchOptions& options) {
  for (const BatchPart& part : batch_parts()) {
    if (name == part.name) return part.measure(options);
  }
  return Error{ErrorKind::kUsage, "no such part", name, "", "weft bench batch --help lists the parts"};
}

app::Run add_batch(app::Options& options) {
  std::vector<std::string> names;
  std::string help = "Which table:";
  for (const BatchPart& part : batch_parts()) {
    names.emplace_back(part.name);
    help += std::string(names.size() > 1 ? ";" : "") + " " + part.name + ", " + part.what;
  }
  const auto part = std::make_shared<std::string>(names.front());
  const auto asked = std::make_shared<BatchBenchOptions>();
  options.add("--part", part.get(), help).one_of(names).shows_default();
  options.add("--scene", &asked->scene, "Scene of the sessions").shows_default();
  options.add("--sessions", &asked->sessions, "How many; 0 is as the part has it").not_negative();
  options.add("--megapixels", &asked->megapixels, "Of a session; 0 is as the part has it").not_negative();
  options.add("--jobs", &asked->jobs, "Local: sessions at a time").in_range(1, 256).shows_default();
  options.add("--kills", &asked->kills, "Kills: how many").not_negative().shows_default();
  return [part, asked](const app::CommonArguments& common) {
    asked->threads = common.threads;
    return print_rows(measure_batch(*part, *asked), common);
  };
}

}  // namespace

app::Verb batch_verb() {
  return {"batch", "Batches: against one process, plans and reports of 10 000 sessions, kills, a farm",
          add_batch};
}

}  // namespace weft::bench
