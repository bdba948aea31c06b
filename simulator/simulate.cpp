// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <new>
#include <numeric>
#include <utility>

#include "core/calibration.h"
#include "core/files.h"
#include "core/image_io/image_io.h"
#include "core/raw_frame.h"
#include "core/session.h"
#include "simulator/build_passes.h"
#include "simulator/camera/dng_writer.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr int kBandRows = 128;                                   // of the truth, in memory at a time
constexpr std::uint64_t kFrameBytes = std::uint64_t{256} << 20;  // of counts, in memory at a time
constexpr int kFarthestPixel = 1000 * 1000;
constexpr int kTruthPlanes = 7;  // normal, albedo, height

/// Adds the time it lives to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(&seconds), start_(steady_clock::now()) {}
  ~Stopwatch() { *seconds_ += std::chrono::duration<double>(steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* seconds_;
  steady_clock::time_point start_;
};

/// A folder under construction, removed unless it was published.
class FolderAside {
 public:
  static Result<FolderAside> make(const fs::path& target) {
    FolderAside aside;
    aside.path_ = target;
    aside.path_ += ".partial";
    std::error_code failed;
    if (fs::create_directory(aside.path_, failed)) return aside;
    const fs::path path = std::exchange(aside.path_, fs::path());
    if (failed) return cannot_write(path, failed.value());
    return Error{ErrorKind::kCannotCreate, "another simulation seems to write there", path.string(),
                 "the folder exists", "wait for it, or remove the folder if that simulation was killed"};
  }
  FolderAside(FolderAside&& other) noexcept : path_(std::exchange(other.path_, fs::path())) {}
  FolderAside& operator=(FolderAside&&) = delete;
  ~FolderAside() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }
  Result<void> publish(const fs::path& target) {
    Result<void> published = publish_folder(path_, target);
    if (published) path_.clear();
    return published;
  }

 private:
  FolderAside() = default;
  fs::path path_;
};

/// Float planes that rows of tiles are put into.
struct Band {
  Image<float> planes;
  int y0 = 0;

  template <typename Value>
  void put(const Tile& tile, int plane, const Value& value_of) {
    const View<float> view = planes.plane(plane);
    for_each_pixel(tile.rect, [&](std::size_t, int x, int y) {
      view(x, y - y0) = static_cast<float>(value_of(index_in(tile.area, x, y)));
    });
  }
  Result<void> append_to(ImageWriter& file, int first, int count, int rows) const {
    std::vector<View<const float>> views;
    for (int p = first; p < first + count; ++p) {
      views.push_back(planes.plane(p).crop({0, 0, planes.width(), rows}));
    }
    return file.write_rows(views);
  }
};

void copy_counts(const Tile& tile, View<std::uint16_t> counts) {
  const auto row_length = static_cast<std::size_t>(tile.rect.width());
  const std::uint16_t* row = tile.counts.data();
  for (int y = tile.rect.y0; y < tile.rect.y1; ++y, row += row_length) {
    std::copy_n(row, row_length, counts.row(y) + tile.rect.x0);
  }
}

constexpr std::uint64_t kMegabyte = 1000000;

Error no_memory(const std::string& why) {
  return {ErrorKind::kTryAgain, "not enough memory", "simulation", why,
          "end other programs or simulate a smaller picture"};
}

Result<void> check_memory(std::uint64_t bytes) {
  const std::uint64_t free = available_memory_bytes();
  if (free == 0 || bytes <= free) return {};  // 0: the system does not say
  return no_memory(fmt::format("{} MB are needed, {} MB are free", bytes / kMegabyte, free / kMegabyte));
}

Error interrupted() {
  return {ErrorKind::kInterrupted, "interrupted", "", "stopped on request", ""};
}

/// One map of the truth: its file and where its planes are in the band.
struct Map {
  const char* file;
  std::vector<std::string> channels;
  int first_plane;
};

class SessionWriter {
 public:
  SessionWriter(const Scene& scene, const Rig& rig, const SimulateOptions& options)
      : scene_(scene),
        rig_(rig),
        options_(options),
        runner_(build_passes(scene, rig, Output::kCounts), options.tiles) {}

  Result<SimulationReport> write(const fs::path& target) {
    if (Result<void> ok = check_room(target); !ok) return ok.error();
    Result<FolderAside> aside = FolderAside::make(target);
    if (!aside) return aside.error();
    folder_ = aside->path();
    for (const char* part : {"raw", "truth"}) {
      if (Result<void> ok = make_writable_folder(folder_ / part); !ok) return ok.error();
    }
    using Step = Result<void> (SessionWriter::*)();
    for (const Step step : {&SessionWriter::write_calibration_folder, &SessionWriter::write_truth,
                            &SessionWriter::write_frames, &SessionWriter::write_session_file}) {
      if (Result<void> ok = (this->*step)(); !ok) return ok.error();
    }
    if (Result<void> ok = publish(*aside, target); !ok) return ok.error();
    report_.exposure_us = rig_.exposure_us;
    report_.passes = runner_.costs();
    report_.left_out = runner_.left_out();
    return std::move(report_);
  }

 private:
  int width() const { return scene_.camera.width; }
  int height() const { return scene_.camera.height; }
  int frames() const { return static_cast<int>(rig_.leds.leds.size()) + 1; }

  std::size_t frames_at_once() const {
    const std::uint64_t fitting = kFrameBytes / frame_bytes();
    return std::clamp<std::size_t>(fitting, 1, static_cast<std::size_t>(frames()));
  }
  std::uint64_t frame_bytes() const {
    return sizeof(std::uint16_t) * static_cast<std::uint64_t>(Size{width(), height()}.pixels());
  }

  /// Better now than after an hour of rendering.
  Result<void> check_room(const fs::path& target) const {
    std::error_code ignored;
    if (fs::exists(target, ignored)) {
      return Error{ErrorKind::kCannotCreate, "session exists", target.string(),
                   "sessions are never overwritten", "choose another name with -o or remove it"};
    }
    const std::uint64_t truth_row = kTruthPlanes * sizeof(float) * static_cast<std::uint64_t>(width());
    const std::uint64_t disk = truth_row * static_cast<std::uint64_t>(height()) +
                               frame_bytes() * static_cast<std::uint64_t>(frames());
    if (const std::uint64_t free = free_disk_bytes(target); free < disk) {
      return Error{ErrorKind::kInputOutput, "no room for the session", target.string(),
                   fmt::format("{} MB are needed, {} MB are free", disk / kMegabyte, free / kMegabyte),
                   "free disk space or choose another disk with -o"};
    }
    return check_memory(truth_row * kBandRows + frame_bytes() * frames_at_once());
  }

  Result<void> write_calibration_folder() {
    Result<Calibration> written = write_calibration(folder_ / "calibration", exact_calibration(scene_, rig_));
    if (!written) return written.error();
    session_.calibration_id = written->id;
    return {};
  }

  Result<void> write_truth() {
    if (Result<void> ok = write_file(folder_ / "truth" / "scene.toml", to_toml(scene_)); !ok) return ok;
    const Map maps[] = {
        {"normal.exr", {"X", "Y", "Z"}, 0}, {"albedo.exr", {"R", "G", "B"}, 3}, {"height.exr", {"Y"}, 6}};
    std::vector<ImageWriter> files;
    for (const Map& map : maps) {
      Result<ImageWriter> file =
          ImageWriter::open(folder_ / "truth" / map.file, {width(), height()}, map.channels, WriteOptions());
      if (!file) return file.error();
      files.push_back(std::move(*file));
    }
    Band band = {Image<float>({width(), std::min(kBandRows, height())}, kTruthPlanes)};
    for (band.y0 = 0; band.y0 < height(); band.y0 += kBandRows) {
      const int y1 = std::min(band.y0 + kBandRows, height());
      if (Result<void> ok = render_truth(band, y1); !ok) return ok;
      const Stopwatch timing(report_.write_seconds);
      for (std::size_t m = 0; m < files.size(); ++m) {
        const int planes = static_cast<int>(maps[m].channels.size());
        if (Result<void> ok = band.append_to(files[m], maps[m].first_plane, planes, y1 - band.y0); !ok)
          return ok;
      }
    }
    for (ImageWriter& file : files) {
      if (Result<void> ok = file.finish(); !ok) return ok;
    }
    report_progress();
    return {};
  }

  Result<void> render_truth(Band& band, int y1) {
    const Stopwatch timing(report_.render_seconds);
    return runner_.run(
        {0, band.y0, width(), y1}, {}, options_.stop,
        [&](const Tile& tile) {
          band.put(tile, 0, [&](std::size_t i) { return tile.surface[i].normal.x; });
          band.put(tile, 1, [&](std::size_t i) { return tile.surface[i].normal.y; });
          band.put(tile, 2, [&](std::size_t i) { return tile.surface[i].normal.z; });
          for (int c = 0; c < 3; ++c) {
            band.put(tile, 3 + c, [&](std::size_t i) { return tile.albedo[i][static_cast<std::size_t>(c)]; });
          }
          band.put(tile, 6, [&](std::size_t i) { return tile.surface[i].height_mm; });
        },
        {});
  }

  Result<void> write_frames() {
    std::vector<int> leds(static_cast<std::size_t>(frames()));
    std::iota(leds.begin(), leds.end(), 1);
    leds.back() = 0;  // the dark shot comes last
    // The surface is the same for every light: frames that fit into memory together share it.
    std::vector<RawFrame> together(frames_at_once());
    for (RawFrame& frame : together) frame = empty_frame();
    for (std::size_t first = 0; first < leds.size(); first += together.size()) {
      const std::size_t count = std::min(together.size(), leds.size() - first);
      if (Result<void> ok = render_frames({&leds[first], count}, together); !ok) return ok;
      for (std::size_t i = 0; i < count; ++i) {
        if (options_.stop.stop_requested()) return interrupted();
        if (Result<void> ok = write_frame(static_cast<int>(first + i), leds[first + i], together[i]); !ok)
          return ok;
        ++report_.frames;
        report_progress();
      }
    }
    return {};
  }

  RawFrame empty_frame() const {
    RawFrame frame;
    frame.counts = Image<std::uint16_t>({width(), height()});
    const auto black = static_cast<float>(rig_.sensor.black);
    frame.black = {{{black, black}, {black, black}}};
    frame.white = static_cast<float>(rig_.sensor.white);
    frame.shot = {rig_.sensor.make, rig_.sensor.model, "virtual",
                  rig_.exposure_us, scene_.camera.iso, scene_.camera.f_number};
    return frame;
  }

  Result<void> render_frames(std::span<const int> leds, std::span<RawFrame> frames) {
    const Stopwatch timing(report_.render_seconds);
    return runner_.run(
        {0, 0, width(), height()}, leds, options_.stop, [](const Tile&) {},
        [&](const Tile& tile) {
          const auto shot = std::find(leds.begin(), leds.end(), tile.led) - leds.begin();
          copy_counts(tile, frames[static_cast<std::size_t>(shot)].counts.plane());
        });
  }

  Result<void> write_frame(int index, int led, const RawFrame& frame) {
    const Stopwatch timing(report_.write_seconds);
    Shot shot;
    shot.index = index;
    shot.led = led;
    shot.role = led == 0 ? ShotRole::kDark : ShotRole::kLit;
    shot.file = fmt::format("raw/{:02}_led{:02}.dng", index, led);
    shot.exposure_us = rig_.exposure_us;
    shot.iso = scene_.camera.iso;
    shot.f_number = scene_.camera.f_number;
    DngTags tags;
    for (std::size_t c = 0; c < 3; ++c) {
      tags.as_shot_neutral[c] = scene_.lights.white_balance[c] / scene_.lights.white_balance[1];
    }
    if (Result<void> ok = write_dng(folder_ / shot.file, frame, tags); !ok) return ok;
    Result<std::string> digest = sha256_of_file(folder_ / shot.file);
    if (!digest) return digest.error();
    shot.sha256 = *digest;
    session_.shots.push_back(std::move(shot));
    return {};
  }

  Result<void> write_session_file() {
    session_.folder = folder_;
    session_.fabric = scene_.fabric;
    session_.cloth_height_mm = scene_.geometry.cloth_height_mm;
    session_.rig = "virtual rig";
    return write_session(session_);
  }

  Result<void> publish(FolderAside& aside, const fs::path& target) {
    const Stopwatch timing(report_.write_seconds);
    return aside.publish(target);
  }

  void report_progress() {
    if (options_.progress) options_.progress(++parts_done_, frames() + 1);
  }

  const Scene& scene_;
  const Rig& rig_;
  const SimulateOptions& options_;
  PassRunner runner_;
  fs::path folder_;
  Session session_;
  SimulationReport report_;
  int parts_done_ = 0;
};

}  // namespace

Result<SimulationReport> simulate_session(const Scene& scene, const fs::path& session_folder,
                                          const SimulateOptions& options) try {
  const Result<Rig> rig = rig_of(scene);
  if (!rig) return rig.error();
  if (session_folder.empty()) {
    return Error{ErrorKind::kUsage, "no session folder", "simulation", "its name is empty",
                 "name one with -o"};
  }
  const bool ends_in_slash = !session_folder.has_filename() && session_folder.has_parent_path();
  const fs::path target = ends_in_slash ? session_folder.parent_path() : session_folder;
  return SessionWriter(scene, *rig, options).write(target);
} catch (const std::bad_alloc&) {
  return no_memory("the system refused some");
}

Result<Rendering> render_readings(const Scene& scene, Rect area, const TileOptions& tiles) try {
  const Result<Rig> rig = rig_of(scene);
  if (!rig) return rig.error();
  const auto inside = [](int from, int to) {
    return from >= -kFarthestPixel && to <= kFarthestPixel && from < to;
  };
  if (!inside(area.x0, area.x1) || !inside(area.y0, area.y1)) {
    return Error{ErrorKind::kUsage, "area cannot be rendered",
                 fmt::format("columns {} to {}, rows {} to {}", area.x0, area.x1, area.y0, area.y1),
                 fmt::format("it must hold a pixel and end within {} pixels of the origin", kFarthestPixel),
                 "choose another area"};
  }
  const std::uint64_t planes = 3 * rig->leds.leds.size() + kTruthPlanes;
  if (Result<void> ok = check_memory(static_cast<std::uint64_t>(area.pixels()) * planes * sizeof(double));
      !ok) {
    return ok.error();
  }
  std::vector<int> leds(rig->leds.leds.size());
  std::iota(leds.begin(), leds.end(), 1);
  const Size size = {area.width(), area.height()};
  Rendering out = {Image<double>(size, 3 * static_cast<int>(leds.size())), Image<double>(size, 3),
                   Image<double>(size, 3), Image<double>(size)};
  const double exposure = rig->exposure(scene.camera.iso);
  const auto put = [&](const Tile& tile, View<double> plane, const auto& value_of) {
    for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
      plane(x - area.x0, y - area.y0) = value_of(i, index_in(tile.area, x, y));
    });
  };
  PassRunner runner(build_passes(scene, *rig, Output::kRgb), tiles);
  const Result<void> ran = runner.run(
      area, leds, {},
      [&](const Tile& tile) {
        put(tile, out.normal.plane(0), [&](std::size_t, std::size_t i) { return tile.surface[i].normal.x; });
        put(tile, out.normal.plane(1), [&](std::size_t, std::size_t i) { return tile.surface[i].normal.y; });
        put(tile, out.normal.plane(2), [&](std::size_t, std::size_t i) { return tile.surface[i].normal.z; });
        put(tile, out.height_mm.plane(), [&](std::size_t, std::size_t i) { return tile.surface[i].height_mm; });
        for (std::size_t c = 0; c < 3; ++c) {
          put(tile, out.albedo.plane(static_cast<int>(c)), [&](std::size_t, std::size_t i) { return tile.albedo[i][c]; });
        }
      },
      [&](const Tile& tile) {
        for (std::size_t c = 0; c < 3; ++c) {
          put(tile, out.readings.plane(3 * (tile.led - 1) + static_cast<int>(c)),
              [&](std::size_t i, std::size_t) { return tile.samples[3 * i + c] / exposure; });
        }
      });
  if (!ran) return ran.error();
  return out;
} catch (const std::bad_alloc&) {
  return no_memory("the system refused some");
}

}  // namespace weft::simulator
