// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/batch/abandoned.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <optional>
#include <string_view>

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".partial";
constexpr auto kLongUnchanged = std::chrono::hours(24);

// ".NAME.HOST.PID.partial" without its ending: the process that made it.
struct Maker {
  std::string_view name_and_host;
  pid_t pid = 0;
};

std::optional<Maker> maker_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kEnding)) return {};
  name.remove_suffix(kEnding.size());
  const std::size_t dot = name.rfind('.');
  if (dot == 0 || dot == std::string_view::npos) return {};
  Maker maker = {name.substr(0, dot), 0};
  const std::string_view number = name.substr(dot + 1);
  const auto [end, failed] = std::from_chars(number.data(), number.data() + number.size(), maker.pid);
  if (failed != std::errc() || end != number.data() + number.size() || maker.pid <= 0) return {};
  return maker;
}

bool runs(pid_t pid) {
  return ::kill(pid, 0) == 0 || errno == EPERM;
}

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

std::string name_of_this_host() {
  std::array<char, 256> name = {};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::vector<fs::path> abandoned_in(const fs::path& parent) {
  const std::string here = "." + name_of_this_host();
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator entry(parent, failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    const std::optional<Maker> maker = maker_of(name);
    if (!maker) continue;
    const bool is_own = maker->name_and_host.ends_with(here);
    if (is_own ? !runs(maker->pid) : is_long_unchanged(entry->path())) found.push_back(entry->path());
  }
  std::ranges::sort(found);
  return found;
}

std::vector<fs::path> abandoned_of(const fs::path& session, const fs::path& solves) {
  std::vector<fs::path> found;
  for (const fs::path& parent : {solves, session / "maps", session / "rectified"}) {
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

}  // namespace weft::app
