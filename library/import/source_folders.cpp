// SPDX-License-Identifier: Apache-2.0
#include "library/import/source_folders.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <system_error>

#include "capture/camera/photograph_facts.h"
#include "core/base/files.h"
#include "core/base/text.h"
#include "core/image_io/linear_image.h"
#include "solve/input/light_list.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& file) {
  return small_letters(file.extension().string());
}

bool is_jpeg(const fs::path& file) {
  return ending_of(file) == ".jpg" || ending_of(file) == ".jpeg";
}

/// The entries of a folder as people count.
Result<std::vector<fs::path>> entries_of(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> entries;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (!entry->path().filename().string().starts_with('.')) entries.push_back(entry->path());
  }
  if (failed) {
    return Error{ErrorKind::kNoInput, "cannot list a folder", folder.string(), failed.message(),
                 "name a folder of photographs that may be read"};
  }
  std::ranges::sort(entries, [](const fs::path& a, const fs::path& b) {
    return stands_before(a.filename().string(), b.filename().string());
  });
  return entries;
}

/// Whether photographs of a folder have their lights in it or in one above, by names or in a table without.
enum class LightsAbove { kNone, kNamed, kNameless };

/// One folder, and what is found in it and below.
class Walk {
 public:
  Walk(const fs::path& root, std::set<fs::path>& seen, SourceFolders& found)
      : root_(root), seen_(seen), found_(found) {}

  Result<void> into(const fs::path& folder, LightsAbove above) {
    if (!seen_.insert(folder).second) return {};
    const Result<std::vector<fs::path>> entries = entries_of(folder);
    if (!entries) return entries.error();
    std::error_code ignored;
    if (fs::exists(folder / "session.json", ignored)) {
      found_.left_over.push_back({folder, "it is a session of weft already"});
      return {};
    }
    above = take_lights(folder, *entries, above);
    std::vector<fs::path> below;
    for (const fs::path& entry : *entries) {
      const fs::file_status status = fs::status(entry, ignored);
      if (fs::is_directory(status)) {
        if (!fs::is_symlink(entry, ignored)) below.push_back(entry);
      } else {
        take(entry, fs::is_regular_file(status), above != LightsAbove::kNone);
      }
    }
    for (const fs::path& entry : below)
      if (Result<void> ok = into(entry, above); !ok) return ok;
    return {};
  }

 private:
  // Notes what holds lights; returns what that is to the files here and below.
  LightsAbove take_lights(const fs::path& folder, const std::vector<fs::path>& entries, LightsAbove above) {
    const bool has_pictures = std::ranges::any_of(entries, is_linear_image);
    std::vector<fs::path> files;
    bool has_table = false, is_nameless = false;
    for (const fs::path& file : solve::light_files_in(folder)) {
      if (is_of_program(file)) {
        files.push_back(file);
      } else if (const Result<solve::LightList> list = solve::read_light_list(file)) {
        has_table = true;
        is_nameless = list->lights.front().name.empty();
      } else {
        found_.unread_lights.push_back(list.error());
      }
    }
    if (has_table && is_nameless && !has_pictures && files.empty()) return LightsAbove::kNameless;
    if (has_table || (above == LightsAbove::kNameless && has_pictures && files.empty())) {
      found_.photo_folders.push_back(folder);
      return LightsAbove::kNamed;
    }
    if (files.empty()) return above;
    found_.light_files.insert(found_.light_files.end(), files.begin(), files.end());
    return LightsAbove::kNamed;
  }

  // Lights as a program writes them, which are no table that anybody may mean otherwise.
  static bool is_of_program(const fs::path& file) {
    const std::string ending = ending_of(file);
    return ending == ".lp" || ending == ".dome" || ending == ".relight" || ending == ".json";
  }

  void take(const fs::path& file, bool is_regular, bool has_lights) {
    const std::string ending = ending_of(file);
    if (!is_regular) {
      found_.left_over.push_back({file, "it is no file"});
    } else if (file.filename() == "import.toml") {
      found_.descriptions.push_back(file);
    } else if (has_lights) {
      if (capture::is_raw_name(file) || is_linear_image(file)) found_.beside_lights.push_back(file);
    } else if (ending == ".json") {
      found_.descriptions.push_back(file);
    } else if (is_jpeg(file)) {
      found_.left_over.push_back({file, "a JPEG went through the camera's tone curve"});
    } else if (capture::is_raw_name(file) || is_linear_image(file)) {
      found_.frames.push_back({file, root_, !capture::is_raw_name(file)});
    } else {
      found_.left_over.push_back({file, "it is no raw, TIFF or EXR file"});
    }
  }

  fs::path root_;
  std::set<fs::path>& seen_;
  SourceFolders& found_;
};

}  // namespace

Result<SourceFolders> look_into(const std::vector<fs::path>& folders) {
  SourceFolders found;
  std::set<fs::path> seen;
  for (const fs::path& named : folders) {
    const fs::path folder = absolute_folder(named);
    found.roots.push_back(folder);
    if (Result<void> ok = Walk(folder, seen, found).into(folder, LightsAbove::kNone); !ok)
      return std::move(ok).error();
  }
  return found;
}

}  // namespace weft::library
