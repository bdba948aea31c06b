// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/export/parts.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

Result<Rows> measure_export(const std::string& name, const ExportBenchOptions& options) {
  for (const ExportPart& part : export_parts()) {
    if (name == part.name) return part.measure(options);
  }
  return Error{ErrorKind::kUsage, "no such part", name, "", "weft bench export --help lists the parts"};
}

app::Run add_export(app::Options& options) {
  std::vector<std::string> names;
  std::string help = "Which table:";
  for (const ExportPart& part : export_parts()) {
    names.emplace_back(part.name);
    help += std::string(names.size() > 1 ? ";" : "") + " " + part.name + ", " + part.what;
  }
  const auto part = std::make_shared<std::string>(names.front());
  const auto asked = std::make_shared<ExportBenchOptions>();
  options.add("--part", part.get(), help).one_of(names).shows_default();
  options.add("--scene", &asked->scene, "Scene of the cloth").shows_default();
  return [part, asked](const app::CommonArguments& common) {
    asked->threads = common.threads;
    return print_rows(measure_export(*part, *asked), common);
  };
}

}  // namespace

app::Verb export_verb() {
  return {"export", "Exports of a cloth: what each encoding loses, and how fast it is written", add_export};
}

}  // namespace weft::bench
