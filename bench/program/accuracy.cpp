// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "app/cli/options.h"
#include "bench/accuracy/bound.h"
#include "bench/accuracy/chain.h"
#include "bench/accuracy/coverage.h"
#include "bench/accuracy/gloss.h"
#include "bench/accuracy/levels.h"
#include "bench/accuracy/page.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"
#include "core/process.h"

namespace weft::bench {
namespace {

struct AccuracyArguments {
  AccuracyTableOptions table;
  std::string set = "held-out";
  bool bound = false;
  bool leds = false;
  bool specular = false;
  bool sigma = false;
  bool chain = false;
  bool gloss = false;
  double megapixels = 0;  ///< of whole frames; 0: not these
  std::vector<std::string> parts;
  std::filesystem::path docs;  ///< folder with accuracy.md; empty: no page
};

Result<Rows> measure(const AccuracyArguments& a, int threads) {
  AccuracyTableOptions options = a.table;
  options.set = a.set == "tuning" ? SceneSet::kTuning : SceneSet::kHeldOut;
  options.threads = threads;
  if (a.bound) return accuracy_bound({options.methods, threads});
  if (a.leds) return accuracy_by_leds(options);
  if (a.specular) return specular_warnings(options);
  if (a.sigma) return coverage_table(options);
  if (a.gloss)
    return gloss_table(
        {.set = options.set, .cloth = options.scene, .seed = options.seed, .threads = threads});
  if (a.chain)
    return chain_table(
        {.name = options.scene, .levels = options.methods, .seed = options.seed, .threads = threads});
  if (a.megapixels > 0) return level_speed({a.megapixels, options.scene, options.methods, threads});
  if (a.docs.empty()) return accuracy_table(options);
  AccuracyFigures figures;
  if (!a.parts.empty()) {
    Result<AccuracyFigures> before = read_accuracy_docs(a.docs);
    if (!before) return std::move(before).error();
    figures = std::move(*before);
  }
  const auto measured = measure_figures({options, a.parts, program_beside("weft")}, figures);
  if (!measured) return measured.error();
  if (Result<void> written = write_accuracy_docs(a.docs, figures); !written)
    return std::move(written).error();
  return std::move(figures.table);
}

app::Run add_accuracy(app::Options& options) {
  const auto a = std::make_shared<AccuracyArguments>();
  options.add_flag("--quick", &a->table.quick, "One small patch a scene, no yardsticks");
  options.add("--set", &a->set, "Scenes: those that methods are tuned on, or those held out")
      .one_of({"tuning", "held-out"})
      .shows_default();
  options.add("--scene", &a->table.scene, "One scene alone, such as \"deep satin\"");
  options.add("--method", &a->table.methods, "These levels and methods alone: fast,least-squares")
      .by_commas();
  const std::vector<app::Option> instead = {
      options.add_flag("--bound", &a->bound,
                       "Instead: scatter against the Cramer-Rao bound, and whether sigma is honest"),
      options.add_flag("--leds", &a->leds, "Instead: from three to ten LEDs"),
      options.add_flag("--specular", &a->specular,
                       "Instead: who says SPECULAR on 30 dark satins and 90 other cloths"),
      options.add_flag("--sigma", &a->sigma,
                       "Instead: whether errors on cloth are as large as sigma says, at every level"),
      options.add_flag("--gloss", &a->gloss,
                       "Instead: the lobe of glossy cloths, found and solved with; --scene is a cloth of it"),
      options.add_flag("--chain", &a->chain,
                       "Instead: whole sessions by the product's own steps, from captures to maps"),
      options
          .add("--megapixels", &a->megapixels,
               "Instead: what levels take on frames of so many million pixels, held in memory")
          .in_range(0.3, 200.0),
      options.add("--docs", &a->docs,
                  "All of it, into this folder: the figures of accuracy.md, its plots, accuracy.json")};
  for (std::size_t i = 0; i < instead.size(); ++i) {
    for (std::size_t j = i + 1; j < instead.size(); ++j) instead[i].excludes(instead[j]);
  }
  options.add("--seed", &a->table.seed, "Of weaves and noise, from 1").shows_default();
  options
      .add("--part", &a->parts,
           fmt::format("With --docs: these figures alone, the others as accuracy.json has them: {}",
                       fmt::join(figure_parts(), ",")))
      .by_commas()
      .needs(instead.back());
  return [a](const app::CommonArguments& common) { return print_rows(measure(*a, common.threads), common); };
}

}  // namespace

app::Verb accuracy_verb() {
  return {"accuracy", "What each level and method gets right, and its price", add_accuracy};
}

}  // namespace weft::bench
