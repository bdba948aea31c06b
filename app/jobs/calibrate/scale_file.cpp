// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/scale_file.h"

#include <fmt/format.h>

#include <cmath>

#include "calibration/response/neutral_scale.h"
#include "core/files.h"
#include "core/toml/toml_keys.h"

namespace weft::app {
namespace {

constexpr std::size_t kFewestOfScale = 5;  // patches
constexpr std::size_t kMost = 100;

std::optional<calibration::ChartCorners> corners_of(const toml::table& table, TomlKeys& keys) {
  if (!keys.has("corners_px")) return {};
  const toml::array* list = table["corners_px"].as_array();
  calibration::ChartCorners corners = {};
  bool is_good = list != nullptr && list->size() == corners.size();
  for (std::size_t i = 0; is_good && i < corners.size(); ++i) {
    const toml::array* corner = list->get_as<toml::array>(i);
    is_good = corner != nullptr && corner->size() == 2;
    for (std::size_t k = 0; is_good && k < 2; ++k) {
      corners[i][k] = corner->get(k)->value_or(NAN);
      is_good = std::isfinite(corners[i][k]);
    }
  }
  if (!is_good) keys.reject("corners_px", "a scale has four corners, [[x, y], ...]");
  return corners;
}

}  // namespace

Result<ScaleSettings> read_scale_file(const std::filesystem::path& file) {
  ScaleSettings settings;
  for (const calibration::MunsellPatch& patch : calibration::munsell_scale())
    settings.reflectances.push_back(patch.reflectance);
  if (!is_there(file)) return settings;
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  TomlKeys keys(*table, file.string(), "docs/calibration.md");
  keys.know({"reflectances", "corners_px", "height_mm", "reflectance_sigma", "delta"});
  if (keys.has("reflectances")) {
    settings.reflectances = keys.numbers("reflectances", 1, kMost);
    if (settings.reflectances.size() < kFewestOfScale)
      keys.reject("reflectances", fmt::format("a scale has {} patches or more", kFewestOfScale));
    for (const double r : settings.reflectances) {
      if (!(r > 0 && r <= 1)) keys.reject("reflectances", "a reflectance is not above 0 and to 1");
    }
  }
  settings.corners_px = corners_of(*table, keys);
  settings.height_mm = keys.number_or("height_mm", settings.height_mm, -1000, 1000);
  settings.reflectance_sigma = keys.number_or("reflectance_sigma", settings.reflectance_sigma, 1e-6, 1);
  settings.delta = keys.number_or("delta", settings.delta, -0.5, 1);
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  return settings;
}

}  // namespace weft::app
