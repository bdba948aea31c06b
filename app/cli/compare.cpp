// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/jobs/batch/solve_change.h"

namespace weft::app {
namespace {

struct CompareArguments {
  std::filesystem::path tested, truth, mask;
  std::string kind = "normal";
};

Result<int> print_albedo(const CompareArguments& a, bool json) {
  const Result<AlbedoComparison> c = compare_albedo(a.tested, a.truth, a.mask);
  if (!c) return c.error();
  if (json) {
    print_json({{"pixels", c->pixels}, {"mean_rel", c->mean_rel}, {"bias_rel", c->bias_rel}});
  } else {
    print(
        fmt::format("{} pixels: mean |A - B| / B {:.5f}, bias {:+.5f}", c->pixels, c->mean_rel, c->bias_rel));
  }
  return kDone;
}

// Two solves by all that a batch says of a session: the tested one is the new one.
Result<int> compare_two_solves(const CompareArguments& a, const CommonArguments& common) {
  const Result<batch::Change> change = compare_solves(a.truth, a.tested, common.threads);
  if (!change) return change.error();
  const std::vector<std::string> worse = batch::regressions(*change);
  if (common.json) {
    Json document = batch::json_of(*change);
    document["regressions"] = worse;
    print_json(document);
    return kDone;
  }
  print(fmt::format("{} pixels: mean {:.4f}, median {:.4f}, 95 % under {:.4f}, max {:.4f} degrees",
                    change->pixels, change->mean_deg, change->median_deg, change->p95_deg, change->max_deg));
  print(fmt::format("  albedo: mean |A - B| / B {:.5f}, bias {:+.5f}", change->albedo_rel,
                    change->albedo_bias_rel));
  if (change->sigma_deg)
    print(fmt::format("  sigma of the normals: {:.4g} to {:.4g} degrees", change->sigma_deg->before,
                      change->sigma_deg->after));
  print(fmt::format("  unsolved: {:.3f} to {:.3f} percent", 100 * change->unsolved.before,
                    100 * change->unsolved.after));
  if (change->status_changed)
    print(fmt::format("  status: {:.3f} percent of the pixels changed", 100 * *change->status_changed));
  const batch::WorstWindow& worst = change->worst;
  print(fmt::format("  worst: {:.4g} degrees in {} x {} pixels at {}, {}", worst.mean_deg, worst.side,
                    worst.side, worst.x, worst.y));
  if (change->is_none()) print("  no pixel changed");
  if (!worse.empty()) print(fmt::format("  worse: {}", fmt::join(worse, "; ")));
  return kDone;
}

Result<int> compare(const CompareArguments& a, const CommonArguments& common) {
  std::error_code ignored;
  if (std::filesystem::is_directory(a.tested, ignored) && std::filesystem::is_directory(a.truth, ignored)) {
    if (a.mask.empty() && a.kind == "normal") return compare_two_solves(a, common);
    return Error{ErrorKind::kUsage, "solves cannot be compared so", "--mask, --kind",
                 "of two folders all maps are compared, where both are solved", "leave these out"};
  }
  if (a.kind == "albedo") return print_albedo(a, common.json);
  const Result<NormalComparison> c = compare_normals(a.tested, a.truth, a.mask);
  if (!c) return c.error();
  if (common.json) {
    print_json({{"pixels", c->pixels},
                {"mean_deg", c->mean_deg},
                {"median_deg", c->median_deg},
                {"p95_deg", c->p95_deg},
                {"max_deg", c->max_deg}});
  } else {
    print(fmt::format("{} pixels: mean {:.4f}, median {:.4f}, 95 % under {:.4f}, max {:.4f} degrees",
                      c->pixels, c->mean_deg, c->median_deg, c->p95_deg, c->max_deg));
  }
  return kDone;
}

Run add_compare(Options& options) {
  const auto a = std::make_shared<CompareArguments>();
  options.add("tested", &a->tested, "Map to test (EXR, TIFF, PNG), or the folder of a solve").required();
  options.add("truth", &a->truth, "Map that is right, or the folder of the solve before").required();
  options.add("--mask", &a->mask, "Image that is over one half where pixels count");
  options.add("--kind", &a->kind, "What the maps are: normal, albedo")
      .one_of({"normal", "albedo"})
      .shows_default();
  return [a](const CommonArguments& common) { return compare(*a, common); };
}

}  // namespace

Verb compare_verb() {
  return {"compare", "Compare a map with the truth: degrees, or relative albedo", add_compare};
}

}  // namespace weft::app
