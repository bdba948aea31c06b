// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/accuracy/bound.h"
#include "bench/accuracy/page.h"

namespace weft::app {
namespace {

Result<bench::Rows> measure(const BenchAccuracyArguments& a, int threads) {
  bench::AccuracyTableOptions options;
  options.set = a.tuning ? bench::SceneSet::kTuning : bench::SceneSet::kHeldOut;
  options.quick = a.quick;
  options.scene = a.scene;
  options.methods = a.methods;
  options.threads = threads;
  if (a.bound) return bench::accuracy_bound({a.methods, threads});
  if (a.leds) return bench::accuracy_by_leds(options);
  if (a.specular) return bench::specular_warnings(options);
  if (a.docs.empty()) return bench::accuracy_table(options);
  Result<bench::AccuracyFigures> figures = bench::measure_figures(options);
  if (!figures) return std::move(figures).error();
  if (Result<void> written = bench::write_accuracy_docs(a.docs, *figures); !written) {
    return std::move(written).error();
  }
  return std::move(figures->table);
}

}  // namespace

Result<int> run_bench_accuracy(const BenchAccuracyArguments& arguments, const CommonArguments& common) {
  return print_rows(measure(arguments, common.threads), common);
}

}  // namespace weft::app
