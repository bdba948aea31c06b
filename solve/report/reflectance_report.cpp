// SPDX-License-Identifier: Apache-2.0
#include "solve/report/reflectance_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/base/vec.h"
#include "report/plot_svg.h"
#include "solve/files/gloss_maps.h"

namespace weft::solve {
namespace {

using solver::LobeRefusal;
using solver::MeasuredLobe;

// Why a lobe is not observable, and what would make it so.
const std::map<LobeRefusal, std::pair<const char*, const char*>> kReasons = {
    {LobeRefusal::kTooFewPixels,
     {"too few pixels have six readings", "scan more of the cloth, or with more light"}},
    {LobeRefusal::kLambertFits,
     {"the readings follow Lambert's law: the cloth is matt, or its lobe is too weak or too broad for ten "
      "LEDs",
      "a pair of scans with parallel and crossed polarisers shows sheen and broad lobes"}},
    {LobeRefusal::kNothingFits,
     {"no lobe explains the readings: light between yarns, blur or several materials",
      "solve with --quality reference, or scan with a sharper lens"}},
    {LobeRefusal::kStrength,
     {"the strength that fits best is none that a cloth has",
      "a pair of scans with parallel and crossed polarisers shows the lobe alone"}},
    {LobeRefusal::kTooBroad,
     {"the lobe is as broad as shading",
      "a pair of scans with parallel and crossed polarisers shows the lobe alone"}},
    {LobeRefusal::kBentDiffuse,
     {"a diffuse part that departs from Lambert's law explains the readings as well",
      "a pair of scans with parallel and crossed polarisers, or a LED at 8 degrees from the camera"}},
    {LobeRefusal::kTooNarrow,
     {"the lobe is narrower than what is fitted", "a LED at 8 degrees from the camera, or a softer light"}},
    {LobeRefusal::kUncertain,
     {"lobes of other roughness or strength explain the readings as well",
      "a LED at 8 degrees from the camera, or a second scan of the cloth tilted by 20 degrees"}}};

// What remains to be done where a pair of films has been used.
const char* remedy_of_film_pair(LobeRefusal refusal) {
  switch (refusal) {
    case LobeRefusal::kLambertFits:
      return "nothing: it shows neither gloss nor sheen";
    case LobeRefusal::kStrength:
    case LobeRefusal::kTooBroad:
    case LobeRefusal::kBentDiffuse:
      return "solve with --quality reference, or scan more of the cloth";
    default:
      return kReasons.at(refusal).second;
  }
}

FittedLobe fitted(const solver::Lobe& lobe) {
  FittedLobe facts = {.family = name_of(lobe.family)};
  if (!lobe.shines()) return facts;
  facts.alpha = lobe.alpha;
  if (lobe.family == solver::LobeFamily::kAnisotropicGgx) {
    facts.alpha_along = lobe.alpha * lobe.along;
    facts.axis_deg = degrees(lobe.axis);
  }
  if (lobe.family == solver::LobeFamily::kTwoGgx) {
    facts.alpha_broad = lobe.broad;
    facts.broad_share = lobe.broad_share;
  }
  facts.f0 = lobe.f0;
  if (lobe.bend != 0) facts.bend = lobe.bend;
  return facts;
}

// What the quarters of the frame say of alpha, and whether they say the same.
void add_parts(const std::vector<solver::LobePart>& parts, LobeCluster& cluster) {
  for (const solver::LobePart& part : parts) {
    cluster.parts.push_back({solver::name_of_part(part.part), part.alpha, part.alpha * part.sigma_alpha,
                             static_cast<std::int64_t>(part.pixels)});
  }
  const auto change = solver::change_across(parts);
  if (!change) return;
  const auto& [smoothest, roughest] = *change;
  cluster.warning = fmt::format(
      "the cloth's roughness changes across the frame: {:.3f} at the {}, {:.3f} at the {}", smoothest.alpha,
      solver::name_of_part(smoothest.part), roughest.alpha, solver::name_of_part(roughest.part));
}

std::vector<double> listed(const std::array<double, 3>& rgb) {
  return {rgb.begin(), rgb.end()};
}

// Adds R, G and B: what a neutral lobe does not say.
void add_tint(const MeasuredLobe& lobe, const F0OfChannels& channels, AlbedoScale scale,
              LobeCluster& cluster) {
  for (const double f0 : channels.f0) cluster.tint.push_back(f0 / lobe.lobe.f0);
  cluster.sigma.tint = listed(lobe.tint->sigma_of_tint);
  if (scale == AlbedoScale::kRelative) return;
  cluster.f0_rgb = listed(channels.f0);
  cluster.sigma.f0_rgb = listed(channels.sigma);
}

LobeSigma sigma_of(const MeasuredLobe& lobe) {
  LobeSigma sigma = {.alpha = lobe.lobe.alpha * lobe.sigma_alpha, .f0 = lobe.sigma_f0};
  if (lobe.lobe.family == solver::LobeFamily::kAnisotropicGgx) {
    sigma.alpha_along = lobe.lobe.alpha * lobe.lobe.along * std::hypot(lobe.sigma_alpha, lobe.sigma_along);
    sigma.axis_deg = degrees(lobe.sigma_axis);
  }
  if (lobe.lobe.family == solver::LobeFamily::kTwoGgx) {
    sigma.alpha_broad = lobe.lobe.broad * lobe.sigma_broad;
    sigma.broad_share = lobe.sigma_share;
  }
  return sigma;
}

LobeCluster measured_cluster(const MeasuredLobe& lobe, const std::optional<F0OfChannels>& channels,
                             AlbedoScale scale) {
  LobeCluster cluster = {.is_observable = true, .lobe = fitted(lobe.lobe), .sigma = sigma_of(lobe)};
  if (lobe.lobe.family == solver::LobeFamily::kAnisotropicGgx) cluster.weft_share = lobe.weft_share;
  if (scale == AlbedoScale::kRelative) {
    cluster.f0_over_albedo = lobe.lobe.f0 / lobe.median_albedo;
    cluster.lobe.f0.reset();
    cluster.sigma.f0_over_albedo = lobe.sigma_f0 / lobe.median_albedo;
    cluster.sigma.f0.reset();
  }
  if (channels) add_tint(lobe, *channels, scale, cluster);
  cluster.correlation = lobe.correlation;
  cluster.is_family_undecided = lobe.is_family_undecided;
  cluster.half_deg = lobe.half_deg;
  cluster.pixels = static_cast<std::int64_t>(lobe.fit.b.size());
  cluster.chi2 = lobe.fit.chi2;
  for (const solver::LobePoint& point : lobe.points)
    cluster.points.push_back({point.half_deg, point.reading, point.lobe});
  if (!lobe.parts.empty()) add_parts(lobe.parts, cluster);
  return cluster;
}

LobeCluster cluster_of(const MeasuredLobe& lobe, const std::optional<F0OfChannels>& channels,
                       AlbedoScale scale, bool of_film_pair) {
  LobeCluster cluster;
  if (lobe.is_measured()) {
    cluster = measured_cluster(lobe, channels, scale);
  } else {
    const auto& [why, remedy] = kReasons.at(lobe.refusal);
    cluster.why = why;
    cluster.remedy = of_film_pair ? remedy_of_film_pair(lobe.refusal) : remedy;
    cluster.typed = {kTypedAlpha, kTypedF0};
  }
  cluster.said = name_of(lobe.refusal);
  for (const solver::LobeCandidate& each : lobe.candidates)
    cluster.candidates.push_back({each.chi2, fitted(each.lobe)});
  return cluster;
}

std::string lobe_words(const LobeFacts& lobe) {
  if (lobe.family.empty()) return "no lobe";
  std::string words = fmt::format("{}, roughness {:.3f}", lobe.family, lobe.alpha.value_or(0));
  if (lobe.alpha_along) words += fmt::format(" across the yarn and {:.3f} along it", *lobe.alpha_along);
  if (lobe.alpha_broad)
    words += fmt::format(" and, for {:.0f} percent of it, {:.3f}", 100 * lobe.broad_share.value_or(0),
                         *lobe.alpha_broad);
  if (lobe.f0) words += fmt::format(", f0 {:.3f}", *lobe.f0);
  if (const auto& f0 = lobe.f0_rgb; !f0.empty()) {
    words += fmt::format(" ({:.3f} red, {:.3f} green, {:.3f} blue)", f0[0], f0[1], f0[2]);
  } else if (const auto& tint = lobe.tint; !tint.empty()) {
    words += fmt::format(", of red, green and blue {:.2f}, {:.2f} and {:.2f} times that", tint[0], tint[1],
                         tint[2]);
  }
  return words;
}

LobeFacts lobe_of(const LobeCluster& cluster) {
  const FittedLobe& lobe = cluster.lobe;
  return {.said = cluster.said,
          .family = lobe.family,
          .alpha = lobe.alpha,
          .alpha_along = lobe.alpha_along,
          .alpha_broad = lobe.alpha_broad,
          .broad_share = lobe.broad_share,
          .f0 = lobe.f0,
          .f0_over_albedo = cluster.f0_over_albedo,
          .f0_rgb = cluster.f0_rgb,
          .tint = cluster.tint};
}

// Its lobe over its readings, or why there is none.
void add_cluster(const LobeCluster& cluster, report::Section& section) {
  if (!cluster.is_observable) {
    section.paragraphs.push_back(fmt::format("Not observable: {}. To do: {}.", cluster.why, cluster.remedy));
    return;
  }
  report::PlotSeries readings = {.name = "readings"},
                     lobe = {.name = "lobe", .joined = true, .marked = false};
  for (const auto& [half_deg, reading, of_lobe] : cluster.points) {
    readings.points.push_back({half_deg, reading});
    lobe.points.push_back({half_deg, of_lobe});
  }
  std::ranges::sort(lobe.points, {}, &report::PlotPoint::x);
  if (!cluster.warning.empty()) {
    section.paragraphs.push_back(fmt::format("Warning: {}. One lobe stands for all of it.", cluster.warning));
  }
  section.figures.push_back(
      {lobe_words(lobe_of(cluster)), report::plot_svg({.x_label = "normal to half-vector, degrees",
                                                       .y_label = "over the lobe's peak",
                                                       .series = {std::move(readings), std::move(lobe)}})});
}

}  // namespace

ReflectanceFacts reflectance_facts(const GlossFacts& facts, AlbedoScale scale) {
  ReflectanceFacts said = {
      .albedo_scale = scale, .share = facts.share, .has_second_pose = facts.of_second_pose};
  for (std::size_t l = 0; l < facts.lobes.size(); ++l) {
    std::optional<F0OfChannels> channels;
    if (l < facts.f0_of_channels.size()) channels = facts.f0_of_channels[l];
    said.clusters.push_back(cluster_of(facts.lobes[l], channels, scale, facts.of_film_pair));
  }
  return said;
}

ReflectanceSummary summary_of(const ReflectanceFacts& facts) {
  ReflectanceSummary summary = {.lobe = lobe_of(facts.clusters.at(0)), .share = facts.share};
  if (facts.clusters.size() > 1) summary.second = lobe_of(facts.clusters[1]);
  return summary;
}

std::string lobes_in_words(const ReflectanceSummary& summary) {
  if (summary.lobe.family.empty()) return "";
  const std::string words = lobe_words(summary.lobe);
  return summary.second ? fmt::format("two materials: {}; {}", words, lobe_words(*summary.second)) : words;
}

std::string reflectance_words(const ReflectanceSummary& summary) {
  const std::string words = lobes_in_words(summary);
  if (words.empty()) return "";
  return fmt::format("{}; solved with it: {:.0f} percent of the frame", words, 100 * summary.share);
}

GlossSaid reflectance_said(const ReflectanceFacts& facts) {
  const std::string words = reflectance_words(summary_of(facts));
  return {!words.empty() && facts.share > 0, words.empty() ? facts.clusters.at(0).why : words};
}

report::Section reflectance_section(const std::optional<ReflectanceFacts>& facts) {
  report::Section section = {.title = "Gloss"};
  if (!facts) return section;
  if (const std::string words = reflectance_words(summary_of(*facts)); !words.empty())
    section.paragraphs.push_back(words + ".");
  for (const LobeCluster& cluster : facts->clusters) add_cluster(cluster, section);
  return section;
}

}  // namespace weft::solve
