// SPDX-License-Identifier: Apache-2.0
#include "batch/change.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/percent.h"

namespace weft::batch {
namespace {

Json json_of(const BeforeAfter& pair) {
  return {{"before", pair.before}, {"after", pair.after}};
}

BeforeAfter pair_from(JsonFields& fields, const char* key) {
  JsonFields pair(fields.object(key), fields.where() + ": " + key);
  const BeforeAfter read = {pair.number("before"), pair.number("after")};
  if (!pair.status()) fields.reject(key, "has no \"before\" and \"after\"");
  return read;
}

std::optional<BeforeAfter> optional_pair(JsonFields& fields, const char* key) {
  if (!fields.has(key)) return {};
  return pair_from(fields, key);
}

// Something that may have grown.
struct Grown {
  double factor = 0;  // 0: it did not grow by enough to speak of
  std::string said;
};

double factor_of(const BeforeAfter& pair, double floor) {
  return (pair.after + floor) / (pair.before + floor);
}

std::vector<Grown> grown(const Change& change) {
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

Json json_of(const Change& c) {
  Json json = {
      {"pixels", c.pixels},
      {"mean_deg", c.mean_deg},
      {"median_deg", c.median_deg},
      {"p95_deg", c.p95_deg},
      {"max_deg", c.max_deg},
      {"albedo_rel", c.albedo_rel},
      {"albedo_bias_rel", c.albedo_bias_rel},
      {"unsolved", json_of(c.unsolved)},
      {"worst",
       {{"x", c.worst.x}, {"y", c.worst.y}, {"side", c.worst.side}, {"mean_deg", c.worst.mean_deg}}}};
  if (c.sigma_deg) json["sigma_deg"] = json_of(*c.sigma_deg);
  if (c.left_out) json["left_out"] = json_of(*c.left_out);
  if (c.status_changed) json["status_changed"] = *c.status_changed;
  return json;
}

Result<Change> change_from_json(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  Change c;
  c.pixels = static_cast<std::int64_t>(fields.number("pixels"));
  c.mean_deg = fields.number("mean_deg");
  c.median_deg = fields.number("median_deg");
  c.p95_deg = fields.number("p95_deg");
  c.max_deg = fields.number("max_deg");
  c.albedo_rel = fields.number("albedo_rel");
  c.albedo_bias_rel = fields.number("albedo_bias_rel");
  c.unsolved = pair_from(fields, "unsolved");
  c.sigma_deg = optional_pair(fields, "sigma_deg");
  c.left_out = optional_pair(fields, "left_out");
  c.status_changed = fields.optional_number("status_changed");
  JsonFields worst(fields.object("worst"), where + ": worst");
  c.worst = {worst.integer("x"), worst.integer("y"), worst.integer("side"), worst.number("mean_deg")};
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  if (Result<void> ok = worst.status(); !ok) return std::move(ok).error();
  return c;
}

std::vector<std::string> regressions(const Change& change) {
  std::vector<std::string> said;
  for (Grown& each : grown(change)) said.push_back(std::move(each.said));
  return said;
}

double regression_weight(const Change& change) {
  const std::vector<Grown> all = grown(change);
  return all.empty() ? 0 : all.front().factor;
}

bool is_graver(const Change& a, const Change& b) {
  return std::tuple(regression_weight(a), a.p95_deg) > std::tuple(regression_weight(b), b.p95_deg);
}

}  // namespace weft::batch
