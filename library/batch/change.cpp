// SPDX-License-Identifier: Apache-2.0
#include "library/batch/change.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/base/percent.h"

namespace weft::library {
namespace {

// Something that may have grown.
struct Grown {
  double factor = 0;  // 0: it did not grow by enough to speak of
  std::string said;
};

double factor_of(const BeforeAfter& pair, double floor) {
  return (pair.after + floor) / (pair.before + floor);
}

std::vector<Grown> grown(const MapChange& change) {
  std::vector<Grown> all;
  if (change.unsolved.after > change.unsolved.before + kMoreUnsolved)
    all.push_back({factor_of(change.unsolved, kMoreUnsolved),
                   fmt::format("unsolved {:.2f} to {:.2f} percent", 100 * change.unsolved.before,
                               100 * change.unsolved.after)});
  if (change.sigma_deg && change.sigma_deg->after > (1 + kWorseBy) * change.sigma_deg->before)
    all.push_back(
        {factor_of(*change.sigma_deg, 1e-3),
         fmt::format("sigma {:.3g} to {:.3g} degrees", change.sigma_deg->before, change.sigma_deg->after)});
  if (change.left_out && change.left_out->after > (1 + kWorseBy) * change.left_out->before)
    all.push_back({factor_of(*change.left_out, 1e-3),
                   fmt::format("left-out lights {} to {} percent off", percent_words(change.left_out->before),
                               percent_words(change.left_out->after))});
  std::ranges::stable_sort(all, [](const Grown& a, const Grown& b) { return a.factor > b.factor; });
  return all;
}

}  // namespace

void describe(Fields& fields, BeforeAfter& pair) {
  fields.value({"before", "Of the solve before", {}, kMustSay}, pair.before);
  fields.value({"after", "Of this one", {}, kMustSay}, pair.after);
}

void describe(Fields& fields, WorstWindow& w) {
  fields.value({"x", "Its left edge, pixels", {}, kMustSay}, w.x);
  fields.value({"y", "Its upper edge, pixels", {}, kMustSay}, w.y);
  fields.value({"side", "Pixels", {}, kMustSay}, w.side);
  fields.value({"mean_deg", "Mean turn of its normals, degrees", {}, kMustSay}, w.mean_deg);
}

void describe(Fields& fields, MapChange& c) {
  fields.value({"pixels", "That have a normal in both", {}, kMustSay}, c.pixels);
  fields.value({"mean_deg", "Between old and new normals, degrees", {}, kMustSay}, c.mean_deg);
  fields.value({"median_deg", "The same", {}, kMustSay}, c.median_deg);
  fields.value({"p95_deg", "The same: its 95th percentile", {}, kMustSay}, c.p95_deg);
  fields.value({"max_deg", "The same", {}, kMustSay}, c.max_deg);
  fields.value({"albedo_rel", "Mean size of the change over the old albedo", {}, kMustSay}, c.albedo_rel);
  fields.value({"albedo_bias_rel", "Mean of (new - old) / old", {}, kMustSay}, c.albedo_bias_rel);
  fields.object({"unsolved", "Shares of pixels", {}, kMustSay}, c.unsolved);
  fields.object({"worst", "The square that turned most", {}, kMustSay}, c.worst);
  fields.object({"sigma_deg", "Medians of the angle that sigma.exr predicts, degrees", {}, kUnlessEmpty},
                c.sigma_deg);
  fields.object({"left_out", "Rms of how left-out lights are predicted, shares", {}, kUnlessEmpty},
                c.left_out);
  fields.value({"status_changed", "Share of pixels whose status speaks otherwise"}, c.status_changed);
}

std::vector<std::string> regressions(const MapChange& change) {
  std::vector<std::string> said;
  for (Grown& each : grown(change)) said.push_back(std::move(each.said));
  return said;
}

double regression_weight(const MapChange& change) {
  const std::vector<Grown> all = grown(change);
  return all.empty() ? 0 : all.front().factor;
}

bool is_graver(const MapChange& a, const MapChange& b) {
  return std::tuple(regression_weight(a), a.p95_deg) > std::tuple(regression_weight(b), b.p95_deg);
}

}  // namespace weft::library
