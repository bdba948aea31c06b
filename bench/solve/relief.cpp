// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/solve_studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "bench/base/bare_embree.h"
#include "bench/base/measured_rig.h"
#include "bench/base/yardsticks.h"
#include "bench/effects/effect_scenes.h"
#include "bench/oracles/rays/gather.h"
#include "bench/oracles/rays/height_grid.h"
#include "bench/oracles/rays/ray_shadows.h"
#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/image/tiles.h"
#include "simulator/geometry/scene_surface.h"
#include "solver/height/height.h"
#include "solver/transport/horizon.h"
#include "solver/transport/light_directions.h"
#include "solver/transport/relief.h"
#include "solver/transport/slices.h"

namespace weft::bench {
namespace {

constexpr int kHeightRepeats = 3;
constexpr double kBytesAPixel = 4 * sizeof(float);

struct Point {
  double height = 0, right = 0, down = 0;
};

// Yarns of 5 pixels, 0.9 rms high, over folds up to 30 pixels high that come back every 400 pixels.
Point weave_with_folds(int x, int y) {
  const double wave = 2 * kPi / 10, amplitude = 1.8;
  const double sx = std::sin(wave * x), cx = std::cos(wave * x), sy = std::sin(wave * y),
               cy = std::cos(wave * y);
  Point p = {amplitude * sx * sy, amplitude * wave * cx * sy, amplitude * wave * sx * cy};
  for (const auto& [height, width, angle] : {std::array{30.0, 20.0, 0.4}, std::array{-22.0, 18.0, 1.9}}) {
    const double c = std::cos(angle), d = std::sin(angle);
    const double u = std::remainder(x * c + y * d - 120, 400) / width;
    const double ridge = height * std::exp(-u * u / 2);
    p.height += ridge;
    p.right -= ridge * u / width * c;
    p.down -= ridge * u / width * d;
  }
  return p;
}

struct FoldedWeave {
  Image<float> normals, truth;

  FoldedWeave(Size size, int threads) : normals(size, 3), truth(size) {
    parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < size.width; ++x) {
        const Point p = weave_with_folds(x, y);
        const Vec3 n = normalized({-p.right, p.down, 1});
        normals(x, y, 0) = static_cast<float>(n.x);
        normals(x, y, 1) = static_cast<float>(n.y);
        normals(x, y, 2) = static_cast<float>(n.z);
        truth(x, y) = static_cast<float>(p.height);
      }
    });
  }
};

// One pixel in seven is left out, never two that touch: still one island.
Image<std::uint8_t> sieve(Size size) {
  Image<std::uint8_t> mask(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) mask(x, y) = (x + 3 * y) % 7 != 0;
  }
  return mask;
}

// Rms of height less truth where the mask is set, without mean and slope (which are uncorrelated but for the
// rim).
double rms_error_px(const Image<float>& height, const Image<float>& truth, View<const std::uint8_t> mask) {
  const Size size = height.size();
  double count = 0, sum = 0, squares = 0, along_x = 0, along_y = 0, xx = 0, yy = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (!mask.empty() && mask(x, y) == 0) continue;
      const double e = double{height(x, y)} - truth(x, y);
      const double u = x - (size.width - 1) / 2.0, v = y - (size.height - 1) / 2.0;
      count += 1;
      sum += e;
      squares += e * e;
      along_x += e * u;
      along_y += e * v;
      xx += u * u;
      yy += v * v;
    }
  }
  const double left = squares - sum * sum / count - along_x * along_x / xx - along_y * along_y / yy;
  return std::sqrt(std::max(left, 0.0) / count);
}

// A line of /proc/self/status such as "VmHWM:  1234 kB", in bytes.
double memory_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key)) return 1024 * std::stod(line.substr(key.size()));
  }
  return 0;
}

// Starts the peak of resident memory anew, where the kernel allows it.
void forget_peak() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

struct Run {
  std::string name;
  solver::HeightMethod method;
  const FoldedWeave* scene;
  View<const std::uint8_t> mask = {};
};

Result<Json> measure(const Run& run, double copy_a_byte, int threads) {
  const Image<float>& normals = run.scene->normals;
  const solver::HeightOptions options = {.method = run.method, .threads = threads};
  std::optional<Error> failure;
  solver::Height height;
  forget_peak();
  const double before = memory_bytes("VmRSS:");
  const double seconds = least_seconds(kHeightRepeats, [&] {
    height = {};
    Result<solver::Height> done = solver::height_from_normals(
        {normals.plane(0), normals.plane(1), normals.plane(2)}, run.mask, options);
    if (done) {
      height = std::move(done).value();
    } else {
      failure = done.error();
    }
  });
  if (failure) return *failure;
  const double peak = memory_bytes("VmHWM:") - before, pixels = static_cast<double>(normals.size().pixels());
  return Json{{"method", run.name},
              {"width", normals.width()},
              {"height", normals.height()},
              {"threads", threads},
              {"rms_error_px", rms_error_px(height.height_mm, run.scene->truth, run.mask)},
              {"cycles", height.cycles},
              {"seconds", seconds},
              {"ns_per_pixel", seconds / pixels * 1e9},
              {"ratio_to_copy", seconds / (copy_a_byte * kBytesAPixel * pixels)},
              {"peak_bytes_per_pixel", peak / pixels}};
}

int prime_from(int n) {
  const auto is_prime = [](int p) {
    for (int d = 2; d * d <= p; ++d) {
      if (p % d == 0) return false;
    }
    return p > 1;
  };
  while (!is_prime(n)) ++n;
  return n;
}

}  // namespace

/// From normals to heights of a weave with folds, a row a method: its rms error in pixels after the best
/// plane, its time, and the memory it took at its peak beside the normals. `ratio_to_copy` is against a copy
/// of the bytes that have to move at least: three floats in, one out. `multigrid-masked` leaves one pixel in
/// seven out, and `dct-prime` has rows of a prime length.
Result<Rows> height_speed(const StudyOptions& options) {
  const int threads = resolved_threads(options.threads);
  const Size size = bench_size(options.megapixels);
  const FoldedWeave scene(size, threads), prime({prime_from(size.width), size.height}, threads);
  const Image<std::uint8_t> mask = sieve(size);
  const double bytes = kBytesAPixel * static_cast<double>(size.pixels());
  const double copy_a_byte = copy_seconds(bytes, threads) / bytes;
  Rows rows;
  for (const Run& run :
       {Run{"dct", solver::HeightMethod::kDct, &scene}, Run{"dct-prime", solver::HeightMethod::kDct, &prime},
        Run{"multigrid", solver::HeightMethod::kMultigrid, &scene},
        Run{"multigrid-masked", solver::HeightMethod::kMultigrid, &scene, mask.plane()},
        Run{"seed", solver::HeightMethod::kSeed, &scene}}) {
    if (Result<void> ok = add_row(rows, measure(run, copy_a_byte, threads)); !ok) return ok.error();
  }
  return rows;
}

namespace {

using namespace solver;
using namespace test;

constexpr int kTransportRepeats = 7;
constexpr Size kBlock = {1024, 512};
constexpr double kAlbedo = 0.5;

struct DeepWeave {
  double mm_per_pixel;
  Image<float> height_mm, normal;

  Normals normals_of(Rect tile) const {
    return {normal.plane(0).crop(tile), normal.plane(1).crop(tile), normal.plane(2).crop(tile)};
  }
};

DeepWeave deep_weave(Size size) {
  const simulator::Scene scene = cloth_scene(simulator::Family::kDeep, size);
  DeepWeave cloth = {scene.camera.mm_per_pixel, Image<float>(size), Image<float>(size, 3)};
  const simulator::Surface surface = simulator::surface_of(scene.geometry);
  parallel_for(static_cast<std::size_t>(size.height), 0, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.width; ++x) {
      const auto at = simulator::point_at(surface, cloth.mm_per_pixel * x, -cloth.mm_per_pixel * y);
      cloth.height_mm(x, y) = static_cast<float>(at.height_mm);
      cloth.normal(x, y, 0) = static_cast<float>(at.normal.x);
      cloth.normal(x, y, 1) = static_cast<float>(at.normal.y);
      cloth.normal(x, y, 2) = static_cast<float>(at.normal.z);
    }
  });
  return cloth;
}

/// Four LEDs 35 degrees and six 62 degrees from the vertical over the picture's centre.
LightDirections leds_over(const DeepWeave& cloth) {
  const Size size = cloth.height_mm.size();
  const double pitch_mm = cloth.mm_per_pixel;
  std::vector<Vec3> positions_mm;
  for (int k = 0; k < 10; ++k) {
    const double zenith = radians(k < 4 ? 35 : 62), azimuth = radians(k < 4 ? 90 * k : 60 * k + 15);
    const Vec3 centre_mm = {pitch_mm * size.width / 2, -pitch_mm * size.height / 2, 0};
    positions_mm.push_back(centre_mm + 600.0 * Vec3{std::sin(zenith) * std::cos(azimuth),
                                                    std::sin(zenith) * std::sin(azimuth), std::cos(zenith)});
  }
  return {positions_mm.size(), [positions_mm, pitch_mm](std::size_t k, int x, int y) {
            return normalized(positions_mm[k] - Vec3{pitch_mm * x, -pitch_mm * y, 0});
          }};
}

/// x, y and z of each vertex of a grid.
std::vector<float> vertices_of(const HeightGrid& grid) {
  const Rect area = grid.area();
  std::vector<float> xyz;
  xyz.reserve(3 * static_cast<std::size_t>(area.pixels()));
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      xyz.insert(xyz.end(), {static_cast<float>(x), static_cast<float>(-y), grid.relief().z_px(x, y)});
    }
  }
  return xyz;
}

void fill(const RayPacket& from, BarePacket& to) {
  std::copy_n(from.is_active, kPacket, to.is_active.data());
  RTCRay16& ray = to.rays.ray;
  std::copy_n(from.start_x, kPacket, ray.org_x);
  std::copy_n(from.start_y, kPacket, ray.org_y);
  std::copy_n(from.start_z, kPacket, ray.org_z);
  std::copy_n(from.direction_x, kPacket, ray.dir_x);
  std::copy_n(from.direction_y, kPacket, ray.dir_y);
  std::copy_n(from.direction_z, kPacket, ray.dir_z);
  std::copy_n(from.length, kPacket, ray.tfar);
}

BareEmbree::Fill filler_of(std::span<const RayPacket> packets) {
  return [packets](std::size_t i, BarePacket& packet) { fill(packets[i], packet); };
}

template <typename T>
std::vector<View<T>> planes_of(Image<T>& image, Rect part) {
  std::vector<View<T>> planes;
  for (int p = 0; p < image.planes(); ++p) planes.push_back(image.plane(p).crop(part));
  return planes;
}

/// What an area would send back under each light by direct light alone.
std::vector<float> direct_radiosity(const DeepWeave& cloth, const LightDirections& lights, Rect area) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(area.pixels()) * lights.count);
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const Vec3 n = {static_cast<double>(cloth.normal(x, y, 0)), static_cast<double>(cloth.normal(x, y, 1)),
                      static_cast<double>(cloth.normal(x, y, 2))};
      for (std::size_t k = 0; k < lights.count; ++k) {
        values.push_back(static_cast<float>(kAlbedo * std::max(dot(n, lights.at(k, x, y)), 0.0)));
      }
    }
  }
  return values;
}

struct Errors {
  double mean = 0, rms = 0;
};

Errors errors_of(const Image<float>& found, const Image<float>& truth) {
  Errors errors;
  const double count = static_cast<double>(found.size().pixels()) * found.planes();
  for (int p = 0; p < found.planes(); ++p) {
    for (int y = 0; y < found.height(); ++y) {
      for (int x = 0; x < found.width(); ++x) {
        const double error = static_cast<double>(found(x, y, p)) - static_cast<double>(truth(x, y, p));
        errors.mean += error / count;
        errors.rms += error * error / count;
      }
    }
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

double rays_in(std::span<const RayPacket> packets) {
  double rays = 0;
  for (const RayPacket& packet : packets) {
    for (const int active : packet.is_active) rays -= active;
  }
  return rays;
}

/// A block of cloth, ready for rays, and the tiles of it that are measured.
struct Measured {
  const DeepWeave& cloth;
  const LightDirections& lights;
  const HeightGrid& grid;
  Rect timed, compared;
};

Json traced_row(const char* stage, int rays_a_pixel, double seconds, std::span<const RayPacket> packets,
                double bare_ns, Rect tile) {
  const double rays = rays_in(packets);
  return {{"stage", stage},
          {"rays", rays_a_pixel},
          {"ns_per_ray", seconds * 1e9 / rays},
          {"bare_ns", bare_ns},
          {"ratio", seconds * 1e9 / rays / bare_ns},
          {"ns_per_pixel", seconds * 1e9 / static_cast<double>(tile.pixels())},
          {"threads", 1}};
}

Result<void> add_shadows(const Measured& m, const BareEmbree& bare, int reach_px, Rows& rows) {
  Image<std::uint32_t> bits({m.timed.width(), m.timed.height()});
  const std::array<View<std::uint32_t>, 1> planes = {bits.plane()};
  const Normals normals = m.cloth.normals_of(m.timed);
  Result<void> found;
  const double seconds = least_seconds(kTransportRepeats, [&] {
    found = find_visible_lights(m.grid, m.timed, normals, m.lights, reach_px, planes);
  });
  if (!found) return found;
  const auto packets = shadow_packets(m.grid, m.timed, normals, m.lights, reach_px);
  rows.push_back(traced_row("shadows", static_cast<int>(m.lights.count), seconds, packets,
                            bare.occlude_ns(packets.size(), filler_of(packets)), m.timed));
  return found;
}

/// Light gathered without rays, against `truth` over the tile that is compared.
Result<void> add_slices(const Measured& m, const Image<float>& truth, Rows& rows) {
  const Rect area = area_of_slices(m.timed, GatherSettings{}.reach_px);
  const Rect picture = m.grid.area();
  const int count = static_cast<int>(m.lights.count);
  Image<float> sent({area.width(), area.height()}, count);
  const std::vector<float> values = direct_radiosity(m.cloth, m.lights, picture);
  for (int y = std::max(area.y0, picture.y0); y < std::min(area.y1, picture.y1); ++y) {
    for (int x = std::max(area.x0, picture.x0); x < std::min(area.x1, picture.x1); ++x) {
      const auto pixel =
          static_cast<std::size_t>(y - picture.y0) * static_cast<std::size_t>(picture.width()) +
          static_cast<std::size_t>(x - picture.x0);
      for (int k = 0; k < count; ++k)
        sent(x - area.x0, y - area.y0, k) = values[pixel * m.lights.count + static_cast<std::size_t>(k)];
    }
  }
  std::vector<View<const float>> planes;
  for (int k = 0; k < count; ++k) planes.emplace_back(sent.plane(k));
  Image<float> light({m.timed.width(), m.timed.height()}, count);
  const Rect compared = {m.compared.x0 - m.timed.x0, m.compared.y0 - m.timed.y0, m.compared.x1 - m.timed.x0,
                         m.compared.y1 - m.timed.y0};
  for (const int directions : {8, 16, 32, 64}) {
    Result<void> done;
    const double seconds = least_seconds(kTransportRepeats, [&] {
      done = gather_by_slices(m.grid.relief(), m.timed, m.cloth.normals_of(m.timed), {area, planes},
                              {.directions = directions},
                              planes_of(light, {0, 0, light.width(), light.height()}));
    });
    if (!done) return done;
    Image<float> found(truth.size(), count);
    for (int k = 0; k < count; ++k) {
      for (int y = 0; y < found.height(); ++y)
        std::copy_n(light.plane(k).crop(compared).row(y), found.width(), found.plane(k).row(y));
    }
    const Errors errors = errors_of(found, truth);
    rows.push_back({{"stage", "slices"},
                    {"directions", directions},
                    {"ns_per_pixel", seconds * 1e9 / static_cast<double>(m.timed.pixels())},
                    {"threads", 1},
                    {"mean_error", errors.mean},
                    {"rms_error", errors.rms}});
  }
  return {};
}

Result<void> add_gathers(const Measured& m, const BareEmbree& bare, Rows& rows) {
  const std::vector<float> values = direct_radiosity(m.cloth, m.lights, m.grid.area());
  const int count = static_cast<int>(m.lights.count);
  const Radiosity radiosity = {m.grid.area(), count, values};
  const auto gathered = [&](Rect tile, int rays) -> Result<Image<float>> {
    Image<float> light({tile.width(), tile.height()}, count);
    const auto planes = planes_of(light, {0, 0, tile.width(), tile.height()});
    auto done = gather_light(m.grid, tile, m.cloth.normals_of(tile), radiosity, {.rays = rays}, planes);
    if (!done) return done.error();
    return light;
  };
  const auto truth = gathered(m.compared, kMostRays);
  if (!truth) return truth.error();
  for (const int rays : {8, 16, 32, 64, 128}) {
    const double seconds = least_seconds(kTransportRepeats, [&] { (void)gathered(m.timed, rays); });
    const auto packets = gather_packets(m.grid, m.timed, m.cloth.normals_of(m.timed), {.rays = rays});
    Json row = traced_row("gather", rays, seconds, packets,
                          bare.intersect_ns(packets.size(), filler_of(packets)), m.timed);
    const auto found = gathered(m.compared, rays);
    if (!found) return found.error();
    const Errors errors = errors_of(*found, *truth);
    row["mean_error"] = errors.mean;
    row["rms_error"] = errors.rms;
    rows.push_back(std::move(row));
  }
  return add_slices(m, *truth, rows);
}

Result<void> add_horizons(const Measured& m, Rows& rows) {
  const Normals normals = m.cloth.normals_of(m.compared);
  Image<float> truth({m.compared.width(), m.compared.height()}), found(truth.size());
  auto done = trace_openness(m.grid, m.compared, normals, {.rays = kMostRays}, truth.plane());
  if (!done) return done;
  for (const auto& counts : {std::pair{4, 8}, {8, 16}}) {
    const double seconds = least_seconds(kTransportRepeats, [&] {
      done =
          scan_openness(m.grid.relief(), m.compared, normals, {counts.first, counts.second}, found.plane());
    });
    if (!done) return done;
    const Errors errors = errors_of(found, truth);
    rows.push_back({{"stage", counts.first == 4 ? "openness 4 x 8" : "openness 8 x 16"},
                    {"ns_per_pixel", seconds * 1e9 / static_cast<double>(m.compared.pixels())},
                    {"threads", 1},
                    {"mean_error", errors.mean},
                    {"rms_error", errors.rms}});
  }
  return {};
}

/// Grid, shadows and arriving light of one block; Embree's memory for it.
Result<std::int64_t> round_of(const DeepWeave& cloth, const Relief& relief, const LightDirections& lights,
                              Rect block, int reach_px) {
  const GatherSettings settings;
  const auto grid = HeightGrid::build(relief, block, std::max(reach_px, settings.reach_px) + 1);
  if (!grid) return grid.error();
  const std::int64_t bytes = HeightGrid::bytes_in_use();
  const Size size = {block.width(), block.height()};
  Image<std::uint32_t> bits(size, visibility_words(lights.count));
  Image<float> light(size, static_cast<int>(lights.count));
  const Rect whole = {0, 0, size.width, size.height};
  const Normals normals = cloth.normals_of(block);
  const auto seen = find_visible_lights(*grid, block, normals, lights, reach_px, planes_of(bits, whole));
  if (!seen) return seen.error();
  const std::vector<float> values(static_cast<std::size_t>(grid->area().pixels()) * lights.count, 0.5f);
  const Radiosity radiosity = {grid->area(), static_cast<int>(lights.count), values};
  const auto done = gather_light(*grid, block, normals, radiosity, settings, planes_of(light, whole));
  if (!done) return done.error();
  return bytes;
}

Result<void> add_round(const StudyOptions& options, const DeepWeave& cloth, const Relief& relief,
                       const LightDirections& lights, int reach_px, Rows& rows) {
  const auto blocks = tiles_of(relief.pixels(), {.width = kBlock.width, .height = kBlock.height / 4});
  std::vector<Result<std::int64_t>> bytes(blocks.size(), std::int64_t{0});
  const double seconds = least_seconds(1, [&] {
    parallel_for(blocks.size(), options.threads, [&](std::size_t i, int) {
      bytes[i] = round_of(cloth, relief, lights, blocks[i], reach_px);
    });
  });
  std::int64_t most_bytes = 0;
  for (const auto& each : bytes) {
    if (!each) return each.error();
    most_bytes = std::max(most_bytes, *each);
  }
  const double pixels = static_cast<double>(relief.pixels().pixels());
  rows.push_back({{"stage", "round"},
                  {"ns_per_pixel", seconds * 1e9 / pixels},
                  {"threads", resolved_threads(options.threads)},
                  {"bytes_per_pixel", static_cast<double>(most_bytes) / pixels}});
  return {};
}

}  // namespace

/// Cost and error of solver/transport and of rays (bench/oracles/rays) on the deep weave, ten pixels a yarn,
/// under ten LEDs 600 mm away:
///   grid      a block's height grid
///   shadows   visibility of ten lights by rays
///   gather    arriving light of ten lights at albedo 0.5 from 8 to 128 rays
///   slices    the same light from 8 to 64 directions
///   openness  by 4 x 8 and 8 x 16 horizon steps
///   round     grids, shadows and 32 rays for all blocks of the picture
/// `ratio` is ns_per_ray over bare_ns: Embree's robust quads of the same heights with the same rays ready in
/// its own structures and in the cache, one by one or in packets of 16, whichever is quicker. ns_per_ray is
/// everything: making rays, tracing them, adding up. Errors are against 4096 rays, in shares of what a facing
/// white surface would receive (gather) or of the sky (openness); bytes_per_pixel is Embree's memory a pixel
/// of the block, halo included.
Result<Rows> transport(const StudyOptions& options) {
  const int side = std::max(static_cast<int>(std::sqrt(options.megapixels * 1e6 / 1.5)), 256);
  const Size size = {side * 3 / 2, side};
  const DeepWeave cloth = deep_weave(size);
  const LightDirections lights = leds_over(cloth);
  const auto relief = Relief::of(cloth.height_mm.plane(), cloth.mm_per_pixel);
  if (!relief) return relief.error();
  const int reach_px = shadow_reach(*relief, lights).reach_px;
  const int halo_px = std::max(reach_px, GatherSettings{}.reach_px) + 1;
  const Rect block = {0, 0, std::min(size.width, kBlock.width), std::min(size.height, kBlock.height)};

  std::optional<Result<HeightGrid>> grid;
  const std::int64_t bytes_before = HeightGrid::bytes_in_use();
  const double build_seconds = least_seconds(kTransportRepeats, [&] {
    grid.reset();
    grid = HeightGrid::build(*relief, block, halo_px);
  });
  if (!*grid) return grid->error();
  const double pixels = static_cast<double>(block.pixels());
  Rows rows = {
      {{"stage", "grid"},
       {"ns_per_pixel", build_seconds * 1e9 / pixels},
       {"threads", hardware_threads()},
       {"bytes_per_pixel", static_cast<double>(HeightGrid::bytes_in_use() - bytes_before) / pixels}}};

  const Rect area = (*grid)->area();
  const BareEmbree bare(BareEmbree::Cells::kQuads, vertices_of(**grid), {area.width(), area.height()});
  const Measured measured = {cloth, lights, **grid, {64, 64, 192, 128}, {80, 80, 112, 112}};
  if (auto done = add_shadows(measured, bare, reach_px, rows); !done) return done.error();
  if (auto done = add_gathers(measured, bare, rows); !done) return done.error();
  if (auto done = add_horizons(measured, rows); !done) return done.error();
  if (auto done = add_round(options, cloth, *relief, lights, reach_px, rows); !done) return done.error();
  return rows;
}

}  // namespace weft::bench
