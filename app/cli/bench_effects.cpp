// SPDX-License-Identifier: Apache-2.0
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "bench/effects_auto.h"
#include "bench/effects_cost.h"
#include "bench/effects_embree.h"
#include "bench/effects_gallery.h"
#include "bench/effects_rays.h"

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
  const Result<bench::Rows> rows = measure(arguments, common.threads);
  if (!rows) return rows.error();
  if (common.json) {
    print_json(bench::document_of(*rows));
  } else {
    print(bench::table_of(*rows));
  }
  return kDone;
}

}  // namespace weft::app
