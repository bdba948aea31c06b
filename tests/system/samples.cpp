// SPDX-License-Identifier: Apache-2.0
#include "tests/system/samples.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "core/base/sha256.h"
#include "core/image/color_spaces.h"
#include "core/rig/session.h"
#include "simulator/simulate.h"
#include "tests/core/places.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

template <typename T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

void need(const Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message());
}

void write_planes(const fs::path& file, Size size, const std::vector<std::string>& channels, SampleType type,
                  const std::function<std::array<double, 3>(int x, int y)>& value) {
  Image<float> image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::array<double, 3> v = value(x, y);
      for (int p = 0; p < 3; ++p) image(x, y, p) = static_cast<float>(v[static_cast<std::size_t>(p)]);
    }
  }
  const std::array<View<const float>, 3> planes = {image.plane(0), image.plane(1), image.plane(2)};
  need(write_image(file, planes, channels, {.type = type}));
}

}  // namespace

fs::path source_file(const std::string& path) {
  return source_folder() / path;
}

simulator::Scene scene_named(const std::string& name, Size size) {
  simulator::Scene scene = need(simulator::read_scene(source_file("testdata/scenes/" + name + ".toml")));
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  return scene;
}

void simulate(const simulator::Scene& scene, const fs::path& folder) {
  const char* shared = std::getenv("WEFT_SAMPLES");
  if (!shared) {
    need(simulator::simulate_session(scene, folder, {}));
    return;
  }
  const fs::path sample = fs::path(shared) / sha256_of(simulator::to_toml(scene));
  if (!fs::exists(sample)) {
    const fs::path aside = fmt::format("{}.of-{}", sample.string(), getpid());
    need(simulator::simulate_session(scene, aside, {}));
    std::error_code another_was_first;
    fs::rename(aside, sample, another_was_first);
  }
  fs::create_directories(folder);
  fs::copy(sample, folder, fs::copy_options::recursive);
}

void simulate_developed(const simulator::Scene& scene, const fs::path& folder, const std::string& ending,
                        SampleType type) {
  simulate(scene, folder);
  Session session = need(read_session(folder));
  std::erase_if(session.shots, [](const Shot& shot) { return shot.role != ShotRole::kLit; });
  const Size size = {scene.camera.width, scene.camera.height};
  const simulator::Rendering rendering =
      need(simulator::render_readings(scene, {0, 0, size.width, size.height}));
  for (Shot& shot : session.shots) {
    const double exposure = shot.exposure_us * 1e-6 * shot.iso / 100;
    const int first = 3 * (shot.led - 1);
    shot.file = fs::path(shot.file).replace_extension(ending).string();
    shot.sha256.clear();
    write_planes(session.path_of(shot), size, {"R", "G", "B"}, type, [&](int x, int y) {
      const auto reading = [&](int c) { return rendering.readings(x, y, first + c) * exposure; };
      return std::array<double, 3>{reading(0), reading(1), reading(2)};
    });
  }
  need(write_session(session));
}

simulator::Scene twill_with_ball(double distance_mm) {
  simulator::Scene scene;
  scene.camera.width = 320;
  scene.camera.height = 240;
  scene.camera.mm_per_pixel = 0.5;
  scene.camera.distance_mm = distance_mm;
  scene.geometry.kind = simulator::GeometryKind::kTwill;
  scene.geometry.warp_pitch_mm = scene.geometry.weft_pitch_mm = 3;
  simulator::BallSettings& ball = scene.balls.emplace_back();
  ball.centre_mm = {20, -12, 33};
  ball.radius_mm = 28;
  ball.highlight_deg = 2;
  return scene;
}

void write_photographs(const simulator::Scene& scene, const fs::path& folder, SampleType type,
                       const fs::path& truth) {
  const Size size = {scene.camera.width, scene.camera.height};
  const simulator::Rendering rendering =
      need(simulator::render_readings(scene, {0, 0, size.width, size.height}));
  fs::create_directories(folder);
  for (int k = 0; k < rendering.readings.planes() / 3; ++k) {
    const std::string name = fmt::format("shot{:02}.{}", k + 2, type == SampleType::kUint8 ? "png" : "exr");
    write_planes(folder / name, size, {"R", "G", "B"}, type, [&](int x, int y) {
      const double grey = std::min(1.0, 0.02 * rendering.readings(x, y, 3 * k + 1));
      const std::array<double, 3> linear = {grey, grey, grey};
      return type == SampleType::kUint8 ? srgb_of_rec709(linear) : linear;
    });
  }
  if (truth.empty()) return;
  write_planes(truth, size, {"X", "Y", "Z"}, SampleType::kFloat, [&](int x, int y) {
    return std::array<double, 3>{rendering.normal(x, y, 0), rendering.normal(x, y, 1),
                                 rendering.normal(x, y, 2)};
  });
}

std::vector<DistantLight> PhotographSample::six_lights() {
  std::vector<DistantLight> lights;
  for (int k = 0; k < 6; ++k) {
    const double azimuth = radians(60.0 * k + 7), zenith = radians(40);
    lights.push_back(
        {{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)},
         {0.9 + 0.1 * k, 1.3 - 0.1 * k, 1.0}});
  }
  return lights;
}

Vec3 PhotographSample::normal_at(int x, int y) const {
  return normalized({0.28 * std::sin(0.31 * x + 0.05 * y), 0.28 * std::cos(0.23 * y), 1});
}

std::array<double, 3> PhotographSample::albedo_at(int x, int y) const {
  return {0.3 + 0.1 * std::sin(0.7 * x), 0.4, 0.35 + 0.1 * std::cos(0.9 * y)};
}

std::string PhotographSample::name_of(std::size_t light) const {
  return fmt::format("{:02}{}", light + 1, ending);
}

void PhotographSample::write(const fs::path& folder) const {
  fs::create_directories(folder);
  std::ofstream names(folder / "filenames.txt"), directions(folder / "light_directions.txt"),
      intensities(folder / "light_intensities.txt");
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const auto& [l, e] = lights[k];
    names << name_of(k) << '\n';
    directions << fmt::format("{} {} {}\n", l.x, l.y, l.z);
    intensities << fmt::format("{} {} {}\n", e[0], e[1], e[2]);
    write_planes(folder / name_of(k), size, {"R", "G", "B"}, type, [&](int x, int y) {
      const double shading = std::max(0.0, dot(normal_at(x, y), l));
      std::array<double, 3> value = albedo_at(x, y);
      for (std::size_t c = 0; c < 3; ++c) value[c] *= e[c] * shading;
      return value;
    });
  }
  write_planes(folder / "normal_gt.exr", size, {"X", "Y", "Z"}, SampleType::kFloat, [&](int x, int y) {
    const Vec3 n = normal_at(x, y);
    return std::array<double, 3>{n.x, n.y, n.z};
  });
  write_planes(folder / "albedo_gt.exr", size, {"R", "G", "B"}, SampleType::kFloat,
               [&](int x, int y) { return albedo_at(x, y); });
}

}  // namespace weft::test
