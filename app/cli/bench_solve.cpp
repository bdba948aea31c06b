// SPDX-License-Identifier: Apache-2.0
#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"
#include "bench/solve/accuracy.h"
#include "bench/solve/end_to_end.h"
#include "bench/solve/speed.h"

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
  return print_rows(measure(arguments, common.threads), common);
}

}  // namespace weft::app
