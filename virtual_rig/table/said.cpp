// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/table/said.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace weft::virtual_rig {
namespace {

Error refused(const std::string& word, const std::vector<Sayable>& settings) {
  std::vector<std::string> names;
  for (const Sayable& each : settings) names.push_back(fmt::format("{}=NUMBER", each.name));
  return {ErrorKind::kUsage, "nobody knows what that is of a thing", word,
          names.empty() ? std::string("nothing can be said of it")
                        : fmt::format("it may be {}", fmt::join(names, ", ")),
          "see weft-virtual-rig --help"};
}

}  // namespace

Result<SaidValues> SaidValues::of(const std::vector<std::string>& words,
                                  const std::vector<Sayable>& settings) {
  SaidValues said;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const auto setting =
        std::ranges::find_if(settings, [&](const Sayable& each) { return each.name == name; });
    if (setting == settings.end() || equals == std::string::npos) return refused(word, settings);
    const char* end = word.data() + word.size();
    double value = 0;
    const auto [read, wrong] = std::from_chars(word.data() + equals + 1, end, value);
    if (wrong != std::errc() || read != end || !(value >= setting->least && value <= setting->most)) {
      return Error{ErrorKind::kUsage, "no thing can be like that", word,
                   fmt::format("{} is a number from {:g} to {:g}", name, setting->least, setting->most),
                   "give it another one"};
    }
    said.values_.emplace_back(name, value);
  }
  return said;
}

std::optional<double> SaidValues::value(const Sayable& setting) const {
  for (const auto& [name, value] : values_) {
    if (name == setting.name) return value;
  }
  return {};
}

}  // namespace weft::virtual_rig
