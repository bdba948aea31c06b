// SPDX-License-Identifier: Apache-2.0
#include "simulator/build_passes.h"

#include <utility>

#include "simulator/effects/effects.h"

namespace weft::simulator {
namespace {

/// A list of passes under construction.
class Builder {
 public:
  Builder(const Scene& scene, const Rig& rig, Output output) : scene_(scene), rig_(rig), output_(output) {}

  PassList build() && {
    add_cloth();
    if (output_ == Output::kSurface) return std::move(list_);
    add_light();
    add_reflection();
    add_photosites();
    for (const EffectKey& effect : effect_keys()) {
      if (!(on().*effect.on)) list_.left_out.push_back({effect.name, "the scene does not name it"});
    }
    return std::move(list_);
  }

 private:
  const EffectSettings& on() const { return scene_.effects; }
  void add(Pass pass) { list_.passes.push_back(std::move(pass)); }

  void add_cloth() {
    add(camera_pass(scene_, rig_));
    add(geometry_pass(scene_));
    add(is_woven(scene_.geometry.kind) ? dye_pass(scene_) : albedo_pass(scene_));
    if (on().relief) add(relief_pass());
  }

  void add_light() {
    if (on().finite_led) {
      add(finite_led_pass(scene_, rig_));
    } else {
      add(on().near_light ? near_light_pass(rig_) : distant_light_pass(scene_, rig_));
    }
  }

  void add_reflection() {
    add(lambert_pass(scene_, rig_));
    if (on().led_drift) add(led_drift_pass(scene_, rig_));
    if (on().stray) add(stray_pass(scene_, rig_));
    if (on().ambient) add(ambient_pass(scene_, rig_));
  }

  void add_photosites() {
    add(output_ == Output::kCounts ? mosaic_pass(0) : rgb_pass());
    if (on().noise) add(noise_pass(scene_, rig_));
    if (output_ == Output::kCounts) add(converter_pass(rig_));
  }

  const Scene& scene_;
  const Rig& rig_;
  Output output_;
  PassList list_;
};

}  // namespace

PassList build_passes(const Scene& scene, const Rig& rig, Output output) {
  return Builder(scene, rig, output).build();
}

}  // namespace weft::simulator
