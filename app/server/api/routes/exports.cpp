// SPDX-License-Identifier: Apache-2.0
// What leaves: presets, and the files that were made by them.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/library_materials.h"
#include "app/server/api/routes/viewed.h"
#include "core/base/files.h"
#include "exchange/export/export.h"
#include "exchange/export/preset_files.h"
#include "library/catalogue/session_files.h"
#include "library/catalogue/session_name.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// Files of a preset are called by ":" for "/", which no name of an export has.
constexpr char kFolderMark = ':';
constexpr const char* kExports = "export";

Json names_of_files(const exchange::Preset& preset) {
  Json names = Json::array();
  if (!preset.keeps_no_files())
    for (const exchange::PresetFile& file : preset.files) names.push_back(file.name);
  for (const exchange::PresetDocument& document : preset.documents) names.push_back(document.name);
  return names;
}

// One that cannot be read stands there with what is wrong with it.
Result<Reply> presets(const Call&) {
  Json list = Json::array();
  for (const exchange::KnownPreset& known : exchange::known_presets()) {
    const Result<exchange::Preset> preset = exchange::read_preset(known.name);
    list.push_back({{"name", known.name},
                    {"says", preset ? preset->says : ""},
                    {"is_own", !known.file.empty()},
                    {"files", preset ? names_of_files(*preset) : Json::array()},
                    {"fault", preset ? "" : preset.error().message()}});
  }
  return json_reply({{"presets", std::move(list)}});
}

Error no_such_export(const std::string& name) {
  return {ErrorKind::kNoInput, "nothing of this name was exported", name.substr(0, 40), "",
          "see the list of exports"};
}

Result<exchange::ExportFacts> one_export(const fs::path& folder, const std::string& preset) {
  if (!library::is_session_name(preset) || !is_there(folder / preset / exchange::kExportProduct.document))
    return no_such_export(preset);
  return exchange::read_export(folder / preset);
}

Result<Reply> list_of(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  Json list = Json::array();
  for (const std::string& name : names) {
    Result<exchange::ExportFacts> facts = one_export(folder, name);
    if (!facts) continue;
    list.push_back({{"preset", name},
                    {"folder", (folder / name).string()},
                    {"created", written_at(folder / name / exchange::kExportProduct.document)},
                    {"bytes", library::bytes_below(folder / name)},
                    {"document", std::move(facts->document)}});
  }
  return json_reply({{"exports", std::move(list)}});
}

// A header takes no more than this of a name.
std::string name_in_header(const std::string& file) {
  std::string name = fs::path(file).filename().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '_');
  return name;
}

// The digest of a file that is listed: a texture, or a document of textures.
Result<std::string> digest_of(const exchange::ExportFacts& facts, const std::string& name) {
  for (const exchange::ExportedTexture& each : facts.files) {
    if (each.file == name) return each.sha256;
  }
  for (const exchange::ExportedDocument& each : facts.documents) {
    if (each.name == name) return each.sha256;
  }
  return no_such_export(name);
}

Result<Reply> file_of(const fs::path& folder, const std::string& preset, const std::string& asked) {
  const Result<exchange::ExportFacts> facts = one_export(folder, preset);
  if (!facts) return facts.error();
  std::string name = asked;
  std::ranges::replace(name, kFolderMark, '/');
  Result<std::string> digest = digest_of(*facts, name);
  if (!digest) return std::move(digest).error();
  const fs::path file = folder / preset / name;
  if (!library::lies_in(file, folder / preset)) return no_such_export(asked);
  Result<std::shared_ptr<const FileBody>> body = open_file_body(file);
  if (!body) return std::move(body).error();
  Reply reply = {200, "application/octet-stream"};
  reply.tag = std::move(*digest);
  reply.keeping = Keeping::kAskAgain;
  reply.headers.emplace_back("Content-Disposition",
                             fmt::format("attachment; filename=\"{}\"", name_in_header(name)));
  reply.file = std::move(*body);
  return reply;
}

using FindFolder = Result<fs::path> (*)(const RigParts& parts, const Call& call);

Result<fs::path> exports_of_session(const RigParts& parts, const Call& call) {
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  return session->folder / kExports;
}

Result<fs::path> exports_of_build(const RigParts&, const Call& call) {
  const Result<Product> build = find_build(call.segments.at(0), call.segments.at(1));
  if (!build) return build.error();
  return build->folder / kExports;
}

// The last segments of the call are preset and file.
void add_routes(std::vector<Route>& routes, const RigParts& parts, const std::string& of, FindFolder find) {
  routes.push_back({"GET", of, [&parts, find](const Call& call) -> Result<Reply> {
                      const Result<fs::path> folder = find(parts, call);
                      if (!folder) return folder.error();
                      return list_of(*folder);
                    }});
  routes.push_back({"GET", of + "/{preset}/files/{file}",
                    [&parts, find](const Call& call) -> Result<Reply> {
                      const Result<fs::path> folder = find(parts, call);
                      if (!folder) return folder.error();
                      const std::size_t count = call.segments.size();
                      return file_of(*folder, call.segments.at(count - 2), call.segments.at(count - 1));
                    },
                    false, Pool::kFiles});
}

}  // namespace

Resource exports_resource(const RigParts& parts) {
  Resource resource = {{{"GET", "/api/v1/presets", presets}}};
  add_routes(resource.routes, parts, "/api/v1/sessions/{name}/exports", exports_of_session);
  add_routes(resource.routes, parts, "/api/v1/materials/{name}/builds/{id}/exports", exports_of_build);
  return resource;
}

}  // namespace weft::app
