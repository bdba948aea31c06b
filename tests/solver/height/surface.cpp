// SPDX-License-Identifier: Apache-2.0
#include "tests/solver/height/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"

namespace weft::test {
namespace {

// Sum of f(x, y) over all pixels.
template <typename Body>
double sum_over(Size size, const Body& body) {
  double sum = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) sum += body(x, y);
  }
  return sum;
}

}  // namespace

SurfacePoint weave_with_folds(double x, double y) {
  const double wave = 2 * kPi / 10, amplitude = 1.8;
  SurfacePoint s = {amplitude * std::sin(wave * x) * std::sin(wave * y),
                    amplitude * wave * std::cos(wave * x) * std::sin(wave * y),
                    amplitude * wave * std::sin(wave * x) * std::cos(wave * y)};
  struct Fold {
    double height, width, angle, offset;
  };
  for (const Fold& fold : {Fold{30, 20, 0.4, 120}, Fold{-22, 18, 1.9, 90}, Fold{20, 25, 1.2, 230}}) {
    const double c = std::cos(fold.angle), d = std::sin(fold.angle);
    const double u = (x * c + y * d - fold.offset) / fold.width;
    const double ridge = fold.height * std::exp(-u * u / 2);
    s.height += ridge;
    s.right -= ridge * u / fold.width * c;
    s.down -= ridge * u / fold.width * d;
  }
  return s;
}

Image<float> normals_of(Size size, const Surface& surface) {
  Image<float> normals(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const SurfacePoint s = surface(x, y);
      const Vec3 n = normalized({-s.right, s.down, 1});
      normals(x, y, 0) = static_cast<float>(n.x);
      normals(x, y, 1) = static_cast<float>(n.y);
      normals(x, y, 2) = static_cast<float>(n.z);
    }
  }
  return normals;
}

std::array<View<const float>, 3> planes_of(const Image<float>& normals) {
  return {normals.plane(0), normals.plane(1), normals.plane(2)};
}

void add_noise(Image<float>& normals, double sigma_deg, std::uint64_t seed) {
  Random random(seed);
  const double sigma = radians(sigma_deg) / std::sqrt(2);
  for (int y = 0; y < normals.height(); ++y) {
    for (int x = 0; x < normals.width(); ++x) {
      const Vec3 n = {normals(x, y, 0), normals(x, y, 1), normals(x, y, 2)};
      const Vec3 side = normalized(cross(n, {0, 1, 0})), other = cross(n, side);
      const Vec3 turned = normalized(n + sigma * random.normal() * side + sigma * random.normal() * other);
      normals(x, y, 0) = static_cast<float>(turned.x);
      normals(x, y, 1) = static_cast<float>(turned.y);
      normals(x, y, 2) = static_cast<float>(turned.z);
    }
  }
}

double rms_error_px(View<const float> height, const Surface& truth) {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  const auto error = [&](int x, int y) { return height(x, y) - truth(x, y).height; };
  sum_over(height.size(), [&](int x, int y) {
    const Eigen::Vector3d base(1, x, y);
    gram += base * base.transpose();
    moment += base * error(x, y);
    return 0.0;
  });
  const Eigen::Vector3d plane = gram.ldlt().solve(moment);
  const double squares = sum_over(height.size(), [&](int x, int y) {
    const double e = error(x, y) - plane.dot(Eigen::Vector3d(1, x, y));
    return e * e;
  });
  return std::sqrt(squares / static_cast<double>(height.size().pixels()));
}

double rms_of(View<const float> height) {
  const double squares =
      sum_over(height.size(), [&](int x, int y) { return height(x, y) * double{height(x, y)}; });
  return std::sqrt(squares / static_cast<double>(height.size().pixels()));
}

double rms_difference(View<const float> a, View<const float> b) {
  const double squares = sum_over(a.size(), [&](int x, int y) {
    const double d = double{a(x, y)} - b(x, y);
    return d * d;
  });
  return std::sqrt(squares / static_cast<double>(a.size().pixels()));
}

double mean_of(View<const float> height) {
  return sum_over(height.size(), [&](int x, int y) { return double{height(x, y)}; }) /
         static_cast<double>(height.size().pixels());
}

bool all_finite(View<const float> height) {
  return sum_over(height.size(), [&](int x, int y) { return std::isfinite(height(x, y)) ? 0.0 : 1.0; }) == 0;
}

bool same_bytes(View<const float> a, View<const float> b) {
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), sizeof(float) * static_cast<std::size_t>(a.width())) != 0)
      return false;
  }
  return a.size() == b.size();
}

solver::Height height_of(const Image<float>& normals, const solver::HeightOptions& options,
                         View<const std::uint8_t> mask) {
  Result<solver::Height> height = solver::height_from_normals(planes_of(normals), mask, options);
  if (!height) {
    ADD_FAILURE() << height.error().message();
    solver::Height none;
    none.height_mm = Image<float>(normals.size());
    return none;
  }
  return std::move(height).value();
}

}  // namespace weft::test
