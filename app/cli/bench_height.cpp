// SPDX-License-Identifier: Apache-2.0
#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/solve/height.h"

namespace weft::app {

Result<int> run_bench_height(const BenchHeightArguments& arguments, const CommonArguments& common) {
  return print_rows(bench::height_speed({arguments.megapixels, common.threads}), common);
}

}  // namespace weft::app
