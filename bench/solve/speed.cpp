// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/solve_studies.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/base/measured_rig.h"
#include "bench/base/yardsticks.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "core/base/vec.h"
#include "core/image_io/png_library.h"
#include "core/rig/session.h"
#include "simulator/simulate.h"
#include "solve/bands/bands.h"
#include "solve/levels/frame.h"
#include "solve/photographs/photographs.h"
#include "solver/kernels/linear.h"
#include "solver/method.h"
#include "solver/normals/seed.h"
#include "solver/reflectance/glossy_method.h"

namespace weft::bench {
namespace {

enum class Cloth {
  kSmooth,  ///< Lambert's law
  kSatin,   ///< and a highlight of the half vector, exponent 24, as strong as half the diffuse albedo
  kYarns    ///< dark, with a lobe that is narrower along the yarn; warp and weft in turn
};

constexpr double kClothAlbedo = 0.4, kPeriod_px = 24, kSteepest_deg = 12, kLobe = 0.2, kExponent = 24;
constexpr double kDarkAlbedo = 0.06;
const solver::Lobe kYarnLobe = {
    .family = solver::LobeFamily::kAnisotropicGgx, .alpha = 0.35, .f0 = 0.05, .along = 0.4};
constexpr double kElectronsPerCount = 2.7, kReadNoise = 1.2;  // counts

// A standard normal deviate that belongs to a number (splitmix64, Steele et al. 2014; Box and Muller 1958).
double deviate(std::uint64_t number) {
  std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  const double u = (static_cast<double>(z >> 32) + 0.5) * 0x1p-32,
               v = static_cast<double>(z & 0xffffffffu) * 0x1p-32;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi * v);
}

Vec3 weave_normal(int x, int y) {
  const double slope = std::tan(radians(kSteepest_deg)) / std::sqrt(2.0), turn = 2 * kPi / kPeriod_px;
  return normalized({slope * std::sin(turn * x), slope * std::sin(turn * y), 1});
}

// What cloth reflects of light of strength 1 at a pixel.
double reflected(Cloth cloth, int x, int y, Vec3 l) {
  const Vec3 n = weave_normal(x, y);
  if (cloth == Cloth::kYarns) {
    const bool is_weft = std::sin(2 * kPi / kPeriod_px * x) * std::sin(2 * kPi / kPeriod_px * y) > 0;
    return solver::modelled(kYarnLobe, kDarkAlbedo * n, {l, {0, 0, 1}}, is_weft ? kPi / 2 : 0);
  }
  const double diffuse = kClothAlbedo * std::max(0.0, dot(n, l));
  if (cloth == Cloth::kSmooth) return diffuse;
  const Vec3 half = normalized(l + Vec3{0, 0, 1});
  return diffuse + kLobe * std::pow(std::max(0.0, dot(n, half)), kExponent);
}

// Puts cloth before the lights of grey mosaics (bench/base/yardsticks.h), with photon and read
// noise: a weave of 24 pixels a period whose slopes reach 12 degrees, seen from above. Counts are a function
// of the pixel alone.
void put_cloth(solve::Photographs& photographs, Cloth cloth, int threads) {
  const double seconds = 1 / 100.0;  // as grey mosaics are exposed
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    RawFrame& frame = photographs.mosaics()->frames[k];
    const double black = frame.black[0][0], range = frame.white - black;
    parallel_for(static_cast<std::size_t>(photographs.size.height), threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < photographs.size.width; ++x) {
        const LightField::Light light = photographs.field->at(k, frame.cfa.channel_at(x, y), x, y);
        const double counts = light.strength * seconds * range * reflected(cloth, x, y, light.direction);
        const std::uint64_t site = (k * static_cast<std::size_t>(photographs.size.height) + row) * 0x100000 +
                                   static_cast<unsigned>(x);
        const double sigma = std::sqrt(counts / kElectronsPerCount + kReadNoise * kReadNoise);
        frame.counts(x, y) = static_cast<std::uint16_t>(
            std::lround(std::clamp(black + counts + sigma * deviate(site), 0.0, double{frame.white})));
      }
    });
  }
}

constexpr std::size_t kLights = 10;
constexpr int kSolveRepeats = 3;

struct Timing {
  double seconds = 0;
  double pixels = 0;
  double bytes_a_pixel = 0;  ///< read and written
};

Result<Timing> time_method(const solve::Photographs& photographs, const solver::Method& method, int threads,
                           const solve::BandOptions& options = {}) {
  std::optional<Error> failure;
  const double seconds = least_seconds(kSolveRepeats, [&] {
    const Result<double> done = solve::solve_bands(
        photographs, method, solve::kSolveTile, {threads, {}, [](std::string_view, double) {}},
        [](const solve::MapBand&) { return Result<void>(); }, options);
    if (!done) failure = done.error();
  });
  if (failure) return *failure;
  // Eleven frames of counts in; normal, albedo, their sigmas, residual and status out.
  return Timing{seconds, static_cast<double>(photographs.size.pixels()), 2 * (kLights + 1) + 4.0 * 11 + 2};
}

// What a level takes, less what it would take of a frame without pixels: the seconds of two frames, one with
// a quarter of the pixels of the other, as a line.
struct FixedTime {
  double seconds = 0, ns_per_pixel = 0;
};

Result<FixedTime> time_level(solver::Level level, Cloth cloth, Size size, int threads) {
  std::array<double, 2> seconds = {}, pixels = {};
  for (const std::size_t i : {0U, 1U}) {
    const Size frame = i == 0 ? Size{size.width / 2, size.height / 2} : size;
    const LightField field = *LightField::make(bench_lights(1, true), bench_camera(frame), frame, 0);
    solve::Photographs photographs = grey_mosaics(field, frame, threads);
    put_cloth(photographs, cloth, threads);
    std::optional<Error> failure;
    seconds[i] = least_seconds(kSolveRepeats, [&] {
      const auto done = solve::solve_frame(photographs, solver::method_of(level), solve::kSolveTile,
                                           {threads, {}, [](std::string_view, double) {}},
                                           [](const solve::MapBand&) { return Result<void>(); });
      if (!done) failure = done.error();
    });
    if (failure) return *failure;
    pixels[i] = static_cast<double>(frame.pixels());
  }
  const double a_pixel = std::max(0.0, seconds[1] - seconds[0]) / (pixels[1] - pixels[0]);
  return FixedTime{seconds[0] - a_pixel * pixels[0], a_pixel * 1e9};
}

// Planes whose rows lie side by side, as the tiles of a solve have them. Thirty planes of 64 MB, one behind
// the other, would measure how the processor finds its pages: 2.2 times as long on an EPYC at 16 megapixels.
class RowPlanes {
 public:
  RowPlanes(Size size, int planes)
      : size_(size), planes_(planes), rows_({size.width, size.height * planes}) {}
  View<float> plane(int p) { return {rows_.plane().row(p), size_, rows_.plane().stride() * planes_}; }

 private:
  Size size_;
  int planes_;
  Image<float> rows_;
};

Timing time_bare(Size size, int threads) {
  constexpr int kReadings = 3 * static_cast<int>(kLights);
  const LightField field = *LightField::make(bench_lights(0, false), bench_camera(size), size, 0);
  RowPlanes planes(size, kReadings + 6);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (std::size_t k = 0; k < kLights; ++k) {
      for (int x = 0; x < size.width; ++x) {
        const LightField::Light light = field.at(k, 0, x, y);
        for (int c = 0; c < 3; ++c) {
          planes.plane(static_cast<int>(k) * 3 + c)(x, y) =
              static_cast<float>(0.4 * light.strength * light.direction.z);
        }
      }
    }
  });
  const double seconds = least_seconds(kSolveRepeats, [&] {
    const TileOptions tiles = {.width = size.width, .height = 16, .threads = threads};
    const Result<void> done = for_each_tile({0, 0, size.width, size.height}, tiles, {}, [&](Rect tile, int) {
      std::vector<View<const float>> views;
      for (int i = 0; i < kReadings; ++i) views.emplace_back(planes.plane(i).crop(tile));
      const auto out = [&](int i) { return planes.plane(kReadings + i).crop(tile); };
      solver::solve_bare(tile, views, field, {out(0), out(1), out(2)}, {out(3), out(4), out(5)});
    });
    if (!done) std::terminate();
  });
  return {seconds, static_cast<double>(size.pixels()), 4.0 * (3 * kLights + 6)};
}

// The four systems a pixel and nothing else of the seed's method.
Timing time_seed(const LightField& field, Size size, int threads) {
  const int rows = std::clamp(100000 / size.width, 1, size.height);
  std::vector<double> sums(static_cast<std::size_t>(rows));
  const double seconds = least_seconds(kSolveRepeats, [&] {
    parallel_for(static_cast<std::size_t>(rows), threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      std::vector<solver::PixelRow> pixel(kLights);
      for (int x = 0; x < size.width; ++x) {
        for (std::size_t k = 0; k < kLights; ++k) {
          for (std::size_t c = 0; c < 3; ++c) {
            const LightField::Light light = field.at(k, static_cast<int>(c), x, y);
            pixel[k].direction = light.direction;
            pixel[k].strength[c] = light.strength;
            pixel[k].reading[c] = 0.4 * light.strength * light.direction.z;
          }
        }
        sums[row] += solver::solve_seed_pixel(pixel).n[3].z;
      }
    });
  });
  return {seconds, static_cast<double>(rows) * size.width, 8 * (3 * kLights + 12)};
}

}  // namespace

/// Time of the solver in memory, next to two yardsticks of the same run and the same threads:
///   copy    C: memcpy that reads and writes as many bytes in all as the bare kernel does
///   unpack  U: LibRaw's open and unpack of the eleven frames as DNG files
/// and the rows bare, fast, least-squares and seed (on fewer pixels: it takes as long a pixel).
/// `standard` also with the channels .model of sigma, which a solve of a session writes, and `robust` with a
/// lobe that is known, of two yarns. Rows with `fixed_s` are whole levels with all their stages, their
/// seconds as a line over two sizes: what a frame without pixels would take, and what each pixel adds.
/// `ratio_to_copy` is against a copy of the bytes that the row itself moves, `ratio_to_unpack` against U.
Result<Rows> solve_speed(const StudyOptions& options) {
  const int threads = resolved_threads(options.threads);
  const Size size = bench_size(options.megapixels);
  const double pixels = static_cast<double>(size.pixels());
  Rows rows;

  const Timing bare = time_bare(size, threads);
  const double copy = copy_seconds(bare.bytes_a_pixel * pixels, threads);
  const double copy_a_byte = copy / (bare.bytes_a_pixel * pixels);

  const LightField field = *LightField::make(bench_lights(1, true), bench_camera(size), size, 0);
  solve::Photographs photographs = grey_mosaics(field, size, threads);
  const Result<double> unpack = unpack_seconds_a_pixel(photographs, threads);
  if (!unpack) return unpack.error();

  const auto add = [&](const char* kind, const char* name, const Timing& t) {
    const double seconds_a_pixel = t.seconds / t.pixels;
    rows.push_back({{kind, name},
                    {"megapixels", t.pixels * 1e-6},
                    {"threads", threads},
                    {"ns_per_pixel", seconds_a_pixel * 1e9},
                    {"bytes_per_pixel", t.bytes_a_pixel},
                    {"ratio_to_copy", seconds_a_pixel / (copy_a_byte * t.bytes_a_pixel)},
                    {"ratio_to_unpack", seconds_a_pixel / *unpack}});
  };
  add("method", "copy", {copy, pixels, bare.bytes_a_pixel});
  add("method", "unpack", {*unpack * pixels, pixels, 2 * (kLights + 1)});
  add("method", "bare", bare);
  const Result<Timing> fast = time_method(photographs, *solver::fast_method(), threads);
  if (!fast) return fast.error();
  add("quality", "fast", *fast);
  const Result<Timing> least_squares = time_method(photographs, *solver::least_squares_method(), threads);
  if (!least_squares) return least_squares.error();
  add("method", "least-squares", *least_squares);
  const Timing seed = time_seed(field, size, threads);
  add("method", "seed", seed);
  struct OnCloth {
    const char* kind;
    const char* name;
    std::unique_ptr<solver::Method> (*make)();
  };
  constexpr OnCloth kMethods[] = {{"method", "wls", &solver::weighted_method},
                                  {"quality", "standard", &solver::standard_method},
                                  {"quality", "robust", &solver::robust_method},
                                  {"method", "lts", &solver::trimmed_method}};
  for (const Cloth cloth : {Cloth::kSmooth, Cloth::kSatin}) {
    const char* cloth_name = cloth == Cloth::kSmooth ? "smooth" : "satin";
    put_cloth(photographs, cloth, threads);
    for (const OnCloth& m : kMethods) {
      const Result<Timing> timing = time_method(photographs, *m.make(), threads);
      if (!timing) return timing.error();
      add(m.kind, m.name, *timing);
      rows.back()["cloth"] = cloth_name;
      if (m.make != &solver::standard_method) continue;
      const Result<Timing> with_model =
          time_method(photographs, *m.make(), threads, {.model = solver::ModelTraits()});
      if (!with_model) return with_model.error();
      add(m.kind, m.name, *with_model);
      rows.back()["cloth"] = cloth_name;
      rows.back()["sigma"] = "with .model";
    }
  }
  put_cloth(photographs, Cloth::kYarns, threads);
  const std::unique_ptr<solver::Method> standard = solver::standard_method();
  const Result<Timing> with_lobe = time_method(
      photographs,
      *solver::glossy_method(*standard, {{.lobe = kYarnLobe}}, solver::Sight(std::nullopt, 0), 1), threads);
  if (!with_lobe) return with_lobe.error();
  add("quality", "robust", *with_lobe);
  rows.back()["cloth"] = "yarns";
  rows.back()["lobe"] = solver::name_of(kYarnLobe.family);
  for (Json& row : rows) {
    row["times_quicker_than_seed"] =
        (seed.seconds / seed.pixels) / (row["ns_per_pixel"].get<double>() * 1e-9);
  }
  for (const auto& [level, cloth] :
       {std::pair{solver::Level::kRobust, Cloth::kSmooth}, std::pair{solver::Level::kRobust, Cloth::kYarns},
        std::pair{solver::Level::kReference, Cloth::kSmooth}}) {
    const Result<FixedTime> time = time_level(level, cloth, size, threads);
    if (!time) return time.error();
    rows.push_back({{"quality", solver::method_of(level).name},
                    {"megapixels", pixels * 1e-6},
                    {"threads", threads},
                    {"ns_per_pixel", time->ns_per_pixel},
                    {"ratio_to_unpack", time->ns_per_pixel * 1e-9 / *unpack},
                    {"cloth", cloth == Cloth::kSmooth ? "smooth" : "yarns"},
                    {"fixed_s", time->seconds}});
  }
  return rows;
}

namespace {

namespace fs = std::filesystem;

Result<double> exr_seconds(const fs::path& file, const fs::path& copy) try {
  Imf::setGlobalThreadCount(hardware_threads());
  Imf::InputFile in(file.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x) + 1,
             height = static_cast<std::size_t>(window.max.y) + 1;
  std::vector<std::vector<char>> planes;
  Imf::FrameBuffer frame;
  for (auto c = in.header().channels().begin(); c != in.header().channels().end(); ++c) {
    const std::size_t sample = c.channel().type == Imf::HALF ? 2 : 4;
    planes.emplace_back(sample * width * height);
    frame.insert(c.name(), Imf::Slice(c.channel().type, planes.back().data(), sample, sample * width));
  }
  in.setFrameBuffer(frame);
  in.readPixels(window.min.y, window.max.y);
  return least_seconds(3, [&] {
    Imf::OutputFile out(copy.c_str(), in.header(), hardware_threads());
    out.setFrameBuffer(frame);
    out.writePixels(static_cast<int>(height));
  });
} catch (const std::exception& failure) {
  return Error{ErrorKind::kInputOutput, "cannot write again", file.string(), failure.what(), ""};
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

bool read_png(png_structp png, png_infop header, std::FILE* file) {
  return png_does(png, [&] {
    png_init_io(png, file);
    png_read_png(png, header, PNG_TRANSFORM_IDENTITY, nullptr);
  });
}

bool write_png(png_structp from, png_infop header, std::FILE* file) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, png_fails, png_warns);
  png_infop copied = png_create_info_struct(png);
  const bool done = png_does(png, [&] {
    png_init_io(png, file);
    png_set_IHDR(png, copied, png_get_image_width(from, header), png_get_image_height(from, header),
                 png_get_bit_depth(from, header), png_get_color_type(from, header), PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_compression_level(png, kPngEffort);
    png_set_rows(png, copied, png_get_rows(from, header));
    png_write_png(png, copied, PNG_TRANSFORM_IDENTITY, nullptr);
  });
  png_destroy_write_struct(&png, &copied);
  return done;
}

Result<double> png_seconds(const fs::path& file, const fs::path& copy) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, png_fails, png_warns);
  png_infop header = png_create_info_struct(png);
  const File in(std::fopen(file.c_str(), "rb"), std::fclose);
  bool done = in != nullptr && read_png(png, header, in.get());
  const double seconds = !done ? 0 : least_seconds(3, [&] {
    const File out(std::fopen(copy.c_str(), "wb"), std::fclose);
    done &= out != nullptr && write_png(png, header, out.get());
  });
  png_destroy_read_struct(&png, &header, nullptr);
  if (!done) return Error{ErrorKind::kInputOutput, "cannot write again", file.string(), "", ""};
  return seconds;
}

// How long the library of its format takes to write the image of `file`, an EXR or PNG, to `copy` in one
// call, as it is stored. Error: kInputOutput.
Result<double> write_alone_seconds(const fs::path& file, const fs::path& copy) {
  return file.extension() == ".png" ? png_seconds(file, copy) : exr_seconds(file, copy);
}

// OpenEXR and libpng alone: the maps of a solve, as they are on disk, written again in one call each.
Result<double> write_seconds(const fs::path& maps, const fs::path& folder) {
  double sum = 0;
  for (const char* name : {"normal.exr", "albedo.exr", "sigma.exr", "residual.exr", "status.png"}) {
    const Result<double> seconds = write_alone_seconds(maps / name, folder / name);
    if (!seconds) return seconds.error();
    sum += *seconds;
  }
  return sum;
}

}  // namespace

/// From eleven DNG files to maps on disk by `weft solve --quality fast`, next to LibRaw's unpacking of the
/// same files and OpenEXR's and libpng's writing of the same maps, with the same threads: `ratio` is decode
/// to write over their sum, without compression, syncing and hashing. Memory is the peak of the process.
Result<Rows> end_to_end(const StudyOptions& options) {
  const TemporaryFolder scratch;
  const Size size = bench_size(options.megapixels);
  const int threads = resolved_threads(options.threads);
  simulator::Scene scene;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  scene.camera.mm_per_pixel = 200.0 / size.width;
  scene.geometry.kind = simulator::GeometryKind::kTwill;
  scene.effects.near_light = true;
  scene.effects.noise = true;
  const fs::path folder = scratch.path() / "cloth.weft";
  const auto simulated =
      simulator::simulate_session(scene, folder, {.tiles = {.threads = threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();

  // Without digests in the journal nothing is hashed while solving.
  Result<Session> session = read_session(folder);
  if (!session) return std::move(session).error();
  std::vector<fs::path> files;
  for (Shot& shot : session->shots) {
    shot.sha256.clear();
    files.push_back(session->path_of(shot));
  }
  if (Result<void> written = write_session(*session); !written) return std::move(written).error();

  const Result<double> unpack = unpack_seconds(files, threads);
  if (!unpack) return unpack.error();
  double best = 0, peak = 0;
  Json seconds;
  fs::path maps;
  for (int i = 0; i < 3; ++i) {
    maps = scratch.path() / fmt::format("maps{}", i);
    const Result<std::string> said =
        run_weft({"solve", folder.string(), "-o", maps.string(), "--quality", "fast", "--no-previews",
                  "--quiet", "--json", "--threads", std::to_string(threads)},
                 options.programs / "weft");
    if (!said) return said.error();
    const Json solved = Json::parse(*said), &s = solved["seconds"];
    const double work = s["read"].get<double>() + s["solve"].get<double>() + s["write"].get<double>();
    if (i == 0 || work < best) {
      best = work;
      seconds = s;
    }
    peak = std::max(peak, solved["peak_bytes"].get<double>());
  }
  const Result<double> write = write_seconds(maps, scratch.path());
  if (!write) return write.error();
  return Rows{{{"quality", "fast"},
               {"megapixels", static_cast<double>(size.pixels()) * 1e-6},
               {"threads", threads},
               {"read_s", seconds["read"]},
               {"solve_s", seconds["solve"]},
               {"write_s", seconds["write"]},
               {"decode_to_write_s", best},
               {"unpack_alone_s", *unpack},
               {"write_alone_s", *write},
               {"ratio", best / (*unpack + *write)},
               {"ns_per_pixel", best * 1e9 / static_cast<double>(size.pixels())},
               {"peak_mb", peak / (1 << 20)}}};
}

}  // namespace weft::bench
