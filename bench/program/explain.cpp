// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/explain.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/options.h"
#include "bench/accuracy/price.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

app::Run add_explain(app::Options& options) {
  struct Said {
    ExplainOptions options;
    PriceTableOptions price;
    std::string set = "held-out";
    bool whole = false;
  };
  const auto said = std::make_shared<Said>();
  options.add_flag("--quick", &said->options.quick, "One small patch a scene, and no whole session");
  options.add_flag("--whole", &said->whole, "Whole sessions alone, whose seconds are foretold too");
  options.add("--set", &said->set, "Scenes: those that the prediction is fitted to, or those held out")
      .one_of({"tuning", "held-out"})
      .shows_default();
  options
      .add("--megapixels", &said->price.megapixels,
           "Sizes of the whole sessions that are priced; default 1,8")
      .by_commas()
      .above_zero();
  options.add("--scenes", &said->price.scenes, "Folder of their scenes").shows_default();
  return [said](const app::CommonArguments& common) -> Result<int> {
    said->options.set = said->set == "tuning" ? SceneSet::kTuning : SceneSet::kHeldOut;
    said->options.threads = common.threads;
    said->price.threads = common.threads;
    Result<Rows> rows = said->options.quick ? Rows() : price_table(said->price);
    if (!rows || said->whole) return print_rows(rows, common);
    Result<Rows> patches = explain_table(said->options);
    if (!patches) return std::move(patches).error();
    std::ranges::move(*patches, std::back_inserter(*rows));
    return print_rows(rows, common);
  };
}

}  // namespace

app::Verb explain_verb() {
  return {"explain", "Errors and seconds that solve --explain foretells against true ones", add_explain};
}

}  // namespace weft::bench
