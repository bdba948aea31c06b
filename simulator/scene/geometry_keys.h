// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "simulator/geometry/knit.h"
#include "simulator/geometry/weave.h"
#include "simulator/scene/camera_keys.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_key.h"

// The keys of [geometry] and of its sections: a part of scene_keys.h.

namespace weft::simulator {

inline constexpr Range kHeight_mm = {-1000, 1000};

template <typename Visitor>
void walk(Visitor& v, PicturePlacement& p) {
  v.number({"mm_per_sample", "mm", "From one sample to the next"}, p.mm_per_sample, {1e-4, 1000});
  v.number({"offset_x_mm", "mm", "Where the picture's centre lies, x"}, p.offset_x_mm, kCoordinate_mm);
  v.number({"offset_y_mm", "mm", "Where the picture's centre lies, y"}, p.offset_y_mm, kCoordinate_mm);
  v.number({"rotation_deg", "degrees", "Of the picture's x axis, from x towards y"}, p.rotation_deg,
           kAngle_deg);
  v.flag({"repeats", "",
          "In both directions. Else heights go on at the border as they are there, and no print does"},
         p.repeats);
}

/// The part of GeometrySettings that is a section of its own.
struct HeightMapSection {
  GeometrySettings& geometry;
};

inline bool heights_are_in_range(const Image<float>& heights_mm) {
  for (int y = 0; y < heights_mm.height(); ++y) {
    const float* row = &heights_mm(0, y);
    if (!std::all_of(row, row + heights_mm.width(), [](float h) { return std::abs(h) <= kHeight_mm.most; }))
      return false;
  }
  return true;
}

template <typename Visitor>
void walk(Visitor& v, HeightMapSection& s) {
  GeometrySettings& g = s.geometry;
  v.picture({"file", "",
             "A picture of one channel, each sample a height in mm from -1000 to 1000: EXR or float TIFF, as "
             "full scale of an integer is 1 mm",
             "must be said"},
            g.heights_file, g.heights_mm);
  v.require(g.heights_mm || !g.heights_file.empty(), "file", "a picture of heights was expected");
  if (g.heights_mm) {
    const Result<void> checked = check_heights(g);
    v.require(checked, "file");
    v.require(!checked || heights_are_in_range(*g.heights_mm), "file",
              "its heights are not between -1000 and 1000 mm");
  }
  walk(v, g.height_map);
}

template <typename Visitor>
void walk(Visitor& v, Fold& f) {
  v.number({"amplitude_mm", "mm", "Of parallel crests, one through the table's centre"}, f.amplitude_mm,
           kHeight_mm);
  v.number({"wavelength_mm", "mm", "From crest to crest"}, f.wavelength_mm, {1e-3, 1e5});
  v.number({"direction_deg", "degrees", "Across the crests, from x towards y"}, f.direction_deg, kAngle_deg);
  v.number({"sharpness", "", "A crest's standard deviation is wavelength / (2π √sharpness)"}, f.sharpness,
           {0.1, 50});
}

template <typename Visitor>
void walk(Visitor& v, Wave& w) {
  v.number({"amplitude_mm", "mm", "Of a sine"}, w.amplitude_mm, kHeight_mm);
  v.number({"wavelength_mm", "mm", "From crest to crest"}, w.wavelength_mm, {1e-3, 1e5});
  v.number({"direction_deg", "degrees", "Across the crests, from x towards y"}, w.direction_deg, kAngle_deg);
  v.number({"phase_deg", "degrees", "At the table's centre"}, w.phase_deg, kAngle_deg);
}

template <typename Visitor>
void walk_weave(Visitor& v, GeometrySettings& g) {
  const Draft usual = draft_of(g);
  v.number({"warp_pitch_mm", "mm", "From one warp yarn, which runs along y, to the next"}, g.warp_pitch_mm,
           {0.01, 100});
  v.number({"weft_pitch_mm", "mm", "From one weft yarn, which runs along x, to the next"}, g.weft_pitch_mm,
           {0.01, 100});
  if (g.kind != GeometryKind::kPlain) {
    v.integer({"over", "yarns",
               "Warp yarn i lies over weft yarn j where (j - `step` i) mod (`over` + `under`) < `over`",
               std::to_string(usual.over)},
              g.over, 1, 32);
    v.integer({"under", "yarns", "As `over` says", std::to_string(usual.under)}, g.under, 1, 32);
    v.integer({"step", "yarns", "As `over` says. Below `over` + `under`", std::to_string(usual.step)}, g.step,
              1, 63);
    const Draft draft = draft_of(g);
    v.require(draft.step < draft.period(), "step", "it must be below \"over\" + \"under\"");
  }
  v.number({"crimp", "pitches",
            "How far a yarn's axis rises over and falls under its mean. No more than keeps yarns below their "
            "neighbours' crests"},
           g.crimp, {0, 0.5});
  v.number({"flank_deg", "degrees", "Slope of a yarn's flank half a pitch from its axis"}, g.flank_deg,
           {5, 80});
  v.number({"twist_relief", "pitches", "Amplitude of the ridges that the plies of a yarn make"},
           g.twist_relief, {0, 0.1});
  v.number({"flatness", "", "Share of a yarn's width that is flat on top"}, g.flatness, {0, 0.9});
  v.number({"fibre_relief", "pitches", "No fibre rises or sinks by more than this"}, g.fibre_relief,
           {0, 0.05});
  v.number(
      {"fibre_spacing", "pitches", "Between fibres, across the yarn. A few pixels at least, or it is noise"},
      g.fibre_spacing, {0.01, 1});
  v.number({"fibre_angle_deg", "degrees", "Between fibres and the yarn's axis"}, g.fibre_angle_deg,
           {-60, 60});
  v.integer({"fibre_seed", "", "Of the fibres alone"}, g.fibre_seed, 0,
            std::numeric_limits<std::int64_t>::max());
  v.require(yarns_stay_beside_their_neighbours(g), "crimp",
            "a yarn on top would cover its neighbours: lower it, \"twist_relief\" or \"fibre_relief\", or "
            "raise \"flank_deg\"");
}

template <typename Visitor>
void walk_knit(Visitor& v, GeometrySettings& g) {
  v.number({"wale_mm", "mm", "From one column of loops to the next, along x"}, g.wale_mm, {0.01, 100});
  v.number({"course_mm", "mm", "From one row of loops to the next, along y. Half of `wale_mm` to twice that"},
           g.course_mm, {0.01, 100});
  v.require(loops_reach_their_neighbours_only(g), "course_mm",
            "it must be between half of \"wale_mm\" and twice that");
  v.number({"yarn_diameter", "wales", "Of the round yarn"}, g.yarn_diameter, {0.1, 1});
  v.number({"loop_flank_deg", "degrees", "Slope of a yarn where its section stops being round"},
           g.loop_flank_deg, {5, 80});
}

template <typename Visitor>
void walk(Visitor& v, GeometrySettings& g) {
  std::optional<Family> family;
  v.choice({"family", "",
            "Starts from one of three plain weaves that results are quoted for: mean slope 7, 19, 36 "
            "degrees. Other keys override it, `kind` only by another weave. `truth/scene.toml` has its "
            "numbers in its place"},
           family, {{"smooth", Family::kSmooth}, {"plain", Family::kPlain}, {"deep", Family::kDeep}});
  if (family) g = family_settings(*family);
  v.kind({"kind", "",
          "A level card, a tilted one, three woven cloths, a plain stitch, a ball or a rod sunk into the "
          "table, or heights from a picture"},
         g.kind,
         {{"flat", GeometryKind::kFlat},
          {"tilted", GeometryKind::kTilted},
          {"plain", GeometryKind::kPlain},
          {"twill", GeometryKind::kTwill},
          {"satin", GeometryKind::kSatin},
          {"knit", GeometryKind::kKnit},
          {"sphere", GeometryKind::kSphere},
          {"cylinder", GeometryKind::kCylinder},
          {"height_map", GeometryKind::kHeightMap}});
  v.require(!family || is_woven(g.kind), "family", "it is a weave, and this kind of geometry is none");
  v.number({"cloth_height_mm", "mm", "Of the plane that heights are measured from, above the table"},
           g.cloth_height_mm, {-100, 1000});
  if (g.kind == GeometryKind::kTilted)
    v.number({"tilt_deg", "degrees", "Between the normal and z"}, g.tilt_deg, {0, 85});
  if (g.kind == GeometryKind::kTilted || g.kind == GeometryKind::kCylinder)
    v.number({"azimuth_deg", "degrees", "`tilted`: of the normal's horizontal part. `cylinder`: of its axis"},
             g.azimuth_deg, kAngle_deg);
  if (is_woven(g.kind)) walk_weave(v, g);
  if (g.kind == GeometryKind::kKnit) walk_knit(v, g);
  if (g.kind == GeometryKind::kSphere || g.kind == GeometryKind::kCylinder) {
    v.number({"radius_mm", "mm", "Of the ball or the rod"}, g.radius_mm, {0.1, 1000});
    v.number({"contact_deg", "degrees", "Slope where the body meets the table"}, g.contact_deg, {5, 89});
  }
  if (g.kind == GeometryKind::kHeightMap) {
    HeightMapSection height_map = {g};
    v.section("height_map", "Heights from a picture, of the kind `height_map`", height_map);
  }
  v.list("fold", "Parallel folds, added to any kind and to the folds before", g.folds);
  v.list("wave", "A slow wave, added to any kind and to the waves before", g.waves);
}

}  // namespace weft::simulator
