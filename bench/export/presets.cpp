// SPDX-License-Identifier: Apache-2.0
#include "bench/export/studies.h"

#include <filesystem>
#include <string>
#include <vector>

#include "app/jobs/export/export.h"
#include "app/jobs/export/price.h"
#include "bench/export/map_set.h"
#include "core/temporary_folder.h"
#include "exchange/presets/preset.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr Size kTile = {2048, 2048};
constexpr double kTileMmPerPixel = 0.08;

// The set of maps of the scene, in a folder that goes with it.
struct TileMaps {
  TemporaryFolder temporary;
  fs::path folder() const { return temporary.path() / "maps"; }
};

Result<void> make_tile(const StudyOptions& options, const TileMaps& tile) {
  const Result<SolvedCloth> cloth = solved_cloth(options.scene, kTile, options.threads);
  if (!cloth) return cloth.error();
  fs::create_directories(tile.folder());
  return write_map_set(*cloth, kTile, kTileMmPerPixel, tile.folder());
}

double megabytes_of(const Json& document) {
  double bytes = 0;
  for (const char* list : {"files", "documents"}) {
    for (const Json& each : document[list]) {
      if (!each.contains("inside")) bytes += each["bytes"].get<double>();
    }
  }
  return bytes * 1e-6;
}

Result<Json> measure_presets(const StudyOptions& options, const TileMaps& tile, const std::string& name,
                             const std::vector<std::string>& presets) {
  app::ExportOptions asked = {.input = tile.folder()};
  asked.presets = presets;
  asked.output = tile.temporary.path() / ("of-" + name);
  Stopwatch watch;
  const Result<std::vector<app::ExportReport>> reports =
      app::export_maps(asked, {.threads = options.threads, .stop = {}});
  if (!reports) return reports.error();
  const double seconds = watch.lap();
  std::size_t files = 0;
  double megabytes = 0;
  for (const app::ExportReport& report : *reports) {
    files += report.document["files"].size();
    megabytes += megabytes_of(report.document);
  }
  std::error_code ignored;
  fs::remove_all(asked.output, ignored);
  return Json{{"preset", name}, {"files", files}, {"megabytes", megabytes}, {"seconds", seconds}};
}

}  // namespace

/// Each preset of weft's own on a tile of 2048 x 2048: files, megabytes and wall seconds, and the same of all
/// at once, where files that are alike are encoded once. Errors of the scene and of export_maps().
Result<Rows> export_presets(const StudyOptions& options) {
  const TileMaps tile;
  if (Result<void> ok = make_tile(options, tile); !ok) return std::move(ok).error();
  Rows rows;
  std::vector<std::string> all;
  for (const exchange::ShippedPreset& preset : exchange::shipped_presets()) {
    all.emplace_back(preset.name);
    Result<Json> row = measure_presets(options, tile, preset.name, {preset.name});
    if (!row) return std::move(row).error();
    rows.push_back(std::move(*row));
  }
  Result<Json> row = measure_presets(options, tile, "all", all);
  if (!row) return std::move(row).error();
  rows.push_back(std::move(*row));
  return rows;
}

/// What normals and albedo of the scene lose in every format: degrees and decibels, with megabytes and
/// seconds of 4 megapixels by one thread.
Result<Rows> export_losses(const StudyOptions& options) {
  const TileMaps tile;
  if (Result<void> ok = make_tile(options, tile); !ok) return std::move(ok).error();
  app::ExportOptions asked = {.input = tile.folder()};
  const Result<std::vector<app::ExportPrice>> prices =
      app::price_exports(asked, {.threads = options.threads, .stop = {}});
  if (!prices) return prices.error();
  Rows rows;
  for (const app::ExportPrice& price : *prices) {
    Json row = {{"of", price.file},         {"as", words_of(price.stored)}, {"megabytes", price.bytes * 1e-6},
                {"seconds", price.seconds}, {"mean_deg", nullptr},          {"p95_deg", nullptr},
                {"max_deg", nullptr},       {"albedo_mean", nullptr},       {"psnr_db", nullptr}};
    if (price.loss.normal) {
      row["mean_deg"] = price.loss.normal->mean_deg;
      row["p95_deg"] = price.loss.normal->p95_deg;
      row["max_deg"] = price.loss.normal->max_deg;
    }
    if (price.loss.albedo) {
      row["albedo_mean"] = price.loss.albedo->mean_abs;
      if (price.loss.albedo->psnr_db) row["psnr_db"] = *price.loss.albedo->psnr_db;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace weft::bench
