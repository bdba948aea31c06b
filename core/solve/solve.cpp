// SPDX-License-Identifier: Apache-2.0
#include "core/solve/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "core/base/files.h"
#include "core/base/percent.h"
#include "core/describe/field_json.h"

namespace weft {
namespace {

constexpr std::array<const char*, 2> kColors = {"camera", "rec709"};

// That of photographs stands alone, in the folder that stands for their session.
std::optional<Product> own_solve(const std::filesystem::path& session) {
  const std::filesystem::path file = session / kSolveProduct.document;
  if (!is_there(file)) return {};
  const Result<Json> document = read_json(file, kSolveProduct.schema, 1);
  if (!document || !document->value("id", Json()).is_string()) return {};
  return Product{kSolveProduct, (*document)["id"].get<std::string>(), absolute_folder(session)};
}

}  // namespace

Result<Product> find_solve(const std::filesystem::path& session, const std::string& id) {
  const std::optional<Product> own = own_solve(session);
  if (own && own->id == id) return *own;
  return find_product(kSolveProduct, session / "solve", id);
}

std::vector<Product> list_solves(const std::filesystem::path& session) {
  if (const std::optional<Product> own = own_solve(session)) return {*own};
  return list_products(kSolveProduct, session / "solve");
}

std::int64_t StatusCounts::with(StatusBit bit) const {
  const auto named = std::ranges::find(kStatusNames, bit, &StatusName::bit);
  return pixels.at(static_cast<std::size_t>(named - kStatusNames.begin()));
}

void describe(Fields& fields, StatusCounts& counts) {
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    const bool is_how = (kStatusNames[i].bit & kHowSolved) != 0;
    fields.value({kStatusNames[i].name, "Pixels that have this bit of status.png", kNotNegative,
                  is_how ? kUnlessEmpty : kMaySay},
                 counts.pixels[i]);
  }
}

void describe(Fields& fields, SolveError& e) {
  fields.value({"mean_deg", "Between the normals and those of the truth, degrees", {}, kMustSay}, e.mean_deg);
  fields.value({"median_deg", "The same", {}, kMustSay}, e.median_deg);
  fields.value({"p95_deg", "The same: its 95th percentile", {}, kMustSay}, e.p95_deg);
  fields.value({"max_deg", "The same", {}, kMustSay}, e.max_deg);
}

void describe(Fields& fields, SolvePrice& p) {
  fields.value({"seconds", "Until solve.json is written", {}, kMustSay}, p.seconds);
  fields.value({"mean_deg", "To expect of the share that is solved, degrees", {}, kMustSay}, p.mean_deg);
  fields.value({"solved", "Share of the cloth that has a normal", {}, kMustSay}, p.solved);
  fields.value({"parts_s", "Seconds by phase", {}, kUnlessEmpty}, p.parts_s);
}

double deg_of_whole(double mean_deg, double solved) {
  return solved * mean_deg + (1 - solved) * (180 / std::numbers::pi);
}

void describe(Fields& fields, RegisteredShot& s) {
  fields.value({"led", "That was lit", {}, kMustSay}, s.led);
  fields.value({"dx_px", "To the right, pixels"}, s.dx_px);
  fields.value({"dy_px", "Down, pixels"}, s.dy_px);
  fields.value({"turn_deg", "About the frame's centre, degrees"}, s.turn_deg);
  fields.value({"sigma_px", "Standard deviation of the shift, pixels"}, s.sigma_px);
  fields.value({"cost_deg", "That normals would be off for it, degrees"}, s.cost_deg);
  fields.value({"corrected", "It was left out for it"}, s.is_corrected);
  fields.value({"verdict", "still, left out, flagged or not registered"}, s.verdict);
}

void describe(Fields& fields, GateFacts& g) {
  constexpr std::array<const char*, 2> kVerdicts = {"under", "over"};
  fields.value({"name", "What was measured"}, g.name);
  fields.value({"value", "In its unit"}, g.value);
  fields.value({"limit", "From which there is something to gain"}, g.limit);
  fields.value({"unit", "Of both"}, g.unit);
  fields.choice({"verdict", "Which side of the limit it is on"}, g.is_over, kVerdicts);
}

void describe(Fields& fields, SolvedBy& s) {
  fields.value({"float32", "By the kernel"}, s.float32);
  fields.value({"double", "By normal equations"}, s.in_double);
  fields.value({"qr", "By QR"}, s.qr);
  fields.value({"svd", "By SVD"}, s.svd);
  fields.value({"unsolved", "Without a solution"}, s.unsolved);
  fields.value({"rejected_readings", "Readings that were left out"}, s.rejected_readings);
  fields.value({"robust_share", "Share of the blocks that are solved as robust does"}, s.robust_share);
}

void describe(Fields& fields, SolveFacts& f) {
  fields.value({"id", "SHA-256 of its input, method and compression", {}, kMustSay}, f.id);
  fields.value({"solver_version", "Rises whenever the bytes of a map may change", {}, kMustSay},
               f.solver_version);
  fields.value({"method", "That solved it", {}, kMustSay}, f.method);
  fields.choice({"compression", "Of its EXR files", {}, kMustSay}, f.compression, kCompressionNames);
  fields.object({"input", "All that it depends on: files by SHA-256, calibration, lights", {}, kUnlessEmpty},
                f.input);
  fields.value({"lights", "How many there are", {}, kMustSay}, f.lights);
  fields.value({"width", "Of the maps, pixels", {}, kMustSay}, f.size.width);
  fields.value({"height", "Of the maps, pixels", {}, kMustSay}, f.size.height);
  fields.choice({"albedo_scale", "Whether albedo is a reflectance", {}, kMustSay}, f.albedo_scale,
                kAlbedoScaleNames);
  fields.choice({"color", "Of the albedo: the camera's channels, or linear Rec.709"}, f.is_rec709, kColors);
  fields.value({"pixels", "With a solution", {}, kMustSay}, f.pixels);
  fields.object({"status", "Pixels by bit of status.png", {}, kMustSay}, f.status);
  fields.object({"solved_by", "Pixels by arithmetic", {}, kUnlessEmpty}, f.solved_by);
  fields.object({"conditions", "Of the session", {}, kUnlessEmpty}, f.conditions);
  fields.list({"registration", "How far each shot had moved"}, f.registration);
  fields.object({"sigma_normal_deg", "Of the predicted angle, degrees", {}, kUnlessEmpty},
                f.sigma_normal_deg);
  fields.object({"check", "How well light that was left out is predicted", {}, kUnlessEmpty}, f.check);
  fields.object({"sharpening", "Where the lens's spread was undone", {}, kUnlessEmpty}, f.sharpening);
  fields.object({"lateral_color", "Where it was taken out", {}, kUnlessEmpty}, f.lateral_color);
  fields.list({"warnings", "What speaks against it"}, f.warnings);
  fields.value(
      {"assumed", "What was taken for granted of photographs and their lights; since 1.2", {}, kUnlessEmpty},
      f.assumed);
  fields.value({"pictures", "Files in its folder"}, f.pictures);
  fields.list({"gates", "Of the level reference: whether there was anything to gain", {}, kUnlessEmpty},
              f.gates);
  fields.object({"reference", "What that level took out", {}, kUnlessEmpty}, f.reference);
  fields.object({"reflectance", "Of the levels robust and reference: the lobe", {}, kUnlessEmpty},
                f.reflectance);
  fields.object({"error", "Against a truth", {}, kUnlessEmpty}, f.error);
  fields.object({"foretold", "Where a price was asked before", {}, kUnlessEmpty}, f.foretold);
  fields.object({"taken", "What it gave and took; since 1.1", {}, kUnlessEmpty}, f.taken);
}

Result<SolveFacts> solve_facts_from_json(const Json& document, const std::string& where) {
  return read_fields<SolveFacts>(document, where);
}

Json json_of(const SolveFacts& facts) {
  const char* minor = !facts.assumed.empty() ? "1.2" : facts.taken ? "1.1" : "1";
  Json json = {{"schema", fmt::format("{}/{}", kSolveProduct.schema, minor)}};
  write_fields(json, facts);
  return json;
}

std::string share_in_words(double share) {
  return share < 1 && share >= 0.995 ? "over 99 %" : percent_words(share) + " %";
}

std::string error_in_words(double mean_deg, double solved) {
  if (!(solved > 0)) return "nothing solved";
  return fmt::format("{:.3g} degrees on {} of the cloth", mean_deg, share_in_words(solved));
}

}  // namespace weft
