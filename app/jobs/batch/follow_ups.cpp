// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/batch/follow_ups.h"

#include "app/jobs/batch/lean.h"
#include "app/jobs/export/export.h"
#include "app/jobs/maps/maps.h"

namespace weft::app {

namespace fs = std::filesystem;

Result<std::vector<std::string>> make_follow_ups(const SolveOfSession& of, const batch::Product& product,
                                                 const JobContext& context) {
  std::vector<std::string> made;
  fs::path maps;
  const JobContext silent = {context.threads, context.stop};
  for (const std::string& each : product.then) {
    if (each == "maps") {
      MapsOptions options;
      options.session = of.session;
      options.solve = of.solve.filename().string();
      options.calibration = of.calibration;
      options.compression = compression_of(product);
      for (const DerivedMap& map : derived_maps()) options.maps.emplace_back(map.name);
      const Result<MapsReport> report = make_maps(options, silent);
      if (!report) return report.error();
      maps = report->folder;
      made.push_back(maps.string());
      continue;
    }
    const std::string preset = each.substr(each.find(':') + 1);
    const fs::path input = maps.empty() ? of.solve : maps;
    ExportOptions options;
    options.input = input;
    options.presets = {preset};
    options.output = of.session / "export" / preset / input.filename();
    const Result<std::vector<ExportReport>> reports = export_maps(options, silent);
    if (!reports) return reports.error();
    for (const ExportReport& report : *reports) made.push_back(report.folder.string());
  }
  return made;
}

}  // namespace weft::app
