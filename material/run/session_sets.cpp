// SPDX-License-Identifier: Apache-2.0
#include "material/run/session_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/rig/cloth_kinds.h"
#include "solve/session/solved.h"

namespace weft::material {
namespace {

// Whether a map stands on the kind of the cloth, which nobody had said.
bool lacks_kind(const MapSetFacts& facts) {
  const auto roughness = std::ranges::find(facts.maps, "roughness", &MapFacts::name);
  return facts.derive.cloth.empty() && roughness != facts.maps.end() &&
         roughness->source == MapSource::kAssumed;
}

SessionSet set_of(const solve::SessionSolves& solves, const Session& session, Product product,
                  MapSetFacts facts) {
  const std::string kind = cloth_kind_of(session);
  const solve::SourceFacts& source = facts.source;
  const solve::ChoosableSolve* const found = solves.find(source.solve);
  SessionSet set = {std::move(product), {}, {}, false, why_stale(solves, source.solve)};
  set.level = found != nullptr ? found->level : source.level;
  if (!kind.empty() && lacks_kind(facts))
    set.stale.push_back(fmt::format("the cloth is {}, which nobody had said", kind));
  if (std::string why = solve::why_other_size(session, source); !why.empty())
    set.stale.push_back(std::move(why));
  set.is_draft = found != nullptr ? found->is_preview() : source.is_draft;
  set.facts = std::move(facts);
  return set;
}

}  // namespace

std::string cloth_kind_of(const Session& session) {
  const auto metadata = session.document.find("metadata");
  const std::string kind = metadata == session.document.end() ? "" : text_at(*metadata, "kind");
  return std::ranges::find(kClothKinds, kind) == kClothKinds.end() ? "" : kind;
}

std::string text_at(const Json& document, const char* key) {
  const Json value = document.is_object() ? document.value(key, Json()) : Json();
  return value.is_string() ? value.get<std::string>() : std::string();
}

bool flag_at(const Json& document, const char* key) {
  return document.is_object() && document.value(key, Json()) == Json(true);
}

std::vector<SessionSet> sets_of(const solve::SessionSolves& solves, bool of_previews) {
  std::vector<SessionSet> sets;
  const Result<Session> session = solve::read_solved(solves.session);
  for (Product& product : list_products(kMapsProduct, solves.session / "maps")) {
    Result<MapSetFacts> facts = read_map_set(product.folder);
    if (facts && (of_previews || !facts->is_preview))
      sets.push_back(set_of(solves, session ? *session : Session(), std::move(product), std::move(*facts)));
  }
  return sets;
}

std::vector<std::string> lacking(const MapSetFacts& facts, const std::vector<std::string>& wanted) {
  std::vector<std::string> names = wanted;
  std::erase_if(names, [&](const std::string& name) {
    return std::ranges::find(facts.maps, name, &MapFacts::name) != facts.maps.end();
  });
  return names;
}

const SessionSet* set_to_use(const solve::SessionSolves& solves, const std::vector<SessionSet>& sets,
                             const std::vector<std::string>& wanted) {
  const solve::ChoosableSolve* const current = solves.current_one();
  const auto order_of = [&](const SessionSet& set) {
    const bool is_of_current = current != nullptr && set.facts.source.solve == current->id;
    return std::tuple(!set.is_draft, is_of_current, lacking(set.facts, wanted).empty());
  };
  const SessionSet* best = nullptr;
  for (const SessionSet& set : sets) {
    if (best == nullptr || order_of(set) >= order_of(*best)) best = &set;
  }
  return best;
}

std::string how_to_make_better(const solve::SessionSolves& solves) {
  const std::string session = solves.session.string();
  const solve::ChoosableSolve* const best = solves.best ? &solves.all[*solves.best] : nullptr;
  const bool has_better = best != nullptr && !best->is_preview() && best->outdated.empty();
  const std::string solve = has_better ? "" : solve::command_to_solve(solves, "standard") + ", then with ";
  const bool is_chosen = solves.is_chosen && has_better && solves.current_one()->id != best->id;
  return fmt::format("make better ones with {}weft maps {}{}", solve, session,
                     is_chosen ? " --solve " + best->id : "");
}

std::vector<std::string> source_lines(const solve::SourceFacts& source) {
  std::vector<std::string> lines = {
      fmt::format("from the {}{}solve {}", source.level, source.level.empty() ? "" : " ", source.solve)};
  if (source.is_draft) lines.back() += ", a draft of half the size and without masks";
  for (const std::string& why : source.stale) lines.push_back(fmt::format("stale: {}", why));
  if (!source.is_size_known) lines.push_back(solve::size_words(source));
  return lines;
}

solve::SourceFacts source_in(const Json& scan) {
  solve::SourceFacts source = {text_at(scan, "solve"), text_at(scan, "level"), flag_at(scan, "draft"), {}};
  for (const Json& why : scan.is_object() ? scan.value("stale", Json::array()) : Json::array()) {
    if (why.is_string()) source.stale.push_back(why.get<std::string>());
  }
  source.is_size_known = !scan.is_object() || scan.value("size_known", Json()) != Json(false);
  return source;
}

}  // namespace weft::material
