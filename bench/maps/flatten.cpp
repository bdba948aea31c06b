// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/maps/cloths.h"
#include "bench/maps/processor_time.h"
#include "core/vec.h"
#include "material/maps/flatten.h"
#include "simulator/geometry/surface.h"
#include "solver/transport/pixel_hash.h"

namespace weft::bench {
namespace {

using SlopePair = std::array<double, 2>;
using SlowError = SlopePair (*)(double u, double v);

constexpr double kBias_deg = 1.5, kYarn_px = 10, kTurned_deg = 1.3, kWander = 0.04;

SlopePair no_error(double, double) {
  return {0, 0};
}
SlopePair cubic_error(double u, double v) {
  const double d = radians(kBias_deg);
  return {d * (0.8 * u + 0.3 * u * u * u + 0.2 * v * u * u), d * (0.7 * v + 0.25 * v * v * v - 0.2 * u * v)};
}
SlopePair corner_error(double u, double v) {
  const double d = radians(kBias_deg);
  return {d * std::pow(u, 7), d * std::pow(v, 7) * (0.5 + 0.5 * u)};
}

SlopePair at_pixel(SlowError error, Size size, int x, int y) {
  return error((2 * x + 1.0) / size.width - 1, 1 - (2 * y + 1.0) / size.height);
}

/// A yarn's way off its place in pitches: one of twelve numbers of about a normal distribution.
double off_place(std::int64_t yarn, int set) {
  const auto n = static_cast<int>((yarn % 100000 + 100000) % 100000);
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += solver::hash_of(n, 12 * set + i).first * 0x1p-32;
  return kWander * sum;
}

/// Slopes of the simulator's weave, turned, each point moved as its two yarns are.
class WanderingWeave {
 public:
  WanderingWeave() : surface_(simulator::surface_of(cloth_of(simulator::Family::kPlain))) {}

  SlopePair slopes(double x, double y) const {
    return {height(x + 0.5, y) - height(x - 0.5, y), height(x, y - 0.5) - height(x, y + 0.5)};
  }

 private:
  double height(double x, double y) const {
    const double c = std::cos(radians(kTurned_deg)), s = std::sin(radians(kTurned_deg));
    const double u = (x * c + y * s) / kYarn_px, v = (y * c - x * s) / kYarn_px;
    const double right = u - off_place(std::llround(std::floor(u)), 0);
    const double down = v - off_place(std::llround(std::floor(v)), 1);
    const double pitch_mm = kYarn_px * kClothPitch_mm;
    return simulator::point_at(surface_, right * pitch_mm, -down * pitch_mm).height_mm / kClothPitch_mm;
  }
  simulator::Surface surface_;
};

struct Slopes {
  Image<float> right, up;

  explicit Slopes(Size size) : right(size), up(size) {}
};

Slopes with_error(const Slopes& cloth, SlowError error) {
  const Size size = cloth.right.size();
  Slopes out(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const SlopePair slow = at_pixel(error, size, x, y);
      out.right(x, y) = cloth.right(x, y) + static_cast<float>(slow[0]);
      out.up(x, y) = cloth.up(x, y) + static_cast<float>(slow[1]);
    }
  }
  return out;
}

struct Flattened {
  double left_deg = 0, us_per_pixel = 0;
};

Result<Flattened> flattened(const Slopes& cloth, SlowError error, const material::FlattenOptions& options) {
  const Slopes slopes = with_error(cloth, error);
  const Size size = slopes.right.size();
  Image<float> removed;
  std::optional<Error> failure;
  const double seconds = processor_seconds([&] {
    const auto slow = material::slow_slopes(slopes.right.plane(), slopes.up.plane(), {}, options);
    if (slow)
      removed = material::removed_slopes(*slow, options.threads);
    else
      failure = slow.error();
  });
  if (failure) return *failure;
  double sum = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const SlopePair slow = at_pixel(error, size, x, y);
      for (int p = 0; p < 2; ++p) {
        const double e = static_cast<double>(removed(x, y, p)) - slow[static_cast<std::size_t>(p)];
        sum += e * e;
      }
    }
  }
  const double pixels = static_cast<double>(size.pixels());
  return Flattened{degrees(std::sqrt(sum / pixels)), seconds / pixels * 1e6};
}

struct Way {
  std::string name;
  material::FlattenOptions options;
};

std::vector<Way> ways(Size size, int threads) {
  const double c = 2 * kYarn_px * std::cos(radians(kTurned_deg)),
               s = 2 * kYarn_px * std::sin(radians(kTurned_deg));
  using material::FlattenMethod;
  std::vector<Way> all;
  for (const int degree : {3, 5}) {
    const std::string name = degree == 3 ? "cubic, " : "quintic, ";
    all.push_back({name + "Hann", {.method = FlattenMethod::kHann, .degree = degree}});
    all.push_back(
        {name + "repeats",
         {.method = FlattenMethod::kRepeat, .degree = degree, .repeat = material::Repeat{c, s, -s, c}}});
    all.push_back({name + "repeats off by 2 %",
                   {.method = FlattenMethod::kRepeat,
                    .degree = degree,
                    .repeat = material::Repeat{1.02 * c, 1.02 * s, -1.02 * s, 1.02 * c}}});
  }
  all.push_back({"high pass, a third of the width",
                 {.method = FlattenMethod::kHighPass, .cut_mm = size.width * kClothPitch_mm / 3}});
  for (Way& way : all) {
    way.options.mm_per_pixel = kClothPitch_mm;
    way.options.threads = threads;
  }
  return all;
}

}  // namespace

/// What each way of flattening leaves of a slow error of 1.5 degrees, a cubic one and one of seventh degree
/// in the corners, and what it takes from the same cloth without one, on a plain weave of 10 pixels a yarn,
/// turned by 1.3 degrees, whose yarns stand off their places by 4 percent of their pitch (rms). Frames of 512
/// x 512 and 1536 x 1024 pixels, rms in degrees.
Result<Rows> maps_flatten(const StudyOptions& options) {
  Rows rows;
  const WanderingWeave weave;
  for (const Size size : {Size{512, 512}, {1536, 1024}}) {
    Slopes cloth(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const SlopePair slope = weave.slopes(x, y);
        cloth.right(x, y) = static_cast<float>(slope[0]);
        cloth.up(x, y) = static_cast<float>(slope[1]);
      }
    }
    for (const Way& way : ways(size, options.threads)) {
      const auto clean = flattened(cloth, no_error, way.options),
                 cubic = flattened(cloth, cubic_error, way.options),
                 corner = flattened(cloth, corner_error, way.options);
      for (const auto* result : {&clean, &cubic, &corner}) {
        if (!*result) return result->error();
      }
      rows.push_back({{"width", size.width},
                      {"way", way.name},
                      {"cubic_left_deg", cubic->left_deg},
                      {"corner_left_deg", corner->left_deg},
                      {"taken_from_cloth_deg", clean->left_deg},
                      {"us_per_pixel", cubic->us_per_pixel}});
    }
  }
  return rows;
}

}  // namespace weft::bench
