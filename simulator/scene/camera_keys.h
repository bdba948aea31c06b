// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "simulator/camera/saturation.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_reader.h"

// The keys of [camera] and of its sections: a part of scene_keys.h.

namespace weft::simulator {

inline constexpr Range kShare = {0, 1};
inline constexpr Range kCoordinate_mm = {-1e4, 1e4};
inline constexpr Range kAngle_deg = {-360, 360};

template <typename Visitor>
void walk(Visitor& v, PoseSettings& p) {
  v.number("tilt_deg", p.tilt_deg, {0, 80});
  v.number("azimuth_deg", p.azimuth_deg, kAngle_deg);
  v.number("roll_deg", p.roll_deg, kAngle_deg);
  v.number("x_mm", p.x_mm, kCoordinate_mm);
  v.number("y_mm", p.y_mm, kCoordinate_mm);
}

template <typename Visitor>
void walk(Visitor& v, LensSettings& l) {
  v.number("k1", l.k1, {-10, 10});
  v.number("k2", l.k2, {-10, 10});
  v.number("k3", l.k3, {-10, 10});
  v.number("p1", l.p1, {-1, 1});
  v.number("p2", l.p2, {-1, 1});
  v.number("offset_x_px", l.offset_x_px, {-5000, 5000});
  v.number("offset_y_px", l.offset_y_px, {-5000, 5000});
}

template <typename Visitor>
void walk(Visitor& v, RetakeSettings& r) {
  v.flag("repeat", r.repeat);
  v.number("bracket", r.bracket, {1e-3, 100});
  v.number("shutter_error", r.shutter_error, {-0.5, 1});
}

template <typename Visitor>
void walk(Visitor& v, MovementSettings& m) {
  v.number("sigma_mm", m.sigma_mm, {0, 100});
  v.number("sigma_deg", m.sigma_deg, {0, 45});
}

template <typename Visitor>
void walk(Visitor& v, VignetteSettings& s) {
  v.number("cosine_power", s.cosine_power, {0, 8});
  v.number("corner_loss", s.corner_loss, {0, 0.5});
}

template <typename Visitor>
void walk(Visitor& v, BlurSettings& b) {
  v.number("defocus_px", b.defocus_px, {0, 32});
  v.number("spread_px", b.spread_px, {0, 5});
  v.number("halo_share", b.halo_share, {0, 0.5});
  v.number("halo_radius_px", b.halo_radius_px, {1, 40});
}

template <typename Visitor>
void walk(Visitor& v, FieldSettings& f) {
  v.number("corner_px", f.corner_px, {0, 16});
}

template <typename Visitor>
void walk(Visitor& v, ChromaticSettings& c) {
  v.number("red_px", c.red_px, {-10, 10});
  v.number("blue_px", c.blue_px, {-10, 10});
}

template <typename Visitor>
void walk(Visitor& v, VeilSettings& s) {
  v.number("share", s.share, {0, 0.2});
  v.number("spread", s.spread, {0.05, 10});
}

template <typename Visitor>
void walk(Visitor& v, BloomSettings& b) {
  v.number("share", b.share, kShare);
  v.number("decay", b.decay, {0, 0.9});
}

template <typename Visitor>
void walk(Visitor& v, DefectSettings& d) {
  v.number("dark_electrons_per_s", d.dark_electrons_per_s, {0, 1e6});
  v.number("temperature_c", d.temperature_c, {-50, 100});
  v.number("dark_doubling_c", d.dark_doubling_c, {2, 20});
  v.number("response_percent", d.response_percent, {0, 20});
  v.number("column_counts", d.column_counts, {0, 1000});
  v.number("photosite_counts", d.photosite_counts, {0, 1000});
  auto& [top, bottom] = d.cell_counts;
  std::array<double, 4> cell = {top[0], top[1], bottom[0], bottom[1]};
  v.numbers("cell_counts", cell, {-1000, 1000});
  top = {cell[0], cell[1]};
  bottom = {cell[2], cell[3]};
  v.number("hot_per_million", d.hot_per_million, {0, 1e5});
  v.number("hot_electrons_per_s", d.hot_electrons_per_s, {0, 1e9});
  v.number("dead_per_million", d.dead_per_million, {0, 1e5});
  v.number("dead_response", d.dead_response, {0, 0.9});
}

template <typename Visitor>
void walk(Visitor& v, CameraSettings& c) {
  v.integer("width", c.width, 2, 20000);
  v.require(c.width % 2 == 0, "width", "it must be even, as a mosaic has whole 2 x 2 cells");
  v.integer("height", c.height, 2, 20000);
  v.require(c.height % 2 == 0, "height", "it must be even, as a mosaic has whole 2 x 2 cells");
  v.number("mm_per_pixel", c.mm_per_pixel, {1e-4, 10});
  v.number("distance_mm", c.distance_mm, {10, 1e4});
  v.choice("body", c.body, {{"offset", Body::kOffset}, {"d5100", Body::kD5100}, {"d80", Body::kD80}});
  v.integer("bits", c.bits, 12, 16);
  v.require(c.bits % 2 == 0, "bits", "it must be 12, 14 or 16");
  v.number("full_well_electrons", c.full_well_electrons, {100, 1e9});
  v.number("read_noise_electrons", c.read_noise_electrons, {0, 1000});
  v.number("iso", c.iso, {100, 25600});
  v.number("f_number", c.f_number, {0.5, 64});
  v.number("exposure_us", c.exposure_us, {1, 1e9});
  v.number("albedo_at_full", c.albedo_at_full, {1e-3, 1});
  v.numbers("linearity", c.linearity, {-1, 1});
  v.require(NonLinearity::of(c.linearity), "linearity");
  v.section("pose", c.pose);
  v.section("lens", c.lens);
  v.optional_section("retakes", c.retakes);
  v.section("movement", c.movement);
  v.section("vignette", c.vignette);
  v.section("blur", c.blur);
  v.section("field", c.field);
  v.section("chromatic", c.chromatic);
  v.section("veil", c.veil);
  v.section("bloom", c.bloom);
  v.section("defects", c.defects);
}

}  // namespace weft::simulator
