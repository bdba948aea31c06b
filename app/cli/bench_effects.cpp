// SPDX-License-Identifier: Apache-2.0
#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/effects/auto.h"
#include "bench/effects/cost.h"
#include "bench/effects/embree.h"
#include "bench/effects/gallery.h"
#include "bench/effects/rays.h"

namespace weft::app {
namespace {

Result<bench::Rows> measure(const BenchEffectsArguments& a, int threads) {
  if (a.rays) return bench::effects_rays(threads);
  if (a.embree) return bench::effects_embree();
  if (a.choice) return bench::effects_auto(threads);
  if (!a.gallery.empty()) return bench::effects_gallery(a.gallery, threads);
  return bench::effects_cost({a.megapixels, threads});
}

}  // namespace

Result<int> run_bench_effects(const BenchEffectsArguments& arguments, const CommonArguments& common) {
  return print_rows(measure(arguments, common.threads), common);
}

}  // namespace weft::app
