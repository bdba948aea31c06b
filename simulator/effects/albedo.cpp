// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "simulator/effects/effects.h"
#include "simulator/effects/random_key.h"
#include "simulator/sampling/random.h"
#include "simulator/spectra/observer.h"

namespace weft::simulator {
namespace {

/// What three channels make of a dye: those of the camera where it is told apart from the observer, which is
/// an effect.
class ColourOf {
 public:
  ColourOf(const Scene& scene, bool seen_by_camera)
      : plain_(scene.material.albedo), weights_(rec709_weights()) {
    if (seen_by_camera && scene.effects.spectral) {
      if (const auto camera = camera_weights(scene.spectra.led, scene.spectra.filters)) weights_ = *camera;
    }
    if (scene.material.dye) plain_ = of(*scene.material.dye);
  }
  Rgb operator()(const std::optional<Spectrum>& dye, const std::optional<Rgb>& albedo) const {
    return dye ? of(*dye) : albedo.value_or(plain_);
  }

 private:
  /// A dye outside Rec.709 counts as the nearest albedo there is.
  Rgb of(const Spectrum& dye) const {
    Rgb albedo = channel_reflectance(weights_, dye);
    for (double& a : albedo) a = std::clamp(a, 0.0, 1.0);
    return albedo;
  }

  Rgb plain_;
  ChannelWeights weights_;
};

/// Albedo of a yarn: its colour, a little lighter or darker than its neighbours.
class Dye {
 public:
  Dye(const Scene& scene, const ColourOf& colour_of)
      : colours_{colour_of(scene.material.warp_dye, scene.material.warp_albedo),
                 colour_of(scene.material.weft_dye, scene.material.weft_albedo)},
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

Pass dye_pass(const Scene& scene, bool seen_by_camera) {
  return {"dye", "gives each yarn its albedo", PassStage::kSurface,
          [dye = Dye(scene, ColourOf(scene, seen_by_camera))](PassTile& tile) {
            for (std::size_t i = 0; i < tile.surface.size(); ++i)
              tile.albedo[i] = dye.of(tile.surface[i].yarn);
          }};
}

Pass albedo_pass(const Scene& scene, bool seen_by_camera) {
  return {"albedo", "gives the cloth its one albedo", PassStage::kSurface,
          [albedo = ColourOf(scene, seen_by_camera)({}, {})](PassTile& tile) {
            std::fill(tile.albedo.begin(), tile.albedo.end(), albedo);
          }};
}

}  // namespace weft::simulator
