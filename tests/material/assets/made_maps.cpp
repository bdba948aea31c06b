// SPDX-License-Identifier: Apache-2.0
#include "tests/material/assets/made_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/files.h"
#include "core/base/json_document.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

void write_planes(const fs::path& file, Size size, const std::vector<std::string>& channels,
                  const std::function<double(int x, int y, int p)>& at) {
  Image<float> map(size, static_cast<int>(channels.size()));
  std::vector<View<const float>> planes;
  for (int p = 0; p < map.planes(); ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) map(x, y, p) = static_cast<float>(at(x, y, p));
    }
    planes.push_back(map.plane(p));
  }
  const Result<void> written = write_image(file, planes, channels, {});
  ASSERT_TRUE(written) << written.error().message();
}

}  // namespace

double noise_at(int x, int y, int seed) {
  const double t = std::sin(12.9898 * x + 78.233 * y + 37.719 * seed) * 43758.5453;
  return t - std::floor(t);
}

void MadeSet::write(const fs::path& folder) const {
  fs::create_directories(folder);
  write_planes(folder / "albedo.exr", size, {"R", "G", "B"},
               [&](int x, int y, int p) { return albedo(x, y, p); });
  write_planes(folder / "normal.exr", size, {"X", "Y", "Z"}, [&](int x, int y, int p) {
    const double sx = slope(x, y, 0), sy = slope(x, y, 1), length = std::hypot(sx, sy, 1.0);
    return (p == 0 ? -sx : p == 1 ? -sy : 1) / length;
  });
  write_planes(folder / "height.exr", size, {"height"}, [&](int x, int y, int) { return height(x, y); });
  write_planes(folder / "occlusion.exr", size, {"openness", "R", "G", "B"},
               [&](int x, int y, int p) { return noise_at(x, y, seed + 40 + p); });
  write_planes(
      folder / "roughness.exr", size, {"roughness", "alpha", "alpha_along", "yarn_deg"},
      [&](int x, int y, int p) {
        const double a = alpha(x, y), along = 0.5 * a;
        return p == 0 ? std::sqrt(std::sqrt(a * along)) : p == 1 ? a : p == 2 ? along : x % 2 ? 90.0 : 0.0;
      });
  const Json maps =
      Json::array({{{"name", "height"}, {"file", "height.exr"}, {"unit", "mm"}, {"source", "derived"}},
                   {{"name", "roughness"}, {"file", "roughness.exr"}, {"source", "measured"}},
                   {{"name", "opacity"}, {"constant", 1}, {"source", "assumed"}}});
  const Result<void> written =
      write_json(folder / "maps.json", {{"schema", "weft.maps/1"},
                                        {"id", "00112233445566" + std::to_string(10 + seed % 80)},
                                        {"solve", "aabb"},
                                        {"width", size.width},
                                        {"height", size.height},
                                        {"mm_per_pixel", mm_per_pixel},
                                        {"is_tile", is_tile},
                                        {"maps", maps}});
  ASSERT_TRUE(written) << written.error().message();
}

void Bench::put(const std::string& name, const std::string& text) const {
  fs::create_directories((*this / name).parent_path());
  const Result<void> written = write_file(*this / name, text);
  ASSERT_TRUE(written) << written.error().message();
}

void Bench::material(const std::string& name, const std::string& text) const {
  put(name, "schema = \"weft.material/1\"\n" + text);
}

Result<BuildReport> Bench::build(const std::vector<std::string>& names, const JobContext& context) const {
  BuildOptions options;
  for (const std::string& name : names) {
    Result<MaterialPlace> place =
        find_material(name.starts_with(kLibraryPrefix) ? name : (*this / name).string(), {});
    if (!place) return std::move(place).error();
    options.materials.push_back(std::move(*place));
  }
  options.output = *this / "build";
  options.compose.has_pictures = draws;
  return build_materials(options, context);
}

BuildReport Bench::built(const std::vector<std::string>& names) const {
  Result<BuildReport> report = build(names);
  EXPECT_TRUE(report) << report.error().message();
  return report ? std::move(*report) : BuildReport();
}

std::string Bench::refusal(const std::string& name, ErrorKind kind) const {
  const Result<BuildReport> report = build({name});
  EXPECT_FALSE(fs::exists(*this / "build")) << "something was written";
  if (report) return "";
  EXPECT_EQ(report.error().kind, kind) << report.error().message();
  return report.error().message();
}

LoadedImage map_of(const BuiltMaterial& material, const std::string& name) {
  Result<LoadedImage> image = read_image(material.folder / (name + ".exr"));
  EXPECT_TRUE(image) << image.error().message();
  return image ? std::move(*image) : LoadedImage();
}

std::map<std::string, std::string> digests_below(const fs::path& folder) {
  std::map<std::string, std::string> digests;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "digests.json")
      digests[entry.path().lexically_relative(folder).string()] = *sha256_of_file(entry.path());
  }
  return digests;
}

}  // namespace weft::material
