// SPDX-License-Identifier: Apache-2.0
#include "library/import/photographs_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/text.h"
#include "core/describe/field_json.h"
#include "core/image_io/image_io.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = "weft.photographs";

ProposedPhotographs planned_by(const solve::PhotoOptions& options, const std::string& name,
                               const fs::path& archive) {
  ProposedPhotographs planned;
  planned.source = options.light_file.empty() ? options.folder : options.light_file;
  planned.folder = archive / (file_name_of(name, "photographs") + ".photos");
  Result<solve::SolvePlan> photos = solve::plan_photos(options);
  if (!photos) {
    planned.state = ImportState::kRefused;
    planned.refusal = std::move(photos).error();
    return planned;
  }
  for (const fs::path& file : photos->files()) {
    if (Result<LoadedImage> decoded = read_image(file); !decoded) {
      planned.state = ImportState::kRefused;
      planned.refusal = std::move(decoded).error();
      return planned;
    }
  }
  planned.photos = std::move(*photos);
  return planned;
}

void look_for_folder(ProposedPhotographs& planned) {
  if (planned.refusal || !is_there(planned.folder)) return;
  const Result<Json> stored = read_json(planned.folder / "photographs.json", kSchema, 1);
  if (stored && *stored == json_of(texts_of(planned).facts)) {
    planned.state = ImportState::kThere;
    return;
  }
  planned.state = ImportState::kRefused;
  planned.refusal =
      Error{ErrorKind::kCannotCreate, "another folder of that name is there", planned.folder.string(),
            "folders of photographs are never overwritten", "import into another archive with -o"};
}

}  // namespace

std::vector<ProposedPhotographs> plan_photographs(const SourceFolders& found, const fs::path& archive) {
  std::vector<ProposedPhotographs> all;
  for (const fs::path& file : found.light_files) {
    // RTIBuilder keeps its light files in a folder of that name.
    const bool is_rtibuilder = file.parent_path().filename() == "assembly-files";
    const fs::path folder = is_rtibuilder ? file.parent_path().parent_path() : file.parent_path();
    const bool is_alone =
        std::ranges::count(found.light_files, file.parent_path(), &fs::path::parent_path) == 1;
    std::string name = folder.filename().string();
    if (!is_alone) name += "_" + file.stem().string();
    solve::PhotoOptions options;
    options.light_file = file;
    all.push_back(planned_by(options, name, archive));
  }
  for (const fs::path& folder : found.photo_folders) {
    solve::PhotoOptions options;
    options.folder = folder;
    all.push_back(planned_by(options, folder.filename().string(), archive));
  }
  std::set<fs::path> taken;
  for (ProposedPhotographs& planned : all) {
    const std::string stem = planned.folder.stem().string();
    for (int i = 2; !taken.insert(planned.folder).second; ++i)
      planned.folder = archive / fmt::format("{}_{}.photos", stem, i);
    look_for_folder(planned);
  }
  return all;
}

void drop_used(const std::vector<ProposedPhotographs>& planned, SourceFolders& found) {
  std::set<fs::path> used;
  for (const ProposedPhotographs& each : planned) {
    for (const fs::path& file : each.photos.files()) used.insert(file.lexically_normal());
    used.insert(each.photos.mask.lexically_normal());
  }
  std::erase_if(found.frames, [&](const SourceFile& frame) { return used.contains(frame.file); });
  std::erase_if(found.left_over, [&](const LeftOver& left) { return used.contains(left.file); });
  const auto is_of_refused = [&](const fs::path& file) {
    return std::ranges::any_of(planned, [&](const ProposedPhotographs& each) {
      std::error_code ignored;
      const bool is_folder = fs::is_directory(each.source, ignored);
      const std::string folder = (is_folder ? each.source : each.source.parent_path()).string() + "/";
      return each.refusal && file.string().starts_with(folder);
    });
  };
  for (const fs::path& file : found.beside_lights)
    if (!used.contains(file) && !is_of_refused(file))
      found.left_over.push_back({file, "no light file names it"});
}

std::vector<std::string> stored_names(const solve::SolvePlan& photos) {
  static const std::set<std::string> kOwn = {"filenames.txt", "light_directions.txt", "light_intensities.txt",
                                             "mask.png", "photographs.json"};
  std::vector<std::string> names;
  std::set<std::string> taken = kOwn;
  bool is_each_another = true;
  for (const fs::path& file : photos.files()) {
    names.push_back(file.filename().string());
    is_each_another = taken.insert(names.back()).second && is_each_another;
  }
  for (std::size_t i = 0; !is_each_another && i < names.size(); ++i)
    names[i] = fmt::format("{:03}_{}", i + 1, names[i]);
  return names;
}

void describe(Fields& fields, ImportedPhotographs& f) {
  fields.value({"from", "The folder or light file that they were imported of", {}, kMustSay}, f.from);
  fields.list({"photographs", "In the order of their lights", {}, kMustSay}, f.photographs);
  fields.value({.name = "transfer",
                .says = "How their values follow light; auto where they differ",
                .need = kMustSay,
                .words = {"auto", "linear", "srgb"}},
               f.transfer);
  fields.value({"mask", "SHA-256 of their mask, where there is one", {}, kUnlessEmpty}, f.mask);
}

Json json_of(const ImportedPhotographs& facts) {
  Json json = {{"schema", fmt::format("{}/1", kSchema)}};
  write_fields(json, facts);
  return json;
}

PhotographTexts texts_of(const ProposedPhotographs& planned) {
  const solve::SolvePlan& photos = planned.photos;
  const std::vector<std::string> names = stored_names(photos);
  PhotographTexts texts;
  texts.facts = {planned.source.string(), photos.input.photographs, photos.input.transfer, photos.input.mask};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Vec3& direction = photos.input.photographs[i].direction;
    const std::array<double, 3>& irradiance = photos.input.photographs[i].irradiance_rgb;
    texts.names += names[i] + "\n";
    texts.directions += fmt::format("{} {} {}\n", direction.x, direction.y, direction.z);
    texts.intensities += fmt::format("{} {} {}\n", irradiance[0], irradiance[1], irradiance[2]);
    texts.facts.photographs[i].file = names[i];
  }
  return texts;
}

}  // namespace weft::library
