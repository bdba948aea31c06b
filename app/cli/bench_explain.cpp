// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/explain.h"

#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"

namespace weft::app {

Result<int> run_bench_explain(const BenchExplainArguments& arguments, const CommonArguments& common) {
  bench::ExplainOptions options;
  options.set = arguments.tuning ? bench::SceneSet::kTuning : bench::SceneSet::kHeldOut;
  options.quick = arguments.quick;
  options.threads = common.threads;
  return print_rows(bench::explain_table(options), common);
}

}  // namespace weft::app
