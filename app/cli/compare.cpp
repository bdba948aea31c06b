// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/compare.h"

#include <fmt/format.h>

#include <memory>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"

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

Result<int> compare(const CompareArguments& a, const CommonArguments& common) {
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
  options.add("tested", &a->tested, "Map to test (EXR, TIFF, PNG)").required();
  options.add("truth", &a->truth, "Map that is right").required();
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
