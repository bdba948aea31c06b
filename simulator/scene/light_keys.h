// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "simulator/light/measured_rig.h"
#include "simulator/scene/camera_keys.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"

// The keys of [lights], [films] and [spectra]: a part of scene_keys.h.

namespace weft::simulator {

inline constexpr Range kFlux = {0, 1e12};
inline constexpr Range kLeak = {0, 0.5};
inline constexpr int kChartPatches = 24;

template <typename Visitor>
void walk(Visitor& v, LedRing& r) {
  v.integer({"count", "LEDs", "Evenly on a circle, aimed at the table's centre"}, r.count, 1, 256);
  v.number({"zenith_deg", "degrees", "Between a LED and z, seen from the table's centre"}, r.zenith_deg,
           {0, 89});
  v.number({"azimuth_deg", "degrees", "Of the first LED, from x towards y"}, r.azimuth_deg, kAngle_deg);
  v.number({"distance_mm", "mm", "From the table's centre"}, r.distance_mm, {10, 1e4});
}

template <typename Visitor>
void walk(Visitor& v, LedSettings& l) {
  v.vec3({"position_mm", "mm", "Above table and cloth", "must be said"}, l.position_mm, kCoordinate_mm);
  v.vec3({"aim", "", "Direction from the LED to the table, of any length above 0", "at the table's centre"},
         l.aim, kCoordinate_mm);
  v.require(!l.aim || length(*l.aim) > 1e-6, "aim", "it must be longer than 0");
  v.number({"mu", "", "Its own lobe", "`mu` of `[lights]`"}, l.mu, {0, 100});
  v.rgb({"flux_rgb", "mm² / s", "Its own Φ by channel", "`flux` times `white_balance`"}, l.flux_rgb, kFlux);
}

/// The lights, and how far the camera is in whose frame a measured rig may be.
struct LightSection {
  LightSettings& lights;
  double camera_distance_mm;
};

template <typename Visitor>
void walk(Visitor& v, LightSection& s) {
  LightSettings& l = s.lights;
  v.number({"flux", "mm² / s", "Φ of the green channel"}, l.flux, kFlux);
  v.rgb({"white_balance", "", "Φ by channel over `flux`, as a camera sees a white LED"}, l.white_balance,
        {1e-3, 100});
  v.number({"mu", "", "Lobe: 0 isotropic, 1 Lambertian, above narrower"}, l.mu, {0, 100});
  v.number({"led_radius_mm", "mm", "`finite_led`: LEDs are spheres"}, l.led_radius_mm, {0, 100});
  v.number({"drift", "",
            "`led_drift`: share of its light that the last LED has lost in its shot against the first in its "
            "own. A repeat shot after it goes on fading"},
           l.drift, {0, 0.5});
  v.number({"flicker", "", "`led_drift`: standard deviation of a shot's brightness, relative"}, l.flicker,
           {0, 0.1});
  v.number({"stray", "",
            "`stray`: light by way of the rig, evenly from all sides, over what a white surface at the "
            "table's centre that faces the LED gets"},
           l.stray, kShare);
  v.number({"ambient", "", "`ambient`: light of the room, in the unit of `stray` for the brightest LED"},
           l.ambient, kShare);
  std::optional<std::string> rig;
  v.file({"rig", "",
          "A JSON file of measured LEDs, which stand before those of `[[lights.led]]`: `lights.json` of a "
          "calibration, or `{\"leds\": [{\"position_mm\", \"direction\", \"mu\", \"flux_rgb\"}]}` in the "
          "frame of a camera (x right, y down, z away from it) straight above the table's centre at "
          "`distance_mm`. `truth/scene.toml` has its numbers in its place"},
         rig);
  if (rig) {
    const Result<std::vector<NearLight>> measured = read_measured_rig(*rig, s.camera_distance_mm);
    v.require(measured, "rig");
    if (measured) {
      for (const NearLight& led : *measured)
        l.leds.push_back({led.position_mm, led.aim, led.mu, led.flux_rgb});
    }
  }
  v.list("ring", "LEDs on a circle", l.rings);
  v.list("led", "One LED", l.leds);
}

template <typename Visitor>
void walk(Visitor& v, FilmSettings& f) {
  v.choice({"states", "",
            "How the lens's film stands to those of the LEDs. `both`: every LED is photographed crossed, and "
            "once more parallel at the end, as `weft scan --polariser crossed,parallel` does"},
           f.states,
           {{"none", FilmStates::kNone},
            {"crossed", FilmStates::kCrossed},
            {"parallel", FilmStates::kParallel},
            {"both", FilmStates::kBoth}});
  v.number({"leak", "", "What crossed films let through of polarised light, over what parallel ones do"},
           f.leak, kLeak);
  v.number({"transmission", "", "Of one film, for light along its axis"}, f.transmission, {0.1, 1});
}

template <typename Visitor>
void walk(Visitor& v, SpectraSettings& s) {
  v.spectrum({"led", "", "What the LEDs send, relative to their peak", "1 everywhere"}, s.led);
  v.spectra({"filters", "", "What the camera's red, green and blue channels pass", "nothing passes"},
            s.filters);
  v.chart({"chart", "",
           "What the patches of a chart reflect, row by row. A folder has them as `01.txt` to `24.txt`"},
          s.chart, kChartPatches);
}

}  // namespace weft::simulator
