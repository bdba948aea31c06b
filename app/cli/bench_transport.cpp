// SPDX-License-Identifier: Apache-2.0
#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/solve/transport.h"

namespace weft::app {

Result<int> run_bench_transport(const BenchTransportArguments& arguments, const CommonArguments& common) {
  return print_rows(bench::transport({arguments.megapixels, common.threads}), common);
}

}  // namespace weft::app
