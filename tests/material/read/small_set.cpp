// SPDX-License-Identifier: Apache-2.0
#include "tests/material/read/small_set.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "exchange/export/export.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr double kTurn = 6.283185307179586;

// 0 to 1 and once around over the picture.
double wave(int x, int y, double columns, double rows, double phase) {
  return 0.5 + 0.5 * std::sin(kTurn * (columns * x / kSmall.width + rows * y / kSmall.height) + phase);
}

}  // namespace

void write_small(const fs::path& file, const std::vector<std::string>& channels, const PixelOf& at,
                 const WriteOptions& options) {
  Image<float> map(kSmall, static_cast<int>(channels.size()));
  std::vector<View<const float>> planes;
  for (int p = 0; p < map.planes(); ++p) {
    for (int y = 0; y < kSmall.height; ++y) {
      for (int x = 0; x < kSmall.width; ++x) map(x, y, p) = static_cast<float>(at(x, y, p));
    }
    planes.push_back(map.plane(p));
  }
  const Result<void> written = write_image(file, planes, channels, options);
  ASSERT_TRUE(written) << written.error().message();
}

double small_albedo(int x, int y, int channel) {
  return 0.1 + 0.1 * channel + 0.25 * wave(x, y, 1, 1, 0.4 * channel);
}

std::array<double, 3> small_normal(int x, int y) {
  const double sx = 0.8 * wave(x, y, 1, 0, 0.3) - 0.4, sy = 0.6 * wave(x, y, 0, 1, 1.1) - 0.2;
  const double length = std::hypot(sx, sy, 1.0);
  return {-sx / length, -sy / length, 1 / length};
}

double small_height_mm(int x, int y) {
  return -0.145 + 0.207 * wave(x, y, 1, 1, 0);
}
double small_openness(int x, int y) {
  return 0.5 + 0.5 * wave(x, y, 0, 1, 0);
}
double small_alpha(int x, int y) {
  return 0.2 + 0.5 * wave(x, y, 1, 0, 0);
}
double small_f0(int x, int y) {
  return 0.03 + 0.04 * wave(x, y, 1, 0, 2);
}

void SmallSet::write(const fs::path& folder) const {
  fs::create_directories(folder);
  write_small(folder / "albedo.exr", {"R", "G", "B"}, [&](int x, int y, int c) {
    return is_albedo_alike ? kSmallAlbedo[static_cast<std::size_t>(c)] : small_albedo(x, y, c);
  });
  write_small(folder / "normal.exr", {"X", "Y", "Z"},
              [](int x, int y, int c) { return small_normal(x, y)[static_cast<std::size_t>(c)]; });
  write_small(folder / "height.exr", {"height"}, [](int x, int y, int) { return small_height_mm(x, y); });
  write_small(folder / "occlusion.exr", {"openness"}, [](int x, int y, int) { return small_openness(x, y); });
  write_small(folder / "roughness.exr", {"alpha", "alpha_along", "yarn_deg"}, [&](int x, int y, int c) {
    return c == 2 ? 0 : is_rough_alike ? kSmallAlpha : small_alpha(x, y);
  });
  write_small(folder / "specular.exr", {"f0"},
              [&](int x, int y, int) { return is_f0_alike ? kSmallF0 : small_f0(x, y); });
  const Json maps = Json::array({{{"name", "height"},
                                  {"file", "height.exr"},
                                  {"unit", "mm"},
                                  {"source", "derived"},
                                  {"least", -0.145},
                                  {"most", 0.062}},
                                 {{"name", "occlusion"}, {"file", "occlusion.exr"}},
                                 {{"name", "opacity"}, {"constant", 1}},
                                 {{"name", "roughness"}, {"file", "roughness.exr"}, {"source", "measured"}},
                                 {{"name", "specular"}, {"file", "specular.exr"}, {"source", "measured"}}});
  const Result<void> written = write_json(folder / "maps.json", {{"schema", "weft.maps/1"},
                                                                 {"id", "0011223344556677"},
                                                                 {"solve", "aabb"},
                                                                 {"name", name},
                                                                 {"width", kSmall.width},
                                                                 {"height", kSmall.height},
                                                                 {"mm_per_pixel", 0.25},
                                                                 {"is_tile", true},
                                                                 {"maps", maps}});
  ASSERT_TRUE(written) << written.error().message();
}

fs::path exported_small(const fs::path& folder, const std::string& preset, const fs::path& output) {
  exchange::ExportOptions options = {.input = folder};
  options.presets = {preset};
  options.output = output / preset;
  const auto reports = exchange::export_maps(options, {.threads = 2, .stop = {}});
  EXPECT_TRUE(reports) << preset << ": " << reports.error().message();
  return options.output;
}

}  // namespace weft::material
