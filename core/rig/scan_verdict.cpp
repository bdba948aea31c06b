// SPDX-License-Identifier: Apache-2.0
#include "core/rig/scan_verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "core/rig/exposed.h"

namespace weft {

void describe(Fields& fields, ScanVerdict& verdict) {
  fields.choice({"grade", "What the scan is worth", {}, kMustSay}, verdict.grade, kGradeNames);
  fields.value({"says", "Why, in a line", {}, kMustSay}, verdict.says);
  fields.value({"action", "The one thing to do; empty: nothing", {}, kMustSay}, verdict.action);
}

std::string words_of(const ScanVerdict& verdict) {
  return fmt::format("{}: {}{}{}", kGradeNames[static_cast<std::size_t>(verdict.grade)], verdict.says,
                     verdict.action.empty() ? "" : "; ", verdict.action);
}

std::vector<std::string> warnings_of(const Shot& shot) {
  std::vector<std::string> warnings;
  const auto list = shot.document.find("warnings");
  if (list == shot.document.end() || !list->is_array()) return warnings;
  for (const Json& warning : *list) {
    if (warning.is_string()) warnings.push_back(warning.get<std::string>());
  }
  return warnings;
}

namespace {

/// What shots were warned of alike.
struct SharedWarning {
  std::string first;        ///< as its first shot was warned of it
  std::set<int> also = {};  ///< LEDs of the others
};

std::string without_numbers(const std::string& warning) {
  std::string words;
  std::ranges::copy_if(warning, std::back_inserter(words),
                       [](char c) { return (c < '0' || c > '9') && c != '.'; });
  return words;
}

std::vector<SharedWarning> shared_warnings(const Session& session) {
  std::vector<SharedWarning> causes;
  std::map<std::string, std::size_t> places;
  for (const Shot& shot : session.shots) {
    if (shot.superseded_by) continue;
    for (const std::string& warning : warnings_of(shot)) {
      const auto [place, is_new] = places.try_emplace(without_numbers(warning), causes.size());
      if (is_new) {
        causes.push_back({warning});
      } else if (shot.led > 0) {
        causes[place->second].also.insert(shot.led);
      }
    }
  }
  return causes;
}

std::string words_of_cause(const SharedWarning& cause) {
  if (cause.also.empty()) return cause.first;
  const std::size_t at = std::min(cause.first.find("; "), cause.first.size());
  return fmt::format("{}, and LED{} {} likewise{}", cause.first.substr(0, at),
                     cause.also.size() > 1 ? "s" : "", fmt::join(cause.also, ", "), cause.first.substr(at));
}

}  // namespace

std::vector<std::string> warnings_of(const Session& session) {
  std::vector<std::string> warnings;
  if (std::string exposure = exposure_warning(session); !exposure.empty())
    warnings.push_back(std::move(exposure));
  for (const SharedWarning& cause : shared_warnings(session)) warnings.push_back(words_of_cause(cause));
  return warnings;
}

ScanVerdict verdict_of_warning(Grade grade, const std::string& warning) {
  const std::size_t at = warning.find("; ");
  return {grade, warning.substr(0, at), at == std::string::npos ? "" : warning.substr(at + 2)};
}

ScanVerdict verdict_of_photographs(const Session& session) {
  if (is_exposed_wrong(session)) return verdict_of_warning(Grade::kAgain, exposure_warning(session));
  const std::vector<std::string> warnings = warnings_of(session);
  if (warnings.empty()) return {Grade::kGood, "nothing is wrong with its photographs", ""};
  ScanVerdict first = verdict_of_warning(Grade::kUsable, warnings.front());
  if (warnings.size() > 1) first.says += fmt::format(", and {} more", warnings.size() - 1);
  return first;
}

}  // namespace weft
