// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/photographs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "bench/sanity/drawn_cloth.h"
#include "core/base/files.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"

namespace weft::bench {
namespace {

constexpr double kElectrons = 40000, kFar_mm = 10000;

struct Rendered {
  Image<double> readings;
  Image<float> normal;
};

// A later part lies over an earlier one.
void lay_over(const simulator::Rendering& part, const std::function<bool(double, double)>& is_there,
              double mm_per_pixel, Rendered& all) {
  const Size size = all.normal.size();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (is_there && !is_there(x * mm_per_pixel, y * mm_per_pixel)) continue;
      for (int p = 0; p < all.readings.planes(); ++p) all.readings(x, y, p) = part.readings(x, y, p);
    }
  }
}

Result<Rendered> render(const KindOfCloth& cloth, const simulator::Scene& scene, Rect area, int threads) {
  const TileOptions tiles = {.threads = threads};
  Result<simulator::Rendering> ground = simulator::render_readings(scene, area, tiles);
  if (!ground) return std::move(ground).error();
  Rendered all = {std::move(ground->readings), Image<float>(ground->normal.size(), 3)};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < all.normal.height(); ++y)
      std::copy_n(ground->normal.plane(c).row(y), all.normal.width(), all.normal.plane(c).row(y));
  }
  for (const ClothPart& part : cloth.parts) {
    simulator::Scene of_part = scene;
    of_part.material = part.material;
    const Result<simulator::Rendering> rendered = simulator::render_readings(of_part, area, tiles);
    if (!rendered) return rendered.error();
    lay_over(*rendered, part.is_there, scene.camera.mm_per_pixel, all);
  }
  return all;
}

// Camera and LEDs, so that light is parallel and as bright.
void put_far_away(simulator::Scene& scene) {
  scene.camera.distance_mm = kFar_mm;
  scene.lights.rings = simulator::default_rings();
  for (simulator::LedRing& ring : scene.lights.rings) {
    scene.lights.flux *=
        std::pow(kFar_mm / ring.distance_mm, 2 / static_cast<double>(scene.lights.rings.size()));
    ring.distance_mm = kFar_mm;
  }
}

double brightest(const Image<double>& readings) {
  double most = 0;
  for (int p = 0; p < readings.planes(); ++p) {
    for (int y = 0; y < readings.height(); ++y)
      most = std::max(
          most, *std::max_element(readings.plane(p).row(y), readings.plane(p).row(y) + readings.width()));
  }
  return most;
}

}  // namespace

Result<WrittenPhotographs> write_photographs(const KindOfCloth& cloth, Size size, std::uint32_t seed,
                                             const std::filesystem::path& folder, int threads) {
  simulator::Scene scene = cloth.scene;
  scene.effects.noise = false;
  put_far_away(scene);
  const int left = (scene.camera.width - size.width) / 2, top = (scene.camera.height - size.height) / 2;
  const Result<Rendered> rendered =
      render(cloth, scene, {left, top, left + size.width, top + size.height}, threads);
  if (!rendered) return rendered.error();
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();

  Draws draws(seed);
  const double full = 1 / (1.02 * brightest(rendered->readings)), told = draws.of_ratio(0.3, 3);
  WrittenPhotographs written;
  written.input.folder = folder;
  written.input.light_file = folder / "cloth.lp";
  written.normal = Image<float>(size, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < size.height; ++y)
      std::copy_n(rendered->normal.plane(c).row(y), size.width, written.normal.plane(c).row(y));
  }
  const auto& leds = rig->leds.leds;
  std::string lights = fmt::format("{}\n", leds.size());
  for (std::size_t k = 0; k < leds.size(); ++k) {
    Image<float> photograph(size, 3);
    for (int c = 0; c < 3; ++c) {
      const auto plane = rendered->readings.plane(3 * static_cast<int>(k) + c);
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          const double signal = full * plane(x, y);
          const double noise = draws.normal() * std::sqrt(std::max(signal, 0.0) / kElectrons);
          photograph(x, y, c) = static_cast<float>(std::max(0.0, signal + noise));
        }
      }
    }
    const std::string name = fmt::format("{:02}.exr", k + 1);
    const std::array<View<const float>, 3> planes = {photograph.plane(0), photograph.plane(1),
                                                     photograph.plane(2)};
    if (Result<void> ok = write_image(folder / name, planes, {"R", "G", "B"}, {.type = SampleType::kFloat});
        !ok)
      return std::move(ok).error();
    const Vec3 at = leds[k].position_mm, toward = normalized(at);
    lights += fmt::format("{} {} {} {}", name, toward.x, toward.y, toward.z);
    for (std::size_t c = 0; c < 3; ++c)
      lights += fmt::format(" {}", told * full * leds[k].flux_rgb[c] / dot(at, at));
    lights += '\n';
  }
  if (Result<void> ok = write_file(written.input.light_file, lights); !ok) return std::move(ok).error();
  return written;
}

}  // namespace weft::bench
