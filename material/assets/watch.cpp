// SPDX-License-Identifier: Apache-2.0
#include "material/assets/watch.h"

#include <sys/stat.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <tuple>
#include <vector>

namespace weft::material {
namespace {

// Size, time and number of a file; zeros where it is not there.
using FileState = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::uint64_t>;

std::vector<FileState> states_of(const std::vector<std::filesystem::path>& files) {
  std::vector<FileState> states;
  for (const std::filesystem::path& file : files) {
    struct stat now = {};
    if (::stat(file.c_str(), &now) != 0) now = {};
    states.emplace_back(now.st_size, now.st_mtim.tv_sec, now.st_mtim.tv_nsec, now.st_ino);
  }
  return states;
}

// False once the caller stops.
bool wait(const std::stop_token& stop, int ms) {
  std::mutex mutex;
  std::condition_variable_any woken;
  std::unique_lock lock(mutex);
  woken.wait_for(lock, stop, std::chrono::milliseconds(ms), [] { return false; });
  return !stop.stop_requested();
}

}  // namespace

void watch_materials(const WatchOptions& options, const JobContext& context,
                     const std::function<void(const Result<BuildReport>&)>& tell) {
  std::vector<std::filesystem::path> files;
  for (const MaterialPlace& place : options.build.materials) {
    if (!place.is_shipped()) files.push_back(place.file);
  }
  bool is_second_look = false;
  while (!context.stop.stop_requested()) {
    // What changes while it is built is seen afterwards.
    const std::vector<FileState> before = states_of(files);
    const Result<BuildReport> report = build_materials(options.build, context);
    if (context.stop.stop_requested()) return;
    if (!is_second_look || !report || report->built > 0) tell(report);
    // A file that is new to the list may have changed before anybody looked at it.
    is_second_look = report && report->files != files;
    if (is_second_look) {
      files = report->files;
      continue;
    }
    while (states_of(files) == before) {
      if (!wait(context.stop, options.every_ms)) return;
    }
  }
}

}  // namespace weft::material
