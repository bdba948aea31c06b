// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "simulator/camera/saturation.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"

// The keys of [camera] and of its sections: a part of scene_keys.h.

namespace weft::simulator {

inline constexpr Range kShare = {0, 1};
inline constexpr Range kCoordinate_mm = {-1e4, 1e4};
inline constexpr Range kAngle_deg = {-360, 360};

template <typename Visitor>
void walk(Visitor& v, PoseSettings& p) {
  v.number({"tilt_deg", "degrees", "Between the line of sight and z"}, p.tilt_deg, {0, 80});
  v.number({"azimuth_deg", "degrees", "Where the tilted camera stands, from x towards y"}, p.azimuth_deg,
           kAngle_deg);
  v.number({"roll_deg", "degrees", "About its line of sight, clockwise as seen from the camera"}, p.roll_deg,
           kAngle_deg);
  v.number({"x_mm", "mm", "The point of the table that it looks at"}, p.x_mm, kCoordinate_mm);
  v.number({"y_mm", "mm", "The point of the table that it looks at"}, p.y_mm, kCoordinate_mm);
}

template <typename Visitor>
void walk(Visitor& v, LensSettings& l) {
  v.number({"k1", "", "Radial distortion, as OpenCV has it. What folds the picture is refused"}, l.k1,
           {-10, 10});
  v.number({"k2", "", "Radial, of the fourth power of the distance"}, l.k2, {-10, 10});
  v.number({"k3", "", "Radial, of the sixth power"}, l.k3, {-10, 10});
  v.number({"p1", "", "Tangential distortion, as OpenCV has it"}, l.p1, {-1, 1});
  v.number({"p2", "", "Tangential"}, l.p2, {-1, 1});
  v.number({"offset_x_px", "pixels", "Of the principal point from the frame's centre, right"}, l.offset_x_px,
           {-5000, 5000});
  v.number({"offset_y_px", "pixels", "Of the principal point from the frame's centre, down"}, l.offset_y_px,
           {-5000, 5000});
}

template <typename Visitor>
void walk(Visitor& v, RetakeSettings& r) {
  v.flag({"repeat", "", "Takes LED 1 once more after the last LED, as a `repeat` shot"}, r.repeat);
  v.number({"bracket", "",
            "Takes every LED once more for so many times the exposure, as `bracket` shots. The calibration's "
            "`exposure_ratios` have what that gathers"},
           r.bracket, {1e-3, 100});
  v.number({"shutter_error", "",
            "Share of light that a bracket gathers beyond what its recorded time says. So does a photograph "
            "of `--captures` at another exposure than the scene's"},
           r.shutter_error, {-0.5, 1});
}

template <typename Visitor>
void walk(Visitor& v, MovementSettings& m) {
  v.number({"sigma_mm", "mm", "Standard deviation of a shift between shots, along x and along y"}, m.sigma_mm,
           {0, 100});
  v.number({"sigma_deg", "degrees", "Standard deviation of the turn about the table's centre"}, m.sigma_deg,
           {0, 45});
}

template <typename Visitor>
void walk(Visitor& v, VignetteSettings& s) {
  v.number({"cosine_power", "", "Natural vignetting: the cosine of the angle to the axis to this power"},
           s.cosine_power, {0, 8});
  v.number({"corner_loss", "", "Mechanical vignetting: share lost in the farthest corner"}, s.corner_loss,
           {0, 0.5});
}

template <typename Visitor>
void walk(Visitor& v, BlurSettings& b) {
  v.number({"defocus_px", "pixels", "Diameter of the circle of confusion"}, b.defocus_px, {0, 32});
  v.number({"spread_px", "pixels", "Standard deviation of the point spread"}, b.spread_px, {0, 5});
  v.number({"halo_share", "", "Share of the light that goes into a disc around the point"}, b.halo_share,
           {0, 0.5});
  v.number({"halo_radius_px", "pixels", "Of that disc. Cost grows with its square"}, b.halo_radius_px,
           {1, 40});
}

template <typename Visitor>
void walk(Visitor& v, FieldSettings& f) {
  v.number({"corner_px", "pixels",
            "Diameter of the circle of confusion in the farthest corner. It grows with the square of the "
            "distance from the axis"},
           f.corner_px, {0, 16});
}

template <typename Visitor>
void walk(Visitor& v, ChromaticSettings& c) {
  v.number({"red_px", "pixels",
            "How much nearer to the axis a red photosite looks than a green one, in the farthest corner. "
            "Elsewhere in proportion to the distance from the axis"},
           c.red_px, {-10, 10});
  v.number({"blue_px", "pixels", "The same of a blue photosite"}, c.blue_px, {-10, 10});
}

template <typename Visitor>
void walk(Visitor& v, VeilSettings& s) {
  v.number({"share", "", "Of the frame's mean light, added all over the frame"}, s.share, {0, 0.2});
  v.number({"spread", "frame diagonals",
            "Standard deviation of how far the light of a point goes. 10 is everywhere alike"},
           s.spread, {0.05, 10});
}

template <typename Visitor>
void walk(Visitor& v, BloomSettings& b) {
  v.number({"share", "", "Of the charge above a full well that spills along the column"}, b.share, kShare);
  v.number({"decay", "", "Of the spill from one photosite to the next"}, b.decay, {0, 0.9});
}

template <typename Visitor>
void walk(Visitor& v, DefectSettings& d) {
  v.number({"dark_electrons_per_s", "electrons / s", "`dark_current`: of a photosite at 25 °C"},
           d.dark_electrons_per_s, {0, 1e6});
  v.number({"temperature_c", "°C", "`dark_current`: of the sensor"}, d.temperature_c, {-50, 100});
  v.number({"dark_doubling_c", "°C", "`dark_current`: warming that doubles dark current and hot photosites"},
           d.dark_doubling_c, {2, 20});
  v.number({"response_percent", "percent", "`uneven_response`: standard deviation of a photosite's response"},
           d.response_percent, {0, 20});
  v.number({"column_counts", "counts", "`uneven_response`: standard deviation of a column's black level"},
           d.column_counts, {0, 1000});
  v.number(
      {"photosite_counts", "counts", "`uneven_response`: standard deviation of a photosite's black level"},
      d.photosite_counts, {0, 1000});
  auto& [top, bottom] = d.cell_counts;
  std::array<double, 4> cell = {top[0], top[1], bottom[0], bottom[1]};
  v.numbers({"cell_counts", "counts",
             "`uneven_response`: black level of the photosites of a cell: upper left, upper right, lower "
             "left, lower right"},
            cell, {-1000, 1000});
  top = {cell[0], cell[1]};
  bottom = {cell[2], cell[3]};
  v.number({"hot_per_million", "", "`dark_current`: photosites with more dark current"}, d.hot_per_million,
           {0, 1e5});
  v.number(
      {"hot_electrons_per_s", "electrons / s", "`dark_current`: mean of what hot photosites have, at 25 °C"},
      d.hot_electrons_per_s, {0, 1e9});
  v.number({"dead_per_million", "", "`dark_current`: photosites that see too little"}, d.dead_per_million,
           {0, 1e5});
  v.number({"dead_response", "", "`dark_current`: share of the light that dead photosites see"},
           d.dead_response, {0, 0.9});
}

template <typename Visitor>
void walk(Visitor& v, CameraSettings& c) {
  v.integer({"width", "photosites", "Of the frame, even. The cloth is always larger"}, c.width, 2, 20000);
  v.require(c.width % 2 == 0, "width", "it must be even, as a mosaic has whole 2 x 2 cells");
  v.integer({"height", "photosites", "Of the frame, even"}, c.height, 2, 20000);
  v.require(c.height % 2 == 0, "height", "it must be even, as a mosaic has whole 2 x 2 cells");
  v.number({"mm_per_pixel", "mm", "On the table, z = 0, where the camera looks"}, c.mm_per_pixel, {1e-4, 10});
  v.number({"distance_mm", "mm", "From where the camera looks to its projection centre"}, c.distance_mm,
           {10, 1e4});
  v.choice({"body", "",
            "`offset`: black 600, white 15520 counts. `d5100`: black is subtracted and clipped at 0, white "
            "15846, as a Nikon D5100 stores it. `d80`: the same by another name"},
           c.body, {{"offset", Body::kOffset}, {"d5100", Body::kD5100}, {"d80", Body::kD80}});
  v.integer(
      {"bits", "",
       "Of the converter: 12, 14 or 16. Black and white of `body` are those of 14 bits and scale with it"},
      c.bits, 12, 16);
  v.require(c.bits % 2 == 0, "bits", "it must be 12, 14 or 16");
  v.number({"full_well_electrons", "electrons", "Of a photosite at white, at ISO 100. Less at higher ISO"},
           c.full_well_electrons, {100, 1e9});
  v.number({"read_noise_electrons", "electrons", "Standard deviation"}, c.read_noise_electrons, {0, 1000});
  v.number({"iso", "", "Speed"}, c.iso, {100, 25600});
  v.number({"f_number", "", "Recorded. `flux` is what arrives through this aperture"}, c.f_number, {0.5, 64});
  v.number({"exposure_us", "µs", "Of every shot, rounded to whole microseconds", "by `albedo_at_full`"},
           c.exposure_us, {1, 1e9});
  v.number({"albedo_at_full", "",
            "Chooses the exposure where there is no `exposure_us`: this albedo, at the table's centre and "
            "facing a LED, gives 0.90 of full scale in the brightest channel of the brightest LED. That of "
            "the cloth adapts the exposure to it"},
           c.albedo_at_full, {1e-3, 1});
  v.numbers({"linearity", "",
             "`nonlinearity`: [a, b] of v (1 + a v + b v²), which makes light of counts v from 0 to 1. It "
             "must rise everywhere"},
            c.linearity, {-1, 1});
  v.require(NonLinearity::of(c.linearity), "linearity");
  v.section("pose", "Where the camera stands that does not stand straight above the table", c.pose);
  v.section("lens", "Effect `distortion`", c.lens);
  v.optional_section("retakes", "Shots beyond one a LED and the dark one", c.retakes);
  v.section("movement", "Effect `movement`", c.movement);
  v.section("vignette", "Effect `vignetting`", c.vignette);
  v.section("blur", "Effect `defocus`", c.blur);
  v.section("field", "Effect `field_curvature`", c.field);
  v.section("chromatic", "Effect `chromatic_aberration`", c.chromatic);
  v.section("veil", "Effect `veil`", c.veil);
  v.section("bloom", "Effect `bloom`", c.bloom);
  v.section("defects", "Effects `dark_current` and `uneven_response`", c.defects);
}

}  // namespace weft::simulator
