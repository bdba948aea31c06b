// SPDX-License-Identifier: Apache-2.0
#include "material/run/maps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/image_io/image_io.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "material/opacity/fill.h"
#include "material/opacity/opacity.h"
#include "material/run/finishing.h"
#include "material/run/light_below.h"
#include "material/run/map_work.h"
#include "material/run/maps_page.h"
#include "material/run/session_sets.h"
#include "material/run/surface_files.h"
#include "material/validation/validate.h"
#include "report/downsampler.h"
#include "report/preview.h"
#include "solve/files/pictures.h"
#include "solve/session/solved.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 3;  // raised whenever the bytes of a map may change

// What a session holds, as its session.json tells by the digests of its frames; empty where none is named.
Result<std::string> digest_of(const fs::path& session) {
  return session.empty() ? Result<std::string>(std::string()) : sha256_of_file(session / "session.json");
}

// Room that maps take at most, bytes a pixel.
std::uint64_t bytes_of_maps(Size size) {
  return 90 * static_cast<std::uint64_t>(size.pixels());
}

// Where the cloth has holes, by the light below where the bare table is known, else by what the solver saw.
Result<std::optional<OpacityFacts>> find_opacity(const MapsOptions& options, const Session& session,
                                                 const RectifyReport& rectified, Surface& surface,
                                                 const JobContext& context) {
  if (options.bare.empty()) {
    Opacity marked = opacity_from_status(surface.status.plane());
    if (marked.facts.holes == 0) return std::optional<OpacityFacts>();
    surface.opacity = std::move(marked.map);
    return std::optional(marked.facts);
  }
  if (solve::photographed_pixel(session)) {
    return Error{ErrorKind::kUsage, "the light below is that of a rig", "--bare",
                 session.folder.string() + " is a solve of photographs under distant lights", "leave it out"};
  }
  const Result<Calibration> calibration =
      read_calibration(options.calibration.empty() ? session.calibration_folder() : options.calibration);
  if (!calibration) return calibration.error();
  const Result<ThroughCloth> through =
      light_through_cloth(session, options.bare, *calibration, rectified.facts, context.threads);
  if (!through) return through.error();
  Result<Opacity> opacity =
      opacity_from_transmission({through->share.plane(), through->saturated.plane()}, context.threads);
  if (!opacity) return std::move(opacity).error();
  surface.opacity = std::move(opacity->map);
  return std::optional(opacity->facts);
}

// Rims of holes are part table: what of them is cloth. Pixels with too little of it have no solution.
Result<std::optional<TableTakenOut>> take_table_out(const MapsOptions& options, Surface& surface,
                                                    int threads) {
  if (options.table_albedo.empty()) return std::optional<TableTakenOut>();
  const std::vector<double>& a = options.table_albedo;
  const Result<TableFacts> facts = remove_table(surface, {a[0], a[1], a[2]}, threads);
  if (!facts) return facts.error();
  return std::optional(TableTakenOut{{a[0], a[1], a[2]}, facts->unmixed, facts->left});
}

// What a photograph by the light below would tell, and does not.
std::vector<Verdict> missing_bare(const MapsOptions& options, const Session& session) {
  if (!options.bare.empty() || !has_light_below(session)) return {};
  return {{"OPACITY_UNKNOWN",
           "the light below photographed the cloth, but nobody knows how bright the bare table is",
           "scan the table without cloth by the same exposure and name that session with --bare"}};
}

// Albedo, normals and relit cloth, as a person looks at them first.
Result<void> draw_surface(const fs::path& folder, const Surface& surface) {
  report::Downsampler slope(surface.size(), 2), albedo(surface.size(), 3);
  slope.add_rows(planes_of(surface.slope), surface.status.plane());
  albedo.add_rows(planes_of(surface.albedo), surface.status.plane());
  const Image<float> normal = normals_of(slope.averages());
  const Image<float>& seen = albedo.averages();
  const double scale = report::display_scale(seen);
  if (Result<void> ok = solve::write_png(folder / "albedo.png", report::albedo_picture(seen, scale)); !ok)
    return ok;
  if (Result<void> ok = solve::write_png(folder / "normal.png", report::normal_picture(normal)); !ok)
    return ok;
  return solve::write_png(folder / "relit.png", report::relit_picture(seen, normal, scale));
}

std::vector<MapStep> steps_of(const Recipe& recipe, const FinishingFacts& facts) {
  const Json told = json_of(recipe)["steps"];
  std::vector<MapStep> steps;
  for (std::size_t i = 0; i < told.size(); ++i) {
    const Json found = i < facts.steps.size() ? facts.steps[i] : Json();
    steps.push_back({told[i]["do"].get<std::string>(), found, told[i]});
  }
  return steps;
}

// What the calibration leaves open of a slope, as the solve says it of most pixels.
Result<FinishingInput> known_of(const Session& session, const RectifyReport& rectified, bool is_preview) {
  const Result<Product> solve = find_solve(session.folder, rectified.facts.source.solve);
  if (!solve) return solve.error();
  const Result<Json> document = read_json(solve->folder / kSolveProduct.document, kSolveProduct.schema, 1);
  if (!document) return document.error();
  const Result<SolveFacts> facts = solve_facts_from_json(*document);
  if (!facts) return facts.error();
  const std::optional<SigmaFacts>& sigma = facts->sigma_normal_deg;
  const bool is_told = sigma && sigma->calibration;
  return FinishingInput{.slow_sigma_deg = is_told ? sigma->calibration->median : 0.0,
                        .most_px = is_preview ? kPreviewPixels : 0};
}

// A step that may be taken back.
bool changes_colour(const Recipe& recipe) {
  return std::ranges::find(recipe.steps, "color", &RecipeStep::name) != recipe.steps.end();
}

// A step that says how large a pixel is.
bool says_scale(const Recipe& recipe) {
  return std::ranges::any_of(recipe.steps, [](const RecipeStep& step) {
    return step.name == "scale" && step.options.value("mm_per_pixel", 0.0) > 0;
  });
}

// On the grid that flattening found, which later steps changed.
Result<void> write_removed(MapWork& work, const FinishingFacts& finished) {
  if (finished.removed.empty()) return {};
  const fs::path folder = work.folder / "removed";
  if (Result<void> ok = make_writable_folder(folder); !ok) return ok;
  MapFacts facts = {.name = "removed", .file = "removed/slopes.exr", .channels = {"slope_x", "slope_y"}};
  measure(facts, finished.removed.plane(0));
  facts.why = "slopes that flattening took off, mm a mm";
  facts.more = {{"width", finished.removed.width()}, {"height", finished.removed.height()}};
  work.made.push_back(std::move(facts));
  return write_image(folder / "slopes.exr", planes_of(finished.removed), {"slope_x", "slope_y"},
                     {.compression = work.compression});
}

// Each that was asked for, in the order of derived_maps().
Result<void> derive(const std::vector<std::string>& asked, MapWork& work) {
  double done = 0;
  for (const DerivedMap& map : derived_maps()) {
    if (std::ranges::find(asked, map.name) == asked.end()) continue;
    if (work.context.stop.stop_requested()) return interrupted();
    work.context.progress("maps", done++ / static_cast<double>(asked.size()));
    if (Result<void> ok = map.make(work); !ok) return ok;
  }
  return {};
}

// The share of each square of pixels that a finding is about.
Result<void> draw_where(const std::filesystem::path& file, const Image<std::uint8_t>& where) {
  Image<float> marked(where.size());
  for (int y = 0; y < where.height(); ++y) {
    for (int x = 0; x < where.width(); ++x) marked(x, y) = where(x, y) > 0 ? 1.0F : 0.0F;
  }
  report::Downsampler reduced(marked.size(), 1);
  reduced.add_rows(std::vector<View<const float>>{marked.plane()});
  return solve::write_png(file, report::heat_picture(reduced.averages().plane(), 1, " share"));
}

// What validation says of maps.
struct CheckedMaps {
  std::vector<MapCheck> checks;
  std::vector<Verdict> verdicts;
};

// Whether the maps are those of a cloth and fit to be put on a material. Those that did not pass have a
// picture of where.
Result<CheckedMaps> check_maps(const MapWork& work, const Session& session) {
  MapsToValidate maps;
  maps.surface = &work.surface;
  maps.openness = work.openness.empty() ? View<const float>() : View<const float>(work.openness.plane());
  // The slopes of a tile's height are those of its waves, which differences of pixels are not.
  if (!work.height_mm.empty() && !work.surface.is_tile) maps.height_mm = work.height_mm.plane();
  maps.has_measured_black = session.dark() != nullptr;
  maps.is_of_rig = !solve::photographed_pixel(session);
  maps.level = work.level;
  maps.is_height_of_slopes = true;
  maps.is_colour_changed = work.is_colour_changed;
  ValidationLimits limits;
  limits.threads = work.context.threads;
  const Result<std::vector<Finding>> findings = validate(maps, limits);
  if (!findings && findings.error().kind == ErrorKind::kBadData) {
    return CheckedMaps{{}, {{"NO_CLOTH", "no pixel is cloth that was solved", findings.error().remedy}}};
  }
  if (!findings) return findings.error();
  CheckedMaps checked = {.checks = {}, .verdicts = verdicts_of(*findings)};
  for (const Finding& finding : *findings) {
    MapCheck check = {finding.verdict.name, finding.severity,     finding.number,
                      finding.limit,        finding.verdict.text, {}};
    if (finding.severity != Severity::kPassed && !finding.where.empty()) {
      check.picture = "where_" + finding.verdict.name + ".png";
      if (Result<void> ok = draw_where(work.folder / check.picture, finding.where); !ok)
        return std::move(ok).error();
    }
    checked.checks.push_back(std::move(check));
  }
  return checked;
}

MapSetFacts facts_of(const Product& product, const RectifyFacts& rectified, const MapsOptions& options,
                     const FinishingFacts& finished, const MapWork& work, CheckedMaps checked) {
  const Surface& surface = work.surface;
  MapSetFacts facts = {.id = product.id,
                       .source = rectified.source,
                       .rectified = rectified.id,
                       .size = surface.size(),
                       .mm_per_pixel = surface.mm_per_pixel,
                       .is_tile = surface.is_tile,
                       .is_preview = options.is_preview,
                       .place = finished.place,
                       .part_mm = finished.part_mm,
                       .steps = steps_of(options.recipe, finished),
                       .maps = work.made,
                       .derive = options.derive,
                       .checks = std::move(checked.checks),
                       .verdicts = finished.verdicts};
  facts.source.is_size_known = work.is_size_known;
  for (MapFacts& map : facts.maps) map.document = json_of(map);
  for (const std::vector<Verdict>& more : {work.verdicts, checked.verdicts})
    facts.verdicts.insert(facts.verdicts.end(), more.begin(), more.end());
  return facts;
}

// A set that was there and is asked for again is the newest: exports and materials take it.
Result<MapSetFacts> asked_for_again(const Product& product, const RectifyReport& rectified,
                                    const Json& document) {
  const fs::path file = product.folder / kMapsProduct.document;
  std::error_code ignored;  // of an archive that cannot be written
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  Result<MapSetFacts> facts = read_fields<MapSetFacts>(document, file.string());
  if (!facts) return facts;
  const bool is_size_known = facts->source.is_size_known;
  facts->source = rectified.facts.source;
  facts->source.is_size_known = is_size_known;
  return facts;
}

// Previews are looked at once.
void remove_previews(const fs::path& parent, const fs::path& but_not) {
  for (const Product& product : list_products(kMapsProduct, parent)) {
    const Result<MapSetFacts> facts = read_map_set(product.folder);
    std::error_code ignored;
    if (facts && facts->is_preview && product.folder != but_not) fs::remove_all(product.folder, ignored);
  }
}

Result<void> check(const MapsOptions& options) {
  const std::vector<double>& table = options.table_albedo;
  if (table.empty()) return {};
  const auto unfit = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, "the table cannot be taken out of the rims of holes", "--table",
                 std::move(why), std::move(remedy)};
  };
  if (options.bare.empty())
    return unfit("which share of a pixel is table is told by the bare table alone",
                 "name its session with --bare");
  if (table.size() != 3 || std::ranges::any_of(table, [](double a) { return !(a >= 0 && a <= 1); }))
    return unfit(fmt::format("its albedo is {}", fmt::join(table, ",")), "give R,G,B, each of 0 to 1");
  return {};
}

Result<Product> product_wanted(const MapsOptions& options, const Session& session,
                               const RectifyReport& rectified) {
  Result<std::string> bare = digest_of(options.bare);
  if (!bare) return std::move(bare).error();
  const Json inputs = {{"version", kVersion},
                       {"rectified", rectified.facts.id},
                       {"recipe", json_of(options.recipe)},
                       {"maps", options.maps},
                       {"derive", object_of(options.derive)},
                       {"bare", *bare},
                       {"table_albedo", options.table_albedo},
                       {"preview", options.is_preview ? Json(kPreviewPixels) : Json(false)},
                       {"compression", name_of(options.compression)}};
  return product_of(kMapsProduct, inputs, session.folder / "maps", options.output);
}

// All files of the set, in a folder aside.
Result<MapSetFacts> make_set(const MapsOptions& options, const Session& session,
                             const RectifyReport& rectified, const Product& product,
                             const PartialFolder& aside, const JobContext& context) {
  Result<RectifiedSurface> read = read_surface(rectified.folder, rectified.facts.mm_per_pixel);
  if (!read) return std::move(read).error();
  Surface& surface = read->surface;
  read->is_size_known = rectified.facts.source.is_size_known || says_scale(options.recipe);
  if (Result<void> begun = begin(aside, bytes_of_maps(surface.size())); !begun)
    return std::move(begun).error();
  const Result<std::optional<OpacityFacts>> opacity =
      find_opacity(options, session, rectified, surface, context);
  if (!opacity) return opacity.error();
  const Result<std::optional<TableTakenOut>> table = take_table_out(options, surface, context.threads);
  if (!table) return table.error();
  const Result<FinishingInput> known = known_of(session, rectified, options.is_preview);
  if (!known) return known.error();
  const Result<FinishingFacts> finished = finish_surface(surface, options.recipe, *known, context);
  if (!finished) return finished.error();
  fill_holes(surface, {.threads = context.threads});
  if (Result<void> ok = write_surface(aside.path(), *read, options.compression); !ok)
    return std::move(ok).error();
  if (Result<void> ok = draw_surface(aside.path(), surface); !ok) return std::move(ok).error();
  for (const StepPicture& each : finished->pictures) {
    if (Result<void> ok = solve::write_png(aside.path() / each.file, each.picture); !ok)
      return std::move(ok).error();
  }
  MapWork work = {.surface = surface,
                  .has_f0 = read->has_f0,
                  .is_size_known = read->is_size_known,
                  .folder = aside.path(),
                  .compression = options.compression,
                  .options = options.derive,
                  .context = context,
                  .level = rectified.facts.source.level,
                  .is_colour_changed = changes_colour(options.recipe),
                  .opacity = *opacity,
                  .yarn_px = finished->yarn_px,
                  .verdicts = missing_bare(options, session)};
  if (Result<void> ok = write_removed(work, *finished); !ok) return std::move(ok).error();
  if (Result<void> ok = derive(options.maps, work); !ok) return std::move(ok).error();
  // A layer of detail has no reflectance that could be checked.
  Result<CheckedMaps> checked = CheckedMaps();
  if (!finished->is_detail) checked = check_maps(work, session);
  if (!checked) return std::move(checked).error();
  MapSetFacts facts = facts_of(product, rectified.facts, options, *finished, work, std::move(*checked));
  facts.table = *table;
  if (Result<void> ok = write_maps_page(aside.path(), facts); !ok) return std::move(ok).error();
  if (Result<void> ok = write_json(aside.path() / kMapsProduct.document, json_of(facts)); !ok)
    return std::move(ok).error();
  return facts;
}

}  // namespace

Result<RectifyReport> rectified_maps(const MapsOptions& options, const JobContext& context) {
  RectifyOptions rectify;
  rectify.session = options.session;
  rectify.solve = options.solve;
  rectify.is_draft = options.is_draft;
  rectify.calibration = options.calibration;
  rectify.mm_per_pixel = options.mm_per_pixel;
  return rectify_session(rectify, context);
}

Result<MapsReport> make_maps(const MapsOptions& wanted, const JobContext& context) {
  if (Result<void> ok = check(wanted); !ok) return std::move(ok).error();
  const Result<Session> session = solve::read_solved(wanted.session);
  if (!session) return session.error();
  MapsOptions options = wanted;
  if (options.derive.cloth.empty()) options.derive.cloth = cloth_kind_of(*session);
  const Result<RectifyReport> rectified = rectified_maps(options, context);
  if (!rectified) return rectified.error();
  const Result<Product> product = product_wanted(options, *session, *rectified);
  if (!product) return product.error();
  Result<std::optional<Json>> found = find_finished(*product);
  if (!found) return std::move(found).error();
  if (*found) {
    Result<MapSetFacts> facts = asked_for_again(*product, *rectified, **found);
    if (!facts) return std::move(facts).error();
    return MapsReport{product->folder, true, std::move(*facts)};
  }
  PartialFolder partial(product->folder);
  Result<MapSetFacts> facts = make_set(options, *session, *rectified, *product, partial, context);
  if (!facts) return std::move(facts).error();
  if (Result<void> ok = partial.publish(); !ok) return std::move(ok).error();
  if (options.is_preview) remove_previews(session->folder / "maps", product->folder);
  context.progress("maps", 1);
  return MapsReport{product->folder, false, std::move(*facts)};
}

}  // namespace weft::material
