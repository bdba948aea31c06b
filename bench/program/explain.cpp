// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/explain.h"

#include <memory>
#include <string>

#include "app/cli/options.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

app::Run add_explain(app::Options& options) {
  struct Said {
    ExplainOptions options;
    std::string set = "held-out";
  };
  const auto said = std::make_shared<Said>();
  options.add_flag("--quick", &said->options.quick, "One small patch a scene");
  options.add("--set", &said->set, "Scenes: those that the prediction is fitted to, or those held out")
      .one_of({"tuning", "held-out"})
      .shows_default();
  return [said](const app::CommonArguments& common) {
    said->options.set = said->set == "tuning" ? SceneSet::kTuning : SceneSet::kHeldOut;
    said->options.threads = common.threads;
    return print_rows(explain_table(said->options), common);
  };
}

}  // namespace

app::Verb explain_verb() {
  return {"explain", "Errors that solve --explain predicts against true ones", add_explain};
}

}  // namespace weft::bench
