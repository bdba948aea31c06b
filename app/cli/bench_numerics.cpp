// SPDX-License-Identifier: Apache-2.0
#include "bench/numerics/numerics.h"

#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"

namespace weft::app {

Result<int> run_bench_numerics(const BenchNumericsArguments& arguments, const CommonArguments& common) {
  if (arguments.docs.empty()) {
    return print_rows(arguments.curve ? bench::numerics_curve() : bench::numerics_cases(), common);
  }
  if (Result<void> written = bench::write_numerics_docs(arguments.docs, arguments.scenes); !written)
    return written.error();
  return kDone;
}

}  // namespace weft::app
