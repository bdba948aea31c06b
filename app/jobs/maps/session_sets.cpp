// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/session_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "app/jobs/maps/maps.h"

namespace weft::app {
namespace {

bool has_maps(const Json& document, const std::vector<std::string>& wanted) {
  const Json maps = document.value("maps", Json::array());
  return std::ranges::all_of(wanted, [&](const std::string& name) {
    return std::ranges::any_of(maps, [&](const Json& map) { return text_at(map, "name") == name; });
  });
}

SessionSet set_of(const library::SessionSolves& solves, Product product, Json document) {
  const std::string solve = text_at(document, "solve");
  const library::ChoosableSolve* const found = solves.find(solve);
  SessionSet set = {std::move(product), std::move(document), {}, false, why_stale(solves, solve)};
  set.level = found != nullptr ? found->level : text_at(set.document, "level");
  set.is_draft = found != nullptr ? found->is_preview() : flag_at(set.document, "draft");
  return set;
}

}  // namespace

std::string text_at(const Json& document, const char* key) {
  const Json value = document.is_object() ? document.value(key, Json()) : Json();
  return value.is_string() ? value.get<std::string>() : std::string();
}

bool flag_at(const Json& document, const char* key) {
  return document.is_object() && document.value(key, Json()) == Json(true);
}

std::vector<SessionSet> sets_of(const library::SessionSolves& solves, bool of_previews) {
  std::vector<SessionSet> sets;
  for (Product& product : list_products(kMapsProduct, solves.session / "maps")) {
    Result<Json> document = read_json(product.folder / kMapsProduct.document, kMapsProduct.schema, 1);
    if (document && (of_previews || !flag_at(*document, "preview")))
      sets.push_back(set_of(solves, std::move(product), std::move(*document)));
  }
  return sets;
}

const SessionSet* set_to_use(const library::SessionSolves& solves, const std::vector<SessionSet>& sets,
                             const std::vector<std::string>& wanted) {
  const library::ChoosableSolve* const current = solves.current_one();
  const auto order_of = [&](const SessionSet& set) {
    const bool is_of_current = current != nullptr && text_at(set.document, "solve") == current->id;
    return std::tuple(!set.is_draft, is_of_current, has_maps(set.document, wanted));
  };
  const SessionSet* best = nullptr;
  for (const SessionSet& set : sets) {
    if (best == nullptr || order_of(set) >= order_of(*best)) best = &set;
  }
  return best;
}

std::string how_to_make_better(const library::SessionSolves& solves) {
  const std::string session = solves.session.string();
  const library::ChoosableSolve* const best = solves.best ? &solves.all[*solves.best] : nullptr;
  const bool has_better = best != nullptr && !best->is_preview() && best->outdated.empty();
  std::string solve = fmt::format("weft solve {} --quality standard, then with ", session);
  if (has_better) solve.clear();
  const bool is_chosen = solves.is_chosen && has_better && solves.current_one()->id != best->id;
  return fmt::format("make better ones with {}weft maps {}{}", solve, session,
                     is_chosen ? " --solve " + best->id : "");
}

std::vector<std::string> source_lines(const Json& document) {
  const std::string level = text_at(document, "level"), solve = text_at(document, "solve");
  std::vector<std::string> lines = {
      fmt::format("from the {}{}solve {}", level, level.empty() ? "" : " ", solve)};
  if (flag_at(document, "draft")) lines.back() += ", a draft of half the size and without masks";
  for (const Json& why : document.value("stale", Json::array())) {
    if (why.is_string()) lines.push_back(fmt::format("stale: {}", why.get<std::string>()));
  }
  return lines;
}

}  // namespace weft::app
