// SPDX-License-Identifier: Apache-2.0
#include "core/base/partial_name.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <string_view>

namespace weft {
namespace {

constexpr std::string_view kPartialEnding = ".partial";

}  // namespace

std::string machine_name() {
  std::array<char, 256> name = {};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string partial_name(const std::string& target) {
  return fmt::format(".{}.{}.{}{}", target, machine_name(), ::getpid(), kPartialEnding);
}

std::optional<PartialMaker> maker_of_partial(const std::filesystem::path& folder) {
  const std::string file_name = folder.filename().string();
  std::string_view name = file_name;
  if (!name.starts_with('.') || !name.ends_with(kPartialEnding)) return {};
  name.remove_suffix(kPartialEnding.size());
  const std::size_t dot = name.rfind('.');
  if (dot == 0 || dot == std::string_view::npos) return {};
  const std::string_view number = name.substr(dot + 1);
  pid_t process = 0;
  const auto [end, failed] = std::from_chars(number.data(), number.data() + number.size(), process);
  if (failed != std::errc() || end != number.data() + number.size() || process <= 0) return {};
  PartialMaker maker;
  maker.is_of_this_machine = name.substr(0, dot).ends_with("." + machine_name());
  maker.runs = maker.is_of_this_machine && (::kill(process, 0) == 0 || errno != ESRCH);
  return maker;
}

}  // namespace weft
