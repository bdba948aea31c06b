// SPDX-License-Identifier: Apache-2.0
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "bench/end_to_end.h"
#include "bench/solve_accuracy.h"
#include "bench/solve_speed.h"

namespace weft::app {
namespace {

Result<bench::Rows> measure(const BenchSolveArguments& a, int threads) {
  if (a.exact) return bench::solve_exactness({a.megapixels, threads});
  if (a.noise) return bench::solve_noise({a.megapixels, threads});
  if (a.order) return bench::solve_order({a.megapixels, threads});
  if (a.end_to_end)
    return bench::end_to_end({a.megapixels, threads, std::filesystem::read_symlink("/proc/self/exe")});
  return bench::solve_speed({a.megapixels, threads});
}

}  // namespace

Result<int> run_bench_solve(const BenchSolveArguments& arguments, const CommonArguments& common) {
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
