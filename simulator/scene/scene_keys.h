// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "simulator/scene/camera_keys.h"
#include "simulator/scene/cloth_keys.h"
#include "simulator/scene/geometry_keys.h"
#include "simulator/scene/light_keys.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"
#include "simulator/scene/target_keys.h"

// Every key of a scene, once: what reads, checks and writes scenes and what prints their page walks over
// these functions. Internal to simulator/scene.

namespace weft::simulator {

template <typename Visitor>
void walk(Visitor& v, TransportSettings& t) {
  v.integer({"shadow_rays", "rays", "`cast_shadows`, where `finite_led` runs: to a LED. A point takes one"},
            t.shadow_rays, 1, 65536);
  v.integer({"bounce_rays", "rays",
             "`interreflection`: directions in which each point looks for light of the cloth"},
            t.bounce_rays, 1, 65536);
  v.integer({"bounces", "", "`interreflection`: from cloth to cloth"}, t.bounces, 1, 64);
}

template <typename Visitor>
void walk(Visitor& v, DamageSettings& d) {
  v.kind({"kind", "",
          "`missing`: NaN. `saturated`: +infinity, in raw frames white. `black`: 0. `fade`: an exposure that "
          "falls"},
         d.kind,
         {{"missing", DamageKind::kMissing},
          {"saturated", DamageKind::kSaturated},
          {"black", DamageKind::kBlack},
          {"fade", DamageKind::kFade}});
  v.integer({"first_led", "", "First LED whose shots are damaged"}, d.first_led, 1, 256);
  v.integer({"last_led", "", "Last LED whose shots are damaged"}, d.last_led, 1, 256);
  v.require(d.first_led <= d.last_led, "last_led", "it must not be below \"first_led\"");
  v.number({"left", "", "Edge of the damaged part, in widths of the frame from its left"}, d.left, kShare);
  v.number({"right", "", "Edge of the damaged part. Not below `left`"}, d.right, kShare);
  v.require(d.left <= d.right, "right", "it must not be below \"left\"");
  v.number({"top", "", "Edge of the damaged part, in heights of the frame from its top"}, d.top, kShare);
  v.number({"bottom", "", "Edge of the damaged part. Not below `top`"}, d.bottom, kShare);
  v.require(d.top <= d.bottom, "bottom", "it must not be below \"top\"");
  if (d.kind == DamageKind::kFade)
    v.number({"decades", "", "Powers of ten by which the exposure falls from `top` to `bottom`"}, d.decades,
             {0, 30});
}

template <typename Visitor>
void walk(Visitor& v, EffectSettings& e) {
  for (const EffectKey& effect : effect_keys()) v.flag({effect.name, "", effect.says}, e.*effect.on);
}

template <typename Visitor>
void walk(Visitor& v, ClothPose& p) {
  v.number({"tilt_deg", "degrees", "Between cloth and table"}, p.tilt_deg, {0, kMostTilt_deg});
  v.number({"downhill_deg", "degrees", "Azimuth to which the cloth falls, from x towards y"}, p.downhill_deg,
           kAngle_deg);
}

template <typename Visitor>
void walk(Visitor& v, BladeSettings& b) {
  v.integer(
      {"led", "", "LED that is photographed once more with the blade, as a `blade` shot at the end; 0: none"},
      b.led, 0, 256);
  v.flag({"lies", "", "The blade lies there in every photograph"}, b.lies);
  v.number({"x_mm", "mm", "The middle of one of its long edges"}, b.x_mm, kCoordinate_mm);
  v.number({"y_mm", "mm", "The middle of one of its long edges"}, b.y_mm, kCoordinate_mm);
  v.number({"turn_deg", "degrees", "Azimuth along that edge, from x towards y: the blade lies to its left"},
           b.turn_deg, kAngle_deg);
  v.number({"height_mm", "mm", "Of the blade above the cloth"}, b.height_mm, {0.1, 200});
  v.number({"length_mm", "mm", "Of its long edges"}, b.length_mm, {1, 1e4});
  v.number({"width_mm", "mm", "Between them"}, b.width_mm, {0.1, 1e4});
  v.number({"albedo", "", "Of its upper side, which is matt"}, b.albedo, kShare);
}

template <typename Visitor>
void walk(Visitor& v, Scene& s) {
  v.text({"fabric", "", "Name of the cloth in `session.json`"}, s.fabric);
  v.integer({"seed", "", "Of all random numbers: the same seed gives the same bytes"}, s.seed, 0,
            std::numeric_limits<std::int64_t>::max());
  v.choice({"frames", "",
            "`dng`: raw mosaics of whole counts, as a camera stores them, and a dark one. `exr`: developed "
            "frames, linear R, G, B as floats, 1 at full scale, nothing clipped"},
           s.frames, {{"dng", FrameFormat::kDng}, {"exr", FrameFormat::kExr}});
  v.automatic(
      {"effects", "", "Which of `[effects]` run: a section of flags, a list of names, or `\"auto\"`"},
      {"to", "",
       "Beside `effects = \"auto\"` alone: how far off the frames may be, in standard deviations of their "
       "photon noise"},
      s.auto_to_sigma, kAutomaticRange);
  v.section("camera",
            "A camera with a Bayer mosaic (red, green / green, blue), straight above the table unless "
            "`[camera.pose]` tilts it",
            s.camera);
  v.section(
      "geometry",
      "The shape of the cloth. Lengths in pitches of yarns or in wales keep slopes the same at any scale",
      s.geometry);
  v.optional_section("pose",
                     "How the cloth lies that does not lie flat: tilted about the point of the z axis at "
                     "`cloth_height_mm`, with its folds and every target",
                     s.pose);
  v.section("material", "Colour and gloss of the cloth", s.material);
  LightSection lights = {s.lights, s.camera.distance_mm};
  v.section("lights",
            "A LED gives a point at distance d, in direction l from the point, Φ max(0, -l · aim)^mu / d² "
            "(no π): Φ is a reading times mm² per second at ISO 100",
            lights);
  v.optional_section("films",
                     "Linear polarisers before every LED and the lens. Without the section there are none",
                     s.films);
  v.optional_section("spectra", "For the effect `spectral` and for colour charts", s.spectra);
  v.section("transport",
            "How light is traced over the cloth. Errors fall with the root of the number of rays, cost grows "
            "with it",
            s.transport);
  v.list("target",
         "What lies beside the cloth or above it, in closed form: edges have their exact coverage in every "
         "pixel",
         s.targets);
  v.list("ball",
         "A ball over cloth and targets, which tells where lamps are. It throws no shadow and mirrors lamps "
         "alone",
         s.balls);
  v.optional_section("blade",
                     "A thin opaque strip with straight edges, level above the cloth: the edge of its shadow "
                     "tells how light spreads in the cloth",
                     s.blade);
  v.list("damage",
         "A fault that no rig should have, in the shots of some LEDs, after everything else and in the order "
         "of the file",
         s.damage);
  if (!s.auto_to_sigma)
    v.flags("effects", "What is simulated beyond the ideal picture, in the order of light", s.effects);
}

}  // namespace weft::simulator
