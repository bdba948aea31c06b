// SPDX-License-Identifier: Apache-2.0
#include "material/validation/validate.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/solve/solve_record.h"
#include "material/validation/checks.h"

namespace weft::material {
namespace {

constexpr double kLeastClothOpacity = 0.3;

Error not_validated(ErrorKind kind, std::string why, std::string remedy) {
  return {kind, "the maps cannot be checked", "validation", std::move(why), std::move(remedy)};
}

Error nothing_solved() {
  return not_validated(ErrorKind::kBadData, "no pixel has a solution",
                       "look into report.html of the solve for what its photographs lack, and scan again");
}

Result<void> check_sizes(const MapsToValidate& maps) {
  if (maps.surface == nullptr || maps.surface->size().pixels() == 0) {
    return not_validated(ErrorKind::kUsage, "there is no surface", "give the surface of the maps");
  }
  const auto fits = [&](View<const float> map) { return map.empty() || map.size() == maps.surface->size(); };
  const bool all = fits(maps.openness) && fits(maps.height_mm) && std::ranges::all_of(maps.normals, fits);
  if (all) return {};
  return not_validated(ErrorKind::kUsage, "a map has another size than the surface", "give maps of one grid");
}

Image<std::uint8_t> counting(const Surface& surface) {
  Image<std::uint8_t> counts(surface.size());
  for (int y = 0; y < counts.height(); ++y) {
    for (int x = 0; x < counts.width(); ++x) {
      const bool cloth = surface.opacity.empty() || double{surface.opacity(x, y)} >= kLeastClothOpacity;
      counts(x, y) = cloth && (surface.status(x, y) & kNoSolution) == 0;
    }
  }
  return counts;
}

Image<float> averaged(const Surface& surface, const Image<std::uint8_t>& counts, int threads) {
  Image<float> made(surface.size(), 3);
  parallel_for(static_cast<std::size_t>(made.height()), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < made.width(); ++x) {
      std::array<double, 3> sum{};
      double count = 0;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, made.height() - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, made.width() - 1); ++i) {
          if (counts(i, j) == 0) continue;
          count += 1;
          for (int c = 0; c < 3; ++c) sum[static_cast<std::size_t>(c)] += double{surface.albedo(i, j, c)};
        }
      }
      for (int c = 0; count > 0 && c < 3; ++c) {
        made(x, y, c) = static_cast<float>(sum[static_cast<std::size_t>(c)] / count);
      }
    }
  });
  return made;
}

double counted(const Image<std::uint8_t>& counts) {
  double pixels = 0;
  for (int y = 0; y < counts.height(); ++y) {
    for (int x = 0; x < counts.width(); ++x) pixels += counts(x, y);
  }
  return pixels;
}

}  // namespace

const char* name_of(Severity severity) {
  return kSeverityNames[static_cast<std::size_t>(severity)];
}

bool has_better_level(const Checked& checked) {
  return checked.maps.level != "reference";
}

double luminance_at(const Image<float>& albedo, int x, int y) {
  return luminance_of(double{albedo(x, y, 0)}, double{albedo(x, y, 1)}, double{albedo(x, y, 2)});
}

Vec3 normal_at(const Surface& surface, int x, int y) {
  return normalized({-double{surface.slope(x, y, 0)}, -double{surface.slope(x, y, 1)}, 1});
}

Finding passed(std::string name, std::string text, double number, double limit) {
  return {{std::move(name), std::move(text), ""}, Severity::kPassed, number, limit, {}};
}

Finding failed(Severity severity, Verdict verdict, double number, double limit, Image<std::uint8_t> where) {
  return {std::move(verdict), severity, number, limit, std::move(where)};
}

Result<std::vector<Finding>> validate(const MapsToValidate& maps, const ValidationLimits& limits) {
  if (Result<void> ok = check_sizes(maps); !ok) return std::move(ok).error();
  Image<std::uint8_t> counts = counting(*maps.surface);
  Image<float> albedo = averaged(*maps.surface, counts, limits.threads);
  const double pixels = counted(counts);
  if (pixels == 0) return nothing_solved();
  const Checked checked = {maps, limits, std::move(counts), std::move(albedo), pixels};
  std::vector<Finding> found;
  for (const auto check : {dark_albedo, bright_albedo, gamut, saturation}) found.push_back(check(checked));
  if (!maps.surface->lobe.empty()) {
    for (const auto check : {f0_range, energy, lobe_energy}) found.push_back(check(checked));
  }
  if (!maps.openness.empty()) found.push_back(light_by_openness(checked));
  found.push_back(light_by_normals(checked));
  if (maps.surface->is_tile) found.push_back(seam(checked));
  if (!maps.normals[0].empty()) found.push_back(normal_length(checked));
  if (!maps.height_mm.empty()) found.push_back(height_off_slopes(checked));
  found.push_back(texel_density(checked));
  if (!maps.greys.empty()) found.push_back(greys(checked));
  return found;
}

Severity worst_of(const std::vector<Finding>& findings) {
  Severity worst = Severity::kPassed;
  for (const Finding& finding : findings) worst = std::max(worst, finding.severity);
  return worst;
}

std::vector<Verdict> verdicts_of(const std::vector<Finding>& findings) {
  std::vector<Verdict> verdicts;
  for (const Finding& finding : findings) {
    if (finding.severity != Severity::kPassed) verdicts.push_back(finding.verdict);
  }
  return verdicts;
}

}  // namespace weft::material
