// SPDX-License-Identifier: Apache-2.0
#include "bench/base/yardsticks.h"

#include <fmt/format.h>
#include <libraw/libraw.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "bench/base/measured_rig.h"
#include "bench/base/study.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "simulator/camera/dng_writer.h"

namespace weft::bench {
namespace {

constexpr int kRepeats = 3;
constexpr double kMegapixels = 4;

Result<std::vector<std::filesystem::path>> write_frames(const solve::Photographs& photographs,
                                                        const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  const auto write = [&](const RawFrame& frame) -> Result<void> {
    files.push_back(folder / fmt::format("{:02}.dng", files.size()));
    return simulator::write_dng(files.back(), frame);
  };
  const solve::Mosaics& mosaics = *photographs.mosaics();
  for (const RawFrame& frame : mosaics.frames) {
    if (Result<void> ok = write(frame); !ok) return std::move(ok).error();
  }
  if (Result<void> ok = write(*mosaics.dark); !ok) return std::move(ok).error();
  return files;
}

}  // namespace

double copy_seconds(double bytes, int threads) {
  const auto half = static_cast<std::size_t>(std::max(bytes / 2, 128.0 * (1 << 20)));
  const Size size = {1 << 20, static_cast<int>(half >> 20) + 1};
  Image<std::uint8_t> from(size), to(size);
  const std::size_t part = half / static_cast<std::size_t>(threads);
  const auto copy = [&](std::size_t i, int) {
    std::memcpy(to.plane().row(0) + i * part, from.plane().row(0) + i * part, part);
  };
  std::memset(from.plane().row(0), 1, half);
  parallel_for(static_cast<std::size_t>(threads), threads, copy);
  const double seconds =
      least_seconds(kRepeats, [&] { parallel_for(static_cast<std::size_t>(threads), threads, copy); });
  return seconds * bytes / (2 * static_cast<double>(half));
}

solve::Photographs grey_mosaics(const LightField& field, Size size, int threads) {
  solve::Photographs photographs;
  photographs.size = size;
  photographs.field = field;
  constexpr double kExposureUs = 10000;
  const double seconds = kExposureUs * 1e-6;
  const auto frame = [&] {
    RawFrame f;
    f.counts = Image<std::uint16_t>(size);
    f.black = {{{600, 600}, {600, 600}}};
    f.white = 15520;
    f.shot = {"weft", "bench", "1", kExposureUs, 100, 8};
    return f;
  };
  std::vector<RawFrame> frames;
  for (std::size_t k = 0; k < field.count(); ++k) {
    RawFrame f = frame();
    parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < size.width; ++x) {
        const LightField::Light light = field.at(k, f.cfa.channel_at(x, y), x, y);
        const double signal = 0.4 * light.strength * light.direction.z * seconds;
        f.counts(x, y) = static_cast<std::uint16_t>(600 + std::min(1.0, signal) * (15520 - 600));
      }
    });
    frames.push_back(std::move(f));
  }
  RawFrame dark = frame();
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t row, int) {
    std::uint16_t* counts = dark.counts.plane().row(static_cast<int>(row));
    std::fill_n(counts, size.width, std::uint16_t{600});
  });
  photographs.frames =
      solve::Mosaics(std::move(frames), std::move(dark), Response{2.7, 1.2, {}}, {kExposureUs, 100});
  return photographs;
}

Result<double> unpack_seconds_a_pixel(const solve::Photographs& photographs, int threads) {
  const TemporaryFolder scratch;
  const auto files = write_frames(photographs, scratch.path());
  if (!files) return files.error();
  const Result<double> unpack = unpack_seconds(*files, threads);
  if (!unpack) return unpack.error();
  return *unpack / static_cast<double>(photographs.size.pixels());
}

Result<Yardsticks> measure_yardsticks(int threads) {
  constexpr double kBytes = 256.0 * (1 << 20);
  const Size size = bench_size(kMegapixels);
  const Result<LightField> field = LightField::make(bench_lights(1, false), bench_camera(size), size, 0);
  if (!field) return field.error();
  const Result<double> unpack = unpack_seconds_a_pixel(grey_mosaics(*field, size, threads), threads);
  if (!unpack) return unpack.error();
  return Yardsticks{copy_seconds(kBytes, threads) / kBytes, *unpack};
}

Result<double> unpack_seconds(const std::vector<std::filesystem::path>& files, int threads) {
  std::atomic<int> failures = 0;
  const double seconds = least_seconds(3, [&] {
    parallel_for(files.size(), threads, [&](std::size_t i, int) {
      const auto raw = std::make_unique<LibRaw>();
      if (raw->open_file(files[i].c_str()) != LIBRAW_SUCCESS || raw->unpack() != LIBRAW_SUCCESS) ++failures;
    });
  });
  if (failures > 0) {
    return Error{ErrorKind::kInternal, "LibRaw cannot read our own DNG", files.front().string(), "", ""};
  }
  return seconds;
}

}  // namespace weft::bench
