// SPDX-License-Identifier: Apache-2.0
#include "material/run/map_set_facts.h"

#include <fmt/format.h>

#include "core/describe/field_json.h"
#include "solve/session/solved.h"

namespace weft::material {

void describe(Fields& fields, FinishedPlace& p) {
  fields.value({"centre_px", "Their middle: x to the right, y down", {}, kMustSay}, p.centre_px);
  fields.value({"corners_px", "x and y of each, from the left upper one clockwise", {}, kMustSay},
               p.corners_px);
}

void describe(Fields& fields, MapStep& s) {
  fields.keep(s.document);
  fields.value({"do", "Which step; its options stand beside it", {}, kMustSay}, s.name);
  fields.value({"facts", "What it found", {}, kUnlessEmpty}, s.facts);
}

void describe(Fields& fields, MapCheck& c) {
  fields.value({"name", "For programs", {}, kMustSay}, c.name);
  fields.choice({"severity", "How grave it is", {}, kMustSay}, c.severity, kSeverityNames);
  fields.value({"number", "What was measured", {}, kOrNull}, c.number);
  fields.value({"limit", "What it is held to, in the same unit", {}, kOrNull}, c.limit);
  fields.value({"text", "One sentence with its numbers"}, c.text);
  fields.value({"picture", "A file beside it: where it did not pass", {}, kUnlessEmpty}, c.picture);
}

void describe(Fields& fields, TableTakenOut& t) {
  fields.value({"albedo", "Of the table: R, G, B", {}, kMustSay}, t.albedo);
  fields.value({"unmixed", "Pixels that it was taken out of"}, t.unmixed);
  fields.value({"left", "Pixels left without a solution"}, t.left);
}

void describe(Fields& fields, DeriveOptions& d) {
  fields.choice({"height", "How slopes are integrated"}, d.height, kHeightMethodNames);
  fields.value({"weighs_by_sigma", "Height: each pixel by one over its variance"}, d.weighs_by_sigma);
  fields.value({"cavity_mm", "Radius that a cavity is seen against, mm"}, d.cavity_mm);
  fields.value({"directions", "Of the occlusion's lines"}, d.directions);
  fields.value({"cloth", "Whose lobe is typed where the photographs tell none; empty: not known"}, d.cloth);
}

void describe(Fields& fields, MapSetFacts& f) {
  fields.keep(f.document);
  fields.value({"id", "Hash of the rectified maps, the recipe and the options", {}, kMustSay}, f.id);
  fields.value({"solve", "Id of the solve that they are of", {}, kMustSay}, f.source.solve);
  fields.value({"level", "Of the solve, or the method of comparison", {}, kUnlessEmpty}, f.source.level);
  fields.value({"draft", "The solve is a preview"}, f.source.is_draft);
  fields.value({"rectified", "Id of the rectified maps that they are of"}, f.rectified);
  fields.value({"width", "Of the maps, pixels", kAboveZero, kMustSay}, f.size.width);
  fields.value({"height", "Of the maps, pixels", kAboveZero, kMustSay}, f.size.height);
  fields.value({"mm_per_pixel", "Side of a pixel, mm", kAboveZero, kMustSay}, f.mm_per_pixel);
  fields.value({"is_tile", "They go on over their borders"}, f.is_tile);
  fields.value({"preview", "To be looked at once"}, f.is_preview);
  fields.object({"place",
                 "Where they lie in the rectified maps, pixels from their left upper corner",
                 {},
                 kUnlessEmpty},
                f.place);
  fields.value({"part_mm",
                "What of a large cloth a preview is of: width and height of the part, then of the cloth",
                {},
                kUnlessEmpty},
               f.part_mm);
  fields.list({"steps", "Of the recipe, in their order"}, f.steps);
  fields.list({"maps", "Those that were derived", {}, kMustSay}, f.maps);
  fields.object({"derive", "How"}, f.derive);
  fields.list({"checks", "Whether they are those of a cloth"}, f.checks);
  fields.list({"verdicts", "What speaks against them"}, f.verdicts);
  fields.object({"table", "Where it was taken out of the rims of holes", {}, kUnlessEmpty}, f.table);
  fields.value({"stale", "Why others would have been made then, sentences", {}, kUnlessEmpty},
               f.source.stale);
  solve::describe_size(fields, f.source, f.document);
}

Json json_of(const MapSetFacts& facts) {
  Json json = {{"schema", fmt::format("{}/1", kMapsProduct.schema)}};
  write_fields(json, facts);
  return json;
}

Result<MapSetFacts> read_map_set(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kMapsProduct.document;
  const Result<Json> document = read_json(file, kMapsProduct.schema, 1);
  if (!document) return document.error();
  return read_fields<MapSetFacts>(*document, file.string());
}

}  // namespace weft::material
