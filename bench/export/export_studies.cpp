// SPDX-License-Identifier: Apache-2.0
#include "bench/export/export_studies.h"

#include <squish.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/accuracy/accuracy_scenes.h"
#include "bench/base/yardsticks.h"
#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "exchange/blocks/decode_blocks.h"
#include "exchange/blocks/encode.h"
#include "exchange/export/export.h"
#include "exchange/export/export_price.h"
#include "exchange/presets/preset.h"
#include "simulator/scene/scene.h"
#include "solve/levels/frame.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

/// A cloth as a scan of it has it, with its noise.
struct SolvedCloth {
  Image<float> normal;  ///< X, Y, Z
  Image<float> albedo;  ///< R, G, B, linear
  double mean_tilt_deg = 0;
};

// A cell of the mosaic stays whole.
Rect middle_of(Size frame, Size most) {
  const int width = std::min(frame.width, most.width) & ~1, height = std::min(frame.height, most.height) & ~1;
  const int x0 = (frame.width - width) / 2 & ~1, y0 = (frame.height - height) / 2 & ~1;
  return {x0, y0, x0 + width, y0 + height};
}

void keep_rows(const std::array<View<const float>, 3>& band, Rect rows, Image<float>& map) {
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < rows.height(); ++y) {
      std::copy_n(band[static_cast<std::size_t>(p)].row(y), rows.width(), map.plane(p).row(rows.y0 + y));
    }
  }
}

double mean_tilt(const Image<float>& normal) {
  double sum = 0;
  for (int y = 0; y < normal.height(); ++y) {
    for (int x = 0; x < normal.width(); ++x) {
      sum += degrees(std::acos(std::clamp(static_cast<double>(normal(x, y, 2)), -1.0, 1.0)));
    }
  }
  return sum / static_cast<double>(normal.size().pixels());
}

// The middle of a scene's frame, `most` at most, photographed and solved by the level standard. Errors:
// those of read_scene(), rendering and solving.
Result<SolvedCloth> solved_cloth(const std::filesystem::path& scene_file, Size most, int threads) {
  const Result<simulator::Scene> scene = simulator::read_scene(scene_file);
  if (!scene) return scene.error();
  const Rect area = middle_of({scene->camera.width, scene->camera.height}, most);
  const Result<ClothPatch> patch = render_patch(*scene, area, threads);
  if (!patch) return patch.error();
  SolvedCloth cloth{Image<float>(patch->size(), 3), Image<float>(patch->size(), 3)};
  JobContext context;
  context.threads = threads;
  const auto keep = [&](const solve::MapBand& band) -> Result<void> {
    keep_rows(band.normal, band.rows, cloth.normal);
    keep_rows(band.albedo, band.albedo_rows, cloth.albedo);
    return {};
  };
  const auto solved = solve::solve_frame(patch->photographs, *solver::find_method("standard"),
                                         solve::kSolveTile, context, keep);
  if (!solved) return solved.error();
  cloth.mean_tilt_deg = mean_tilt(cloth.normal);
  return cloth;
}

using exchange::BlockFormat;
using Planes = std::vector<View<const float>>;

constexpr Size kMost = {1536, 1024}, kTimed = {4096, 4096};
constexpr int kTimedThreads = 2;

enum class Holds { kAlbedo, kNormal, kMask };
struct BlockRow {
  BlockFormat format;
  const char* of;
  Holds holds;
  std::size_t planes;
};
// A normal's x and y in bc1 leave blue empty.
constexpr BlockRow kRows[] = {{BlockFormat::kBc1, "albedo", Holds::kAlbedo, 3},
                              {BlockFormat::kBc3, "albedo, mask", Holds::kAlbedo, 4},
                              {BlockFormat::kBc7, "albedo", Holds::kAlbedo, 3},
                              {BlockFormat::kBc7, "albedo, mask", Holds::kAlbedo, 4},
                              {BlockFormat::kBc4, "normal x", Holds::kMask, 1},
                              {BlockFormat::kBc5, "normal x, y", Holds::kNormal, 2},
                              {BlockFormat::kBc1, "normal x, y, z", Holds::kNormal, 3},
                              {BlockFormat::kBc7, "normal x, y, z", Holds::kNormal, 3}};

// R, G, B as sRGB, and nz as a mask that has edges.
Image<float> albedo_texture(const SolvedCloth& cloth) {
  Image<float> texture(cloth.albedo.size(), 4);
  for (int y = 0; y < texture.height(); ++y) {
    for (int x = 0; x < texture.width(); ++x) {
      Rgb linear = {};
      for (int p = 0; p < 3; ++p) linear[static_cast<std::size_t>(p)] = cloth.albedo(x, y, p);
      const Rgb display = srgb_of_rec709(linear);
      for (int p = 0; p < 3; ++p) texture(x, y, p) = static_cast<float>(display[static_cast<std::size_t>(p)]);
      texture(x, y, 3) = std::clamp(4 * cloth.normal(x, y, 2) - 2.9F, 0.0F, 1.0F);
    }
  }
  return texture;
}

Image<float> normal_texture(const SolvedCloth& cloth) {
  Image<float> texture(cloth.normal.size(), 3);
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < texture.height(); ++y) {
      for (int x = 0; x < texture.width(); ++x) texture(x, y, p) = 0.5F * cloth.normal(x, y, p) + 0.5F;
    }
  }
  return texture;
}

Planes planes_of_texture(const Image<float>& texture, std::size_t count) {
  Planes planes;
  for (std::size_t p = 0; p < count; ++p) planes.push_back(texture.plane(static_cast<int>(p)));
  return planes;
}

// PSNR of the planes; with `in_8_bits` against the values that 8 bits have.
double psnr_of(const Planes& planes, const Image<float>& decoded, bool in_8_bits) {
  double sum = 0;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (int y = 0; y < decoded.height(); ++y) {
      for (int x = 0; x < decoded.width(); ++x) {
        const double value = std::clamp(static_cast<double>(planes[p](x, y)), 0.0, 1.0);
        const double meant = in_8_bits ? std::floor(255 * value + 0.5) / 255 : value;
        const double off = static_cast<double>(decoded(x, y, static_cast<int>(p))) - meant;
        sum += off * off;
      }
    }
  }
  return -10 * std::log10(
                   sum / (static_cast<double>(decoded.size().pixels()) * static_cast<double>(planes.size())));
}

void put_angles(const Image<float>& normal, const Image<float>& decoded, Json& row) {
  std::vector<double> angles;
  double sum = 0;
  for (int y = 0; y < decoded.height(); ++y) {
    for (int x = 0; x < decoded.width(); ++x) {
      const double nx = 2.0 * decoded(x, y, 0) - 1, ny = 2.0 * decoded(x, y, 1) - 1;
      const Vec3 read = normalized(Vec3{nx, ny, std::sqrt(std::max(0.0, 1 - nx * nx - ny * ny))});
      angles.push_back(angle_deg(read, {normal(x, y, 0), normal(x, y, 1), normal(x, y, 2)}));
      sum += angles.back();
    }
  }
  std::sort(angles.begin(), angles.end());
  row["mean_deg"] = sum / static_cast<double>(angles.size());
  row["p95_deg"] = angles[angles.size() * 95 / 100];
  row["max_deg"] = angles.back();
}

Image<float> side_by_side(const Image<float>& texture, Size size) {
  Image<float> large(size, texture.planes());
  for (int p = 0; p < texture.planes(); ++p) {
    for (int y = 0; y < size.height; ++y) {
      const float* from = texture.plane(p).row(y % texture.height());
      for (int x = 0; x < size.width; ++x) large(x, y, p) = from[x % texture.width()];
    }
  }
  return large;
}

struct Pictures {
  SolvedCloth cloth;
  Image<float> albedo, normal, large_albedo, large_normal;
};

// What libsquish alone makes of a normal's x and y in bc5: the yardstick of our search for ends.
Result<Json> row_of_libsquish(const Pictures& pictures) {
  const Size size = pictures.normal.size();
  std::vector<squish::u8> texels(static_cast<std::size_t>(size.pixels()) * 4, 255);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      squish::u8* texel = &texels[4 * static_cast<std::size_t>(std::int64_t{y} * size.width + x)];
      for (int p = 0; p < 2; ++p) texel[p] = static_cast<squish::u8>(255 * pictures.normal(x, y, p) + 0.5F);
    }
  }
  std::string blocks(exchange::bytes_of(BlockFormat::kBc5, size), '\0');
  const std::clock_t begin = std::clock();
  squish::CompressImage(texels.data(), size.width, size.height, blocks.data(), squish::kBc5);
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const Result<Image<float>> decoded = exchange::decode_blocks(BlockFormat::kBc5, blocks, size);
  if (!decoded) return decoded.error();
  const Planes planes = planes_of_texture(pictures.normal, 2);
  Json row = {{"format", "bc5 of libsquish"}, {"of", "normal x, y"}};
  row["psnr_db"] = psnr_of(planes, *decoded, false);
  row["psnr_8bit_db"] = psnr_of(planes, *decoded, true);
  put_angles(pictures.cloth.normal, *decoded, row);
  row["mp_s"] = static_cast<double>(size.pixels()) / 1e6 / seconds;
  for (const char* key : {"s_16mp", "copies", "bc1s"}) row[key] = nullptr;
  return row;
}

struct BlockTimes {
  double processor = 0, wall = 0;  ///< of one thread, and of two
};

BlockTimes times_of(BlockFormat format, const Planes& planes) {
  BlockTimes times;
  const std::clock_t begin = std::clock();
  (void)exchange::encode_blocks(format, planes, 1);
  times.processor = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  times.wall = least_seconds(2, [&] { (void)exchange::encode_blocks(format, planes, kTimedThreads); });
  return times;
}

Result<Json> row_of_format(const BlockRow& asked, const Pictures& pictures, double& bc1_seconds) {
  const bool is_albedo = asked.holds == Holds::kAlbedo;
  const Planes planes = planes_of_texture(is_albedo ? pictures.albedo : pictures.normal, asked.planes);
  const Result<std::string> blocks = exchange::encode_blocks(asked.format, planes);
  if (!blocks) return blocks.error();
  const Result<Image<float>> decoded = exchange::decode_blocks(asked.format, *blocks, planes[0].size());
  if (!decoded) return decoded.error();

  Json row = {{"format", exchange::name_of(asked.format)}, {"of", asked.of}};
  row["psnr_db"] = psnr_of(planes, *decoded, false);
  row["psnr_8bit_db"] = psnr_of(planes, *decoded, true);
  for (const char* key : {"mean_deg", "p95_deg", "max_deg"}) row[key] = nullptr;
  if (asked.holds == Holds::kNormal) put_angles(pictures.cloth.normal, *decoded, row);

  const BlockTimes times =
      times_of(asked.format,
               planes_of_texture(is_albedo ? pictures.large_albedo : pictures.large_normal, asked.planes));
  const double pixels = static_cast<double>(kTimed.pixels());
  const double read = pixels * sizeof(float) * static_cast<double>(asked.planes);
  const double written = static_cast<double>(exchange::bytes_of(asked.format, kTimed));
  if (bc1_seconds == 0) bc1_seconds = times.wall;
  row["mp_s"] = pixels / 1e6 / times.processor;
  row["s_16mp"] = times.wall * 16e6 / pixels;
  row["copies"] = times.wall / copy_seconds(read + written, kTimedThreads);
  row["bc1s"] = times.wall / bc1_seconds;
  return row;
}

}  // namespace

/// Loss and price of each block format on the cloth of a scene as the level standard solves it. `psnr_db` is
/// of what is decoded against the values in float that were encoded, colour as sRGB; `psnr_8bit_db` against
/// the same in 8 bits. Angles are of normals whose z is the rest of x and y, against the solved ones. `mp_s`
/// is megapixels a processor second of one thread; `s_16mp` the wall time of 16 megapixels of that cloth,
/// laid side by side, on two threads; `copies` that time over a copy of the same bytes on two threads, `bc1s`
/// over that of bc1, which is libsquish's.
Result<Rows> export_blocks(const StudyOptions& options) {
  Result<SolvedCloth> cloth = solved_cloth(options.scene, kMost, options.threads);
  if (!cloth) return std::move(cloth).error();
  Pictures pictures;
  pictures.cloth = std::move(*cloth);
  pictures.albedo = albedo_texture(pictures.cloth);
  pictures.normal = normal_texture(pictures.cloth);
  pictures.large_albedo = side_by_side(pictures.albedo, kTimed);
  pictures.large_normal = side_by_side(pictures.normal, kTimed);
  Rows rows;
  double bc1_seconds = 0;
  for (const BlockRow& asked : kRows) {
    if (Result<void> ok = add_row(rows, row_of_format(asked, pictures, bc1_seconds)); !ok) return ok.error();
  }
  if (Result<void> ok = add_row(rows, row_of_libsquish(pictures)); !ok) return ok.error();
  for (Json& each : rows) each["tilt_deg"] = pictures.cloth.mean_tilt_deg;
  return rows;
}

namespace {

// A plane of the large map by the pixel of the cloth that lies there.
template <typename Value>
Image<float> repeated(Size cloth, Size size, int planes, const Value& value) {
  Image<float> map(size, planes);
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) map(x, y, p) = value(x % cloth.width, y % cloth.height, p);
    }
  }
  return map;
}

// Writes a set of maps of this size into `folder`: the solved cloth beside itself over and over, with a
// height, an openness and a roughness that vary as its normals do. Errors of write_image().
Result<void> write_map_set(const SolvedCloth& cloth, Size size, double mm_per_pixel,
                           const std::filesystem::path& folder) {
  const Size of = cloth.normal.size();
  Json maps = Json::array();
  const auto write = [&](const char* name, const std::vector<std::string>& channels, SampleType type,
                         const Image<float>& map) {
    std::vector<View<const float>> planes;
    for (int p = 0; p < map.planes(); ++p) planes.push_back(map.plane(p));
    const std::string file = std::string(name) + ".exr";
    const bool is_height = file == "height.exr";
    maps.push_back({{"name", name},
                    {"file", file},
                    {"source", "measured"},
                    {"least", is_height ? -0.1 : 0},
                    {"most", is_height ? 0.1 : 1}});
    return write_image(folder / file, planes, channels,
                       {.type = type, .pitch_mm = {mm_per_pixel, mm_per_pixel}});
  };
  const auto z = [&](int x, int y) { return cloth.normal(x, y, 2); };
  if (Result<void> ok =
          write("normal", {"X", "Y", "Z"}, SampleType::kFloat,
                repeated(of, size, 3, [&](int x, int y, int p) { return cloth.normal(x, y, p); }));
      !ok)
    return ok;
  if (Result<void> ok =
          write("albedo", {"R", "G", "B"}, SampleType::kHalf,
                repeated(of, size, 3, [&](int x, int y, int p) { return cloth.albedo(x, y, p); }));
      !ok)
    return ok;
  if (Result<void> ok =
          write("height", {"height"}, SampleType::kFloat,
                repeated(of, size, 1, [&](int x, int y, int) { return 0.2F * z(x, y) - 0.1F; }));
      !ok)
    return ok;
  if (Result<void> ok = write("occlusion", {"openness"}, SampleType::kHalf,
                              repeated(of, size, 1, [&](int x, int y, int) { return z(x, y); }));
      !ok)
    return ok;
  const auto lobe = [&](int x, int y, int p) {
    const float alpha = 0.2F + 0.1F * z(x, y);
    return p == 0 ? std::sqrt(alpha) : p == 1 ? alpha : p == 2 ? 0.5F * alpha : 45.0F;
  };
  if (Result<void> ok = write("roughness", {"roughness", "alpha", "alpha_along", "yarn_deg"},
                              SampleType::kHalf, repeated(of, size, 4, lobe));
      !ok)
    return ok;
  maps.push_back({{"name", "specular"}, {"constant", 0.04}, {"source", "assumed"}});
  return write_json(folder / "maps.json", {{"schema", "weft.maps/1"},
                                           {"id", "bench"},
                                           {"width", size.width},
                                           {"height", size.height},
                                           {"mm_per_pixel", mm_per_pixel},
                                           {"is_tile", true},
                                           {"maps", maps}});
}

namespace fs = std::filesystem;

constexpr Size kTile = {2048, 2048};
constexpr double kTileMmPerPixel = 0.08;

// The set of maps of the scene, in a folder that goes with it.
struct TileMaps {
  TemporaryFolder temporary;
  fs::path folder() const { return temporary.path() / "maps"; }
};

Result<void> make_tile(const StudyOptions& options, const TileMaps& tile) {
  const Result<SolvedCloth> cloth = solved_cloth(options.scene, kTile, options.threads);
  if (!cloth) return cloth.error();
  fs::create_directories(tile.folder());
  return write_map_set(*cloth, kTile, kTileMmPerPixel, tile.folder());
}

double megabytes_of(const exchange::ExportFacts& facts) {
  std::uint64_t bytes = 0;
  for (const exchange::ExportedTexture& each : facts.files) bytes += each.inside.empty() ? each.bytes : 0;
  for (const exchange::ExportedDocument& each : facts.documents) bytes += each.bytes;
  return static_cast<double>(bytes) * 1e-6;
}

Result<Json> measure_presets(const StudyOptions& options, const TileMaps& tile, const std::string& name,
                             const std::vector<std::string>& presets) {
  exchange::ExportOptions asked = {.input = tile.folder()};
  asked.presets = presets;
  asked.output = tile.temporary.path() / ("of-" + name);
  Stopwatch watch;
  const Result<std::vector<exchange::ExportReport>> reports =
      exchange::export_maps(asked, {.threads = options.threads, .stop = {}});
  if (!reports) return reports.error();
  const double seconds = watch.lap();
  std::size_t files = 0;
  double megabytes = 0;
  for (const exchange::ExportReport& report : *reports) {
    files += report.facts.files.size();
    megabytes += megabytes_of(report.facts);
  }
  std::error_code ignored;
  fs::remove_all(asked.output, ignored);
  return Json{{"preset", name}, {"files", files}, {"megabytes", megabytes}, {"seconds", seconds}};
}

}  // namespace

/// Each preset of weft's own on a tile of 2048 x 2048: files, megabytes and wall seconds, and the same of all
/// at once, where files that are alike are encoded once. Errors of the scene and of export_maps().
Result<Rows> export_presets(const StudyOptions& options) {
  const TileMaps tile;
  if (Result<void> ok = make_tile(options, tile); !ok) return std::move(ok).error();
  Rows rows;
  std::vector<std::string> all;
  for (const exchange::ShippedPreset& preset : exchange::shipped_presets()) {
    all.emplace_back(preset.name);
    if (Result<void> ok = add_row(rows, measure_presets(options, tile, preset.name, {preset.name})); !ok)
      return ok.error();
  }
  if (Result<void> ok = add_row(rows, measure_presets(options, tile, "all", all)); !ok) return ok.error();
  return rows;
}

/// What normals and albedo of the scene lose in every format: degrees and decibels, with megabytes and
/// seconds of 4 megapixels by one thread.
Result<Rows> export_losses(const StudyOptions& options) {
  const TileMaps tile;
  if (Result<void> ok = make_tile(options, tile); !ok) return std::move(ok).error();
  exchange::ExportOptions asked = {.input = tile.folder()};
  const Result<std::vector<exchange::ExportPrice>> prices =
      exchange::price_exports(asked, {.threads = options.threads, .stop = {}});
  if (!prices) return prices.error();
  Rows rows;
  for (const exchange::ExportPrice& price : *prices) {
    Json row = {{"of", price.file},         {"as", words_of(price.stored)}, {"megabytes", price.bytes * 1e-6},
                {"seconds", price.seconds}, {"mean_deg", nullptr},          {"p95_deg", nullptr},
                {"max_deg", nullptr},       {"albedo_mean", nullptr},       {"psnr_db", nullptr}};
    if (price.loss.normal) {
      row["mean_deg"] = price.loss.normal->mean_deg;
      row["p95_deg"] = price.loss.normal->p95_deg;
      row["max_deg"] = price.loss.normal->max_deg;
    }
    if (price.loss.albedo) {
      row["albedo_mean"] = price.loss.albedo->mean_abs;
      if (price.loss.albedo->psnr_db) row["psnr_db"] = *price.loss.albedo->psnr_db;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace weft::bench
