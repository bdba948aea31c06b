// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/reflectance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "app/jobs/gloss_maps.h"
#include "core/vec.h"
#include "report/plot_svg.h"

namespace weft::app {
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

void add_lobe(const solver::Lobe& lobe, Json& into) {
  into["family"] = name_of(lobe.family);
  if (!lobe.shines()) return;
  into["alpha"] = lobe.alpha;
  if (lobe.family == solver::LobeFamily::kAnisotropicGgx) {
    into["alpha_along"] = lobe.alpha * lobe.along;
    into["axis_deg"] = degrees(lobe.axis);
  }
  if (lobe.family == solver::LobeFamily::kTwoGgx) {
    into["alpha_broad"] = lobe.broad;
    into["broad_share"] = lobe.broad_share;
  }
  into["f0"] = lobe.f0;
  if (lobe.bend != 0) into["bend"] = lobe.bend;
}

Json candidates_of(const MeasuredLobe& lobe) {
  Json candidates = Json::array();
  for (const solver::LobeCandidate& each : lobe.candidates) {
    Json candidate = {{"chi2", each.chi2}};
    add_lobe(each.lobe, candidate);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

// What the quarters of the frame say of alpha, and whether they say the same.
void add_parts(const std::vector<solver::LobePart>& parts, Json& cluster) {
  Json all = Json::array();
  for (const solver::LobePart& part : parts) {
    all.push_back({{"part", solver::name_of_part(part.part)},
                   {"alpha", part.alpha},
                   {"sigma", part.alpha * part.sigma_alpha},
                   {"pixels", part.pixels}});
  }
  cluster["parts"] = std::move(all);
  const auto change = solver::change_across(parts);
  if (!change) return;
  const auto& [smoothest, roughest] = *change;
  cluster["warning"] = fmt::format(
      "the cloth's roughness changes across the frame: {:.3f} at the {}, {:.3f} at the {}", smoothest.alpha,
      solver::name_of_part(smoothest.part), roughest.alpha, solver::name_of_part(roughest.part));
}

// Of R, G and B: what a neutral lobe does not say.
void add_tint(const MeasuredLobe& lobe, const pipeline::F0OfChannels& channels, AlbedoScale scale,
              Json& cluster, Json& sigma) {
  std::array<double, 3> tint = {};
  for (std::size_t c = 0; c < 3; ++c) tint[c] = channels.f0[c] / lobe.lobe.f0;
  cluster["tint"] = tint;
  sigma["tint"] = lobe.tint->sigma_of_tint;
  if (scale == AlbedoScale::kRelative) return;
  cluster["f0_rgb"] = channels.f0;
  sigma["f0_rgb"] = channels.sigma;
}

Json measured_cluster(const MeasuredLobe& lobe, const std::optional<pipeline::F0OfChannels>& channels,
                      AlbedoScale scale) {
  Json cluster = {{"observable", true}};
  add_lobe(lobe.lobe, cluster);
  const bool has_yarn = lobe.lobe.family == solver::LobeFamily::kAnisotropicGgx;
  Json sigma = {{"alpha", lobe.lobe.alpha * lobe.sigma_alpha}, {"f0", lobe.sigma_f0}};
  if (has_yarn) {
    sigma["alpha_along"] = lobe.lobe.alpha * lobe.lobe.along * std::hypot(lobe.sigma_alpha, lobe.sigma_along);
    sigma["axis_deg"] = degrees(lobe.sigma_axis);
    cluster["weft_share"] = lobe.weft_share;
  }
  if (lobe.lobe.family == solver::LobeFamily::kTwoGgx) {
    sigma["alpha_broad"] = lobe.lobe.broad * lobe.sigma_broad;
    sigma["broad_share"] = lobe.sigma_share;
  }
  if (scale == AlbedoScale::kRelative) {
    cluster["f0_over_albedo"] = lobe.lobe.f0 / lobe.median_albedo;
    cluster.erase("f0");
    sigma["f0_over_albedo"] = lobe.sigma_f0 / lobe.median_albedo;
    sigma.erase("f0");
  }
  if (channels) add_tint(lobe, *channels, scale, cluster, sigma);
  cluster["sigma"] = std::move(sigma);
  cluster["correlation"] = lobe.correlation;
  cluster["family_undecided"] = lobe.is_family_undecided;
  cluster["half_deg"] = lobe.half_deg;
  cluster["pixels"] = lobe.fit.b.size();
  cluster["chi2"] = lobe.fit.chi2;
  Json points = Json::array();
  for (const solver::LobePoint& point : lobe.points)
    points.push_back({point.half_deg, point.reading, point.lobe});
  cluster["points"] = std::move(points);
  if (!lobe.parts.empty()) add_parts(lobe.parts, cluster);
  return cluster;
}

Json cluster_of(const MeasuredLobe& lobe, const std::optional<pipeline::F0OfChannels>& channels,
                AlbedoScale scale, bool of_film_pair) {
  Json cluster;
  if (lobe.is_measured()) {
    cluster = measured_cluster(lobe, channels, scale);
  } else {
    const auto& [why, remedy] = kReasons.at(lobe.refusal);
    cluster = {{"observable", false},
               {"why", why},
               {"remedy", of_film_pair ? remedy_of_film_pair(lobe.refusal) : remedy},
               {"typed", {{"alpha", kTypedAlpha}, {"f0", kTypedF0}}}};
  }
  cluster["said"] = name_of(lobe.refusal);
  cluster["candidates"] = candidates_of(lobe);
  return cluster;
}

std::string lobe_words(const Json& cluster) {
  if (!cluster.contains("family")) return "no lobe";
  std::string words = fmt::format("{}, roughness {:.3f}", cluster["family"].get<std::string>(),
                                  cluster["alpha"].get<double>());
  if (cluster.contains("alpha_along"))
    words += fmt::format(" across the yarn and {:.3f} along it", cluster["alpha_along"].get<double>());
  if (cluster.contains("alpha_broad"))
    words += fmt::format(" and, for {:.0f} percent of it, {:.3f}", 100 * cluster["broad_share"].get<double>(),
                         cluster["alpha_broad"].get<double>());
  if (cluster.contains("f0")) words += fmt::format(", f0 {:.3f}", cluster["f0"].get<double>());
  if (cluster.contains("f0_rgb")) {
    const auto f0 = cluster["f0_rgb"].get<std::array<double, 3>>();
    words += fmt::format(" ({:.3f} red, {:.3f} green, {:.3f} blue)", f0[0], f0[1], f0[2]);
  } else if (cluster.contains("tint")) {
    const auto tint = cluster["tint"].get<std::array<double, 3>>();
    words += fmt::format(", of red, green and blue {:.2f}, {:.2f} and {:.2f} times that", tint[0], tint[1],
                         tint[2]);
  }
  return words;
}

// Its lobe over its readings, or why there is none.
void add_cluster(const Json& cluster, report::Section& section) {
  if (!cluster["observable"].get<bool>()) {
    section.paragraphs.push_back(fmt::format("Not observable: {}. To do: {}.",
                                             cluster["why"].get<std::string>(),
                                             cluster["remedy"].get<std::string>()));
    return;
  }
  report::PlotSeries readings = {.name = "readings"},
                     lobe = {.name = "lobe", .joined = true, .marked = false};
  for (const Json& point : cluster["points"]) {
    readings.points.push_back({point[0].get<double>(), point[1].get<double>()});
    lobe.points.push_back({point[0].get<double>(), point[2].get<double>()});
  }
  std::ranges::sort(lobe.points, {}, &report::PlotPoint::x);
  if (cluster.contains("warning")) {
    section.paragraphs.push_back(
        fmt::format("Warning: {}. One lobe stands for all of it.", cluster["warning"].get<std::string>()));
  }
  section.figures.push_back(
      {lobe_words(cluster), report::plot_svg({.x_label = "normal to half-vector, degrees",
                                              .y_label = "over the lobe's peak",
                                              .series = {std::move(readings), std::move(lobe)}})});
}

}  // namespace

Json reflectance_document(const pipeline::GlossFacts& facts, AlbedoScale scale) {
  Json clusters = Json::array();
  for (std::size_t l = 0; l < facts.lobes.size(); ++l) {
    std::optional<pipeline::F0OfChannels> channels;
    if (l < facts.f0_of_channels.size()) channels = facts.f0_of_channels[l];
    clusters.push_back(cluster_of(facts.lobes[l], channels, scale, facts.of_film_pair));
  }
  Json document = {{"schema", "weft.reflectance/1.2"},
                   {"albedo_scale", name_of(scale)},
                   {"share", facts.share},
                   {"clusters", std::move(clusters)}};
  if (facts.of_second_pose) document["second_pose"] = true;
  return document;
}

Json reflectance_summary(const Json& document) {
  const auto summary_of = [](const Json& cluster) {
    Json summary = {{"said", cluster["said"]}};
    for (const char* key : {"family", "alpha", "alpha_along", "alpha_broad", "broad_share", "f0",
                            "f0_over_albedo", "f0_rgb", "tint"}) {
      if (cluster.contains(key)) summary[key] = cluster[key];
    }
    return summary;
  };
  const Json& clusters = document["clusters"];
  Json summary = summary_of(clusters[0]);
  summary["share"] = document["share"];
  if (clusters.size() > 1) summary["second"] = summary_of(clusters[1]);
  return summary;
}

std::string lobes_in_words(const Json& summary) {
  if (!summary.contains("family")) return "";
  const std::string words = lobe_words(summary);
  return summary.contains("second")
             ? fmt::format("two materials: {}; {}", words, lobe_words(summary["second"]))
             : words;
}

std::string reflectance_words(const Json& summary) {
  const std::string words = lobes_in_words(summary);
  if (words.empty()) return "";
  return fmt::format("{}; solved with it: {:.0f} percent of the frame", words,
                     100 * summary["share"].get<double>());
}

Json reflectance_said(const Json& document) {
  const std::string words = reflectance_words(reflectance_summary(document));
  const bool is_used = !words.empty() && document["share"].get<double>() > 0;
  return {{"used", is_used}, {"says", words.empty() ? document["clusters"][0]["why"] : Json(words)}};
}

report::Section reflectance_section(const Json& document) {
  report::Section section = {.title = "Gloss"};
  if (document.is_null()) return section;
  if (const std::string words = reflectance_words(reflectance_summary(document)); !words.empty())
    section.paragraphs.push_back(words + ".");
  for (const Json& cluster : document["clusters"]) add_cluster(cluster, section);
  return section;
}

}  // namespace weft::app
