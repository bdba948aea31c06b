// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/compare.h"

#include <fmt/format.h>

#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"

namespace weft::app {
namespace {

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

}  // namespace

Result<int> run_compare(const CompareArguments& a, const CommonArguments& common) {
  if (a.albedo) return print_albedo(a, common.json);
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

}  // namespace weft::app
