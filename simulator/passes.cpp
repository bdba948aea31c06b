// SPDX-License-Identifier: Apache-2.0
#include "simulator/passes.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "core/raw_frame.h"
#include "simulator/light.h"

namespace weft::simulator {
namespace {

using std::chrono::steady_clock;

std::array<std::uint32_t, 2> random_key(const Scene& scene) {
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
}

/// Albedo of a yarn: its colour, a little lighter or darker than its neighbours.
class Dye {
 public:
  explicit Dye(const Scene& scene)
      : colours_{scene.material.warp_albedo.value_or(scene.material.albedo),
                 scene.material.weft_albedo.value_or(scene.material.albedo)},
        stripe_yarns_(scene.material.stripe_yarns) {
    for (std::uint32_t i = 0; i < kYarns; ++i) {
      const auto bits = philox({i, 0, kStream, 0}, random_key(scene));
      for (std::size_t set = 0; set < 2; ++set) {
        const double u = uniform(bits[2 * set], bits[2 * set + 1]);
        brightness_[set].push_back(1 + scene.material.yarn_variation * (2 * u - 1));
      }
    }
  }

  Rgb of(Yarn yarn) const {
    const double brightness = brightness_[yarn.is_weft][static_cast<std::size_t>(yarn.index) % kYarns];
    Rgb albedo = colours_[has_second_colour(yarn)];
    for (double& a : albedo) a = std::min(a * brightness, 1.0);
    return albedo;
  }

 private:
  bool has_second_colour(Yarn yarn) const {
    if (stripe_yarns_ == 0) return yarn.is_weft;
    const std::int64_t before_zero = yarn.index < 0 ? stripe_yarns_ - 1 : 0;  // division rounds towards 0
    return (yarn.index - before_zero) / stripe_yarns_ % 2 != 0;
  }

  static constexpr std::uint32_t kStream = 0xFFFFFFFF;  // a shot that no scene has
  static constexpr std::size_t kYarns = 1024;           // then the brightnesses repeat

  std::array<Rgb, 2> colours_;
  std::int64_t stripe_yarns_;
  std::array<std::vector<double>, 2> brightness_;
};

Pass camera_pass(const Scene& scene) {
  return {"camera", "finds the point of the cloth's plane that each pixel sees", Stage::kSurface,
          [scene](Tile& tile) {
            tile.for_each_pixel(
                [&](std::size_t i, int x, int y) { tile.point_mm[i] = point_of_pixel(scene, x, y); });
          }};
}

Pass geometry_pass(const Scene& scene) {
  const auto pass = [](const auto& surface) {
    return [surface](Tile& tile) {
      for (std::size_t i = 0; i < tile.surface.size(); ++i) {
        tile.surface[i] = surface.at(tile.point_mm[i].x, tile.point_mm[i].y);
      }
    };
  };
  return {"geometry", "gives the cloth its height, normal and yarn in closed form", Stage::kSurface,
          std::visit([&](const auto& surface) -> std::function<void(Tile&)> { return pass(surface); },
                     surface_of(scene.geometry))};
}

Pass relief_pass() {
  return {"relief", "lifts each point from the plane to the cloth's height", Stage::kSurface, [](Tile& tile) {
            for (std::size_t i = 0; i < tile.surface.size(); ++i)
              tile.point_mm[i].z += tile.surface[i].height_mm;
          }};
}

Pass dye_pass(const Scene& scene) {
  return {"dye", "gives each yarn its albedo", Stage::kSurface, [dye = Dye(scene)](Tile& tile) {
            for (std::size_t i = 0; i < tile.surface.size(); ++i)
              tile.albedo[i] = dye.of(tile.surface[i].yarn);
          }};
}

Pass plain_albedo_pass(const Scene& scene) {
  return {"albedo", "gives the cloth its one albedo", Stage::kSurface,
          [albedo = scene.material.albedo](Tile& tile) {
            std::fill(tile.albedo.begin(), tile.albedo.end(), albedo);
          }};
}

/// signal = albedo * flux * strength * max(0, n . l) * exposure, with the light that `incidence_at(led,
/// point)` gives.
template <typename IncidenceAt>
std::function<void(Tile&)> lit_by(std::vector<Rgb> signal_of_unit, const IncidenceAt& incidence_at) {
  return [signal_of_unit = std::move(signal_of_unit), incidence_at](Tile& tile) {
    if (tile.led == 0) {
      std::fill(tile.signal.begin(), tile.signal.end(), Rgb{});
      return;
    }
    const auto led = static_cast<std::size_t>(tile.led - 1);
    for (std::size_t i = 0; i < tile.signal.size(); ++i) {
      const double light = shading(incidence_at(led, tile.point_mm[i]), tile.surface[i].normal);
      for (std::size_t c = 0; c < 3; ++c)
        tile.signal[i][c] = tile.albedo[i][c] * light * signal_of_unit[led][c];
    }
  };
}

Pass near_light_pass(const Scene& scene, const Rig& rig) {
  const double exposure = rig.exposure(scene.camera.iso);
  std::vector<Rgb> signal_of_unit;
  for (const NearLight& led : rig.leds.leds) {
    signal_of_unit.push_back(
        {led.flux_rgb[0] * exposure, led.flux_rgb[1] * exposure, led.flux_rgb[2] * exposure});
  }
  return {"near light", "lights each point from a LED's true place: direction, distance and lobe",
          Stage::kShot,
          lit_by(std::move(signal_of_unit), [leds = rig.leds.leds](std::size_t led, Vec3 point_mm) {
            return incidence(leds[led], point_mm);
          })};
}

Pass distant_light_pass(const Scene& scene, const Rig& rig) {
  const double exposure = rig.exposure(scene.camera.iso);
  std::vector<Rgb> signal_of_unit;
  std::vector<Incidence> light;
  for (const DistantLight& each : distant_lights(rig, scene.geometry.cloth_height_mm).lights) {
    const std::array<double, 3>& e = each.irradiance_rgb;
    signal_of_unit.push_back({e[0] * exposure, e[1] * exposure, e[2] * exposure});
    light.push_back({each.direction, 1});
  }
  return {"distant light", "lights all points alike, as at the table's centre", Stage::kShot,
          lit_by(std::move(signal_of_unit),
                 [light = std::move(light)](std::size_t led, Vec3) { return light[led]; })};
}

Pass mosaic_pass() {
  return {"mosaic", "keeps the colour that each photosite's filter passes", Stage::kShot, [](Tile& tile) {
            constexpr CfaPattern kCfa;
            tile.samples.resize(tile.signal.size());
            tile.for_each_pixel([&](std::size_t i, int x, int y) {
              tile.samples[i] = tile.signal[i][static_cast<std::size_t>(kCfa.channel_at(x, y))];
            });
          }};
}

Pass rgb_pass() {
  return {"rgb", "keeps all three colours of each pixel", Stage::kShot, [](Tile& tile) {
            tile.samples.clear();
            for (const Rgb& s : tile.signal) tile.samples.insert(tile.samples.end(), s.begin(), s.end());
          }};
}

Pass noise_pass(const Scene& scene, const Rig& rig) {
  return {"noise", "draws photons (Poisson) and read noise (normal)", Stage::kShot,
          [sensor = rig.sensor, key = random_key(scene)](Tile& tile) {
            const std::size_t channels = tile.samples.size() / tile.signal.size();
            tile.for_each_pixel([&](std::size_t i, int x, int y) {
              for (std::size_t c = 0; c < channels; ++c) {
                double& sample = tile.samples[channels * i + c];
                sample = noisy(sensor, sample,
                               philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                       static_cast<std::uint32_t>(tile.led), static_cast<std::uint32_t>(c)},
                                      key));
              }
            });
          }};
}

Pass converter_pass(const Rig& rig) {
  return {"converter", "adds the black level, rounds to whole counts and clips at 0 and white", Stage::kShot,
          [sensor = rig.sensor](Tile& tile) {
            tile.counts.resize(tile.samples.size());
            for (std::size_t i = 0; i < tile.counts.size(); ++i)
              tile.counts[i] = count_of(sensor, tile.samples[i]);
          }};
}

}  // namespace

void Tile::resize(Rect tile) {
  rect = tile;
  const auto pixels = static_cast<std::size_t>(tile.pixels());
  point_mm.resize(pixels);
  surface.resize(pixels);
  albedo.resize(pixels);
  signal.resize(pixels);
}

PassList build_passes(const Scene& scene, const Rig& rig, Output output) {
  PassList list;
  const auto add = [&](Pass pass) { list.passes.push_back(std::move(pass)); };
  const auto leave_out = [&](const char* effect) {
    list.left_out.push_back({effect, "the scene does not name it"});
  };
  add(camera_pass(scene));
  add(geometry_pass(scene));
  add(is_woven(scene.geometry.kind) ? dye_pass(scene) : plain_albedo_pass(scene));
  scene.effects.relief ? add(relief_pass()) : leave_out("relief");
  add(scene.effects.near_light ? near_light_pass(scene, rig) : distant_light_pass(scene, rig));
  if (!scene.effects.near_light) leave_out("near_light");
  add(output == Output::kCounts ? mosaic_pass() : rgb_pass());
  scene.effects.noise ? add(noise_pass(scene, rig)) : leave_out("noise");
  if (output == Output::kCounts) add(converter_pass(rig));
  return list;
}

PassRunner::PassRunner(PassList list, const TileOptions& options)
    : list_(std::move(list)),
      options_(options),
      workers_(static_cast<std::size_t>(resolved_threads(options.threads))) {
  for (Worker& worker : workers_) {
    worker.spent.resize(list_.passes.size());
    worker.pixels.resize(list_.passes.size());
  }
}

void PassRunner::run_stage(Stage stage, Worker& worker) const {
  for (std::size_t p = 0; p < list_.passes.size(); ++p) {
    if (list_.passes[p].stage != stage) continue;
    const steady_clock::time_point start = steady_clock::now();
    list_.passes[p].run(worker.tile);
    worker.spent[p] += steady_clock::now() - start;
    worker.pixels[p] += worker.tile.rect.pixels();
  }
}

Result<void> PassRunner::run(Rect area, std::span<const int> leds, std::stop_token stop,
                             const std::function<void(const Tile&)>& with_surface,
                             const std::function<void(const Tile&)>& with_shot) {
  // The tile loop starts at column 0, an area anywhere.
  const Rect whole = {0, 0, area.width(), area.height()};
  return for_each_tile(whole, options_, std::move(stop), [&](Rect part, int w) {
    Worker& worker = workers_[static_cast<std::size_t>(w)];
    worker.tile.resize({area.x0 + part.x0, area.y0 + part.y0, area.x0 + part.x1, area.y0 + part.y1});
    run_stage(Stage::kSurface, worker);
    with_surface(worker.tile);
    for (const int led : leds) {
      worker.tile.led = led;
      run_stage(Stage::kShot, worker);
      with_shot(worker.tile);
    }
  });
}

std::vector<PassCost> PassRunner::costs() const {
  std::vector<PassCost> costs;
  for (std::size_t p = 0; p < list_.passes.size(); ++p) {
    PassCost cost = {list_.passes[p].name, list_.passes[p].does};
    for (const Worker& worker : workers_) {
      cost.seconds += std::chrono::duration<double>(worker.spent[p]).count();
      cost.pixels += worker.pixels[p];
    }
    costs.push_back(std::move(cost));
  }
  return costs;
}

}  // namespace weft::simulator
