// SPDX-License-Identifier: Apache-2.0
#include "material/run/rectify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/describe/described_fields.h"
#include "core/describe/field_check.h"
#include "core/describe/field_json.h"
#include "core/image_io/image_io.h"
#include "core/image_io/solve_maps.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "core/solve/solve_record.h"
#include "material/table_grid.h"
#include "solve/session/solved.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr int kRectifiedVersion = 3;  // raised whenever the bytes of a map may change
constexpr const char* kFilter =
    "cubic convolution, a = -1/2 (Keys 1981), stretched to the grid where it is coarser than the frame";
constexpr const char* kNoFilter = "none: the grid is that of the photographs";
constexpr double kFarAbove_mm = 1000;  // of photographs, whose lens nobody knows

Result<CameraModel> camera_of_maps(const CameraModel& camera, Size maps, const fs::path& folder) {
  const auto reduces = [&](int factor) {
    return maps.width == camera.size.width / factor && maps.height == camera.size.height / factor;
  };
  for (const int factor : {1, 2}) {
    if (reduces(factor)) return reduced_camera(camera, factor);
  }
  return Error{ErrorKind::kBadData, "maps are not of the calibrated camera", folder.string(),
               fmt::format("they have {} x {} pixels, its frames {} x {}", maps.width, maps.height,
                           camera.size.width, camera.size.height),
               "name the calibration that the session was taken with"};
}

// What sees the maps of a solve, and the grid that they go to.
struct Sight {
  std::string calibration;  // its id
  CameraModel camera;
  TableGrid grid;
  bool is_own_grid = false;   // each pixel of the grid is one of the maps
  PixelPitch stated_mm = {};  // in files; none where it is assumed
};

// Everything that one map after another is made with.
struct Rectification {
  Sight sight;
  Image<std::uint16_t> status;
  fs::path to;
  const RectifyOptions& options;
  const JobContext& context;
};

// Calls make(first row, rows) band by band.
template <typename Make>
Result<void> by_bands(const Rectification& r, const Make& make) {
  const int height = r.sight.grid.size.height;
  for (int y = 0; y < height; y += r.options.band_rows) {
    if (r.context.stop.stop_requested()) return interrupted();
    if (const Result<void> made = make(y, std::min(r.options.band_rows, height - y)); !made) return made;
  }
  return {};
}

// Azimuths from 0 to 180 against the grid's rows. 0 also says that a lobe has no direction: it stays.
void turn_yarns(double turn_deg, View<float> yarn_deg) {
  if (turn_deg == 0) return;
  for (int y = 0; y < yarn_deg.height(); ++y) {
    for (int x = 0; x < yarn_deg.width(); ++x) {
      const double turned = static_cast<double>(yarn_deg(x, y)) - turn_deg;
      if (yarn_deg(x, y) != 0) yarn_deg(x, y) = static_cast<float>(turned - 180 * std::floor(turned / 180));
    }
  }
}

void copy_rows(std::span<const View<const float>> map, int y, std::span<const View<float>> out) {
  for (std::size_t p = 0; p < out.size(); ++p) {
    for (int j = 0; j < out[p].height(); ++j) std::copy_n(map[p].row(y + j), out[p].width(), out[p].row(j));
  }
}

Result<void> rectify_map(const Rectification& r, const std::string& name, MapKind kind, SampleType type,
                         const Result<LoadedImage>& map) {
  if (!map) return map.error();
  const Sight& s = r.sight;
  const Size size = s.grid.size;
  const auto yarn_channel = std::ranges::find(map->info.channels, "yarn_deg");
  const int yarn = yarn_channel == map->info.channels.end()
                       ? -1
                       : static_cast<int>(yarn_channel - map->info.channels.begin());
  std::vector<View<const float>> planes;
  for (int p = 0; p < map->planes.planes(); ++p) planes.push_back(map->planes.plane(p));
  Result<ImageWriter> writer =
      ImageWriter::open(r.to / name, size, map->info.channels,
                        {.type = type, .compression = r.options.compression, .pitch_mm = s.stated_mm});
  if (!writer) return std::move(writer).error();
  Image<float> band({size.width, r.options.band_rows}, static_cast<int>(planes.size()));
  const Result<void> done = by_bands(r, [&](int y, int rows) {
    std::vector<View<float>> out;
    for (int p = 0; p < band.planes(); ++p) out.push_back(band.plane(p).crop({0, 0, size.width, rows}));
    if (s.is_own_grid) {
      copy_rows(planes, y, out);
    } else {
      rectify_rows(s.camera, s.grid, kind, planes, r.status.plane(), y, r.context.threads, out);
    }
    if (yarn >= 0) turn_yarns(s.grid.turn_deg, out[static_cast<std::size_t>(yarn)]);
    return writer->write_rows(std::vector<View<const float>>(out.begin(), out.end()));
  });
  if (!done) return done;
  return writer->finish();
}

Result<void> rectify_status(const Rectification& r, std::int64_t& solved) {
  const Sight& s = r.sight;
  const Size size = s.grid.size;
  Result<ImageWriter> writer = ImageWriter::open(r.to / "status.png", size, {"Y"},
                                                 {.type = SampleType::kUint16, .pitch_mm = s.stated_mm});
  if (!writer) return std::move(writer).error();
  Image<std::uint16_t> band({size.width, r.options.band_rows});
  const Result<void> done = by_bands(r, [&](int y, int rows) {
    const View<std::uint16_t> out = band.plane().crop({0, 0, size.width, rows});
    if (!s.is_own_grid) rectify_status_rows(s.camera, s.grid, r.status.plane(), y, r.context.threads, out);
    for (int j = 0; j < rows; ++j) {
      if (s.is_own_grid) std::copy_n(r.status.plane().row(y + j), out.width(), out.row(j));
      solved += std::count_if(out.row(j), out.row(j) + out.width(),
                              [](auto bits) { return (bits & kNoSolution) == 0; });
    }
    return writer->write_rows(View<const std::uint16_t>(out));
  });
  if (!done) return done;
  return writer->finish();
}

// All maps that the solve has.
Result<void> rectify_maps(const Rectification& r, const SolveMaps& maps, const fs::path& solve) {
  r.context.progress("rectify", 0.1);
  Result<void> made = rectify_map(r, "normal.exr", MapKind::kNormal, SampleType::kFloat, maps.normal());
  if (!made) return made;
  r.context.progress("rectify", 0.4);
  made = rectify_map(r, "albedo.exr", MapKind::kValue, SampleType::kHalf, maps.albedo());
  if (!made) return made;
  r.context.progress("rectify", 0.7);
  made = rectify_map(r, "sigma.exr", MapKind::kSigma, SampleType::kHalf, maps.sigma());
  if (!made) return made;
  for (const char* name : {"roughness.exr", "specular.exr"}) {
    if (!is_there(solve / name)) continue;
    made = rectify_map(r, name, MapKind::kChoice, SampleType::kHalf, read_image(solve / name));
    if (!made) return made;
  }
  return {};
}

RectifyFacts facts_of(const std::string& id, const solve::SourceFacts& source, const Rectification& r,
                      std::int64_t solved) {
  const TableGrid& g = r.sight.grid;
  const Vec3 corner = g.point_mm(0, 0);
  return {.id = id,
          .source = source,
          .calibration = r.sight.calibration,
          .size = g.size,
          .mm_per_pixel = g.mm_per_pixel,
          .height_mm = g.height_mm,
          .turn_deg = g.turn_deg,
          .centre_mm = {g.centre_x_mm, g.centre_y_mm},
          .first_pixel_mm = {corner.x, corner.y},
          .normals = "in the grid's axes: x along its rows, y up its columns, z to the camera",
          .filter = r.sight.is_own_grid ? kNoFilter : kFilter,
          .compression = r.options.compression,
          .pixels = solved,
          .document = {}};
}

Result<Calibration> calibration_with_camera(const fs::path& folder) {
  Result<Calibration> calibration = read_calibration(folder);
  if (!calibration || calibration->camera) return calibration;
  return Error{ErrorKind::kBadData, "calibration has no camera", folder.string(), "there is no camera.json",
               "calibrate the camera with weft calibrate camera"};
}

solve::SourceFacts source_today(const Session& session, const solve::SessionSolves& solves,
                                const solve::ChoosableSolve& solve) {
  solve::SourceFacts source = solve::source_of(solve, why_stale(solves, solve.id));
  if (const auto pixel = solve::photographed_pixel(session)) {
    source.pixel_mm = pixel->mm;
    source.is_size_known = pixel->is_known;
  }
  return source;
}

Result<Sight> sight_of_rig(const Session& session, const RectifyOptions& options, Size maps,
                           const fs::path& solve) {
  const Result<Calibration> calibration = calibration_with_camera(
      options.calibration.empty() ? session.calibration_folder() : options.calibration);
  if (!calibration) return calibration.error();
  const CameraModel seen = seen_from(session.pose, session.cloth_height_mm, *calibration->camera);
  Result<CameraModel> camera = camera_of_maps(seen, maps, solve);
  if (!camera) return std::move(camera).error();
  const Result<TableGrid> grid =
      table_grid(*camera, {options.mm_per_pixel.value_or(0), session.cloth_height_mm, options.turn_deg});
  if (!grid) return grid.error();
  return Sight{calibration->id, std::move(*camera), *grid, false, {grid->mm_per_pixel, grid->mm_per_pixel}};
}

// Photographs without a calibration are taken as seen from straight above, by a lens without distortion.
Result<Sight> sight_of_photographs(const solve::SourceFacts& source, const RectifyOptions& options,
                                   Size maps) {
  if (!options.calibration.empty()) {
    return Error{ErrorKind::kUsage, "photographs under distant lights have no camera to calibrate",
                 "--calibration", "they are taken as seen from straight above", "leave it out"};
  }
  const double mm = *source.pixel_mm * (source.is_draft ? 2 : 1);
  Sight sight = {"", overhead_camera(maps, kFarAbove_mm, mm), {maps, mm}, true, {}};
  if (options.turn_deg != 0 || options.mm_per_pixel.value_or(mm) != mm) {
    const Result<TableGrid> grid =
        table_grid(sight.camera, {options.mm_per_pixel.value_or(mm), 0, options.turn_deg});
    if (!grid) return grid.error();
    sight.grid = *grid;
    sight.is_own_grid = false;
  }
  if (source.is_size_known) sight.stated_mm = {sight.grid.mm_per_pixel, sight.grid.mm_per_pixel};
  return sight;
}

// Room that the maps take at most: normal 12, sigma 32, albedo 6, roughness and specular 10, status 2 bytes a
// pixel.
std::uint64_t bytes_of_rectified(Size size) {
  return 62 * static_cast<std::uint64_t>(size.pixels());
}

}  // namespace

void describe(Fields& fields, RectifyOptions& o) {
  describe_session(fields, o.session);
  describe_solve(fields, o.solve, o.is_draft, o.calibration);
  describe_output(fields, o.output, "Folder for the maps; default SESSION/rectified/ID");
  describe_grid(fields, o.mm_per_pixel);
  fields.value({"turn_deg", "Degrees that the grid is turned, counterclockwise from above", {-360, 360}},
               o.turn_deg);
  describe_compression(fields, o.compression);
  fields.require(o.band_rows >= 1, "band_rows", "must be 1 or more");
}

void describe(Fields& fields, RectifyFacts& f) {
  fields.keep(f.document);
  fields.value({"id", "Hash of the solve, the calibration and the options", {}, kMustSay}, f.id);
  fields.value({"solve", "Id of the solve that they are of", {}, kMustSay}, f.source.solve);
  fields.value({"calibration", "Id of that whose camera was undone", {}, kMustSay}, f.calibration);
  fields.value({"width", "Of the maps, pixels", kAboveZero, kMustSay}, f.size.width);
  fields.value({"height", "Of the maps, pixels", kAboveZero, kMustSay}, f.size.height);
  fields.value({"mm_per_pixel", "Side of a pixel, mm", kAboveZero, kMustSay}, f.mm_per_pixel);
  fields.value({"height_mm", "Of the plane of the grid above the table, mm", {}, kMustSay}, f.height_mm);
  fields.value({"turn_deg", "Of the grid, counterclockwise from above, degrees", {}, kMustSay}, f.turn_deg);
  fields.value({"centre_mm", "Of the grid: x and y on the table, mm", {}, kMustSay}, f.centre_mm);
  fields.value({"first_pixel_mm", "Of the middle of the upper left pixel: x and y on the table, mm"},
               f.first_pixel_mm);
  fields.value({"normals", "Which axes they are in, a sentence"}, f.normals);
  fields.value({"filter", "How the solve's pixels were weighed, a sentence"}, f.filter);
  fields.choice({"compression", "Of its EXR files"}, f.compression, kCompressionNames);
  fields.value({"pixels", "With a solution"}, f.pixels);
  fields.value({"level", "Of the solve, or the method of comparison", {}, kUnlessEmpty}, f.source.level);
  fields.value({"draft", "The solve is a preview"}, f.source.is_draft);
  fields.value({"stale", "Why another would have been made then, sentences", {}, kUnlessEmpty},
               f.source.stale);
  solve::describe_size(fields, f.source, f.document);
}

Json json_of(const RectifyFacts& facts) {
  Json json = {{"schema", fmt::format("{}/1", kRectifiedProduct.schema)}};
  write_fields(json, facts);
  return json;
}

Result<RectifyReport> rectify_session(const RectifyOptions& options, const JobContext& context) {
  if (const Result<void> ok = check_fields(options); !ok) return ok.error();
  const Result<Session> session = solve::read_solved(options.session);
  if (!session) return session.error();
  const solve::SessionSolves solves = solve::solves_of(*session);
  const Result<solve::ChoosableSolve> solve = solve::solve_for_maps(solves, options.solve, options.is_draft);
  if (!solve) return solve.error();
  const solve::SourceFacts source = source_today(*session, solves, *solve);
  const Result<SolveMaps> maps = SolveMaps::open(solve->folder);
  if (!maps) return maps.error();
  Result<Sight> sight = source.pixel_mm ? sight_of_photographs(source, options, maps->size())
                                        : sight_of_rig(*session, options, maps->size(), solve->folder);
  if (!sight) return std::move(sight).error();
  const TableGrid grid = sight->grid;

  Json inputs = {{"version", kRectifiedVersion},
                 {"solve", solve->id},
                 {"calibration", sight->calibration},
                 {"mm_per_pixel", grid.mm_per_pixel},
                 {"height_mm", grid.height_mm},
                 {"turn_deg", grid.turn_deg},
                 {"compression", name_of(options.compression)}};
  if (source.pixel_mm) inputs["photographed"] = {*source.pixel_mm, source.is_size_known};
  const Product product =
      product_of(kRectifiedProduct, inputs, session->folder / "rectified", options.output);
  Result<std::optional<Json>> finished = find_finished(product);
  if (!finished) return std::move(finished).error();
  if (*finished) {
    Result<RectifyFacts> facts =
        read_fields<RectifyFacts>(**finished, (product.folder / kRectifiedProduct.document).string());
    if (!facts) return std::move(facts).error();
    facts->source = source;
    return RectifyReport{product.folder, true, std::move(*facts)};
  }

  Result<Image<std::uint16_t>> status = maps->status();
  if (!status) return std::move(status).error();
  PartialFolder partial(product.folder);
  if (const Result<void> begun = begin(partial, bytes_of_rectified(grid.size)); !begun) return begun.error();
  const Rectification r = {std::move(*sight), std::move(*status), partial.path(), options, context};
  std::int64_t solved = 0;
  if (const Result<void> ok = rectify_status(r, solved); !ok) return ok.error();
  if (const Result<void> ok = rectify_maps(r, *maps, solve->folder); !ok) return ok.error();
  RectifyFacts facts = facts_of(product.id, source, r, solved);
  const Result<void> written = write_json(partial.path() / kRectifiedProduct.document, json_of(facts));
  if (!written) return written.error();
  if (const Result<void> ok = partial.publish(); !ok) return ok.error();
  context.progress("rectify", 1);
  return RectifyReport{product.folder, false, std::move(facts)};
}

}  // namespace weft::material
