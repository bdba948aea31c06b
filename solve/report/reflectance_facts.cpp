// SPDX-License-Identifier: Apache-2.0
#include "solve/report/reflectance_facts.h"

namespace weft::solve {

void describe(Fields& fields, FittedLobe& l) {
  fields.value({"family", "ggx, anisotropic-ggx, beckmann, cloth or, since 1.2, two-ggx", {}, kUnlessEmpty},
               l.family);
  fields.value({"alpha", "Roughness; with two that across the yarn, of two lobes the sharp one's"}, l.alpha);
  fields.value({"alpha_along", "Roughness along the yarn"}, l.alpha_along);
  fields.value({"axis_deg", "Azimuth of the warp from x, degrees"}, l.axis_deg);
  fields.value({"alpha_broad", "Roughness of the broad lobe; since 1.2"}, l.alpha_broad);
  fields.value({"broad_share", "Of the facets, which are of the broad lobe; since 1.2"}, l.broad_share);
  fields.value({"f0", "Reflectance at normal incidence"}, l.f0);
  fields.value({"bend", "Of the diffuse part, from Lambert's law"}, l.bend);
}

namespace {

Field of_colours(const char* name, const char* says) {
  return {.name = name, .says = says, .need = kUnlessEmpty, .fewest = 3, .most = 3};
}

void describe_observable(Fields& fields, LobeCluster& c) {
  describe(fields, c.lobe);
  fields.value({"weft_share", "Of the facets, which lie across the warp"}, c.weft_share);
  fields.value({"f0_over_albedo", "Where the albedo is relative, in place of f0"}, c.f0_over_albedo);
  fields.value(of_colours("tint", "f0 of R, G and B over f0; since 1.2"), c.tint);
  fields.value(of_colours("f0_rgb", "f0 in the colours of albedo.exr; since 1.2"), c.f0_rgb);
  fields.object({"sigma", "Standard deviation of each"}, c.sigma);
  fields.value({"correlation", "Of alpha and f0", {}, kOrNull}, c.correlation);
  fields.value({"family_undecided", "Another family fits as well"}, c.is_family_undecided);
  fields.value({"half_deg", "2nd and 98th percentile of the angles between normal and half-vector, degrees"},
               c.half_deg);
  fields.value({"pixels", "That it was fitted to"}, c.pixels);
  fields.value({"chi2", "Of a reading", {}, kOrNull}, c.chi2);
  fields.value({"points", "Angle in degrees, reading and lobe, both over the lobe's peak"}, c.points);
  fields.list(
      {"parts", "Quarters of the frame, where the cloth is one material; since 1.1", {}, kUnlessEmpty},
      c.parts);
  fields.value({"warning", "Where their roughness differs", {}, kUnlessEmpty}, c.warning);
}

}  // namespace

void describe(Fields& fields, LobeCandidateFacts& c) {
  fields.value({"chi2", "Of a reading", {}, kOrNull}, c.chi2);
  describe(fields, c.lobe);
}

void describe(Fields& fields, LobeSigma& s) {
  fields.value({"alpha", "Of alpha"}, s.alpha);
  fields.value({"f0", "Of f0"}, s.f0);
  fields.value({"alpha_along", "Of alpha_along"}, s.alpha_along);
  fields.value({"axis_deg", "Degrees"}, s.axis_deg);
  fields.value({"alpha_broad", "Of alpha_broad"}, s.alpha_broad);
  fields.value({"broad_share", "Of broad_share"}, s.broad_share);
  fields.value({"f0_over_albedo", "Of f0_over_albedo"}, s.f0_over_albedo);
  fields.value(of_colours("tint", "Of each"), s.tint);
  fields.value(of_colours("f0_rgb", "Of each"), s.f0_rgb);
}

void describe(Fields& fields, LobePartFacts& p) {
  fields.value({"part", "upper left, upper right, lower left or lower right", {}, kMustSay}, p.part);
  fields.value({"alpha", "Roughness", {}, kMustSay}, p.alpha);
  fields.value({"sigma", "Standard deviation of it", {}, kOrNull}, p.sigma);
  fields.value({"pixels", "That tell it"}, p.pixels);
}

void describe(Fields& fields, TypedLobe& t) {
  fields.value({"alpha", "Roughness", {}, kMustSay}, t.alpha);
  fields.value({"f0", "Reflectance at normal incidence", {}, kMustSay}, t.f0);
}

void describe(Fields& fields, LobeCluster& c) {
  fields.value({"observable", "The photographs tell its lobe", {}, kMustSay}, c.is_observable);
  fields.only_if(c.is_observable, [&] { describe_observable(fields, c); });
  fields.only_if(!c.is_observable, [&] {
    fields.value({"why", "It is not observable"}, c.why);
    fields.value({"remedy", "What would make it so"}, c.remedy);
    fields.object({"typed", "What stands for it"}, c.typed);
  });
  fields.value({"said", "measured, or why there is no lobe"}, c.said);
  fields.list({"candidates", "Each family as it was fitted"}, c.candidates);
}

void describe(Fields& fields, ReflectanceFacts& f) {
  fields.value({"schema", "Its name and version"}, f.schema);
  fields.choice({"albedo_scale", "Whether albedo is a reflectance", {}, kMustSay}, f.albedo_scale,
                kAlbedoScaleNames);
  fields.value({"share", "Of the blocks, solved with a lobe", {}, kMustSay}, f.share);
  fields.list({"clusters", "One a material", {}, kMustSay}, f.clusters);
  fields.value({"second_pose", "The lobe was sought in one too; since 1.1", {}, kUnlessEmpty},
               f.has_second_pose);
}

void describe(Fields& fields, GlossSaid& g) {
  fields.value({"used", "Pixels were solved with a lobe"}, g.is_used);
  fields.value({"says", "The lobes, or why there is none"}, g.says);
}

}  // namespace weft::solve
