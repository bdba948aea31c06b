// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/studies.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>

#include "bench/base/rig.h"
#include "bench/base/yardsticks.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "solver/height/height.h"

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
    Result<Json> row = measure(run, copy_a_byte, threads);
    if (!row) return std::move(row).error();
    rows.push_back(std::move(row).value());
  }
  return rows;
}

}  // namespace weft::bench
