// SPDX-License-Identifier: Apache-2.0
#include "bench/numerics/numerics.h"

#include <filesystem>
#include <memory>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

struct NumericsArguments {
  bool curve = false;          ///< error against condition number, not the cases
  std::filesystem::path docs;  ///< folder; empty: print
  std::filesystem::path scenes = "testdata/scenes";
};

Result<int> measure(const NumericsArguments& a, const app::CommonArguments& common) {
  if (a.docs.empty()) return print_rows(a.curve ? numerics_curve() : numerics_cases(), common);
  if (Result<void> written = write_numerics_docs(a.docs, a.scenes); !written) return written.error();
  return app::kDone;
}

app::Run add_numerics(app::Options& options) {
  const auto a = std::make_shared<NumericsArguments>();
  const app::Option curve =
      options.add_flag("--curve", &a->curve, "Error against condition number instead of the cases");
  const app::Option docs =
      options.add("--docs", &a->docs, "Folder with numerics.md, whose tables and pictures to make again");
  options.add("--scenes", &a->scenes, "Folder with torture.toml").shows_default().needs(docs);
  curve.excludes(docs);
  return [a](const app::CommonArguments& common) { return measure(*a, common); };
}

}  // namespace

app::Verb numerics_verb() {
  return {"numerics", "Pixels that are numerically hard: errors, flags and what solved them", add_numerics};
}

}  // namespace weft::bench
