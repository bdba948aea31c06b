// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulator/effects/effects.h"
#include "simulator/effects/random_key.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {
namespace {

/// Albedo of a yarn: its colour, a little lighter or darker than its neighbours.
class Dye {
 public:
  explicit Dye(const Scene& scene)
      : colours_{scene.material.warp_albedo.value_or(scene.material.albedo),
                 scene.material.weft_albedo.value_or(scene.material.albedo)},
        stripe_yarns_(scene.material.stripe_yarns) {
    for (std::uint32_t i = 0; i < kYarns; ++i) {
      const auto bits = philox({i, 0, kYarnStream, 0}, random_key(scene));
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

  static constexpr std::size_t kYarns = 1024;  // then the brightnesses repeat

  std::array<Rgb, 2> colours_;
  std::int64_t stripe_yarns_;
  std::array<std::vector<double>, 2> brightness_;
};

}  // namespace

Pass dye_pass(const Scene& scene) {
  return {"dye", "gives each yarn its albedo", Stage::kSurface, [dye = Dye(scene)](Tile& tile) {
            for (std::size_t i = 0; i < tile.surface.size(); ++i)
              tile.albedo[i] = dye.of(tile.surface[i].yarn);
          }};
}

Pass albedo_pass(const Scene& scene) {
  return {"albedo", "gives the cloth its one albedo", Stage::kSurface,
          [albedo = scene.material.albedo](Tile& tile) {
            std::fill(tile.albedo.begin(), tile.albedo.end(), albedo);
          }};
}

}  // namespace weft::simulator
