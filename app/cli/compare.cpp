// SPDX-License-Identifier: Apache-2.0
#include "material/read/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/describe/field_json.h"
#include "library/run/solve_change.h"

namespace weft::app {
namespace {

struct CompareArguments {
  std::filesystem::path tested, truth, mask;
  std::string kind = "auto";
};

constexpr std::array<const char*, 3> kKindNames = {"normal", "albedo",
                                                   "number"};  // in the order of ComparedKind

// A mean that falls to less than half by turning y round is no chance from here on.
constexpr double kTellsFlip_deg = 1;

// The angles between two maps or two solves.
std::string angles_in_words(const auto& c) {
  return fmt::format("{} pixels: mean {:.4f}, median {:.4f}, 95 % under {:.4f}, max {:.4f} degrees", c.pixels,
                     c.mean_deg, c.median_deg, c.p95_deg, c.max_deg);
}

std::string albedo_in_words(double mean_rel, double bias_rel) {
  return fmt::format("mean |A - B| / B {:.5f}, bias {:+.5f}", mean_rel, bias_rel);
}

void print_comparison(const solve::NormalComparison& c, bool json) {
  const bool is_flipped = c.mean_deg > kTellsFlip_deg && 2 * c.flipped_mean_deg < c.mean_deg;
  if (json) {
    Json document = {{"kind", "normal"},           {"pixels", c.pixels},   {"mean_deg", c.mean_deg},
                     {"median_deg", c.median_deg}, {"p95_deg", c.p95_deg}, {"max_deg", c.max_deg}};
    if (is_flipped) document["flipped_mean_deg"] = c.flipped_mean_deg;
    print_json(document);
    return;
  }
  print(angles_in_words(c));
  if (is_flipped)
    print(
        fmt::format("  with the green of one map turned round the mean is {:.4f} degrees: one of them is in "
                    "DirectX's direction, y down",
                    c.flipped_mean_deg));
}

void print_comparison(const material::AlbedoComparison& c, bool json) {
  if (json) {
    print_json(
        {{"kind", "albedo"}, {"pixels", c.pixels}, {"mean_rel", c.mean_rel}, {"bias_rel", c.bias_rel}});
    return;
  }
  print(fmt::format("{} pixels: {}", c.pixels, albedo_in_words(c.mean_rel, c.bias_rel)));
}

void print_comparison(const std::vector<material::NumberComparison>& all, bool json) {
  Json numbers = Json::array();
  for (const material::NumberComparison& c : all) {
    numbers.push_back({{"name", c.name},
                       {"unit", c.unit},
                       {"pixels", c.pixels},
                       {"mean_abs", c.mean_abs},
                       {"bias", c.bias},
                       {"max_abs", c.max_abs}});
    if (json) continue;
    const std::string unit = c.unit.empty() ? "" : " " + c.unit;
    print(fmt::format("{}{} pixels: mean |A - B| {:.5g}{}, bias {:+.5g}, max {:.5g}",
                      c.name.empty() ? "" : c.name + ": ", c.pixels, c.mean_abs, unit, c.bias, c.max_abs));
  }
  if (json) print_json({{"kind", "number"}, {"numbers", std::move(numbers)}});
}

// Two solves by all that a batch says of a session: the tested one is the new one.
Result<int> compare_two_solves(const CompareArguments& a, const CommonArguments& common) {
  const Result<library::MapChange> change = library::compare_solves(a.truth, a.tested, common.threads);
  if (!change) return change.error();
  const std::vector<std::string> worse = library::regressions(*change);
  if (common.json) {
    Json document = object_of(*change);
    document["regressions"] = worse;
    print_json(document);
    return kDone;
  }
  print(angles_in_words(*change));
  print("  albedo: " + albedo_in_words(change->albedo_rel, change->albedo_bias_rel));
  if (change->sigma_deg)
    print(fmt::format("  sigma of the normals: {:.4g} to {:.4g} degrees", change->sigma_deg->before,
                      change->sigma_deg->after));
  print(fmt::format("  unsolved: {:.3f} to {:.3f} percent", 100 * change->unsolved.before,
                    100 * change->unsolved.after));
  if (change->status_changed)
    print(fmt::format("  status: {:.3f} percent of the pixels changed", 100 * *change->status_changed));
  const library::WorstWindow& worst = change->worst;
  print(fmt::format("  worst: {:.4g} degrees in {} x {} pixels at {}, {}", worst.mean_deg, worst.side,
                    worst.side, worst.x, worst.y));
  if (change->is_none()) print("  no pixel changed");
  if (!worse.empty()) print(fmt::format("  worse: {}", fmt::join(worse, "; ")));
  return kDone;
}

Result<int> compare(const CompareArguments& a, const CommonArguments& common) {
  std::error_code ignored;
  if (std::filesystem::is_directory(a.tested, ignored) && std::filesystem::is_directory(a.truth, ignored)) {
    if (a.mask.empty() && a.kind == "auto") return compare_two_solves(a, common);
    return Error{ErrorKind::kUsage, "solves cannot be compared so", "--mask, --kind",
                 "of two folders all maps are compared, where both are solved", "leave these out"};
  }
  const auto kind = std::ranges::find(kKindNames, a.kind);
  const Result<material::MapComparison> c = material::compare_maps(
      a.tested, a.truth, a.mask,
      kind == kKindNames.end()
          ? std::nullopt
          : std::optional(static_cast<material::ComparedKind>(kind - kKindNames.begin())));
  if (!c) return c.error();
  std::visit([&](const auto& compared) { print_comparison(compared, common.json); }, *c);
  return kDone;
}

Run add_compare(Options& options) {
  const auto a = std::make_shared<CompareArguments>();
  options.add("tested", &a->tested, "Map to test (EXR, TIFF, PNG), or the folder of a solve").required();
  options.add("truth", &a->truth, "Map that is right, or the folder of the solve before").required();
  options.add("--mask", &a->mask, "Image that is over one half where pixels count");
  options.add("--kind", &a->kind, "What the maps are: auto, normal, albedo, number")
      .one_of({"auto", "normal", "albedo", "number"})
      .shows_default();
  return [a](const CommonArguments& common) { return compare(*a, common); };
}

}  // namespace

Verb compare_verb() {
  return {"compare", "Compare a map with the truth: degrees, relative albedo, or numbers in their unit",
          add_compare};
}

}  // namespace weft::app
