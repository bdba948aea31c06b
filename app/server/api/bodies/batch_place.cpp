// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/batch_place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/base/files.h"
#include "library/catalogue/session_name.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "sessions.txt";
constexpr int kMostTries = 100;

int number_of_name(const std::string& name) {
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && end == name.data() + name.size() ? number : 0;
}

int highest_number(const fs::path& batches) {
  int highest = 0;
  for (const std::string& name : batch_names(batches)) highest = std::max(highest, number_of_name(name));
  return highest;
}

Result<void> make_folder(const fs::path& folder) {
  std::error_code failed;
  if (fs::create_directory(folder, failed)) return {};
  if (failed) return cannot_write(folder, failed.value());
  return Error{ErrorKind::kCannotCreate, "there is a batch of this name", folder.filename().string(), "",
               "take another name"};
}

// The first number that nobody takes in the same moment.
Result<std::string> make_numbered(const fs::path& batches) {
  const int highest = highest_number(batches);
  for (int i = 1;; ++i) {
    const std::string name = fmt::format("{:04}", highest + i);
    Result<void> made = make_folder(batches / name);
    if (made) return name;
    if (made.error().kind != ErrorKind::kCannotCreate || i == kMostTries) return std::move(made).error();
  }
}

}  // namespace

fs::path list_of_batch(const fs::path& batches, const std::string& name) {
  return batches / name / kList;
}

fs::path plan_of_batch(const fs::path& batches, const std::string& name) {
  return batches / name / "plan.jsonl";
}

fs::path report_of_batch(const fs::path& batches, const std::string& name) {
  return batches / name / "plan.results" / "report";
}

std::vector<std::string> batch_names(const fs::path& batches) {
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(batches, error)) {
    const std::string name = entry.path().filename().string();
    std::error_code gone;
    const fs::file_time_type begun = fs::last_write_time(list_of_batch(batches, name), gone);
    if (!gone && library::is_session_name(name)) found.emplace_back(begun, name);
  }
  std::ranges::sort(found, std::greater{});
  std::vector<std::string> names;
  for (auto& [time, name] : found) names.push_back(std::move(name));
  return names;
}

Result<fs::path> find_batch(const fs::path& batches, const std::string& name) {
  if (library::is_session_name(name) && is_there(list_of_batch(batches, name))) return batches / name;
  return Error{ErrorKind::kNoInput, "there is no such batch", name.substr(0, 40), "",
               "see the list of batches"};
}

Result<std::string> begin_batch(const fs::path& batches, const std::string& name,
                                const std::vector<std::string>& sessions) {
  if (!name.empty() && !library::is_session_name(name)) {
    return Error{ErrorKind::kUsage, "this is no name of a batch", name.substr(0, 40), "",
                 "write at most 100 letters, digits, dots and dashes"};
  }
  if (Result<void> ok = make_writable_folder(batches); !ok) return std::move(ok).error();
  Result<std::string> begun = name;
  if (name.empty()) {
    begun = make_numbered(batches);
  } else if (Result<void> made = make_folder(batches / name); !made) {
    begun = std::move(made).error();
  }
  if (!begun) return begun;
  const std::string text = fmt::format("{}\n", fmt::join(sessions, "\n"));
  if (Result<void> written = write_file(list_of_batch(batches, *begun), text); !written) {
    remove_batch(batches, *begun);
    return std::move(written).error();
  }
  return begun;
}

void remove_batch(const fs::path& batches, const std::string& name) {
  std::error_code ignored;
  if (library::is_session_name(name)) fs::remove_all(batches / name, ignored);
}

}  // namespace weft::app
