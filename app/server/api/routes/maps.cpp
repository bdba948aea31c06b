// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include "app/server/api/api.h"
#include "app/server/api/routes/viewed.h"
#include "library/catalogue/session_files.h"
#include "library/catalogue/session_name.h"
#include "material/run/maps.h"
#include "material/run/recipe.h"
#include "material/run/session_sets.h"

namespace weft::app {
namespace {

template <typename Named>
Json names_of(const std::vector<Named>& all) {
  Json names = Json::array();
  for (const Named& each : all) names.push_back(each.name);
  return names;
}

// What a list says of a set of maps.
Json set_summary(const material::SessionSet& set) {
  const Product& product = set.product;
  const material::MapSetFacts& facts = set.facts;
  return {{"id", product.id},
          {"created", written_at(product.folder / material::kMapsProduct.document)},
          {"bytes", library::bytes_below(product.folder)},
          {"solve", facts.source.solve},
          {"level", set.level},
          {"draft", set.is_draft},
          {"stale", set.stale},
          {"preview", facts.is_preview},
          {"is_tile", facts.is_tile},
          {"width", facts.size.width},
          {"height", facts.size.height},
          {"mm_per_pixel", facts.mm_per_pixel},
          {"maps", names_of(facts.maps)},
          {"warnings", names_of(facts.verdicts)}};
}

Result<Reply> sets(const RigParts& parts, const Call& call) {
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  const solve::SessionSolves solves = solve::solves_of(*session);
  const std::vector<material::SessionSet> all = material::sets_of(solves, true),
                                          finals = material::sets_of(solves);
  const material::SessionSet* const current = material::set_to_use(solves, finals, {});
  Json list = Json::array();
  for (const material::SessionSet& set : all) list.push_back(set_summary(set));
  std::ranges::reverse(list);
  return json_reply(
      {{"sets", std::move(list)}, {"current", current != nullptr ? Json(current->product.id) : Json()}});
}

Result<Reply> one_set(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = find_map_set(parts, call.segments.at(0), call.segments.at(1));
  if (!viewed) return viewed.error();
  const Result<Json> document = viewed_json(parts, *viewed);
  if (!document) return document.error();
  return json_reply(*document);
}

// One of the pictures that a set lies beside.
Result<Reply> picture_of_set(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = find_map_set(parts, call.segments.at(0), call.segments.at(1));
  if (!viewed) return viewed.error();
  const std::string& name = call.segments.at(2);
  const bool is_picture = library::is_session_name(name) && name.ends_with(".png");
  Result<std::shared_ptr<const FileBody>> file =
      is_picture
          ? open_file_body(viewed->folder / name)
          : Error{ErrorKind::kNoInput, "the set of maps has no such picture", name.substr(0, 40), "", ""};
  if (!file) return std::move(file).error();
  Reply reply = {200, "image/png"};
  reply.file = std::move(*file);
  reply.keeping = Keeping::kForever;
  return reply;
}

const char* word_of(material::StepHolds holds) {
  switch (holds) {
    case material::StepHolds::kNumber:
      return "number";
    case material::StepHolds::kMaybe:
      return "maybe";
    case material::StepHolds::kWhole:
      return "whole";
    case material::StepHolds::kFlag:
      return "flag";
    case material::StepHolds::kWord:
      return "word";
    case material::StepHolds::kNumbers:
      return "numbers";
    case material::StepHolds::kSpots:
      return "spots";
  }
  return "";
}

// All that a recipe may say, and the recipes that weft brings along.
Result<Reply> recipes(const Call&) {
  Json steps = Json::array(), known = Json::array();
  for (const material::RecipeStepKind& kind : material::step_kinds()) {
    Json keys = Json::array();
    for (const material::StepKey& key : kind.keys) {
      keys.push_back({{"name", key.name},
                      {"says", key.says},
                      {"holds", word_of(key.holds)},
                      {"default", key.otherwise},
                      {"least", key.least},
                      {"most", key.most},
                      {"words", key.words}});
    }
    steps.push_back({{"name", kind.name}, {"says", kind.says}, {"keys", std::move(keys)}});
  }
  for (const std::string& name : material::recipe_names()) {
    Json recipe = json_of(material::recipe_named(name));
    recipe["name"] = name;
    known.push_back(std::move(recipe));
  }
  return json_reply({{"steps", std::move(steps)}, {"recipes", std::move(known)}});
}

}  // namespace

Resource maps_resource(const RigParts& parts) {
  const std::string of = "/api/v1/sessions/{name}/maps";
  const std::string one = of + "/{id}";
  Resource resource = {
      {{"GET", of, [&parts](const Call& call) { return sets(parts, call); }},
       {"GET", one, [&parts](const Call& call) { return one_set(parts, call); }},
       {"GET", one + "/pictures/{file}", [&parts](const Call& call) { return picture_of_set(parts, call); },
        false, Pool::kFiles},
       {"GET", "/api/v1/recipes", recipes, false, Pool::kQuick}}};
  for (Route& route : view_routes(parts, one, find_map_set)) resource.routes.push_back(std::move(route));
  return resource;
}

}  // namespace weft::app
