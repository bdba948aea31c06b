// SPDX-License-Identifier: Apache-2.0
#include "library/chain/make.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "exchange/export/export.h"
#include "exchange/export/prepare.h"
#include "exchange/export/preset_files.h"
#include "library/catalogue/metadata.h"
#include "material/run/maps.h"
#include "material/run/session_sets.h"
#include "solve/report/solve_report.h"
#include "solve/run/solve_session.h"
#include "solve/session/solved.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// One run of make_session(): each step looks at what lies there, says what it does, does it.
class Making {
 public:
  Making(const MakeOptions& options, const JobContext& context, const TellStep& tell)
      : options_(options), context_(context), tell_(tell) {}

  Result<void> begin_with(const fs::path& session);
  Result<void> make_solve();
  Result<void> make_maps();
  Result<void> export_all();
  Result<MakeReport> ended();

  const std::string& solve() const { return solve_; }
  const fs::path& maps() const { return maps_; }

 private:
  Result<solve::LevelPrice> priced_level();
  Result<void> check_solve_of_photographs(const ChainLink& link) const;
  Result<void> make_current();
  std::vector<std::string> presets_wanted() const;
  std::vector<std::string> lacking_maps(const fs::path& set) const;
  material::MapsOptions maps_like_the_newest(const solve::SessionSolves& solves) const;
  void tell_step(std::string step);

  const MakeOptions& options_;
  const JobContext& context_;
  const TellStep& tell_;
  Session session_;
  Chain before_;
  std::string solve_;    // that maps are made of
  bool is_new_ = false;  // so far something was made, or would be
  fs::path maps_;
  MakeReport report_;
};

// What can be refused is refused before anything is made.
Result<void> Making::begin_with(const fs::path& session) {
  for (const std::string& preset : options_.presets) {
    if (const Result<exchange::Preset> known = exchange::read_preset(preset); !known) return known.error();
  }
  Result<Session> read = solve::read_solved(fs::absolute(session).lexically_normal());
  if (!read) return std::move(read).error();
  session_ = std::move(*read);
  before_ = chain_of(session_);
  return {};
}

std::string reasons(const ChainLink& link) {
  return link.why.empty() ? "" : fmt::format(", as {}", link.why.front());
}

void Making::tell_step(std::string step) {
  is_new_ = true;
  if (tell_) tell_(step);
  report_.steps.push_back(std::move(step));
}

// What the wish chooses, or else the price recommends. A preview is no end of a chain.
Result<solve::LevelPrice> Making::priced_level() {
  Result<solve::Ladder> ladder =
      solve::explain_session({.folder = session_.folder, .calibration = {}, .leds = {}}, {}, {}, context_);
  if (!ladder) return std::move(ladder).error();
  std::erase_if(ladder->levels,
                [](const solve::LevelPrice& level) { return level.level == solver::Level::kPreview; });
  const Result<std::size_t> chosen = solve::choose_level(*ladder, options_.wish);
  if (!chosen) return chosen.error();
  return std::move(ladder->levels[*chosen]);
}

// A solve of photographs does not know where they lie.
Result<void> Making::check_solve_of_photographs(const ChainLink& link) const {
  if (!options_.wish.is_one() && link.freshness != Freshness::kDraft) return {};
  return Error{
      options_.wish.is_one() ? ErrorKind::kUsage : ErrorKind::kNoInput,
      "photographs are solved from their own folder", session_.folder.string(),
      options_.wish.is_one() ? "this one holds their solve" : "this one holds the preview of a solve",
      fmt::format("solve them with {}", command_to_solve(solve::solves_of(session_), "standard"))};
}

Result<void> Making::make_solve() {
  const ChainLink& link = before_.link("solve");
  solve_ = link.id;
  if (solve::is_lone_solve(session_)) return check_solve_of_photographs(link);
  const bool is_fresh = link.freshness == Freshness::kFresh;
  const bool is_good_enough = options_.wish.to_deg && link.mean_deg && link.solved &&
                              deg_of_whole(*link.mean_deg, *link.solved) <= *options_.wish.to_deg;
  if (is_fresh && (!options_.wish.is_one() || is_good_enough)) return {};
  solve::SolveOptions how;
  if (link.freshness == Freshness::kStale && !options_.wish.is_one()) {
    how.method = link.level;
    tell_step(fmt::format("solve it again at {}{}", link.level, reasons(link)));
  } else {
    const Result<solve::LevelPrice> level = priced_level();
    if (!level) return level.error();
    const bool is_no_better = is_fresh && link.mean_deg && link.solved &&
                              level->error.of_whole_deg() >= deg_of_whole(*link.mean_deg, *link.solved);
    if (is_fresh && (is_no_better || level->name() == link.level)) return {};
    how.method = level->name();
    how.foretold = solve::price_of(*level);
    tell_step(fmt::format("solve it at {}: {} in {:.3g} s foretold{}", level->name(),
                          error_in_words(level->error.total_deg, level->error.solved), level->seconds.total(),
                          is_fresh ? "" : reasons(link)));
  }
  if (options_.only_explains) return {};
  Stopwatch watch;
  const Result<solve::SolveReport> solved =
      solve::solve_session({.folder = session_.folder, .calibration = {}, .leds = {}}, how, context_);
  if (!solved) return solved.error();
  solve_ = solved->facts.id;
  if (!solved->was_there) report_.made.push_back({"solve", solve_, solved->folder, watch.lap()});
  return make_current();
}

// Another may be chosen, or stand higher; what is made of the session is made of this one.
Result<void> Making::make_current() {
  if (solve::current_solve(session_) == solve_) return {};
  const Result<MetadataChange> changed = change_metadata(session_.folder, {{"current_solve", solve_}});
  if (!changed) return changed.error();
  return {};
}

// By the recipe and the options of the newest set that somebody made.
material::MapsOptions Making::maps_like_the_newest(const solve::SessionSolves& solves) const {
  material::MapsOptions how;
  how.session = session_.folder;
  how.solve = solve_;
  for (const material::DerivedMap& map : material::derived_maps()) how.maps.emplace_back(map.name);
  const std::vector<material::SessionSet> sets = material::sets_of(solves);
  if (sets.empty()) return how;
  const material::MapSetFacts& like = sets.back().facts;
  how.derive = like.derive;
  if (Result<material::Recipe> recipe = material::recipe_from_json(like.document, "maps.json"))
    how.recipe = std::move(*recipe);
  return how;
}

Result<void> Making::make_maps() {
  const ChainLink& link = before_.link("maps");
  const bool is_there = !is_new_ && link.freshness == Freshness::kFresh;
  const std::vector<std::string> lacking = is_there ? lacking_maps(link.folder) : std::vector<std::string>();
  maps_ = link.folder;
  if (is_there && lacking.empty()) return {};
  const material::MapsOptions how = maps_like_the_newest(solve::solves_of(session_));
  tell_step(fmt::format("make its maps{}{}", how.recipe.steps.empty() ? "" : ", finished as the newest are",
                        !lacking.empty() ? fmt::format(", as they are without {}", fmt::join(lacking, ", "))
                        : is_new_        ? " of that"
                                         : reasons(link)));
  if (options_.only_explains) return {};
  Stopwatch watch;
  const Result<material::MapsReport> made = material::make_maps(how, context_);
  if (!made) return made.error();
  maps_ = made->folder;
  if (!made->was_there) report_.made.push_back({"maps", made->facts.id, maps_, watch.lap()});
  return {};
}

// What the presets cannot do without.
std::vector<std::string> Making::lacking_maps(const fs::path& set) const {
  const Result<material::MapSetFacts> facts = material::read_map_set(set);
  if (!facts) return {};
  return material::lacking(*facts, exchange::needed_maps(presets_wanted()));
}

// What was exported before, as far as its preset is there yet.
std::vector<std::string> Making::presets_wanted() const {
  if (!options_.presets.empty()) return options_.presets;
  std::vector<std::string> before;
  for (const ChainLink& link : before_.links) {
    if (link.name == "export" && !link.id.empty() && exchange::read_preset(link.id))
      before.push_back(link.id);
  }
  return before;
}

Result<void> Making::export_all() {
  for (const std::string& preset : presets_wanted()) {
    const auto link = std::ranges::find_if(
        before_.links, [&](const ChainLink& each) { return each.name == "export" && each.id == preset; });
    const bool is_known = link != before_.links.end();
    if (!is_new_ && is_known && link->freshness == Freshness::kFresh) continue;
    tell_step(fmt::format("export {}{}", preset, is_known ? " again" : ""));
    if (options_.only_explains) continue;
    Stopwatch watch;
    exchange::ExportOptions how;
    how.input = maps_;
    how.presets = {preset};
    // Beside those that a batch left there.
    const bool is_of_batch = is_known && fs::path(link->folder).parent_path().filename() == preset;
    if (is_of_batch) how.output = session_.folder / "export" / preset / maps_.filename();
    const Result<std::vector<exchange::ExportReport>> made = exchange::export_maps(how, context_);
    if (!made) return made.error();
    if (!made->front().was_there)
      report_.made.push_back({"export", preset, made->front().folder, watch.lap()});
  }
  return {};
}

Result<MakeReport> Making::ended() {
  const Result<Session> session = solve::read_solved(session_.folder);
  if (!session) return session.error();
  report_.chain = chain_of(*session);
  return std::move(report_);
}

}  // namespace

void describe(Fields& fields, MakeOptions& options) {
  fields.value({.name = "session",
                .says = "Session folder, NAME.weft, or that of a solve of photographs",
                .need = kMustSay,
                .path = PathTo::kSession,
                .option = ""},
               options.session);
  fields.value({.name = "within_s",
                .says = "Of the solve: the best level that takes so many seconds; default the level that "
                        "its price recommends",
                .range = kAboveZero},
               options.wish.within_seconds);
  fields.value({.name = "to_deg",
                .says = "Of the solve: the cheapest level expected to be so many degrees off at most",
                .range = kAboveZero},
               options.wish.to_deg);
  fields.value({.name = "presets",
                .says = "Name of a preset of weft export --list; default those that were exported before",
                .option = "--preset",
                .is_said_again = true},
               options.presets);
  fields.value(
      {.name = "explain", .says = "Say what would be made, and make nothing", .said = Said::kAtThisMachine},
      options.only_explains);
}

Result<MakeReport> make_session(const MakeOptions& options, const JobContext& context, const TellStep& tell) {
  Making making(options, context, tell);
  if (Result<void> ok = making.begin_with(options.session); !ok) return std::move(ok).error();
  if (Result<void> ok = making.make_solve(); !ok) return std::move(ok).error();
  if (Result<void> ok = making.make_maps(); !ok) return std::move(ok).error();
  if (Result<void> ok = making.export_all(); !ok) return std::move(ok).error();
  return making.ended();
}

Result<std::string> make_solve_first(const fs::path& session, const JobContext& context,
                                     const TellStep& tell) {
  const Result<Session> read = solve::read_solved(session);
  if (!read) return read.error();
  if (solve::solve_for_maps(solve::solves_of(*read), "", false)) return std::string();
  const MakeOptions options;
  Making making(options, context, tell);
  if (Result<void> ok = making.begin_with(session); !ok) return std::move(ok).error();
  if (Result<void> ok = making.make_solve(); !ok) return std::move(ok).error();
  return making.solve();
}

Result<fs::path> make_maps_first(const fs::path& session, const std::vector<std::string>& presets,
                                 const JobContext& context, const TellStep& tell) {
  const Result<Session> read = solve::read_solved(session);
  if (!read) return read.error();
  const solve::SessionSolves solves = solve::solves_of(*read);
  const std::vector<material::SessionSet> sets = material::sets_of(solves);
  const std::vector<std::string> wanted = exchange::needed_maps(presets);
  const material::SessionSet* const set = material::set_to_use(solves, sets, wanted);
  if (set != nullptr && !set->is_draft && solve::why_other_size(*read, set->facts.source).empty() &&
      material::lacking(set->facts, wanted).empty())
    return fs::path();
  const MakeOptions options = {.session = session, .presets = presets};
  Making making(options, context, tell);
  if (Result<void> ok = making.begin_with(session); !ok) return std::move(ok).error();
  if (Result<void> ok = making.make_solve(); !ok) return std::move(ok).error();
  if (Result<void> ok = making.make_maps(); !ok) return std::move(ok).error();
  return making.maps();
}

}  // namespace weft::library
