// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/session_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <map>
#include <string_view>

#include "core/base/text.h"

namespace weft::library {
namespace {

constexpr std::size_t kMostNameBytes = 40;
constexpr int kMostCount = 99999;

std::string local_time(std::chrono::system_clock::time_point time, const char* format) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts = {};
  localtime_r(&seconds, &parts);
  std::array<char, 32> text = {};
  return {text.data(), std::strftime(text.data(), text.size(), format, &parts)};
}

Error bad_template(const std::string& name_template, std::string why) {
  return {ErrorKind::kBadData, "session_name gives no name", name_template, std::move(why),
          "use letters, digits, '.', '_', '-', {date}, {time}, {fabric}, {rig} and {count}"};
}

Result<std::string> filled(const std::string& name_template,
                           const std::map<std::string, std::string>& values) {
  std::string name;
  for (std::string_view rest = name_template; !rest.empty();) {
    if (rest[0] != '{') {
      name += rest[0];
      rest.remove_prefix(1);
      continue;
    }
    const std::size_t end = std::min(rest.find('}'), rest.size() - 1);
    const auto value = values.find(std::string(rest.substr(1, end - 1)));
    if (value == values.end()) {
      return bad_template(name_template, fmt::format("{} is not known", rest.substr(0, end + 1)));
    }
    name += value->second;
    rest.remove_prefix(end + 1);
  }
  // A fabric may begin with what a name may not.
  name.erase(0, std::min(name.find_first_not_of(".-"), name.size()));
  return name;
}

}  // namespace

bool is_session_name(const std::string& name) {
  return !name.empty() && name.size() <= kMostSessionNameBytes && name[0] != '.' && name[0] != '-' &&
         plain_name(name) == name;
}

Result<std::filesystem::path> session_folder(const std::filesystem::path& sessions, const std::string& name) {
  if (!is_session_name(name)) {
    return Error{
        ErrorKind::kUsage, "this is no name of a session", name.substr(0, kMostSessionNameBytes), "",
        "use at most 100 bytes of letters, digits, '.', '_' and '-', beginning with a letter, digit or '_'"};
  }
  std::filesystem::path folder = sessions / (name + ".weft");
  std::error_code error;
  const auto type = std::filesystem::symlink_status(folder, error).type();
  if (type != std::filesystem::file_type::not_found && type != std::filesystem::file_type::directory) {
    return Error{ErrorKind::kBadData, "the session is no folder of its own", folder.string(),
                 "a file or a link is in its place", "move it away, or take another name"};
  }
  return folder;
}

Result<std::string> next_session_name(const std::string& name_template, const std::string& fabric,
                                      const std::string& rig, const std::filesystem::path& sessions,
                                      std::chrono::system_clock::time_point now) {
  std::map<std::string, std::string> values = {{"date", local_time(now, "%Y-%m-%d")},
                                               {"time", local_time(now, "%H%M%S")},
                                               {"fabric", file_name_of(fabric, "cloth", kMostNameBytes)},
                                               {"rig", file_name_of(rig, "rig", kMostNameBytes)}};
  const bool counts = name_template.find("{count}") != std::string::npos;
  for (int count = 1; count <= kMostCount; ++count) {
    values["count"] = fmt::format("{:03}", count);
    Result<std::string> name = filled(name_template, values);
    if (!name) return name;
    if (!counts && count > 1) *name += fmt::format("_{}", count);
    if (!is_session_name(*name)) return bad_template(name_template, fmt::format("it gives '{}'", *name));
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(sessions / (*name + ".weft"), ignored)))
      return name;
  }
  return bad_template(name_template, "every number is taken");
}

}  // namespace weft::library
