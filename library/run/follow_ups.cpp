// SPDX-License-Identifier: Apache-2.0
#include "library/run/follow_ups.h"

#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "core/rig/session.h"
#include "exchange/export/export.h"
#include "library/batch/outcome.h"
#include "library/catalogue/session_files.h"
#include "library/run/lean.h"
#include "material/run/maps.h"
#include "solve/run/solve_session.h"

namespace weft::library {

namespace fs = std::filesystem;

namespace {

// A session of its own whose photographs and calibration are those of another.
Result<void> link_session(const fs::path& session, const fs::path& copy) {
  const std::set<fs::path> products = {"solve", "rectified", "maps", "export"};
  std::error_code failed;
  fs::create_directory(copy, failed);
  for (fs::directory_iterator entry(session, failed), end; !failed && entry != end; entry.increment(failed)) {
    const fs::path name = entry->path().filename();
    if (products.contains(name)) continue;
    if (name == "session.json") {
      fs::copy_file(entry->path(), copy / name, failed);
    } else {
      fs::create_symlink(entry->path(), copy / name, failed);
    }
    if (failed) break;
  }
  if (failed) return cannot_write(copy, failed.value());
  return {};
}

// What the process had before counts no more, where the kernel lets it forget.
void forget_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

Result<FollowUpPrice> try_follow_ups(const Candidate& candidate, const BatchProduct& product,
                                     const fs::path& aside, const JobContext& context) {
  const Result<Session> session = read_session(candidate.input.folder);
  if (!session) return session.error();
  solve::SessionOptions input = candidate.input;
  input.folder = aside / candidate.input.folder.filename();
  if (input.calibration.empty() && session->is_of_rig()) input.calibration = session->calibration_folder();
  if (Result<void> ok = link_session(candidate.input.folder, input.folder); !ok) return std::move(ok).error();
  solve::SolveOptions quick;
  quick.method = "fast";
  quick.compression = compression_of(product);
  const Result<solve::SolveReport> solved = solve::solve_session(input, quick, context);
  if (!solved) return solved.error();
  FollowUpPrice price = {.megapixels = candidate.traits.megapixels};
  const std::uint64_t before = bytes_below(input.folder);
  forget_peak_memory();
  Stopwatch watch;
  const auto made = make_follow_ups({input.folder, solved->folder, input.calibration}, product, context);
  if (!made) return made.error();
  price.seconds = watch.lap();
  price.memory_bytes = peak_memory_bytes();
  price.write_bytes = bytes_below(input.folder) - before;
  return price;
}

}  // namespace

Result<std::vector<std::string>> make_follow_ups(const SolveOfSession& of, const BatchProduct& product,
                                                 const JobContext& context) {
  std::vector<std::string> made;
  fs::path maps;
  const JobContext silent = {context.threads, context.stop};
  for (const std::string& each : product.then) {
    if (each == "maps") {
      material::MapsOptions options;
      options.session = of.session;
      options.solve = of.solve.filename().string();
      options.calibration = of.calibration;
      options.compression = compression_of(product);
      for (const material::DerivedMap& map : material::derived_maps()) options.maps.emplace_back(map.name);
      const Result<material::MapsReport> report = material::make_maps(options, silent);
      if (!report) return report.error();
      maps = report->folder;
      made.push_back(maps.string());
      continue;
    }
    const std::string preset = each.substr(each.find(':') + 1);
    const fs::path input = maps.empty() ? of.solve : maps;
    exchange::ExportOptions options;
    options.input = input;
    options.presets = {preset};
    options.output = of.session / "export" / preset / input.filename();
    const Result<std::vector<exchange::ExportReport>> reports = exchange::export_maps(options, silent);
    if (!reports) return reports.error();
    for (const exchange::ExportReport& report : *reports) made.push_back(report.folder.string());
  }
  return made;
}

FollowUpPrice FollowUpPrice::of(double other_megapixels) const {
  const double times = megapixels > 0 ? other_megapixels / megapixels : 0;
  const auto scaled = [&](std::uint64_t bytes) { return static_cast<std::uint64_t>(times * double(bytes)); };
  return {other_megapixels, times * seconds, scaled(memory_bytes), scaled(write_bytes)};
}

Result<FollowUpPrice> price_follow_ups(const Candidate& candidate, const BatchProduct& product,
                                       const JobContext& context) {
  const TemporaryFolder aside;
  Result<FollowUpPrice> price = try_follow_ups(candidate, product, aside.path(), context);
  if (price) return price;
  Error error = std::move(price).error();
  const std::string copy = aside.path().string(), disk = aside.path().parent_path().string();
  if (is_of_session(error.kind) && error.where.starts_with(copy))
    error.where = candidate.input.folder.string();
  if (error.kind == ErrorKind::kInputOutput && error.where.starts_with(disk))
    error.remedy = "point TMPDIR to a larger disk, or plan without --then";
  return error;
}

}  // namespace weft::library
