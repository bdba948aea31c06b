// SPDX-License-Identifier: Apache-2.0
#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/solve/registration.h"

namespace weft::app {

Result<int> run_bench_registration(const BenchRegistrationArguments&, const CommonArguments& common) {
  return print_rows(bench::registration(common.threads), common);
}

}  // namespace weft::app
