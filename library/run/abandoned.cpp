// SPDX-License-Identifier: Apache-2.0
#include "library/run/abandoned.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "core/base/partial_name.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr auto kLongUnchanged = std::chrono::hours(24);

bool is_long_unchanged(const fs::path& folder) {
  std::error_code failed;
  auto newest = fs::last_write_time(folder, failed);
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code ignored;
    const auto written = entry->last_write_time(ignored);
    if (!ignored) newest = std::max(newest, written);
  }
  return !failed && fs::file_time_type::clock::now() - newest > kLongUnchanged;
}

}  // namespace

std::vector<fs::path> abandoned_in(const fs::path& parent) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator entry(parent, failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::optional<PartialMaker> maker = maker_of_partial(entry->path());
    if (!maker) continue;
    const bool is_done = maker->is_of_this_machine ? !maker->runs : is_long_unchanged(entry->path());
    if (is_done) found.push_back(entry->path());
  }
  std::ranges::sort(found);
  return found;
}

std::vector<fs::path> abandoned_of(const fs::path& session, const fs::path& solves) {
  std::vector<fs::path> found, parents = {solves, session / "maps"};
  std::error_code failed;
  for (fs::directory_iterator preset(session / "export", failed), end; !failed && preset != end;
       preset.increment(failed))
    parents.push_back(preset->path());
  for (const fs::path& parent : parents) {
    const std::vector<fs::path> here = abandoned_in(parent);
    found.insert(found.end(), here.begin(), here.end());
  }
  return found;
}

int remove_folders(const std::vector<fs::path>& folders) {
  int gone = 0;
  for (const fs::path& folder : folders) {
    std::error_code failed;
    fs::remove_all(folder, failed);
    if (!failed) ++gone;
  }
  return gone;
}

}  // namespace weft::library
