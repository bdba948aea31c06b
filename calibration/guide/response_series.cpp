// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/response_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kShares[] = {0.125, 0.25, 0.5, 1};  // of the longest exposure
constexpr int kAlike = 2;                            // photographs of each
constexpr const char* kLit = "lit";
constexpr const char* kDark = "dark";
constexpr const char* kTrap = "trap";

int photographs_in(const fs::path& folder) {
  std::error_code ignored;
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    count += entry.is_regular_file(ignored) ? 1 : 0;
  return count;
}

/// Photographs of the exposures of a folder, which their times name.
void add(std::vector<capture::SeriesShot>& shots, const std::string& folder, const std::vector<int>& leds,
         const std::vector<double>& exposures_us) {
  for (const double exposure_us : exposures_us) {
    for (int twin = 0; twin < kAlike; ++twin) {
      shots.push_back({fmt::format("{}/{:09}us_{}", folder, std::lround(exposure_us), twin == 0 ? 'a' : 'b'),
                       leds, exposure_us});
    }
  }
}

struct SeriesFolder {
  const char* name;
  const char* step;
  int wanted;
};
constexpr int kOfFolder = kAlike * static_cast<int>(std::size(kShares));
constexpr SeriesFolder kResponseFolders[] = {{"led01", kLit, kOfFolder},
                                             {"led02", kLit, kOfFolder},
                                             {"led01+led02", kLit, kOfFolder},
                                             {"dark", kDark, kOfFolder}};
constexpr SeriesFolder kTrapFolders[] = {{"trap", kTrap, kAlike}};

std::string says_of(const std::string& step) {
  if (step == kLit) {
    return "lay something still and matt on the table that is partly light and partly dark, as white paper "
           "on grey card, or a printed chart (weft target chart); about a minute, do not touch the table";
  }
  if (step == kDark) return "put the cover on the lens";
  return "lay white paper that fills the picture, with the black trap in its middle";
}

}  // namespace

Result<SetStanding> look_at_series(const PhotographSet& set) {
  SetStanding standing;
  const auto look = [&](const auto& folders) {
    for (const SeriesFolder& folder : folders) {
      const int there = photographs_in(set.folder / folder.name);
      standing.photographs.push_back({folder.name,
                                      there >= folder.wanted,
                                      false,
                                      there >= folder.wanted ? "" : "photographs are missing",
                                      {{"photographs", there}, {"wanted", folder.wanted}}});
      if (there < folder.wanted && !standing.next)
        standing.next = SetStep{StepKind::kSeries, folder.step, says_of(folder.step), Json()};
    }
  };
  set.part == SetPart::kResponse ? look(kResponseFolders) : look(kTrapFolders);
  standing.is_done = !standing.next;
  return standing;
}

std::vector<std::string> complete_series(const fs::path& sets) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(sets, ignored)) {
    const Result<PhotographSet> set = read_set(entry.path());
    const bool is_series = set && (set->part == SetPart::kResponse || set->part == SetPart::kTrap);
    if (!is_series) continue;
    const Result<SetStanding> standing = look_at_series(*set);
    if (standing && standing->is_done) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::vector<capture::SeriesShot> series_of(const SetStep& step, int leds,
                                           const std::function<double(double share)>& share_of_us) {
  std::vector<double> exposures_us;
  for (const double share : kShares) exposures_us.push_back(share_of_us(share));
  std::vector<capture::SeriesShot> shots;
  if (step.name == kDark) add(shots, "dark", {}, exposures_us);
  if (step.name == kTrap) add(shots, "trap", {1}, {exposures_us.back()});
  if (step.name != kLit) return shots;
  add(shots, "led01", {1}, exposures_us);
  if (leds < 2) return shots;
  add(shots, "led02", {2}, exposures_us);
  add(shots, "led01+led02", {1, 2}, exposures_us);
  return shots;
}

}  // namespace weft::calibration
