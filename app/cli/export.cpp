// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/base/files.h"
#include "exchange/export/export.h"
#include "exchange/export/export_price.h"
#include "exchange/export/export_request.h"
#include "exchange/export/preset_files.h"
#include "library/chain/make.h"
#include "solve/session/solved.h"

namespace weft::app {
namespace {

Result<int> list_presets(const CommonArguments& common) {
  Json rows = Json::array();
  for (const exchange::KnownPreset& known : exchange::known_presets()) {
    const Result<exchange::Preset> preset = exchange::read_preset(known.name);
    const std::string says = preset ? preset->says : preset.error().message();
    rows.push_back({{"name", known.name}, {"says", says}, {"file", known.file.string()}});
    if (!common.json)
      print(
          fmt::format("{:12}  {}{}", known.name, says, known.file.empty() ? "" : ", " + known.file.string()));
  }
  if (common.json) print_json({{"presets", std::move(rows)}});
  return kDone;
}

Result<int> show_preset(const std::string& name) {
  Result<std::string> text = exchange::preset_text(name);
  if (!text) return std::move(text).error();
  if (!text->empty() && text->back() == '\n') text->pop_back();
  print(*text);
  return kDone;
}

std::string lost_words(const exchange::Loss& lost) {
  std::string words;
  if (lost.normal) {
    words += fmt::format("; normals {:.3g} deg, 95 % within {:.3g}, at most {:.3g}", lost.normal->mean_deg,
                         lost.normal->p95_deg, lost.normal->max_deg);
  }
  if (lost.albedo) {
    words += fmt::format("; albedo {:.2g}", lost.albedo->mean_abs);
    if (lost.albedo->psnr_db) words += fmt::format(", {:.1f} dB", *lost.albedo->psnr_db);
  }
  const exchange::DistanceLoss* seen = nullptr;
  for (const exchange::DistanceLoss& each : lost.by_distance) {
    if (each.level <= exchange::kToldDistance) seen = &each;
  }
  if (seen != nullptr)
    words += fmt::format("; roughness {:.2g} off {} times as far", seen->mean_abs, 1 << seen->level);
  return words;
}

void print_report(const exchange::ExportReport& report) {
  const exchange::ExportFacts& facts = report.facts;
  print(report.folder.string());
  if (report.was_there) print("  is there already: same maps, same preset, same options");
  const std::string size = facts.size_mm.empty()
                               ? "size not known"
                               : fmt::format("{:.6g} x {:.6g} mm{}", facts.size_mm[0], facts.size_mm[1],
                                             facts.is_size_known ? "" : " assumed");
  print(fmt::format("  {} x {} pixels, {}, normals {}, roughness as {}", facts.size.width, facts.size.height,
                    size, facts.normal, facts.roughness));
  for (const std::string& line : report.source) print("  " + line);
  for (const exchange::ExportedTexture& file : facts.files) {
    print(fmt::format("  {}: {}, {:.2f} MB{}", file.file, file.encoding,
                      static_cast<double>(file.bytes) * 1e-6, lost_words(file.lost)));
  }
  for (const exchange::ExportedDocument& document : facts.documents) {
    print(fmt::format("  {}: {:.2f} MB", document.name, static_cast<double>(document.bytes) * 1e-6));
    for (const std::string& left_out : document.left_out) print("    " + left_out);
  }
  for (const std::string& text : facts.notes) print("  " + text);
}

// What a person says of photographs; all else knows its size.
Result<void> keep_pixel(exchange::ExportOptions& options) {
  if (!options.mm_per_pixel) return {};
  if (solve::read_solved(options.input)) {
    if (Result<void> ok = solve::keep_pixel(options.input, options.mm_per_pixel); !ok) return ok;
  }
  if (!options.mm_per_pixel) return {};
  return Error{ErrorKind::kUsage, "the size of a pixel is said of a solve of photographs alone",
               "--mm-per-pixel", options.input.string() + " is none", "leave it out"};
}

// Whoever names maps, or is content with a draft, gets what there is.
Result<void> make_maps_first(exchange::ExportOptions& options, const JobContext& context,
                             const library::TellStep& tell) {
  if (!solve::read_solved(options.input) || !options.maps.empty() || options.is_draft) return {};
  Result<std::filesystem::path> made =
      library::make_maps_first(options.input, options.presets, context, tell);
  if (!made) return std::move(made).error();
  if (!made->empty()) options.maps = made->filename().string();
  return {};
}

Result<int> run_export(const exchange::ExportRequest& a, const CommonArguments& common) {
  exchange::ExportOptions options = a.options;
  const Result<std::vector<exchange::ExportReport>> reports =
      [&]() -> Result<std::vector<exchange::ExportReport>> {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    if (Result<void> ok = keep_pixel(options); !ok) return std::move(ok).error();
    if (Result<void> ok = make_maps_first(options, context, line.teller()); !ok) return std::move(ok).error();
    return exchange::export_maps(options, context);
  }();
  if (!reports) return reports.error();
  Json exports = Json::array();
  for (const exchange::ExportReport& report : *reports) {
    if (!common.json) print_report(report);
    Json json = {
        {"folder", report.folder.string()}, {"was_there", report.was_there}, {"seconds", report.seconds}};
    json["source"] = report.source;
    json.update(json_of(report.facts));
    exports.push_back(std::move(json));
  }
  if (common.json) print_json({{"exports", std::move(exports)}});
  return kDone;
}

void print_prices(const std::vector<exchange::ExportPrice>& prices) {
  print(fmt::format("{:28}  {:15}  {:>9}  {:>8}  {}", "file", "stored as", "MB", "seconds", "lost"));
  for (const exchange::ExportPrice& price : prices) {
    const std::string name = price.preset.empty() ? price.file : price.preset + ": " + price.file;
    std::string lost = lost_words(price.loss);
    if (lost.starts_with("; ")) lost.erase(0, 2);
    print(fmt::format("{:28}  {:15}  {:>9.2f}  {:>8.2f}  {}{}", name, words_of(price.stored),
                      price.bytes * 1e-6, price.seconds, lost, price.is_chosen ? ", chosen" : ""));
  }
  print("bytes and seconds of the whole cloth, by one thread, from a piece of its middle");
}

Result<int> explain_export(const exchange::ExportRequest& a, const CommonArguments& common) {
  const Result<std::vector<exchange::ExportPrice>> prices =
      price_exports(a.options, {common.threads, stop_on_signal(), [](std::string_view, double) {}});
  if (!prices) return prices.error();
  if (common.json) {
    print_json({{"rows", json_of(*prices)}});
  } else {
    print_prices(*prices);
  }
  return kDone;
}

Error missing(const char* option, const char* remedy) {
  return {ErrorKind::kUsage, "nothing can be exported", option, "it is missing", remedy};
}

Run add_export(Options& options) {
  const auto a = std::make_shared<exchange::ExportRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) -> Result<int> {
    if (a->lists) return list_presets(common);
    if (!a->shown.empty()) return show_preset(a->shown);
    if (a->options.input.empty()) return missing("input", "name a session or a folder of maps");
    if (a->only_explains) return explain_export(*a, common);
    if (a->options.presets.empty()) return missing("--preset", "name one of weft export --list");
    return run_export(*a, common);
  };
}

}  // namespace

Verb export_verb() {
  return {"export", "Write the maps as files and materials that other programs open", add_export};
}

}  // namespace weft::app
