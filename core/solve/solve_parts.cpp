// SPDX-License-Identifier: Apache-2.0
#include "core/solve/solve_parts.h"

namespace weft {

void describe(Fields& fields, SolvedShot& s) {
  fields.value({"led", "That was lit; 0: none", {}, kMustSay}, s.led);
  fields.value({"file", "Relative to the session", {}, kMustSay}, s.file);
  fields.value({"sha256", "Of its bytes", {}, kMustSay}, s.sha256);
  fields.value({"exposure_us", "Microseconds"}, s.exposure_us);
  fields.value({"iso", "Speed"}, s.iso);
  fields.value({"f_number", "Aperture"}, s.f_number);
}

void describe(Fields& fields, DistantPhotograph& p) {
  fields.value({"file", "Its name", {}, kMustSay}, p.file);
  fields.value({"sha256", "Of its bytes", {}, kMustSay}, p.sha256);
  fields.value({"direction", "To the light: x to the right, y up, z to the camera", {}, kMustSay},
               p.direction);
  fields.value({"irradiance_rgb", "That the photograph is divided by", {}, kMustSay}, p.irradiance_rgb);
  fields.value({"distance_mm", "Of a near light from the middle of the picture", {}, kUnlessEmpty},
               p.distance_mm);
}

void describe(Fields& fields, SolveInput& i) {
  fields.value({"session", "Of a session: its fabric"}, i.session);
  fields.value({"calibration", "Of a session: the calibration's id"}, i.calibration);
  fields.value({"cloth_height_mm", "Of a session: the cloth's surface above the table, mm"},
               i.cloth_height_mm);
  fields.list({"shots", "Of a session: its photographs", {}, kUnlessEmpty}, i.shots);
  fields.object({"pose", "Of a cloth that does not lie flat", {}, kUnlessEmpty}, i.pose);
  fields.list({"photographs", "Under distant lights", {}, kUnlessEmpty}, i.photographs);
  fields.value({"transfer", "How their values follow light", {}, kUnlessEmpty}, i.transfer);
  fields.value({"orientation", "Of TIFF and EXIF, 2 to 8, by which they were turned", {}, kUnlessEmpty},
               i.orientation);
  fields.value({"mm_per_pixel", "Of the cloth, under near lights", {}, kUnlessEmpty}, i.mm_per_pixel);
  fields.value({"fov_deg", "Of the picture's width, under near lights", {}, kUnlessEmpty}, i.fov_deg);
  fields.value({"flip", "What was done to directions of lights", {}, kUnlessEmpty}, i.flip);
  fields.value({"dark", "SHA-256 of the one with all lamps off", {}, kUnlessEmpty}, i.dark);
  fields.value({"ambient", "Light that was taken from all, a share of full scale", {}, kUnlessEmpty},
               i.ambient);
  fields.value({"mask", "SHA-256 of their mask", {}, kUnlessEmpty}, i.mask);
  fields.value({"second_pose", "The same of a session in another pose", {}, kUnlessEmpty}, i.second_pose);
}

void describe(Fields& fields, ConditionedLed& l) {
  fields.value({"led", "Its number", {}, kMustSay}, l.led);
  fields.value({"factor", "Brightness over the calibration's", {}, kMustSay}, l.factor);
  fields.value({"from", "patches or repeat"}, l.from);
}

void describe(Fields& fields, UnusedLed& l) {
  fields.value({"led", "Its number", {}, kMustSay}, l.led);
  fields.value({"why", "saturated, not lit, fits nothing or moved"}, l.why);
}

void describe(Fields& fields, ClothGain& g) {
  fields.value({"led", "Its number", {}, kMustSay}, g.led);
  fields.value({"factor", "Brightness over the calibration's", {}, kMustSay}, g.factor);
  fields.value({"sigma", "Standard deviation of it", {}, kOrNull}, g.sigma);
}

void describe(Fields& fields, ClothGains& g) {
  fields.list({"leds", "One each", {}, kMustSay}, g.leds);
  fields.value({"misfit_before", "Of the readings, a share", {}, kOrNull}, g.misfit_before);
  fields.value({"misfit_after", "Of the readings, a share", {}, kOrNull}, g.misfit_after);
  fields.value({"left_out_gain", "By which left-out light is predicted better, a share", {}, kOrNull},
               g.left_out_gain);
  fields.value({"left_out_sigma", "Standard deviation of it", {}, kOrNull}, g.left_out_sigma);
}

void describe(Fields& fields, FrameFitFacts& f) {
  fields.value({"led", "Its number", {}, kMustSay}, f.led);
  fields.value({"missed", "By what the other frames predict, a share of the brightness", {}, kOrNull},
               f.missed);
  fields.value({"sigma", "That noise alone would give", {}, kOrNull}, f.sigma);
  fields.value({"rows", "By which its light rises and falls along rows, a share"}, f.rows);
  fields.value({"part", "Pixels that do not fit: x0, y0, x1, y1", {}, kUnlessEmpty}, f.part);
  fields.value({"costs_deg", "By which it would turn the normals, degrees"}, f.costs_deg);
}

void describe(Fields& fields, RowFlickerFacts& r) {
  fields.value({"period_rows", "Rows from one crest of its light to the next", {}, kMustSay}, r.period_rows);
  fields.value({"hertz", "Crests in a second, where the time of the shutter is known", {}, kUnlessEmpty},
               r.hertz);
  fields.value({"sigma", "Standard deviation of the frames' rows"}, r.sigma);
  fields.value({"costs_deg", "By which it would turn the normals, degrees"}, r.costs_deg);
}

void describe(Fields& fields, RoomLightFacts& r) {
  fields.value({"share", "Of the mean reading; below 0 in the dark shot alone", {}, kMustSay}, r.share);
  fields.value({"sigma", "Standard deviation of it"}, r.sigma);
  fields.value({"costs_deg", "By which it would turn the normals, degrees"}, r.costs_deg);
  fields.value({"costs_albedo", "By which it would make albedo too bright, a share"}, r.costs_albedo);
}

void describe(Fields& fields, ClothSpreadFacts& s) {
  fields.value(
      {"said",
       "given by a person; measured in a blade's shadow; told by the cloth's own photographs; all are "
       "undone. not_observable in a blade's shadow: left as it is"},
      s.said);
  fields.value({"share", "Of the light that leaves beside where it entered", {}, kMustSay}, s.share);
  fields.value({"share_sigma", "Standard deviation of it"}, s.share_sigma);
  fields.value({"mean_mm", "How far away, in the mean, mm"}, s.mean_mm);
  fields.value({"mean_px", "The same in pixels, where it was undone"}, s.mean_px);
  fields.value({"mean_sigma_mm", "Standard deviation of it, mm"}, s.mean_sigma_mm);
  fields.value({"led", "That threw the blade's shadow", kAboveZero}, s.led);
}

void describe(Fields& fields, ConditionFacts& c) {
  fields.value({"hot_photosites", "That were replaced, of raw frames", kNotNegative}, c.hot_photosites);
  fields.value({"veil", "Share of the light that was taken off"}, c.veil);
  fields.value({"brackets", "Shots that were joined", kNotNegative, kUnlessEmpty}, c.brackets);
  fields.list({"left_out", "LEDs that were not solved from", {}, kUnlessEmpty}, c.left_out);
  fields.list({"drift", "How bright LEDs were, by patches or repeats", {}, kUnlessEmpty}, c.drift);
  fields.object({"cloth_gains", "How bright LEDs were, by what the cloth tells", {}, kUnlessEmpty},
                c.cloth_gains);
  fields.list({"frames", "How each frame fits the others", {}, kUnlessEmpty}, c.frames);
  fields.object({"flicker", "Of light along rows", {}, kUnlessEmpty}, c.flicker);
  fields.object({"room", "Light of frames or dark shot alone", {}, kUnlessEmpty}, c.room);
  fields.object({"cloth_spread", "Of light that spreads in the cloth", {}, kUnlessEmpty}, c.cloth_spread);
}

void describe(Fields& fields, AngleMiddle& a) {
  fields.value({"median", "Degrees", {}, kOrNull}, a.median);
  fields.value({"p95", "95th percentile, degrees", {}, kOrNull}, a.p95);
}

void describe(Fields& fields, SigmaFacts& s) {
  fields.value({"median", "Degrees"}, s.median);
  fields.value({"p95", "95th percentile, degrees"}, s.p95);
  fields.object({"noise", "Its part of noise", {}, kUnlessEmpty}, s.noise);
  fields.object({"model", "Its part of what is not as the model has it", {}, kUnlessEmpty}, s.model);
  fields.object({"calibration", "Its part of the calibration's covariance", {}, kUnlessEmpty}, s.calibration);
  fields.value({"solved", "Share of the cloth that has a normal, which they hold for"}, s.solved);
}

void describe(Fields& fields, SharpeningFacts& s) {
  fields.value({"sigma_px", "Of the blur, pixels: R, G, B"}, s.sigma_px);
  fields.value({"share", "Of the correction that noise allowed, mean over the frame"}, s.share);
}

void describe(Fields& fields, LateralColorFacts& c) {
  fields.value({"corner_px", "How much farther out red and blue look than green in the farthest corner"},
               c.corner_px);
}

void describe(Fields& fields, LeftOutGain& g) {
  fields.value({"gain", "By which left-out light is predicted better, a share", {}, kOrNull}, g.gain);
  fields.value({"sigma", "Standard deviation of it", {}, kOrNull}, g.sigma);
  fields.value({"patches", "That tell it"}, g.patches);
}

void describe(Fields& fields, StageGain& s) {
  fields.value({"stage", "What was taken out", {}, kMustSay}, s.stage);
  describe(fields, s.by);
  fields.value({"kept", "It stays out"}, s.is_kept);
}

void describe(Fields& fields, RoundFacts& r) {
  fields.value({"turned_deg", "By which normals turned, degrees", {}, kOrNull}, r.turned_deg);
  fields.value({"stages", "What was taken out"}, r.stages);
  fields.value({"albedo_scale", "Absolute albedo over the solved one"}, r.albedo_scale);
  fields.value({"slope_residual_rms", "How far the normals before it were from any surface's, a tangent"},
               r.slope_residual_rms);
  fields.value({"refused", "Its normals were not used"}, r.is_refused);
}

void describe(Fields& fields, ReferenceLevelFacts& r) {
  fields.value({"stages", "That the last solve took out"}, r.stages);
  fields.list({"rounds", "The last solve at their end, unless robust is published"}, r.rounds);
  fields.list({"left_out", "How much better left-out light was predicted, by stage"}, r.left_out);
  fields.value({"albedo_scale_is_open",
                "Bounces were left in: neither calibration nor cloth tells the scale of the albedo"},
               r.albedo_scale_is_open);
  fields.value({"published",
                "robust where that level predicted left-out light better, else reference",
                {},
                kUnlessEmpty},
               r.published);
  fields.object({"over_robust", "How much better this level predicts it", {}, kUnlessEmpty}, r.over_robust);
  fields.value({"shadow_reach_is_capped", "Shadows fall farther than they are looked for"},
               r.shadow_reach_is_capped);
}

void describe(Fields& fields, LobeFacts& l) {
  const auto of_colours = [](const char* name, const char* says) {
    return Field{.name = name, .says = says, .need = kUnlessEmpty, .fewest = 3, .most = 3};
  };
  fields.value({"said", "measured, or why there is no lobe", {}, kMustSay}, l.said);
  fields.value({"family", "Of a measured one", {}, kUnlessEmpty}, l.family);
  fields.value({"alpha", "Roughness; with two that across the yarn, of two lobes the sharp one's"}, l.alpha);
  fields.value({"alpha_along", "Roughness along the yarn"}, l.alpha_along);
  fields.value({"alpha_broad", "Roughness of the broad lobe"}, l.alpha_broad);
  fields.value({"broad_share", "Of the facets, which are of the broad lobe"}, l.broad_share);
  fields.value({"f0", "Reflectance at normal incidence"}, l.f0);
  fields.value({"f0_over_albedo", "The same over an albedo that is relative"}, l.f0_over_albedo);
  fields.value(of_colours("f0_rgb", "f0 in the colours of albedo.exr"), l.f0_rgb);
  fields.value(of_colours("tint", "f0 of R, G and B over f0"), l.tint);
}

void describe(Fields& fields, ReflectanceSummary& g) {
  describe(fields, g.lobe);
  fields.value({"share", "Of the blocks solved with it"}, g.share);
  fields.object({"second", "Of a second material", {}, kUnlessEmpty}, g.second);
}

}  // namespace weft
