// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "app/cli/options.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"
#include "bench/solve/accuracy.h"
#include "bench/solve/end_to_end.h"
#include "bench/solve/speed.h"
#include "core/process.h"

namespace weft::bench {
namespace {

struct SolveArguments {
  double megapixels = 4;
  bool exact = false;
  bool noise = false;
  bool order = false;
  bool end_to_end = false;
};

Result<Rows> measure(const SolveArguments& a, int threads) {
  if (a.exact) return solve_exactness({a.megapixels, threads});
  if (a.noise) return solve_noise({a.megapixels, threads});
  if (a.order) return solve_order({a.megapixels, threads});
  if (a.end_to_end) return end_to_end({a.megapixels, threads, program_beside("weft")});
  return solve_speed({a.megapixels, threads});
}

app::Run add_solve(app::Options& options) {
  const auto a = std::make_shared<SolveArguments>();
  options.add("--megapixels", &a->megapixels, "Size of the photographs, millions of pixels")
      .in_range(0.01, 200.0)
      .shows_default();
  const app::Option exact =
      options.add_flag("--exact", &a->exact, "Noise-free errors against the truth instead of speed");
  const app::Option noise =
      options.add_flag("--noise", &a->noise, "Errors under noise against the Cramer-Rao bound");
  const app::Option order =
      options.add_flag("--order", &a->order, "Demosaicing before solving against after it");
  const app::Option end_to_end = options.add_flag("--end-to-end", &a->end_to_end,
                                                  "From eleven DNG files to maps on disk, with peak memory");
  exact.excludes(noise).excludes(order).excludes(end_to_end);
  noise.excludes(order).excludes(end_to_end);
  order.excludes(end_to_end);
  return [a](const app::CommonArguments& common) { return print_rows(measure(*a, common.threads), common); };
}

}  // namespace

app::Verb solve_verb() {
  return {"solve", "Speed and exactness of the solver", add_solve};
}

}  // namespace weft::bench
