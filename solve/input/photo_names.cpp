// SPDX-License-Identifier: Apache-2.0
// Which photographs the names of a light file mean.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "capture/camera/photograph_facts.h"
#include "core/base/files.h"
#include "core/base/text.h"
#include "core/image_io/linear_image.h"
#include "solve/input/light_list.h"
#include "solve/input/photo_mask.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFolders = 100;
// Where RTIBuilder and others put photographs beside the folder of their light file.
constexpr std::array<const char*, 5> kNeighbours = {"jpeg-exports", "original-captures", "images", "photos",
                                                    "photographs"};

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

/// The names of a folder, read once.
class Folders {
 public:
  const std::vector<fs::path>& files_of(const fs::path& folder) {
    const auto [place, is_new] = files_.try_emplace(folder.string());
    if (!is_new) return place->second;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
      std::error_code ignored;
      if (!entry->is_directory(ignored)) place->second.push_back(entry->path());
    }
    return place->second;
  }

 private:
  std::map<std::string, std::vector<fs::path>> files_;
};

/// How the name of a file that was found differs from what was written.
enum class NameFit { kExact, kOtherCase, kOtherEnding };
struct FoundName {
  fs::path file;
  NameFit fit = NameFit::kExact;
};

// The file of that name in a folder, else the only one in other capitals, else the only picture of its stem.
std::optional<FoundName> look_in(const fs::path& folder, const std::string& name, Folders& folders) {
  if (is_there(folder / name)) return FoundName{folder / name, NameFit::kExact};
  const std::string small = small_letters(name), stem = small_letters(fs::path(name).stem().string());
  std::vector<fs::path> other_case, other_ending;
  for (const fs::path& file : folders.files_of(folder)) {
    if (small_letters(file.filename().string()) == small) other_case.push_back(file);
    if (is_linear_image(file) && small_letters(file.stem().string()) == stem) other_ending.push_back(file);
  }
  if (other_case.size() == 1) return FoundName{other_case.front(), NameFit::kOtherCase};
  if (other_case.empty() && other_ending.size() == 1)
    return FoundName{other_ending.front(), NameFit::kOtherEnding};
  return std::nullopt;
}

// The parts of a path of any machine, without drive, "." and "..".
std::vector<std::string> parts_of(std::string_view written) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= written.size();) {
    const std::size_t end = std::min(written.find_first_of("/\\", begin), written.size());
    const std::string_view part = written.substr(begin, end - begin);
    const bool is_drive = begin == 0 && part.size() == 2 && part[1] == ':';
    if (!part.empty() && part != "." && part != ".." && !is_drive) parts.emplace_back(part);
    begin = end + 1;
  }
  return parts;
}

/// One way to read all names: these last parts of them, below a folder.
struct NameReading {
  fs::path folder;
  std::size_t parts = 0;  // 0: as written
  std::vector<std::optional<FoundName>> files;

  std::size_t found() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(files, [](const auto& f) { return f.has_value(); }));
  }
  bool are_distinct() const {
    std::set<fs::path> seen;
    return std::ranges::all_of(files, [&](const auto& f) { return !f || seen.insert(f->file).second; });
  }
};

/// Reads the names of one list.
class NameSearch {
 public:
  NameSearch(const PhotographPlace& place, LightList& list) : place_(place), list_(list) {
    for (const ListedLight& light : list.lights) {
      parts_.push_back(parts_of(light.name));
      most_parts_ = std::max(most_parts_, parts_.back().size());
    }
  }

  Result<void> run() {
    if (Result<void> ok = check_names(); !ok) return ok;
    const fs::path own = folder_of(list_.file);
    const fs::path first = place_.folder.empty() ? own : place_.folder;
    if (place_.folder.empty() || own.lexically_normal() == first.lexically_normal() ||
        (own / "").lexically_normal() == (first / "").lexically_normal()) {
      if (accept(as_written(own))) return take();
    }
    std::vector<fs::path> bases = {first};
    if (place_.folder.empty()) bases.push_back(fs::absolute(own).lexically_normal().parent_path());
    for (std::size_t parts = most_parts_; parts > 0; --parts)
      for (const fs::path& base : bases)
        if (accept(by_last(parts, base))) return take();
    if (Result<void> ok = search_around(bases); !ok) return ok;
    if (is_settled_ || (place_.skips_missing && best_.found() > 0)) return take();
    return missing();
  }

 private:
  Result<void> check_names() const {
    std::map<std::string, std::size_t> seen;
    for (std::size_t k = 0; k < list_.lights.size(); ++k) {
      const auto [first, is_new] = seen.try_emplace(list_.lights[k].name, k);
      if (is_new) continue;
      return Error{
          ErrorKind::kBadData, "two lights have one photograph", list_.file.string(),
          fmt::format("{} is named by lights {} and {}", list_.lights[k].name, first->second + 1, k + 1),
          "name another photograph for each light"};
    }
    return {};
  }

  NameReading as_written(const fs::path& own) {
    NameReading reading = {own, 0, {}};
    for (const ListedLight& light : list_.lights) {
      const fs::path file = own / light.name;
      std::error_code ignored;
      const bool is_file = fs::exists(file, ignored) && !fs::is_directory(file, ignored);
      reading.files.push_back(is_file ? std::optional(FoundName{file, NameFit::kExact}) : std::nullopt);
    }
    return reading;
  }

  NameReading by_last(std::size_t count, const fs::path& base) {
    NameReading reading = {base, count, {}};
    for (const std::vector<std::string>& parts : parts_) {
      if (parts.empty()) {
        reading.files.emplace_back();
        continue;
      }
      fs::path folder = base;
      for (std::size_t i = parts.size() - std::min(count, parts.size()); i + 1 < parts.size(); ++i)
        folder /= parts[i];
      reading.files.push_back(look_in(folder, parts.back(), folders_));
    }
    return reading;
  }

  // Whether the reading has them all; the best one is kept.
  bool accept(NameReading reading) {
    if (std::ranges::find(looked_in_, reading.folder.string()) == looked_in_.end())
      looked_in_.push_back(reading.folder.string());
    if (!reading.are_distinct()) return false;
    is_settled_ = reading.found() == list_.lights.size();
    if (is_settled_ || best_.files.empty() || reading.found() > best_.found()) best_ = std::move(reading);
    return is_settled_;
  }

  // By their last part in the folders below and beside; more than one that has them all is none.
  Result<void> search_around(const std::vector<fs::path>& bases) {
    std::set<fs::path> around;
    std::error_code failed;
    for (fs::directory_iterator entry(bases.front(), failed), end; !failed && entry != end;
         entry.increment(failed)) {
      std::error_code ignored;
      if (entry->is_directory(ignored)) around.insert(entry->path());
      if (around.size() > kMostFolders) break;
    }
    if (bases.size() > 1)
      for (const char* name : kNeighbours)
        if (is_there(bases[1] / name)) around.insert(bases[1] / name);
    std::vector<NameReading> whole;
    for (const fs::path& folder : around) {
      NameReading reading = by_last(1, folder);
      if (reading.found() == list_.lights.size() && reading.are_distinct()) {
        whole.push_back(std::move(reading));
      } else {
        accept(std::move(reading));
      }
    }
    if (whole.size() > 1) {
      return Error{ErrorKind::kBadData, "photographs may be in several folders", list_.file.string(),
                   fmt::format("{} and {} have them all", whole[0].folder.string(), whole[1].folder.string()),
                   "name the folder that is meant with --photos"};
    }
    if (!whole.empty()) accept(std::move(whole.front()));
    return {};
  }

  Error missing() const {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < list_.lights.size(); ++k)
      if (best_.files.empty() || !best_.files[k]) names.push_back(list_.lights[k].name);
    const std::size_t count = names.size();
    if (count > 3) names.resize(3);
    return {ErrorKind::kNoInput, "cannot read a photograph", list_.file.string(),
            fmt::format("{} of {} are not there: {}{}; looked for in {}", count, list_.lights.size(),
                        fmt::join(names, ", "), count > 3 ? " ..." : "", fmt::join(looked_in_, ", ")),
            "name their folder with --photos, or leave them out with --skip-missing"};
  }

  // Gives each light its photograph, and says how names were read.
  Result<void> take() {
    std::vector<ListedLight> lights;
    std::vector<std::string> left_out;
    std::array<std::size_t, 3> fits = {};
    std::string example;
    for (std::size_t k = 0; k < list_.lights.size(); ++k) {
      if (!best_.files[k]) {
        left_out.push_back(list_.lights[k].name);
        continue;
      }
      const FoundName& found = *best_.files[k];
      ++fits[static_cast<std::size_t>(found.fit)];
      if (found.fit == NameFit::kOtherEnding && example.empty())
        example = fmt::format("{} for {}", found.file.filename().string(), parts_[k].back());
      lights.push_back(std::move(list_.lights[k]));
      lights.back().photograph = found.file;
    }
    list_.lights = std::move(lights);
    if (best_.parts > 0 && best_.parts < most_parts_) {
      list_.assumed.push_back(fmt::format(
          "names are of another folder: the photographs of these names in {} are taken", place_words()));
    } else if (best_.parts > 0 && place_.folder.empty() && best_.folder != folder_of(list_.file)) {
      list_.assumed.push_back("photographs are in " + place_words());
    }
    if (fits[1] > 0) list_.assumed.push_back(fmt::format("{} names have other capitals", fits[1]));
    if (fits[2] > 0)
      list_.assumed.push_back(fmt::format("{} names have another ending: {}", fits[2], example));
    if (!left_out.empty()) {
      list_.assumed.push_back(fmt::format("{} lights without a photograph are left out: {}", left_out.size(),
                                          fmt::join(left_out, ", ")));
    }
    return {};
  }

  std::string place_words() const {
    const std::string folder = best_.folder.filename().string();
    if (best_.folder == folder_of(list_.file)) return "the folder of the light file";
    return folder.empty() ? best_.folder.string() : folder;
  }

  const PhotographPlace& place_;
  LightList& list_;
  Folders folders_;
  std::vector<std::vector<std::string>> parts_;
  std::size_t most_parts_ = 0;
  NameReading best_;
  bool is_settled_ = false;
  std::vector<std::string> looked_in_;
};

// A name with '#' for each number in it.
std::string pattern_of(const fs::path& file) {
  std::string pattern;
  for (const char c : small_letters(file.filename().string())) {
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit) pattern += c;
    if (is_digit && !pattern.ends_with('#')) pattern += '#';
  }
  return pattern;
}

// The photographs of a folder, as people count: of several kinds of names that which has `count`. Raws where
// nothing is developed.
Result<std::vector<fs::path>> photographs_of(const fs::path& folder, std::size_t count,
                                             const fs::path& lights) {
  Folders folders;
  std::vector<fs::path> all, raws;
  for (const fs::path& file : folders.files_of(folder)) {
    if (file.filename().string().starts_with('.')) continue;
    if (capture::is_raw_name(file)) raws.push_back(file);
    if (is_linear_image(file) && !is_mask_name(file) && !is_dark_name(file)) all.push_back(file);
  }
  if (all.empty()) all = std::move(raws);
  std::ranges::sort(all, [](const fs::path& a, const fs::path& b) {
    return stands_before(a.filename().string(), b.filename().string());
  });
  std::map<std::string, std::vector<fs::path>> kinds;
  for (const fs::path& file : all) kinds[pattern_of(file)].push_back(file);
  std::vector<std::vector<fs::path>> fitting;
  for (auto& [pattern, files] : kinds)
    if (files.size() == count) fitting.push_back(std::move(files));
  if (fitting.size() == 1) return std::move(fitting.front());
  if (fitting.empty() && all.size() == count) return all;
  if (all.empty()) {
    return Error{ErrorKind::kNoInput, "there are no photographs", folder.string(),
                 fmt::format("{} has {} lights and names no photograph", lights.string(), count),
                 "name their folder with --photos"};
  }
  return Error{ErrorKind::kBadData, "photographs and lights differ in number", folder.string(),
               fmt::format("{} has {} lights and no names, and there are {} photographs, {} to {}",
                           lights.filename().string(), count, all.size(), all.front().filename().string(),
                           all.back().filename().string()),
               "leave the photographs of these lights in the folder, or write an .lp file with names"};
}

}  // namespace

Result<void> find_photographs(const PhotographPlace& place, LightList& list) {
  if (!list.lights.front().name.empty()) return NameSearch(place, list).run();
  const fs::path folder = place.folder.empty() ? folder_of(list.file) : place.folder;
  const Result<std::vector<fs::path>> files = photographs_of(folder, list.lights.size(), list.file);
  if (!files) return files.error();
  for (std::size_t k = 0; k < files->size(); ++k) list.lights[k].photograph = (*files)[k];
  list.assumed.push_back(fmt::format("photographs are in the order of their names, {} to {}",
                                     files->front().filename().string(), files->back().filename().string()));
  return {};
}

}  // namespace weft::solve
