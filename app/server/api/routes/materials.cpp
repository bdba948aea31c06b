// SPDX-License-Identifier: Apache-2.0
// Materials in layers: those of the library, what their files say, and what was built of them.
#include <algorithm>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/library_materials.h"
#include "app/server/api/bodies/material_body.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/api/routes/viewed.h"
#include "core/base/files.h"
#include "library/catalogue/session_files.h"
#include "material/assets/resolve.h"

namespace weft::app {
namespace {

Result<Reply> materials(const Call&) {
  Json list = Json::array();
  for (const material::MaterialPlace& place : material::list_materials())
    list.push_back({{"key", key_of(place)}, {"name", place.name}, {"is_own", !place.is_shipped()}});
  return json_reply({{"materials", std::move(list)}});
}

// Writes a material that differs from another by its layers into the user's library.
Result<Reply> new_material(const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  const Result<NewMaterialBody> material = read_material_body(*body, material::user_materials_folder());
  if (!material) return material.error();
  if (Result<void> ok = make_writable_folder(material->file.parent_path()); !ok) return std::move(ok).error();
  if (Result<void> ok = write_file(material->file, material->text); !ok) return std::move(ok).error();
  return json_reply({{"key", material->key}, {"file", material->file.string()}, {"text", material->text}});
}

// With the names of its layers in their order, which values by key do not tell.
Result<Reply> one_material(const Call& call) {
  const Result<material::MaterialPlace> place = library_material(call.segments.at(0));
  if (!place) return place.error();
  const Result<material::ResolvedMaterial> resolved =
      material::resolve_material(*place, material::materials_on_disk());
  if (!resolved) return resolved.error();
  Json document = json_of(*resolved), layers = Json::array();
  for (const material::MaterialLayer& layer : resolved->layers) layers.push_back(layer.name);
  document["layers"] = std::move(layers);
  return json_reply(document);
}

Result<Reply> builds(const Call& call) {
  const Result<std::vector<Product>> found = list_builds(call.segments.at(0));
  if (!found) return found.error();
  Json list = Json::array();
  for (const Product& build : *found) {
    list.push_back({{"id", build.id},
                    {"created", written_at(build.folder / build.kind.document)},
                    {"bytes", library::bytes_below(build.folder)}});
  }
  std::ranges::reverse(list);
  return json_reply({{"builds", std::move(list)}});
}

Result<Reply> one_build(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = find_built_maps(parts, call.segments.at(0), call.segments.at(1));
  if (!viewed) return viewed.error();
  const Result<Json> document = viewed_json(parts, *viewed);
  if (!document) return document.error();
  return json_reply(*document);
}

}  // namespace

Resource materials_resource(const RigParts& parts) {
  const std::string of = "/api/v1/materials";
  const std::string one = of + "/{name}/builds/{id}";
  Resource resource = {{{"GET", of, materials},
                        {"POST", of, new_material},
                        {"GET", of + "/{name}", one_material},
                        {"GET", of + "/{name}/builds", builds},
                        {"GET", one, [&parts](const Call& call) { return one_build(parts, call); }}}};
  for (Route& route : view_routes(parts, one, find_built_maps)) resource.routes.push_back(std::move(route));
  return resource;
}

}  // namespace weft::app
