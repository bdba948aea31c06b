// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace weft::simulator {
namespace {

constexpr std::size_t kBlock = 16;

struct Frame {
  std::array<float, 3> x, y, z;
};

std::array<float, 3> floats(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Duff et al., "Building an orthonormal basis, revisited" (JCGT 6(1), 2017).
Frame frame_about(Vec3 n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {floats({1 + sign * n.x * n.x * a, sign * b, -sign * n.x}), floats({b, sign + n.y * n.y * a, -n.y}),
          floats(n)};
}

struct CirclePoint {
  float cosine, sine;
};

/// Cosine and sine of a turn in [0, 1), but for their sign, to 2e-7: Taylor series of the half angle, which
/// stays within a quarter turn. Unlike the library's functions, vector instructions in a loop.
CirclePoint circle_point(float turn) {
  const float a = 3.14159265f * (turn - 0.5f), q = a * a;
  const float s =
      a *
      (1 + q * (-1 / 6.0f + q * (1 / 120.0f + q * (-1 / 5040.0f + q * (1 / 362880.0f - q / 39916800.0f)))));
  const float c =
      1 + q * (-1 / 2.0f + q * (1 / 24.0f + q * (-1 / 720.0f + q * (1 / 40320.0f + q * (-1 / 3628800.0f +
                                                                                        q / 479001600.0f)))));
  return {1 - 2 * s * s, 2 * s * c};
}

/// `polar(u)` gives the cosine and sine of the angle from the axis.
template <typename Polar>
void aim(const RaySettings& settings, Scramble scramble, Vec3 start_mm, Vec3 axis, double longest_mm,
         std::size_t first, RayBatch& rays, const Polar& polar) {
  const auto count = static_cast<std::size_t>(settings.rays);
  const std::array<float, 3> start = floats(start_mm);
  std::fill_n(&rays.origin_x_mm[first], count, start[0]);
  std::fill_n(&rays.origin_y_mm[first], count, start[1]);
  std::fill_n(&rays.origin_z_mm[first], count, start[2]);

  const Frame f = frame_about(axis);
  const auto reach = static_cast<float>(settings.reach_mm), longest = static_cast<float>(longest_mm);
  for (std::size_t done = 0; done < count; done += kBlock) {
    // Local and of constant size, so that the compiler sees whole vectors that overlap nothing.
    float x[kBlock], y[kBlock], z[kBlock], length[kBlock];
    for (std::size_t k = 0; k < kBlock; ++k) {
      const SquarePoint p = sobol(static_cast<std::uint32_t>(done + k), scramble);
      const CirclePoint from_axis = polar(p.u), around = circle_point(p.v);
      const float a = from_axis.sine * around.cosine, b = from_axis.sine * around.sine, c = from_axis.cosine;
      x[k] = a * f.x[0] + b * f.y[0] + c * f.z[0];
      y[k] = a * f.x[1] + b * f.y[1] + c * f.z[1];
      z[k] = a * f.x[2] + b * f.y[2] + c * f.z[2];
      length[k] = std::min(reach / std::sqrt(x[k] * x[k] + y[k] * y[k]), longest);
    }
    const std::size_t n = std::min(kBlock, count - done), to = first + done;
    std::copy_n(x, n, &rays.direction_x[to]);
    std::copy_n(y, n, &rays.direction_y[to]);
    std::copy_n(z, n, &rays.direction_z[to]);
    std::copy_n(length, n, &rays.length_mm[to]);
  }
}

}  // namespace

Result<void> check_rays(const RaySettings& settings) {
  const auto refuse = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, "rays cannot be traced", "ray settings", std::move(why),
                 std::move(remedy)};
  };
  if (settings.rays < 1 || settings.rays > kMostRays) {
    return refuse(fmt::format("{} rays a pixel", settings.rays),
                  fmt::format("ask for from 1 to {}", kMostRays));
  }
  if (!(settings.reach_mm > 0) || !std::isfinite(settings.reach_mm)) {
    return refuse(fmt::format("a reach of {} mm", settings.reach_mm), "give a finite reach over 0");
  }
  return {};
}

int halo_for(double reach_mm, double least_step_mm) {
  return static_cast<int>(std::min(std::ceil(reach_mm / least_step_mm), 1e9)) + 1;
}

void RayBatch::resize(std::size_t rays) {
  for (auto* values :
       {&origin_x_mm, &origin_y_mm, &origin_z_mm, &direction_x, &direction_y, &direction_z, &length_mm}) {
    values->resize(rays);
  }
}

void aim_along(const RaySettings& settings, Vec3 start_mm, Vec3 axis, double longest_mm, std::size_t first,
               RayBatch& rays) {
  rays.origin_x_mm[first] = static_cast<float>(start_mm.x);
  rays.origin_y_mm[first] = static_cast<float>(start_mm.y);
  rays.origin_z_mm[first] = static_cast<float>(start_mm.z);
  rays.direction_x[first] = static_cast<float>(axis.x);
  rays.direction_y[first] = static_cast<float>(axis.y);
  rays.direction_z[first] = static_cast<float>(axis.z);
  const double slant = std::sqrt(axis.x * axis.x + axis.y * axis.y);
  rays.length_mm[first] = static_cast<float>(std::min(settings.reach_mm / slant, longest_mm));
}

void aim_in_cone(const RaySettings& settings, Scramble scramble, Vec3 start_mm, Vec3 axis, double sine,
                 double longest_mm, std::size_t first, RayBatch& rays) {
  // 1 - cos of the half angle, without cancellation.
  const auto depth = static_cast<float>(sine * sine / (1 + std::sqrt(1 - sine * sine)));
  aim(settings, scramble, start_mm, axis, longest_mm, first, rays, [depth](float u) {
    const float d = depth * u;
    return CirclePoint{1 - d, std::sqrt(d * (2 - d))};
  });
}

void aim_by_cosine(const RaySettings& settings, Scramble scramble, Vec3 start_mm, Vec3 axis,
                   std::size_t first, RayBatch& rays) {
  aim(settings, scramble, start_mm, axis, std::numeric_limits<double>::infinity(), first, rays, [](float u) {
    return CirclePoint{std::sqrt(1 - u), std::sqrt(u)};
  });
}

}  // namespace weft::simulator
