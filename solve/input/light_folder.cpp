// SPDX-License-Identifier: Apache-2.0
// Which file of a folder holds the lights of its photographs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/text.h"
#include "solve/input/light_json.h"
#include "solve/input/light_list.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostJson = std::size_t{4} << 20;
constexpr double kSameDirection_deg = 0.01;

bool holds_lights(const fs::path& file) {
  const std::string name = small_letters(file.filename().string()), ending = fs::path(name).extension(),
                    stem = fs::path(name).stem();
  const auto is_one_of = [&](auto... endings) { return ((ending == endings) || ...); };
  if (is_one_of(".lp", ".dome", ".relight")) return true;
  if (ending == ".json") {
    const Result<std::string> text = read_text(file, kMostJson);
    return text && is_light_json(*text);
  }
  const bool is_named_so = stem.find("light") != stem.npos || stem == "directions";
  return is_named_so && stem.find("intensit") == stem.npos &&
         is_one_of(".txt", ".csv", ".tsv", ".npy", ".dat");
}

// Whether two files say the same of the same number of lights.
bool agree(const LightList& a, const LightList& b) {
  return std::ranges::equal(a.lights, b.lights, [](const ListedLight& left, const ListedLight& right) {
    return angle_deg(left.direction(), right.direction()) < kSameDirection_deg;
  });
}

// The one that has the others' lights, and names if one has them; those that cannot be read are none.
Result<fs::path> choose_light_file(const fs::path& folder, const std::vector<fs::path>& files) {
  std::vector<LightList> lists;
  for (const fs::path& file : files)
    if (Result<LightList> list = read_light_list(file)) lists.push_back(std::move(*list));
  if (lists.empty()) return files.front();
  const auto chosen =
      std::ranges::find_if(lists, [](const LightList& list) { return !list.lights.front().name.empty(); });
  const LightList& best = chosen == lists.end() ? lists.front() : *chosen;
  if (std::ranges::all_of(lists, [&](const LightList& list) { return agree(list, best); })) return best.file;
  std::vector<std::string> names;
  for (const LightList& list : lists) names.push_back(list.file.filename().string());
  return Error{ErrorKind::kBadData, "there are several light files", folder.string(),
               fmt::format("{} say different things", fmt::join(names, ", ")),
               "name the one that is meant with --lp"};
}

}  // namespace

std::vector<fs::path> light_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    std::error_code ignored;
    const bool is_hidden = entry->path().filename().string().starts_with('.');
    if (!is_hidden && entry->is_regular_file(ignored) && holds_lights(entry->path()))
      files.push_back(entry->path());
  }
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return stands_before(a.filename().string(), b.filename().string());
  });
  return files;
}

Result<fs::path> find_light_file(const fs::path& folder) {
  std::error_code failed;
  fs::directory_iterator(folder, failed);
  if (failed) return cannot_read(folder, failed.value());
  const fs::path above = absolute_folder(folder).parent_path();
  for (const fs::path& place : {folder, folder / "assembly-files", above / "assembly-files", above}) {
    const std::vector<fs::path> files = light_files_in(place);
    if (files.size() == 1) return files.front();
    if (!files.empty()) return choose_light_file(place, files);
  }
  return Error{
      ErrorKind::kNoInput, "there is no light file", folder.string(),
      "neither light_directions.txt nor an .lp, .dome, .relight, .json or lights.csv is there or above",
      "write one (docs/formats.md), or name it with --lp"};
}

}  // namespace weft::solve
