// SPDX-License-Identifier: Apache-2.0
#include "material/run/rectify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
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
#include "solve/session/current.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr int kRectifiedVersion = 3;  // raised whenever the bytes of a map may change
constexpr const char* kFilter =
    "cubic convolution, a = -1/2 (Keys 1981), stretched to the grid where it is coarser than the frame";

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

// Everything that one map after another is made with.
struct Rectification {
  CameraModel camera;
  TableGrid grid;
  Image<std::uint16_t> status;
  fs::path to;
  const RectifyOptions& options;
  const JobContext& context;
};

// Calls make(first row, rows) band by band.
template <typename Make>
Result<void> by_bands(const Rectification& r, const Make& make) {
  const int height = r.grid.size.height;
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

Result<void> rectify_map(const Rectification& r, const std::string& name, MapKind kind, SampleType type,
                         const Result<LoadedImage>& map) {
  if (!map) return map.error();
  const auto yarn_channel = std::ranges::find(map->info.channels, "yarn_deg");
  const int yarn = yarn_channel == map->info.channels.end()
                       ? -1
                       : static_cast<int>(yarn_channel - map->info.channels.begin());
  std::vector<View<const float>> planes;
  for (int p = 0; p < map->planes.planes(); ++p) planes.push_back(map->planes.plane(p));
  Result<ImageWriter> writer = ImageWriter::open(r.to / name, r.grid.size, map->info.channels,
                                                 {.type = type,
                                                  .compression = r.options.compression,
                                                  .pitch_mm = {r.grid.mm_per_pixel, r.grid.mm_per_pixel}});
  if (!writer) return std::move(writer).error();
  Image<float> band({r.grid.size.width, r.options.band_rows}, static_cast<int>(planes.size()));
  const Result<void> done = by_bands(r, [&](int y, int rows) {
    std::vector<View<float>> out;
    for (int p = 0; p < band.planes(); ++p)
      out.push_back(band.plane(p).crop({0, 0, r.grid.size.width, rows}));
    rectify_rows(r.camera, r.grid, kind, planes, r.status.plane(), y, r.context.threads, out);
    if (yarn >= 0) turn_yarns(r.grid.turn_deg, out[static_cast<std::size_t>(yarn)]);
    return writer->write_rows(std::vector<View<const float>>(out.begin(), out.end()));
  });
  if (!done) return done;
  return writer->finish();
}

Result<void> rectify_status(const Rectification& r, std::int64_t& solved) {
  Result<ImageWriter> writer = ImageWriter::open(
      r.to / "status.png", r.grid.size, {"Y"},
      {.type = SampleType::kUint16, .pitch_mm = {r.grid.mm_per_pixel, r.grid.mm_per_pixel}});
  if (!writer) return std::move(writer).error();
  Image<std::uint16_t> band({r.grid.size.width, r.options.band_rows});
  const Result<void> done = by_bands(r, [&](int y, int rows) {
    const View<std::uint16_t> out = band.plane().crop({0, 0, r.grid.size.width, rows});
    rectify_status_rows(r.camera, r.grid, r.status.plane(), y, r.context.threads, out);
    for (int j = 0; j < rows; ++j) {
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

RectifyFacts facts_of(const std::string& id, const solve::SourceFacts& source, const Calibration& calibration,
                      const Rectification& r, std::int64_t solved) {
  const TableGrid& g = r.grid;
  const Vec3 corner = g.point_mm(0, 0);
  return {.id = id,
          .source = source,
          .calibration = calibration.id,
          .size = g.size,
          .mm_per_pixel = g.mm_per_pixel,
          .height_mm = g.height_mm,
          .turn_deg = g.turn_deg,
          .centre_mm = {g.centre_x_mm, g.centre_y_mm},
          .first_pixel_mm = {corner.x, corner.y},
          .normals = "in the grid's axes: x along its rows, y up its columns, z to the camera",
          .filter = kFilter,
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
}

Json json_of(const RectifyFacts& facts) {
  Json json = {{"schema", fmt::format("{}/1", kRectifiedProduct.schema)}};
  write_fields(json, facts);
  return json;
}

Result<RectifyReport> rectify_session(const RectifyOptions& options, const JobContext& context) {
  if (const Result<void> ok = check_fields(options); !ok) return ok.error();
  const Result<Session> session = read_session(options.session);
  if (!session) return session.error();
  const Result<Calibration> calibration = calibration_with_camera(
      options.calibration.empty() ? session->calibration_folder() : options.calibration);
  if (!calibration) return calibration.error();
  const solve::SessionSolves solves = solve::solves_of(*session);
  const Result<solve::ChoosableSolve> solve = solve::solve_for_maps(solves, options.solve, options.is_draft);
  if (!solve) return solve.error();
  const solve::SourceFacts source = solve::source_of(*solve, why_stale(solves, solve->id));
  const Result<SolveMaps> maps = SolveMaps::open(solve->folder);
  if (!maps) return maps.error();
  const CameraModel seen = seen_from(session->pose, session->cloth_height_mm, *calibration->camera);
  const Result<CameraModel> camera = camera_of_maps(seen, maps->size(), solve->folder);
  if (!camera) return camera.error();
  const Result<TableGrid> grid =
      table_grid(*camera, {options.mm_per_pixel.value_or(0), session->cloth_height_mm, options.turn_deg});
  if (!grid) return grid.error();

  const Json inputs = {{"version", kRectifiedVersion},
                       {"solve", solve->id},
                       {"calibration", calibration->id},
                       {"mm_per_pixel", grid->mm_per_pixel},
                       {"height_mm", grid->height_mm},
                       {"turn_deg", grid->turn_deg},
                       {"compression", name_of(options.compression)}};
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
  if (const Result<void> begun = begin(partial, bytes_of_rectified(grid->size)); !begun) return begun.error();
  const Rectification r = {*camera, *grid, std::move(*status), partial.path(), options, context};
  std::int64_t solved = 0;
  if (const Result<void> ok = rectify_status(r, solved); !ok) return ok.error();
  if (const Result<void> ok = rectify_maps(r, *maps, solve->folder); !ok) return ok.error();
  RectifyFacts facts = facts_of(product.id, source, *calibration, r, solved);
  const Result<void> written = write_json(partial.path() / kRectifiedProduct.document, json_of(facts));
  if (!written) return written.error();
  if (const Result<void> ok = partial.publish(); !ok) return ok.error();
  context.progress("rectify", 1);
  return RectifyReport{product.folder, false, std::move(facts)};
}

}  // namespace weft::material
