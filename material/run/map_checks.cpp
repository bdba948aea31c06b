// SPDX-License-Identifier: Apache-2.0
#include "material/run/map_checks.h"

#include <string>
#include <utility>
#include <vector>

#include "report/downsampler.h"
#include "report/preview.h"
#include "solve/files/pictures.h"

namespace weft::app {
namespace {

using material::Finding;
using material::Severity;

// The share of each square of pixels that a finding is about.
Result<void> draw_where(const std::filesystem::path& file, const Image<std::uint8_t>& where) {
  Image<float> marked(where.size());
  for (int y = 0; y < where.height(); ++y) {
    for (int x = 0; x < where.width(); ++x) marked(x, y) = where(x, y) > 0 ? 1.0F : 0.0F;
  }
  report::Downsampler reduced(marked.size(), 1);
  reduced.add_rows(std::vector<View<const float>>{marked.plane()});
  return write_png(file, report::heat_picture(reduced.averages().plane(), 1, " share"));
}

}  // namespace

Result<std::vector<MapCheck>> check_maps(MapWork& work, bool has_measured_black) {
  material::MapsToValidate maps;
  maps.surface = &work.surface;
  maps.openness = work.openness.empty() ? View<const float>() : View<const float>(work.openness.plane());
  // The slopes of a tile's height are those of its waves, which differences of pixels are not.
  if (!work.height_mm.empty() && !work.surface.is_tile) maps.height_mm = work.height_mm.plane();
  maps.has_measured_black = has_measured_black;
  maps.level = work.level;
  maps.is_height_of_slopes = true;
  maps.is_colour_changed = work.is_colour_changed;
  material::ValidationLimits limits;
  limits.threads = work.context.threads;
  const Result<std::vector<Finding>> findings = material::validate(maps, limits);
  if (!findings && findings.error().kind == ErrorKind::kBadData) {
    work.verdicts.push_back({"NO_CLOTH", "no pixel is cloth that was solved", findings.error().remedy});
    return std::vector<MapCheck>();
  }
  if (!findings) return findings.error();
  std::vector<MapCheck> checks;
  for (const Finding& finding : *findings) {
    MapCheck check = {finding.verdict.name, finding.severity,     finding.number,
                      finding.limit,        finding.verdict.text, {}};
    if (finding.severity != Severity::kPassed && !finding.where.empty()) {
      check.picture = "where_" + finding.verdict.name + ".png";
      if (Result<void> ok = draw_where(work.folder / check.picture, finding.where); !ok)
        return std::move(ok).error();
    }
    checks.push_back(std::move(check));
  }
  const std::vector<Verdict> verdicts = material::verdicts_of(*findings);
  work.verdicts.insert(work.verdicts.end(), verdicts.begin(), verdicts.end());
  return checks;
}

}  // namespace weft::app
