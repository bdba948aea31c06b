// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/photos.h"

#include "app/cli/bench_rows.h"
#include "app/cli/verbs.h"

namespace weft::app {

Result<int> run_bench_photos(const BenchPhotosArguments& a, const CommonArguments& common) {
  return print_rows(bench::photos_table({a.folder, a.pick, a.subsets, a.seed, a.methods, common.threads}),
                    common);
}

}  // namespace weft::app
