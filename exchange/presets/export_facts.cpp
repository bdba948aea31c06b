// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/export_facts.h"

#include <fmt/format.h>

#include "core/describe/field_json.h"

namespace weft::exchange {

void describe(Fields& fields, NumberLoss& l) {
  fields.value({"mean", "Of the difference", {}, kOrNull}, l.mean);
  fields.value({"max", "Of the difference", {}, kOrNull}, l.most);
}

void describe(Fields& fields, ExportedChannel& c) {
  fields.value({"name", "What it holds", {}, kMustSay}, c.name);
  fields.value({"unit", "Of its values", {}, kUnlessEmpty}, c.unit);
  fields.value({"source", "measured, derived or assumed"}, c.source);
  fields.value({"at_0", "Of integers: the value that 0 stands for"}, c.at_0);
  fields.value({"at_1", "Of integers: the value that full scale stands for"}, c.at_1);
  fields.value({"least", "Of the maps' values", {}, kOrNull}, c.least);
  fields.value({"most", "Of the maps' values", {}, kOrNull}, c.most);
  fields.value({"mean", "Of the maps' values", {}, kOrNull}, c.mean);
  fields.object({"lost", "By how much its values differ from the maps'"}, c.lost);
  fields.value({"cut_share", "Of the pixels whose value the file cannot hold"}, c.cut_share);
}

void describe(Fields& fields, ExportedTexture& f) {
  fields.value({"file", "Relative to the folder", {}, kMustSay}, f.file);
  fields.value({"sha256", "Of its bytes", {}, kMustSay}, f.sha256);
  fields.value({"bytes", "How many", {}, kMustSay}, f.bytes);
  fields.value({"width", "Of the largest level, pixels", kAboveZero, kMustSay}, f.size.width);
  fields.value({"height", "Of the largest level, pixels", kAboveZero, kMustSay}, f.size.height);
  fields.value({"levels", "Of half the size each"}, f.levels);
  fields.value({"encoding", "Format and samples, in words"}, f.encoding);
  fields.choice({"color", "What its numbers are"}, f.color, kColorSpaceNames);
  fields.value({"direction", "Of its normals: opengl or directx", {}, kUnlessEmpty}, f.direction);
  fields.value({"roughness", "What it has for roughness", {}, kUnlessEmpty}, f.roughness);
  fields.list({"channels", "In their order", {}, kMustSay}, f.channels);
  fields.object({"lost", "What it holds otherwise than the maps"}, f.lost);
  fields.value({"inside", "The document that alone holds it", {}, kUnlessEmpty}, f.inside);
}

void describe(Fields& fields, ExportedDocument& d) {
  fields.value({"file", "Relative to the folder", {}, kMustSay}, d.name);
  fields.value({"kind", "Its format"}, d.kind);
  fields.value({"sha256", "Of its bytes", {}, kMustSay}, d.sha256);
  fields.value({"bytes", "How many", {}, kMustSay}, d.bytes);
  fields.value({"files", "That it names or holds"}, d.files);
  fields.value({"left_out", "What its format cannot hold, sentences"}, d.left_out);
}

void describe(Fields& fields, ExportFacts& f) {
  fields.keep(f.document);
  fields.value({"id", "Hash of the maps' files, the preset's files and the options", {}, kMustSay}, f.id);
  fields.value({"preset", "By which it was made", {}, kMustSay}, f.preset);
  fields.value({"name", "Of the cloth in file names", {}, kMustSay}, f.name);
  fields.value({"title", "Of the cloth, as people call it", {}, kUnlessEmpty}, f.title);
  fields.value({"normal", "The preset's direction: opengl, directx or both"}, f.normal);
  fields.value({"roughness", "The preset's convention"}, f.roughness);
  fields.value({"width", "Of the largest level, pixels", kAboveZero, kMustSay}, f.size.width);
  fields.value({"height", "Of the largest level, pixels", kAboveZero, kMustSay}, f.size.height);
  fields.value({.name = "mm_per_pixel",
                .says = "Side of a pixel, mm; two where they are not square, null where nobody knows",
                .range = kAboveZero,
                .need = kOrNull,
                .fewest = 1,
                .most = 2},
               f.mm_per_pixel);
  fields.value({.name = "size_mm",
                .says = "Width and height, mm; null where nobody knows",
                .range = kAboveZero,
                .need = kOrNull,
                .fewest = 2,
                .most = 2},
               f.size_mm);
  const bool is_said = f.document.is_object() && f.document.contains("size_known");
  fields.only_if(is_said || !f.is_size_known, [&] {
    fields.value({"size_known", "False: nobody said it, and millimetres are assumed"}, f.is_size_known);
  });
  fields.value({"is_tile", "It goes on over its borders"}, f.is_tile);
  fields.value({"albedo_scale", "absolute, relative or unknown"}, f.albedo_scale);
  fields.value({"notes", "Sentences that people should read"}, f.notes);
  fields.list({"files", "Its textures", {}, kMustSay}, f.files);
  fields.list({"documents", "What names or holds them", {}, kMustSay}, f.documents);
  fields.value({"from",
                "Ids and SHA-256 of maps, material or solve, of the session, its calibration and "
                "its raw files; level, draft and stale as in maps.json"},
               f.from);
}

Json json_of(const ExportFacts& facts) {
  Json json = {{"schema", fmt::format("{}/1", kExportProduct.schema)}};
  write_fields(json, facts);
  return json;
}

Result<ExportFacts> read_export(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kExportProduct.document;
  const Result<Json> document = read_json(file, kExportProduct.schema, 1);
  if (!document) return document.error();
  return read_fields<ExportFacts>(*document, file.string());
}

}  // namespace weft::exchange
