// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/routes/viewed.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/solve/solve.h"
#include "library/catalogue/session_files.h"
#include "library/chain/chain.h"
#include "material/read/compare.h"
#include "solve/session/current.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Json summary_of(const SolveFacts& solve, const fs::path& folder, const solve::SessionSolves& of) {
  Json warnings = Json::array();
  for (const Verdict& verdict : solve.warnings) warnings.push_back(verdict.name);
  const solve::ChoosableSolve* const current = of.current_one();
  const solve::ChoosableSolve* const found = of.find(solve.id);
  return {{"id", solve.id},
          {"is_current", current != nullptr && current->id == solve.id},
          {"outdated", found != nullptr ? found->outdated : ""},
          {"created", written_at(folder / kSolveProduct.document)},
          {"bytes", library::bytes_below(folder)},
          {"method", solve.method},
          {"width", solve.size.width},
          {"height", solve.size.height},
          {"albedo_scale", solve.albedo_scale == AlbedoScale::kAbsolute ? "absolute" : "relative"},
          {"warnings", std::move(warnings)}};
}

Result<Reply> solves(const RigParts& parts, const Call& call) {
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  const solve::SessionSolves of = solve::solves_of(*session);
  Json list = Json::array();
  for (const Product& product : list_solves(session->folder)) {
    const Result<std::optional<Json>> document = find_finished(product);
    if (!document || !*document) continue;
    const Result<SolveFacts> facts = solve_facts_from_json(**document);
    if (facts) list.push_back(summary_of(*facts, product.folder, of));
  }
  std::ranges::reverse(list);
  return json_reply(
      {{"solves", std::move(list)}, {"truth", is_there(session->folder / kTruth / "normal.exr")}});
}

Result<Reply> chain(const RigParts& parts, const Call& call) {
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  return json_reply(json_of(library::chain_of(*session)));
}

Result<Reply> one_solve(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = find_solve_maps(parts, call.segments.at(0), call.segments.at(1));
  if (!viewed) return viewed.error();
  const Result<Json> document = viewed_json(parts, *viewed);
  if (!document) return document.error();
  return json_reply(*document);
}

/// What the solver said of the scan and of itself: report.json, and what `reference` did.
Result<Reply> report_of_solve(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = find_solve_maps(parts, call.segments.at(0), call.segments.at(1));
  if (!viewed) return viewed.error();
  if (!viewed->solve) return Error{ErrorKind::kNoInput, "a truth has no report", kTruth, "", "name a solve"};
  Result<Json> report = read_json(viewed->folder / "report.json", "weft.solve-report", 1);
  if (!report) return std::move(report).error();
  (*report)["reference"] = viewed->solve->reference ? object_of(*viewed->solve->reference) : Json();
  (*report)["solved_by"] = viewed->solve->solved_by ? object_of(*viewed->solve->solved_by) : Json();
  return json_reply(*report);
}

/// a and b are NAME/ID.
Result<Reply> compare(const RigParts& parts, const Call& call) {
  std::array<Viewed, 2> both;
  const std::array<const char*, 2> keys = {"a", "b"};
  for (std::size_t i = 0; i < both.size(); ++i) {
    const auto text = call.query.find(keys[i]);
    const std::size_t slash = text == call.query.end() ? std::string::npos : text->second.find('/');
    if (slash == std::string::npos)
      return Error{ErrorKind::kUsage, "what is asked of the maps cannot be read", keys[i],
                   "must be SESSION/SOLVE", "see openapi.json"};
    Result<Viewed> viewed =
        find_solve_maps(parts, text->second.substr(0, slash), text->second.substr(slash + 1));
    if (!viewed) return std::move(viewed).error();
    both[i] = std::move(*viewed);
  }
  const auto file = [&](std::size_t i, const char* name) { return both[i].folder / name; };
  const Result<solve::NormalComparison> normal =
      material::compare_normals(file(0, "normal.exr"), file(1, "normal.exr"), {});
  if (!normal) return normal.error();
  const Result<material::AlbedoComparison> albedo =
      material::compare_albedo(file(0, "albedo.exr"), file(1, "albedo.exr"), {});
  if (!albedo) return albedo.error();
  return json_reply(
      {{"normal",
        {{"pixels", normal->pixels},
         {"mean_deg", normal->mean_deg},
         {"median_deg", normal->median_deg},
         {"p95_deg", normal->p95_deg},
         {"max_deg", normal->max_deg}}},
       {"albedo",
        {{"pixels", albedo->pixels}, {"mean_rel", albedo->mean_rel}, {"bias_rel", albedo->bias_rel}}}});
}

}  // namespace

Resource solves_resource(const RigParts& parts) {
  const std::string of = "/api/v1/sessions/{name}/solves";
  const std::string one = of + "/{solve}";
  Resource resource = {
      {{"GET", of, [&parts](const Call& call) { return solves(parts, call); }},
       {"GET", "/api/v1/sessions/{name}/chain", [&parts](const Call& call) { return chain(parts, call); }},
       {"GET", one, [&parts](const Call& call) { return one_solve(parts, call); }},
       {"GET", one + "/report", [&parts](const Call& call) { return report_of_solve(parts, call); }},
       {"GET", "/api/v1/compare", [&parts](const Call& call) { return compare(parts, call); }, false,
        Pool::kTiles}}};
  for (Route& route : view_routes(parts, one, find_solve_maps)) resource.routes.push_back(std::move(route));
  return resource;
}

}  // namespace weft::app
