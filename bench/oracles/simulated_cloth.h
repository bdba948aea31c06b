// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"

namespace weft::test {

/// What lights a photograph: how much of each LED's light and how much of the room's reaches it.
struct Lighting {
  std::map<int, double> leds;  ///< LED from 1: 1 is all of it
  double room = 0;             ///< 1: as bright as LED 1 on average
};

/// A scene that is over twice as wide seen from further away, and with few rays for its bounces.
simulator::Scene seen_from_afar(simulator::Scene scene, int width);

/// A cloth under the LEDs of a scene, rendered once without noise; every photograph is a sum of that with the
/// noise of its own take.
class SimulatedCloth {
 public:
  explicit SimulatedCloth(simulator::Scene scene);
  RawFrame photograph(const Lighting& lighting, double exposure_us, std::uint32_t take) const;

  int leds() const { return static_cast<int>(calibration_.lights ? light_count(*calibration_.lights) : 0); }
  const Calibration& calibration() const { return calibration_; }
  double scene_exposure_us() const { return rig_.exposure_us; }

 private:
  simulator::Scene scene_;
  simulator::SceneRig rig_;
  simulator::Rendering rendering_;
  Calibration calibration_;
};

}  // namespace weft::test
