// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <variant>

#include "simulator/scene/camera_keys.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"
#include "simulator/targets/pattern.h"

// The keys of [[target]]: a part of scene_keys.h.

namespace weft::simulator {

inline constexpr Range kTargetSize_mm = {0.1, 1e4};
inline constexpr Range kTargetGap_mm = {0, 1000};

template <typename Visitor>
void walk(Visitor& v, PaperSettings& p) {
  v.number({"width_mm", "mm", "Of the sheet"}, p.width_mm, kTargetSize_mm);
  v.number({"height_mm", "mm", "Of the sheet"}, p.height_mm, kTargetSize_mm);
}

template <typename Visitor>
void walk(Visitor& v, CheckerboardSettings& b) {
  v.integer({"squares_x", "", "Columns of squares"}, b.squares_x, 1, 100);
  v.integer({"squares_y", "", "Rows of squares"}, b.squares_y, 1, 100);
  v.number({"square_mm", "mm", "Side of a square"}, b.square_mm, kTargetSize_mm);
  v.number({"margin_mm", "mm", "White, around the squares"}, b.margin_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, CharucoSettings& b) {
  v.integer({"squares_x", "", "Columns of squares"}, b.squares_x, 2, 100);
  v.integer({"squares_y", "", "Rows of squares"}, b.squares_y, 2, 100);
  v.number({"square_mm", "mm", "Side of a square"}, b.square_mm, kTargetSize_mm);
  v.number({"marker_share", "", "Side of a marker over that of a square"}, b.marker_share, {0.1, 0.95});
  v.text({"dictionary", "", "As OpenCV names it, with enough markers for the squares"}, b.dictionary);
  v.number({"margin_mm", "mm", "White, around the squares"}, b.margin_mm, kTargetGap_mm);
  v.flag({"mirrored", "", "Printed as a mirror shows it"}, b.mirrored);
}

template <typename Visitor>
void walk(Visitor& v, GreyScaleSettings& g) {
  v.numbers(
      {"reflectances", "", "From left to right, 1 to 100 of them. The default is Munsell 9.5 and 9 to 2"},
      g.reflectances, kShare);
  v.number({"patch_mm", "mm", "Side of a patch"}, g.patch_mm, kTargetSize_mm);
  v.number({"gap_mm", "mm", "Between patches"}, g.gap_mm, kTargetGap_mm);
  v.number({"margin_mm", "mm", "White, around the patches"}, g.margin_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, ChartSettings& c) {
  v.number({"patch_mm", "mm", "Side of a patch"}, c.patch_mm, kTargetSize_mm);
  v.number({"gap_mm", "mm", "Between patches"}, c.gap_mm, kTargetGap_mm);
  v.number({"frame_mm", "mm", "Black, around the patches"}, c.frame_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, TagSettings& t) {
  v.text({"dictionary", "", "As OpenCV names it"}, t.dictionary);
  v.integer({"id", "", "Below what the dictionary holds"}, t.id, 0, std::numeric_limits<int>::max());
  v.number({"side_mm", "mm", "Of the marker with its black border"}, t.side_mm, kTargetSize_mm);
  v.number({"margin_mm", "mm", "White, around the marker"}, t.margin_mm, kTargetGap_mm);
}

template <typename Visitor>
void walk(Visitor& v, SheetSettings& s) {
  v.number({"waviness_deg", "degrees", "Rms angle of its slow waves to the plane"}, s.waviness_deg, {0, 10});
  v.number({"wavelength_mm", "mm", "Of the waves, about"}, s.wavelength_mm, {1, 1e4});
  v.number({"grain_percent", "percent", "Rms of the albedo of a grain over its mean"}, s.grain_percent,
           {0, 20});
  v.number({"grain_deg", "degrees", "Rms angle of a grain to the sheet"}, s.grain_deg, {0, 20});
  v.number({"grain_mm", "mm", "Side of a grain"}, s.grain_mm, {0.01, 10});
  v.number({"non_lambertian", "", "δ of 1 - δ (1 - n·l), what the sheet reflects over Lambert's law"},
           s.non_lambertian, {-0.5, 1});
}

template <typename Visitor>
void walk(Visitor& v, TargetSettings& t) {
  choose(v,
         {"kind", "",
          "`paper`: a blank sheet, or as a small one a white patch. `checkerboard`: the square at the upper "
          "left is black. `charuco`: as OpenCV 4.6 draws it. `grey_scale`: a row of patches. `chart`: 6 x 4 "
          "patches of `chart` of `[spectra]` in a black frame. `tag`: one marker"},
         t.pattern, {"paper", "checkerboard", "charuco", "grey_scale", "chart", "tag"});
  std::visit([&](auto& pattern) { walk(v, pattern); }, t.pattern);
  v.require(make_pattern(t.pattern), "kind");
  v.vec3({"centre_mm", "mm", "Of the sheet. A target below the cloth is hidden"}, t.centre_mm,
         kCoordinate_mm);
  v.number({"tilt_deg", "degrees", "Between its normal and z"}, t.tilt_deg, {0, 85});
  v.number({"azimuth_deg", "degrees", "Of its normal's horizontal part, from x towards y"}, t.azimuth_deg,
           kAngle_deg);
  v.number({"rotation_deg", "degrees", "In its plane, counterclockwise"}, t.rotation_deg, kAngle_deg);
  v.number({"white", "", "Reflectance of the sheet"}, t.white, kShare);
  v.number({"black", "", "Reflectance of black ink"}, t.black, kShare);
  v.section("sheet", "What a target is printed on", t.sheet);
}

template <typename Visitor>
void walk(Visitor& v, BallSettings& b) {
  v.choice(
      {"surface", "", "`chrome` and `glossy` (black glass) mirror a lamp, `matt` shades"}, b.surface,
      {{"matt", BallSurface::kMatt}, {"glossy", BallSurface::kGlossy}, {"chrome", BallSurface::kChrome}});
  v.vec3({"centre_mm", "mm", "Of the ball"}, b.centre_mm, kCoordinate_mm);
  v.number({"radius_mm", "mm", "From its centre to its surface"}, b.radius_mm, {0.1, 1000});
  v.number({"albedo", "", "Of what does not mirror"}, b.albedo, {0.001, 1});
  v.number({"highlight_deg", "degrees", "Standard deviation of a mirrored lamp's brightness"},
           b.highlight_deg, {0.1, 10});
}

}  // namespace weft::simulator
