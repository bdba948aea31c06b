// SPDX-License-Identifier: Apache-2.0
#include "solve/run/solve_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "solver/method.h"

namespace weft::solve {
namespace {

constexpr NumberRange kTileSide = {1, 1 << 20};

/// A field for the levels, or for the methods that they are compared with.
Field field_of_methods(const char* name, const char* says, bool is_level) {
  Field field = {.name = name};
  std::vector<std::string> each_says;
  for (const solver::MethodName& each : solver::method_names()) {
    if (each.level.has_value() != is_level) continue;
    field.words.emplace_back(each.name);
    each_says.push_back(fmt::format("{} ({})", each.name, each.help));
  }
  field.says = fmt::format("{}: {}", says, fmt::join(each_says, ", "));
  return field;
}

void describe_session(Fields& fields, SolveRequest& r) {
  fields.value(
      {.name = "session", .says = "Session folder, NAME.weft", .path = PathTo::kSession, .option = ""},
      r.session.folder);
}

void describe_photographs(Fields& fields, SolveRequest& r) {
  fields.value({.name = "photos",
                .says = "Folder of photographs under distant lights, whose light file is in it or above",
                .said = Said::kAtThisMachine},
               r.photos.folder);
  fields.value(
      {.name = "light_file",
       .says = "Their lights, x right, y up, z to the camera: .lp, light_directions.txt, CSV, .npy, .dome, "
               ".relight or JSON of Meshroom",
       .option = "--lp",
       .said = Said::kAtThisMachine},
      r.photos.light_file);
  fields.value({.name = "skip_missing",
                .says = "Leave out lights whose photograph is not there",
                .said = Said::kAtThisMachine},
               r.photos.skips_missing);
  fields.need_one({"session", "photos", "light_file"});
  fields.exclude("session", "photos");
  fields.exclude("session", "light_file");
}

void describe_wish(Fields& fields, SolveRequest& r) {
  fields.value({.name = "within_s",
                .says = "Choose the best level that takes so many seconds, by --explain",
                .range = kAboveZero},
               r.wish.within_seconds);
  fields.value({.name = "to_deg",
                .says = "Choose the cheapest level expected to be so many degrees off at most",
                .range = kAboveZero},
               r.wish.to_deg);
}

void describe_level(Fields& fields, SolveRequest& r) {
  fields.value(field_of_methods("quality", "Level", true), r.quality);
  fields.value(field_of_methods("method", "Method for comparison", false), r.method);
  fields.value({.name = "explain",
                .says = "Solve nothing: predict, from a cut of the middle, each level's mean error in "
                        "degrees, the share of the cloth that it holds for, and its seconds here",
                .said = Said::kAtThisMachine},
               r.explain);
  fields.value({.name = "crops",
                .says = "With --explain: folder for what each level made of the same 512 x 256 pixels, "
                        "LEVEL_relit.png, LEVEL_normal.png and LEVEL_normal.exr",
                .said = Said::kAtThisMachine},
               r.crops);
  describe_wish(fields, r);
  fields.value({.name = "ladder",
                .says = "Solve by every level, and draw the same 128 x 128 normals of each into this PNG",
                .said = Said::kAtThisMachine},
               r.ladder);
  fields.value(
      {.name = "foretold",
       .says = "What --explain said of this solve, SECONDS,DEGREES,SHARE: solve.json keeps it beside what "
               "is taken",
       .range = kNotNegative,
       .said = Said::kAtThisMachine,
       .is_said_again = true},
      r.foretold);
  fields.require(r.foretold.empty() || (r.foretold.size() == 3 && r.foretold[2] <= 1), "foretold",
                 "must be three numbers, seconds, degrees and a share of at most 1, as weft solve --explain "
                 "prints them for the level");
  fields.exclude("quality", "method");
  fields.need("crops", "explain");
  fields.need("ladder", "session");
  for (const char* priced : {"explain", "within_s", "to_deg", "ladder"}) {
    for (const char* said : {"foretold", "quality", "method"}) fields.exclude(priced, said);
  }
  for (const char* priced : {"explain", "within_s", "to_deg"}) fields.exclude("ladder", priced);
}

void describe_readings(Fields& fields, SolveRequest& r) {
  fields.value({.name = "lights",
                .says = "LEDs or photographs to solve from, numbered from 1: 1,4,7; default all",
                .range = kAboveZero},
               r.session.leds);
  fields.value({.name = "calibration",
                .says = "Calibration folder; default the session's own",
                .path = PathTo::kFolder},
               r.session.calibration);
  fields.value({.name = "second_pose",
                .says = "Session of the same cloth lying tilted (weft scan --tilt), in which robust and "
                        "reference seek its lobe too",
                .path = PathTo::kSession},
               r.options.second_pose);
  fields.value({.name = "accept_moved",
                .says = "Solve although the last check of this rig's calibration did not pass before the "
                        "scan: the reason, which is kept",
                .is_sentence = true},
               r.accept_moved);
  fields.value(
      {.name = "cloth_spread",
       .says = "Share of the light that leaves the cloth beside where it entered, which is taken off: "
               "0.2 to 0.4 of white cotton, wool and chiffon, 0: none; default what the cloth and a shot "
               "with a blade tell (weft scan --blade)",
       .range = {0, solver::kMostSpread}},
      r.options.cloth_spread);
  fields.value(
      {.name = "spread_distance_mm", .says = "How far away it leaves, in the mean", .range = {0.001, 5}},
      r.options.spread_distance_mm);
  fields.need("spread_distance_mm", "cloth_spread");
  for (const char* of_session : {"calibration", "second_pose", "accept_moved"})
    fields.need(of_session, "session");
}

void describe_maps(Fields& fields, SolveRequest& r) {
  fields.value({.name = "output",
                .says = "Folder for the maps; default SESSION/solve/ID, or ./NAME-solve/ID for photographs",
                .option = "-o,--output",
                .said = Said::kAtThisMachine},
               r.options.output);
  for (const char* unsaved : {"explain", "ladder"}) fields.exclude(unsaved, "output");
  fields.choice({"compress", "Of EXR files: none, zip, piz"}, r.options.compression, kCompressionNames);
  fields.value({"tile_width", "Columns a tile (changes no byte of the result)", kTileSide},
               r.options.tile.width);
  fields.value({"tile_height", "Rows a tile (changes no byte of the result)", kTileSide},
               r.options.tile.height);
  fields.value({.name = "previews", .says = "Write no pictures", .option = "!--no-previews"},
               r.options.previews);
  fields.value({.name = "check",
                .says = "Print how well each light that is left out is predicted from the others",
                .said = Said::kAtThisMachine},
               r.check);
  fields.value({.name = "deblur", .says = "Leave the blur of the lens as it is", .option = "!--no-deblur"},
               r.options.deblur);
  fields.value({.name = "registration",
                .says = "Take the cloth to lie alike in all shots",
                .option = "!--no-registration"},
               r.options.registration);
  fields.value({"condition",
                "Also write condition.exr: the logarithm of the condition number of the lights that each "
                "pixel was solved from"},
               r.options.condition);
  fields.value(
      {.name = "strict", .says = "Exit with 2 where pixels have no solution", .said = Said::kAtThisMachine},
      r.strict);
}

}  // namespace

const std::string& SolveRequest::method_asked() const {
  return !method.empty() ? method : !quality.empty() ? quality : options.method;
}

void describe(Fields& fields, SolveRequest& r) {
  describe_session(fields, r);
  describe_photographs(fields, r);
  describe_level(fields, r);
  describe_readings(fields, r);
  describe(fields, r.session.reading);
  fields.value({"unsay", "Of imported photographs: forget how they were read before"},
               r.session.forgets_reading);
  fields.need("unsay", "session");
  fields.value(
      {.name = "dark",
       .says = "The same photograph with all lamps off, which is taken from the others; else dark.* or "
               "ambient.* beside them",
       .said = Said::kAtThisMachine},
      r.photos.dark);
  fields.exclude("session", "dark");
  describe_maps(fields, r);
}

void describe(Fields& fields, PriceRequest& request) {
  describe_session(fields, request.solve);
  fields.need_one({"session"});
  describe_wish(fields, request.solve);
  describe_readings(fields, request.solve);
  describe(fields, request.solve.session.reading);
}

}  // namespace weft::solve
