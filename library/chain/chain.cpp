// SPDX-License-Identifier: Apache-2.0
#include "library/chain/chain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/iso_time.h"
#include "core/describe/field_json.h"
#include "core/solve/solve.h"
#include "exchange/presets/export_facts.h"
#include "library/catalogue/session_verdict.h"
#include "material/run/session_sets.h"
#include "solve/report/solve_report.h"
#include "solve/session/solved.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChainSchema = "weft.chain";

Freshness freshness_of(bool is_draft, const std::vector<std::string>& why) {
  if (is_draft) return Freshness::kDraft;
  return why.empty() ? Freshness::kFresh : Freshness::kStale;
}

// When it was written; empty where its owner removed it meanwhile.
std::string time_of(const fs::path& document) {
  std::error_code gone;
  const auto written = fs::last_write_time(document, gone);
  if (gone) return "";
  return iso_time(
      std::chrono::duration<double>(std::chrono::file_clock::to_sys(written).time_since_epoch()).count());
}

ChainLink photographs_of(const Session& session) {
  ChainLink link = {.name = "photographs", .freshness = Freshness::kFresh, .folder = session.folder.string()};
  if (session.shots.empty()) {
    link.freshness = Freshness::kMissing;
    link.why.emplace_back("nothing was photographed");
  } else if (session.state != "complete") {
    link.freshness = Freshness::kDraft;
    link.why.emplace_back("the scan did not end");
  }
  if (!session.shots.empty()) link.written = session.shots.front().time;
  return link;
}

// The solves of a session with what their documents say.
class SolvesOnDisk {
 public:
  explicit SolvesOnDisk(const Session& session) : session_(session), solves_(solve::solves_of(session)) {}

  const solve::SessionSolves& all() const { return solves_; }

  // The error of the solve that something is made of, and its level.
  void tell_source(const std::string& id, ChainLink& link) {
    const solve::ChoosableSolve* const found = solves_.find(id);
    if (found == nullptr) return;
    link.level = found->level;
    const std::optional<SolveFacts>& facts = facts_of(*found);
    if (!facts || !facts->taken) return;
    link.mean_deg = facts->taken->mean_deg;
    link.solved = facts->taken->solved;
  }

  // Why maps have another size than those that would be made today.
  std::string why_other_size(const solve::SourceFacts& source) const {
    return solve::why_other_size(session_, source);
  }

  // Why the solve is not what would be made of the session today.
  std::vector<std::string> why_stale(const std::string& id) {
    const bool is_chosen = solves_.is_chosen && solves_.current_one()->id == id;
    std::vector<std::string> why;
    if (!is_chosen) why = solve::why_stale(solves_, id);
    const solve::ChoosableSolve* const found = solves_.find(id);
    if (found == nullptr) return why;
    if (!found->is_whole) why.emplace_back("not all of its maps were kept");
    if (is_chosen) return why;
    const std::optional<SolveFacts>& facts = facts_of(*found);
    if (!facts) return why;
    if (facts->solver_version < kSolverVersion)
      why.push_back(fmt::format("version {} of the solver made it, and this is {}", facts->solver_version,
                                kSolverVersion));
    // A solve by a calibration that was named for it is left alone; one before the session's own changed is
    // not.
    const std::string used = facts->input ? facts->input->calibration.value_or("") : "";
    const std::string calibrated = time_of(session_.calibration_folder() / "calibration.json");
    if (!used.empty() && used != session_.calibration_id && found->written < calibrated)
      why.push_back(fmt::format("the session's calibration is {} since, and it was made with {}",
                                session_.calibration_id.substr(0, 12), used.substr(0, 12)));
    return why;
  }

 private:
  const std::optional<SolveFacts>& facts_of(const solve::ChoosableSolve& solve) {
    const auto [known, is_new] = facts_.try_emplace(solve.id);
    if (is_new) {
      const Result<Json> document = read_json(solve.folder / kSolveProduct.document, kSolveProduct.schema, 1);
      Result<SolveFacts> facts = document ? solve_facts_from_json(*document) : document.error();
      if (facts) known->second = std::move(*facts);
    }
    return known->second;
  }

  const Session& session_;
  solve::SessionSolves solves_;
  std::map<std::string, std::optional<SolveFacts>> facts_;
};

ChainLink solve_link(SolvesOnDisk& solves) {
  ChainLink link = {.name = "solve"};
  const solve::ChoosableSolve* const current = solves.all().current_one();
  if (current == nullptr) {
    link.why.emplace_back("nothing was solved");
    return link;
  }
  link.id = current->id;
  link.folder = current->folder.string();
  link.written = current->written;
  solves.tell_source(current->id, link);
  link.why = solves.why_stale(current->id);
  link.freshness = freshness_of(current->is_preview(), link.why);
  if (current->is_preview()) link.why.insert(link.why.begin(), "a preview has half the size and no masks");
  return link;
}

ChainLink maps_link(SolvesOnDisk& solves) {
  ChainLink link = {.name = "maps"};
  const std::vector<material::SessionSet> sets = material::sets_of(solves.all());
  const material::SessionSet* const set = material::set_to_use(solves.all(), sets, {});
  if (set == nullptr) {
    link.why.emplace_back("none were made");
    return link;
  }
  link.id = set->product.id;
  link.folder = set->product.folder.string();
  link.written = time_of(set->product.folder / material::kMapsProduct.document);
  link.level = set->level;
  solves.tell_source(set->facts.source.solve, link);
  link.why = solves.why_stale(set->facts.source.solve);
  if (std::string why = solves.why_other_size(set->facts.source); !why.empty())
    link.why.push_back(std::move(why));
  link.freshness = freshness_of(set->is_draft, link.why);
  if (set->is_draft) link.why.insert(link.why.begin(), "they are of a preview");
  return link;
}

std::string text_in(const Json& document, const char* key) {
  const Json value = document.value(key, Json());
  return value.is_string() ? value.get<std::string>() : std::string();
}

ChainLink export_link(const fs::path& folder, const exchange::ExportFacts& facts, const ChainLink& maps,
                      SolvesOnDisk& solves) {
  ChainLink link = {.name = "export", .id = facts.preset, .folder = folder.string()};
  link.written = time_of(folder / exchange::kExportProduct.document);
  const std::string set = text_in(facts.from, "maps"), solve = text_in(facts.from, "solve");
  link.level = text_in(facts.from, "level");
  solves.tell_source(solve, link);
  if (!solve.empty()) link.why = solves.why_stale(solve);
  if (!set.empty() && maps.id.empty()) link.why.push_back(fmt::format("its maps {} are gone", set));
  if (!set.empty() && !maps.id.empty() && set != maps.id)
    link.why.push_back(fmt::format("it is of the maps {}, and {} would be taken now", set, maps.id));
  const bool is_draft = facts.from.value("draft", Json()) == Json(true);
  link.freshness = freshness_of(is_draft, link.why);
  if (is_draft) link.why.insert(link.why.begin(), "it is of a preview");
  return link;
}

std::string what_it_is(const ChainLink& link) {
  std::vector<std::string> words;
  if (link.name == "photographs" && link.freshness == Freshness::kFresh) words.emplace_back("complete");
  if (link.name == "export" && !link.id.empty()) words.push_back(link.id);
  if (!link.level.empty()) words.push_back((link.name == "solve" ? "" : "of ") + link.level);
  if (link.mean_deg && link.solved) words.push_back(error_in_words(*link.mean_deg, *link.solved));
  return fmt::format("{}", fmt::join(words, ", "));
}

bool is_all_fresh(const std::vector<ChainLink>& links) {
  return std::ranges::all_of(links, [](const ChainLink& link) {
    const bool is_not_wanted = link.name == "export" && link.freshness == Freshness::kMissing;
    return link.freshness == Freshness::kFresh || is_not_wanted;
  });
}

// Folders that hold an export: export/PRESET, and export/PRESET/MAPS as batches write them.
std::vector<fs::path> export_folders(const Session& session) {
  std::vector<fs::path> found;
  const auto look_in = [&](const fs::path& parent, const auto& otherwise) {
    std::error_code failed;
    for (fs::directory_iterator entry(parent, failed), end; !failed && entry != end;
         entry.increment(failed)) {
      std::error_code ignored;
      if (entry->is_symlink(ignored) || !entry->is_directory(ignored)) continue;
      if (is_there(entry->path() / exchange::kExportProduct.document)) {
        found.push_back(entry->path());
      } else {
        otherwise(entry->path());
      }
    }
  };
  const auto nothing = [](const fs::path&) {};
  look_in(session.folder / "export", [&](const fs::path& folder) { look_in(folder, nothing); });
  std::ranges::sort(found);
  return found;
}

}  // namespace

void describe(Fields& fields, ChainLink& link) {
  fields.value({"name", "photographs, solve, maps or export", {}, kMustSay}, link.name);
  fields.choice({"freshness", "draft: of a preview; stale: another would be made today", {}, kMustSay},
                link.freshness, kFreshnessNames);
  fields.value({"says", "What it is, in a line", {}, kMustSay}, link.says);
  fields.value({.name = "id", .says = "Of a solve or maps; of an export its preset", .need = kUnlessEmpty},
               link.id);
  fields.value({.name = "folder", .says = "Where it lies", .need = kUnlessEmpty}, link.folder);
  fields.value({.name = "written", .says = "ISO 8601", .need = kUnlessEmpty}, link.written);
  fields.value({.name = "level", .says = "Of the solve that it is, or is made of", .need = kUnlessEmpty},
               link.level);
  fields.value({.name = "mean_deg",
                .says = "Mean error of the normals to expect, degrees, where there are some",
                .need = kUnlessEmpty},
               link.mean_deg);
  fields.value({.name = "solved", .says = "Share of the cloth that has a normal", .need = kUnlessEmpty},
               link.solved);
  fields.value({.name = "why", .says = "It is not fresh, a sentence each", .need = kUnlessEmpty}, link.why);
}

void describe(Fields& fields, Chain& chain) {
  fields.value({"session", "Its folder", {}, kMustSay}, chain.session);
  fields.value({"fabric", "Of the cloth", {}, kMustSay}, chain.fabric);
  fields.object({"verdict", "What the scan is worth, and the one thing to do", {}, kMustSay}, chain.verdict);
  fields.value({"fresh", "Nothing is missing, a draft or stale, but exports that nobody made", {}, kMustSay},
               chain.is_fresh);
  fields.list({"links", "From photographs to exports, in this order", {}, kMustSay}, chain.links);
}

Json json_of(const Chain& chain) {
  Json json = {{"schema", fmt::format("{}/1", kChainSchema)}};
  write_fields(json, chain);
  return json;
}

const ChainLink& Chain::link(const std::string& name) const {
  return *std::ranges::find(links, name, &ChainLink::name);
}

Chain chain_of(const Session& session) {
  SolvesOnDisk solves(session);
  Chain chain = {.session = session.folder.string(), .fabric = session.fabric, .links = {}};
  chain.links = {photographs_of(session), solve_link(solves), maps_link(solves)};
  const ChainLink maps = chain.links.back();
  std::map<std::string, ChainLink> exports;  // the newest of each preset
  for (const fs::path& folder : export_folders(session)) {
    const Result<exchange::ExportFacts> facts = exchange::read_export(folder);
    if (!facts) continue;
    ChainLink link = export_link(folder, *facts, maps, solves);
    ChainLink& newest = exports[link.id];
    if (newest.written <= link.written) newest = std::move(link);
  }
  for (auto& [preset, link] : exports) chain.links.push_back(std::move(link));
  if (exports.empty()) chain.links.push_back({.name = "export", .why = {"nothing was exported"}});
  for (ChainLink& link : chain.links) link.says = what_it_is(link);
  chain.is_fresh = is_all_fresh(chain.links);
  chain.verdict = verdict_of(session);
  return chain;
}

std::string words_of(const ChainLink& link) {
  if (link.freshness == Freshness::kFresh) return link.says;
  return fmt::format("{}{}{}: {}", link.says, link.says.empty() ? "" : "; ",
                     kFreshnessNames[static_cast<std::size_t>(link.freshness)], fmt::join(link.why, "; "));
}

}  // namespace weft::library
