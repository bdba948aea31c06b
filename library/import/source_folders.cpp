// SPDX-License-Identifier: Apache-2.0
#include "library/import/source_folders.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <system_error>

#include "core/base/files.h"
#include "core/base/text.h"
#include "core/image_io/linear_image.h"
#include "library/import/name_pattern.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
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

/// One folder, and what is found in it and below.
class Walk {
 public:
  Walk(const fs::path& root, std::set<fs::path>& seen, SourceFolders& found)
      : root_(root), seen_(seen), found_(found) {}

  Result<void> into(const fs::path& folder) {
    if (!seen_.insert(folder).second) return {};
    const Result<std::vector<fs::path>> entries = entries_of(folder);
    if (!entries) return entries.error();
    std::error_code ignored;
    if (fs::exists(folder / "session.json", ignored)) {
      found_.left_over.push_back({folder, "it is a session of weft already"});
      return {};
    }
    if (fs::exists(folder / "photographs.json", ignored)) {
      found_.left_over.push_back({folder, "it was imported already"});
      return {};
    }
    if (fs::exists(folder / "light_directions.txt", ignored) &&
        fs::exists(folder / "filenames.txt", ignored)) {
      found_.photo_folders.push_back(folder);
      return {};
    }
    const bool has_light_file =
        std::ranges::any_of(*entries, [](const fs::path& entry) { return ending_of(entry) == ".lp"; });
    std::vector<fs::path> below;
    for (const fs::path& entry : *entries) {
      const fs::file_status status = fs::status(entry, ignored);
      if (fs::is_directory(status)) {
        if (!fs::is_symlink(entry, ignored)) below.push_back(entry);
      } else {
        take(entry, fs::is_regular_file(status), has_light_file);
      }
    }
    // Photographs of an RTI often lie in a folder beside the light file.
    if (has_light_file) return {};
    for (const fs::path& entry : below)
      if (Result<void> ok = into(entry); !ok) return ok;
    return {};
  }

 private:
  void take(const fs::path& file, bool is_regular, bool is_of_light_file) {
    const std::string ending = ending_of(file);
    if (!is_regular) {
      found_.left_over.push_back({file, "it is no file"});
    } else if (ending == ".lp") {
      found_.light_files.push_back(file);
    } else if (is_of_light_file) {
      return;  // the light file names its photographs
    } else if (file.filename() == "import.toml" || ending == ".json") {
      found_.descriptions.push_back(file);
    } else if (is_jpeg(file)) {
      found_.left_over.push_back({file, "a JPEG went through the camera's tone curve"});
    } else if (is_raw_name(file) || is_linear_image(file)) {
      found_.frames.push_back({file, root_, !is_raw_name(file)});
    } else {
      found_.left_over.push_back({file, "it is no raw, TIFF or EXR file"});
    }
  }

  fs::path root_;
  std::set<fs::path>& seen_;
  SourceFolders& found_;
};

}  // namespace

bool is_raw_name(const fs::path& file) {
  static constexpr std::array<std::string_view, 11> kRaw = {".nef", ".nrw", ".cr2", ".cr3", ".crw", ".dng",
                                                            ".arw", ".orf", ".pef", ".rw2", ".raf"};
  return std::ranges::find(kRaw, ending_of(file)) != kRaw.end();
}

Result<SourceFolders> look_into(const std::vector<std::string>& folders) {
  SourceFolders found;
  std::set<fs::path> seen;
  for (const std::string& named : folders) {
    const fs::path folder = absolute_folder(named);
    if (Result<void> ok = Walk(folder, seen, found).into(folder); !ok) return std::move(ok).error();
  }
  return found;
}

}  // namespace weft::library
