// SPDX-License-Identifier: Apache-2.0
#include "bench/export/map_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/image_io/image_io.h"
#include "core/json_document.h"

namespace weft::bench {
namespace {

// A plane of the large map by the pixel of the cloth that lies there.
template <typename Value>
Image<float> repeated(Size cloth, Size size, int planes, const Value& value) {
  Image<float> map(size, planes);
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) map(x, y, p) = value(x % cloth.width, y % cloth.height, p);
    }
  }
  return map;
}

}  // namespace

Result<void> write_map_set(const SolvedCloth& cloth, Size size, double mm_per_pixel,
                           const std::filesystem::path& folder) {
  const Size of = cloth.normal.size();
  Json maps = Json::array();
  const auto write = [&](const char* name, const std::vector<std::string>& channels, SampleType type,
                         const Image<float>& map) {
    std::vector<View<const float>> planes;
    for (int p = 0; p < map.planes(); ++p) planes.push_back(map.plane(p));
    const std::string file = std::string(name) + ".exr";
    const bool is_height = file == "height.exr";
    maps.push_back({{"name", name},
                    {"file", file},
                    {"source", "measured"},
                    {"least", is_height ? -0.1 : 0},
                    {"most", is_height ? 0.1 : 1}});
    return write_image(folder / file, planes, channels,
                       {.type = type, .pitch_mm = {mm_per_pixel, mm_per_pixel}});
  };
  const auto z = [&](int x, int y) { return cloth.normal(x, y, 2); };
  if (Result<void> ok =
          write("normal", {"X", "Y", "Z"}, SampleType::kFloat,
                repeated(of, size, 3, [&](int x, int y, int p) { return cloth.normal(x, y, p); }));
      !ok)
    return ok;
  if (Result<void> ok =
          write("albedo", {"R", "G", "B"}, SampleType::kHalf,
                repeated(of, size, 3, [&](int x, int y, int p) { return cloth.albedo(x, y, p); }));
      !ok)
    return ok;
  if (Result<void> ok =
          write("height", {"height"}, SampleType::kFloat,
                repeated(of, size, 1, [&](int x, int y, int) { return 0.2F * z(x, y) - 0.1F; }));
      !ok)
    return ok;
  if (Result<void> ok = write("occlusion", {"openness"}, SampleType::kHalf,
                              repeated(of, size, 1, [&](int x, int y, int) { return z(x, y); }));
      !ok)
    return ok;
  const auto lobe = [&](int x, int y, int p) {
    const float alpha = 0.2F + 0.1F * z(x, y);
    return p == 0 ? std::sqrt(alpha) : p == 1 ? alpha : p == 2 ? 0.5F * alpha : 45.0F;
  };
  if (Result<void> ok = write("roughness", {"roughness", "alpha", "alpha_along", "yarn_deg"},
                              SampleType::kHalf, repeated(of, size, 4, lobe));
      !ok)
    return ok;
  maps.push_back({{"name", "specular"}, {"constant", 0.04}, {"source", "assumed"}});
  return write_json(folder / "maps.json", {{"schema", "weft.maps/1"},
                                           {"id", "bench"},
                                           {"width", size.width},
                                           {"height", size.height},
                                           {"mm_per_pixel", mm_per_pixel},
                                           {"is_tile", true},
                                           {"maps", maps}});
}

}  // namespace weft::bench
