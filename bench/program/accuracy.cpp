// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include "bench/accuracy/accuracy_page.h"
#include "bench/accuracy/coverage.h"
#include "bench/accuracy/photos.h"
#include "bench/cloths/cloths.h"
#include "bench/cloths/forecast.h"
#include "bench/program/studies.h"
#include "bench/sanity/frame_faults.h"
#include "bench/sanity/sanity.h"

namespace weft::bench {
namespace {

struct AccuracyArguments {
  AccuracyTableOptions table;
  std::string set = "held-out";
  double megapixels = 0;  ///< of whole frames; 0: not these
  std::vector<std::string> parts;
  std::filesystem::path docs;  ///< folder with the pages on accuracy; empty: no page

  AccuracyTableOptions with(const StudyOptions& options) const {
    AccuracyTableOptions all = table;
    all.set = set == "tuning" ? SceneSet::kTuning : SceneSet::kHeldOut;
    all.threads = options.threads;
    return all;
  }
};

app::Option add_set(app::Options& options, std::string& set, const char* help) {
  return options.add("--set", &set, help).one_of({"tuning", "held-out"}).shows_default();
}

Result<Rows> measure_for_docs(const AccuracyArguments& a, const StudyOptions& options) {
  AccuracyFigures figures;
  if (!a.parts.empty()) {
    Result<AccuracyFigures> before = read_accuracy_docs(a.docs);
    if (!before) return std::move(before).error();
    figures = std::move(*before);
  }
  const auto measured = measure_figures({a.with(options), a.parts, options.programs / "weft"}, figures);
  if (!measured) return measured.error();
  if (Result<void> written = write_accuracy_docs(a.docs, figures); !written)
    return std::move(written).error();
  return std::move(figures.table);
}

Result<Rows> measure_table(const AccuracyArguments& a, const StudyOptions& options) {
  if (!a.docs.empty()) return measure_for_docs(a, options);
  AccuracyTableOptions table = a.with(options);
  if (a.megapixels == 0) return accuracy_table(table);
  table.megapixels = a.megapixels;
  return level_speed(table);
}

app::Run add_accuracy(app::Options& options) {
  const auto a = std::make_shared<AccuracyArguments>();
  options.add_flag("--quick", &a->table.quick, "One small patch a scene, no yardsticks");
  add_set(options, a->set, "Scenes: those that methods are tuned on, or those held out");
  options.add("--scene", &a->table.scene, "One scene alone, such as \"deep satin\"");
  options.add("--method", &a->table.methods, "These levels and methods alone: fast,least-squares")
      .by_commas();
  const auto of = [a](Result<Rows> (*table)(const AccuracyTableOptions&)) {
    return [a, table](const StudyOptions& o) { return table(a->with(o)); };
  };
  std::vector<app::Option> instead;
  const Choice choice = by_flag(
      options,
      {{"table", "", [a](const StudyOptions& o) { return measure_table(*a, o); }},
       {"bound", "Instead: scatter against the Cramer-Rao bound, and whether sigma is honest",
        of(accuracy_bound)},
       {"leds", "Instead: from three to ten LEDs", of(accuracy_by_leds)},
       {"specular", "Instead: who says SPECULAR on 30 dark satins and 90 other cloths",
        of(specular_warnings)},
       {"sigma", "Instead: whether errors on cloth are as large as sigma says, at every level",
        of(coverage_table)},
       {"gloss", "Instead: the lobe of glossy cloths, found and solved with; --scene is a cloth of it",
        of(gloss_table)},
       {"chain", "Instead: whole sessions by the product's own steps, from captures to maps",
        of(chain_table)}},
      &instead);
  instead.push_back(options
                        .add("--megapixels", &a->megapixels,
                             "Instead: what levels take on frames of so many million pixels, held in memory")
                        .in_range(0.3, 200.0));
  instead.push_back(
      options.add("--docs", &a->docs,
                  "All of it, into this folder: accuracy.md, measured/accuracy.md, plots, accuracy.json"));
  exclude_each_other(instead);
  options.add("--seed", &a->table.seed, "Of weaves and noise, from 1").shows_default();
  options
      .add("--part", &a->parts,
           fmt::format("With --docs: these figures alone, the others as accuracy.json has them: {}",
                       fmt::join(figure_parts(), ",")))
      .by_commas()
      .needs(instead.back());
  return run_of(choice);
}

app::Run add_explain(app::Options& options) {
  struct Said : AccuracyArguments {
    std::vector<double> sizes = {1, 8};
    bool whole = false;
  };
  const auto said = std::make_shared<Said>();
  options.add_flag("--quick", &said->table.quick, "One small patch a scene, and no whole session");
  options.add_flag("--whole", &said->whole, "Whole sessions alone, whose seconds are foretold too");
  add_set(options, said->set, "Scenes: those that the prediction is fitted to, or those held out");
  options.add("--megapixels", &said->sizes, "Sizes of the whole sessions that are priced; default 1,8")
      .by_commas()
      .above_zero();
  options.add("--scenes", &said->table.scenes, "Folder of their scenes").shows_default();
  return run_of(by_flag(options, {{"explain", "", [said](const StudyOptions& o) -> Result<Rows> {
                                     const AccuracyTableOptions table = said->with(o);
                                     Result<Rows> rows =
                                         table.quick ? Rows() : price_table(table, said->sizes);
                                     if (!rows || said->whole) return rows;
                                     Result<Rows> patches = explain_table(table);
                                     if (!patches) return patches;
                                     std::ranges::move(*patches, std::back_inserter(*rows));
                                     return rows;
                                   }}}));
}

app::Run add_photos(app::Options& options) {
  const auto a = std::make_shared<PhotosOptions>();
  options.add("folder", &a->folder, "Photographs in the layout of the DiLiGenT benchmark, with normal_gt.exr")
      .required();
  options.add("--pick", &a->pick, "Well-spread lights a subset; 0 is all of them")
      .not_negative()
      .shows_default();
  options.add("--subsets", &a->subsets, "Subsets to average over").in_range(1, 10000).shows_default();
  options.add("--seed", &a->seed, "Of the subsets").shows_default();
  options.add("--method", &a->methods, "These levels and methods alone: fast,least-squares").by_commas();
  return run_of(by_flag(options, {{"photos", "", [a](const StudyOptions& o) {
                                     a->threads = o.threads;
                                     return photos_table(*a);
                                   }}}));
}

app::Run add_cloths(app::Options& options) {
  struct Said : ClothsOptions {
    std::string set_name = "held-out";
  };
  const auto a = std::make_shared<Said>();
  const Choice choice = by_flag(options, {{"cloths",
                                           "",
                                           [a](const StudyOptions& o) {
                                             a->set = a->set_name == "tuning"     ? KindSet::kChosenOn
                                                      : a->set_name == "held-out" ? KindSet::kHeldOut
                                                                                  : KindSet::kAnything;
                                             return cloths_table(*a, o);
                                           },
                                           {.runs = 1}}});
  options
      .add("--set", &a->set_name,
           "Kinds of cloth: those that thresholds are chosen on, those held out, or cloths of no kind")
      .one_of({"tuning", "held-out", "anything"})
      .shows_default();
  options.add("--kind", &a->kind, "One kind alone, such as \"white cotton\"");
  options.add("--method", &a->methods, "These levels alone: standard,reference").by_commas();
  options.add_flag("--sessions", &a->as_session, "Mosaics of a calibrated rig instead of loose photographs");
  options.add("--draws", &choice->options.runs, "Of a kind; 0 is 1").in_range(0, 1000);
  options.add("--seed", &choice->options.seed, "Of the first draw").shows_default();
  options.add(
      "--blocks", &a->blocks,
      "File to which a line of JSON is added for each block of 64 x 64 pixels: what it showed, and its "
      "error");
  return run_of(choice);
}

app::Run add_forecast(app::Options& options) {
  const auto a = std::make_shared<ForecastOptions>();
  const Choice choice =
      by_flag(options, {{"forecast", "", [a](const StudyOptions& o) { return forecast_table(*a, o); }}});
  options.add("blocks", &a->held, "Files of weft bench cloths --blocks, whose errors are foretold")
      .required();
  options.add("--learn", &a->taught_on, "Learn from the blocks of these files: a.jsonl,b.jsonl")
      .by_commas()
      .required();
  options.add("--seed", &choice->options.seed, "Of the networks' beginnings").shows_default();
  return run_of(choice);
}

app::Run add_sanity(app::Options& options) {
  const auto a = std::make_shared<SanityOptions>();
  const Choice choice = by_flag(
      options, {{"sanity", "", [a](const StudyOptions& o) { return sanity_table(*a, o); }, {.runs = 100}}});
  std::vector<std::string> names;
  for (const SetFault& fault : set_faults()) names.emplace_back(fault.name);
  options.add("--fault", &a->fault, "One fault alone, such as \"y mirrored\"").one_of(names);
  options.add("--sets", &choice->options.runs, "Sets of photographs a fault; 0 is 100").in_range(0, 10000);
  options.add("--seed", &choice->options.seed, "Of the first set").shows_default();
  options.add_flag("--list", &a->lists, "What is said of each set");
  return run_of(choice);
}

app::Run add_frames(app::Options& options) {
  const auto a = std::make_shared<FrameFaultOptions>();
  const Choice choice = by_flag(
      options,
      {{"frames", "", [a](const StudyOptions& o) { return frame_faults_table(*a, o); }, {.runs = 200}}});
  options.add("--fault", &a->fault, "One fault alone, such as \"rows off by one\"").one_of(frame_faults());
  options.add("--draws", &choice->options.runs, "Of a fault; 0 is 200").in_range(0, 100000);
  options.add("--seed", &choice->options.seed, "Of the first draw").shows_default();
  options.add_flag("--list", &a->lists, "What is said of each draw");
  return run_of(choice);
}

}  // namespace

app::Verb accuracy_verb() {
  return {"accuracy", "What each level and method gets right, and its price", add_accuracy};
}

app::Verb explain_verb() {
  return {"explain", "Errors and seconds that solve --explain foretells against true ones", add_explain};
}

app::Verb cloths_verb() {
  return {"cloths", "Errors of thirty-seven kinds of cloth against what reports say of them", add_cloths};
}

app::Verb forecast_verb() {
  return {"forecast", "Errors that blocks of simulated cloths let one expect, by formulas and as learned",
          add_forecast};
}

app::Verb sanity_verb() {
  return {"sanity", "What is said of photographs whose lights or values are not what they are taken for",
          add_sanity};
}

app::Verb frames_verb() {
  return {"frames", "What is said of frames of a rig, some of which lie", add_frames};
}

app::Verb photos_verb() {
  return {"photos", "Errors on real photographs under known distant lights", add_photos};
}

}  // namespace weft::bench
