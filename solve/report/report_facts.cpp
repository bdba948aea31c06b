// SPDX-License-Identifier: Apache-2.0
#include "solve/report/report_facts.h"

#include "core/describe/field_json.h"

namespace weft::solve {
namespace {

using solver::FaultKind;

constexpr std::array<const char*, 3> kFaultKinds = {"dead", "exchanged", "gain"};
constexpr std::array<const char*, 2> kReportedOn = {"session", "photographs"};

void describe_maps(Fields& fields, SolveReportFacts& f) {
  fields.value({"id", "Of the solve", {}, kMustSay}, f.id);
  fields.value({"method", "That solved it", {}, kMustSay}, f.method);
  fields.value({"width", "Of the maps, pixels", kAboveZero, kMustSay}, f.size.width);
  fields.value({"height", "Of the maps, pixels", kAboveZero, kMustSay}, f.size.height);
  fields.choice({"albedo_scale", "Whether albedo is a reflectance", {}, kMustSay}, f.albedo_scale,
                kAlbedoScaleNames);
  fields.value({"pixels", "With a solution", {}, kMustSay}, f.pixels);
  fields.list({"warnings", "What speaks against it, the gravest first", {}, kMustSay}, f.warnings);
  fields.object({"status", "Shares of the pixels by bit of status.png", {}, kMustSay}, f.status);
}

void describe_lights(Fields& fields, SolveReportFacts& f) {
  fields.value({"looked_at", "Pixels from all over the frame that the rest is measured on"}, f.looked_at);
  fields.value(
      {"outshining",
       "Share of them with a reading over three times what matt cloth of the frame gives in that channel",
       {},
       kOrNull},
      f.outshining);
  fields.value(
      {"residual",
       "Median over them of the mean absolute deviation of the readings from a robust fit, over the albedo",
       {},
       kOrNull},
      f.residual);
  fields.value({"residual_explained",
                "The same with named faults and the cloth's own departure from Lambert put right",
                {},
                kOrNull},
               f.residual_explained);
  fields.list({"lights", "How the readings of each fit", {}, kMustSay}, f.lights);
  fields.list({"faults", "Lights that contradict the others", {}, kMustSay}, f.faults);
  fields.list({"budget", "Where the error comes from, each in its own unit", {}, kMustSay}, f.budget);
  fields.object({"condition", "Condition number of the lights over the frame"}, f.condition);
}

}  // namespace

void describe(Fields& fields, StatusShares& s) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i)
    fields.value({kStatusNames[i].name, "Share of the pixels that have this bit of status.png"}, s.shares[i]);
}

void describe(Fields& fields, LightFacts& l) {
  const auto share = [&](const char* name, const char* says, double& value) {
    fields.value({name, says, {}, kOrNull}, value);
  };
  fields.value({"light", "Its number", {}, kMustSay}, l.light);
  share("residual_rms", "Of its readings from a robust fit, over the albedo", l.residual_rms);
  share("residual_median", "Median of their absolute values", l.residual_median);
  share("residual_mean", "Mean of them", l.residual_mean);
  share("gain", "What it gives of what the others let expect, named exchanges put right", l.gain);
  share("gain_range", "By how much that changes with the way the cloth faces the light", l.gain_range);
  share("saturated", "Share of its readings", l.saturated);
  share("shadowed", "Share of its readings", l.shadowed);
  share("missing", "Share of its readings", l.missing);
  share("outlier", "Share of its readings", l.outlier);
  share("gradient", "Change of its residual over the frame, as a plane", l.gradient);
  share("gradient_share", "Of the residual's variance, which that explains", l.gradient_share);
}

void describe(Fields& fields, FaultFacts& f) {
  const auto number = [&](const char* name, const char* says, double& value) {
    fields.value({name, says, {}, kOrNull}, value);
  };
  fields.choice({"kind", "What is wrong", {}, kMustSay}, f.kind, kFaultKinds);
  fields.value({"lights", "Their numbers", {}, kMustSay}, f.lights);
  fields.value({"shown_by", "Of those exchanged: the photograph that shows each", {}, kUnlessEmpty},
               f.shown_by);
  fields.only_if(f.kind != FaultKind::kExchanged,
                 [&] { number("value", "Light over what its calibration says", f.value); });
  fields.only_if(f.kind == FaultKind::kGain,
                 [&] { number("sigma", "Standard deviation of the value", f.sigma); });
  fields.only_if(f.kind != FaultKind::kDead, [&] {
    number("residual_before", "Of their readings, over the albedo", f.residual_before);
    number("residual_after", "The same with it put right", f.residual_after);
    number("moved_deg", "How far putting it right turns normals of least squares, median, degrees",
           f.moved_deg);
  });
  number("confidence", "Share of eight parts of the picture that agree", f.confidence);
}

void describe(Fields& fields, ErrorSource& e) {
  fields.value({"source", "Where it comes from", {}, kMustSay}, e.source);
  fields.value({"what", "What was measured"}, e.what);
  fields.value({"value", "In its unit", {}, kMustSay}, e.value);
  fields.value({"unit", "deg or percent"}, e.unit);
}

void describe(Fields& fields, LightCondition& c) {
  fields.value({"median", "Over the frame; null: they do not span three directions", {}, kOrNull}, c.median);
  fields.value({"worst", "Over the frame; null: they do not span three directions", {}, kOrNull}, c.worst);
}

void describe(Fields& fields, SigmaMap& s) {
  fields.value({"median", "Degrees; null: no pixel has one", {}, kOrNull}, s.median);
  fields.value({"p95", "95th percentile, degrees", {}, kOrNull}, s.p95);
  fields.value({"solved", "Share of the cloth that has a normal, which they hold for"}, s.solved);
  fields.value({"square_px", "Side of a square of the grid, pixels"}, s.square_px);
  fields.value({"columns", "Of the grid"}, s.columns);
  fields.value({"rows", "Of the grid"}, s.rows);
  fields.value({"grid", "Means of squares, row by row, degrees; null where there is none"}, s.grid);
}

void describe(Fields& fields, SolveReportFacts& f) {
  fields.value({"title", "Of the cloth", {}, kMustSay}, f.title);
  fields.choice({"of", "What was solved", {}, kMustSay}, f.is_of_photographs, kReportedOn);
  describe_maps(fields, f);
  describe_lights(fields, f);
  fields.object({"sigma_normal_deg", "Predicted angle of the normals over the frame, degrees"},
                f.sigma_normal_deg);
  fields.object({"sigma_noise_deg", "Its part of noise", {}, kUnlessEmpty}, f.sigma_noise_deg);
  fields.object({"sigma_model_deg", "Its part of what is not as the model has it", {}, kUnlessEmpty},
                f.sigma_model_deg);
  fields.object({"sigma_calibration_deg", "Its part of the calibration's covariance", {}, kUnlessEmpty},
                f.sigma_calibration_deg);
  fields.object({"check", "How well light that was left out is predicted", {}, kUnlessEmpty}, f.check);
  fields.object({"error", "Against a truth", {}, kUnlessEmpty}, f.error);
  fields.list({"gates", "Of the level reference: whether there was anything to gain", {}, kUnlessEmpty},
              f.gates);
  fields.list({"registration", "How far each shot had moved", {}, kUnlessEmpty}, f.registration);
  fields.object({"sharpening", "Where the lens's spread was undone", {}, kUnlessEmpty}, f.sharpening);
  fields.object({"lateral_color", "Where it was taken out", {}, kUnlessEmpty}, f.lateral_color);
  fields.object({"conditions", "Of the session", {}, kUnlessEmpty}, f.conditions);
  fields.value({"seconds", "By phase"}, f.seconds);
  fields.object({"reflectance", "What reflectance.json says", {}, kUnlessEmpty}, f.reflectance);
  fields.object({"gloss", "The same in words", {}, kUnlessEmpty}, f.gloss);
  fields.object({"foretold", "Where a price was asked before", {}, kUnlessEmpty}, f.foretold);
}

Json json_of(const SolveReportFacts& facts) {
  Json json = {{"schema", "weft.solve-report/1"}};
  write_fields(json, facts);
  return json;
}

}  // namespace weft::solve
