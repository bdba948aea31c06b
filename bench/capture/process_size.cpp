// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/process_size.h"

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

std::optional<ProcessSize> size_of(pid_t pid) {
  const fs::path folder = fs::path("/proc") / std::to_string(pid);
  ProcessSize size;
  std::ifstream status(folder / "status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) size.resident_bytes = std::stoull(line.substr(6)) << 10;
  }
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder / "fd", failed))
    size.descriptors += !entry.path().empty();
  if (failed || size.resident_bytes == 0) return std::nullopt;
  return size;
}

std::optional<pid_t> child_of(pid_t parent, const std::string& name) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc", ignored)) {
    const std::string number = entry.path().filename().string();
    pid_t pid = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), pid).ec != std::errc()) continue;
    const std::string stat = text_of(entry.path() / "stat");
    const std::size_t open = stat.find('('), close = stat.rfind(')');
    if (open == std::string::npos || close == std::string::npos || stat.size() < close + 4) continue;
    if (stat.substr(open + 1, close - open - 1) == name &&
        std::strtol(stat.c_str() + close + 4, nullptr, 10) == parent)
      return pid;
  }
  return std::nullopt;
}

}  // namespace weft::bench
