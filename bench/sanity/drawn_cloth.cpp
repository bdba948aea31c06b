// SPDX-License-Identifier: Apache-2.0
#include "bench/sanity/drawn_cloth.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulator/sampling/random.h"

namespace weft::bench {
namespace {

// A yarn's round back over its place, 0 to 1, that goes over and under the others.
double yarn(double across, double along, bool is_over) {
  const double side = 2 * (across - std::floor(across)) - 1;
  return std::sqrt(1 - 0.9 * side * side) +
         (is_over ? 0.6 : -0.6) * std::sin(kPi * (along - std::floor(along)));
}

struct Weave {
  double period, turn;
  int step;  // 1: plain, 2 and more: twill
  double operator()(double x, double y) const {
    const double u = (std::cos(turn) * x - std::sin(turn) * y) / period;
    const double v = (std::sin(turn) * x + std::cos(turn) * y) / period;
    const int cells = static_cast<int>(std::floor(u)) + static_cast<int>(std::floor(v));
    const bool warp_is_over = ((cells % (step + 1)) + step + 1) % (step + 1) == 0;
    return std::max(yarn(u, v, warp_is_over), yarn(v, u, !warp_is_over));
  }
};

struct Wave {
  double kx, ky, phase, height;
};

template <typename Height>
Image<float> heights(Size size, const Height& height) {
  Image<float> image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image(x, y) = static_cast<float>(height(x, y));
  }
  return image;
}

Image<float> waves(Size size, int count, double shortest, double longest, Draws& draws) {
  std::vector<Wave> all;
  for (int i = 0; i < count; ++i) {
    const double length_px = draws.of_ratio(shortest, longest), turn = draws.between(0, 2 * kPi);
    all.push_back({2 * kPi / length_px * std::cos(turn), 2 * kPi / length_px * std::sin(turn),
                   draws.between(0, 2 * kPi), length_px});
  }
  return heights(size, [&](int x, int y) {
    double sum = 0;
    for (const Wave& w : all) sum += w.height * std::sin(w.kx * x + w.ky * y + w.phase);
    return sum;
  });
}

Image<float> bumps(Size size, Draws& draws) {
  Image<float> image(size);
  const double radius = draws.between(6, 16);
  const int count = static_cast<int>(static_cast<double>(size.pixels()) / (8 * radius * radius)) + 4;
  const double sign = draws.with(0.5) ? 1 : -1;
  for (int i = 0; i < count; ++i) {
    const double cx = draws.between(0, size.width), cy = draws.between(0, size.height);
    const double r = radius * draws.between(0.7, 1.3);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x)
        image(x, y) +=
            static_cast<float>(sign * r * std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (r * r)));
    }
  }
  return image;
}

// Central differences; p and q with y up.
std::array<double, 2> slope_at(const Image<float>& height, int x, int y) {
  const int left = std::max(x - 1, 0), right = std::min(x + 1, height.width() - 1);
  const int above = std::max(y - 1, 0), below = std::min(y + 1, height.height() - 1);
  const auto at = [&](int ax, int ay) { return static_cast<double>(height(ax, ay)); };
  return {(at(right, y) - at(left, y)) / (right - left), (at(x, above) - at(x, below)) / (below - above)};
}

void scale_to_slope(double rms, Image<float>& height) {
  double sum = 0;
  for (int y = 0; y < height.height(); ++y) {
    for (int x = 0; x < height.width(); ++x) {
      const auto [p, q] = slope_at(height, x, y);
      sum += p * p + q * q;
    }
  }
  const double now = std::sqrt(sum / static_cast<double>(height.size().pixels()));
  for (int y = 0; y < height.height(); ++y) {
    for (int x = 0; x < height.width(); ++x) height(x, y) *= static_cast<float>(rms / now);
  }
}

Image<float> draw_relief(Shape shape, Size size, Draws& draws) {
  Image<float> height;
  if (shape == Shape::kWeave) {
    const Weave weave = {draws.between(10, 28), draws.between(-0.3, 0.3), draws.below(3) + 1};
    height = heights(size, weave);
  } else if (shape == Shape::kBumps) {
    height = bumps(size, draws);
  } else {
    height = waves(size, 5, 15, 100, draws);
  }
  scale_to_slope(draws.between(0.1, 0.5), height);
  const Image<float> fibres = waves(size, 12, 5, 9, draws);
  const float share = static_cast<float>(draws.between(0, 0.02));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) height(x, y) += share * fibres(x, y);
  }
  return height;
}

// Height and normals in closed form: differences fail at its edge.
void make_ball(DrawnCloth& cloth, Draws& draws) {
  const Size size = cloth.albedo.size();
  const double radius = draws.between(0.35, 0.47) * std::min(size.width, size.height);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double dx = x - 0.5 * size.width, up = 0.5 * size.height - y;
      const double z = radius * radius - dx * dx - up * up;
      const bool inside = z > 0.01 * radius * radius;
      cloth.inside(x, y) = inside ? 1 : 0;
      cloth.height_px(x, y) = static_cast<float>(std::sqrt(std::max(z, 0.0)));
      const Vec3 normal = inside ? Vec3{dx / radius, up / radius, std::sqrt(z) / radius} : Vec3{0, 0, 1};
      for (const auto& [c, n] : {std::pair{0, normal.x}, {1, normal.y}, {2, normal.z}})
        cloth.normal(x, y, c) = static_cast<float>(n);
    }
  }
}

void make_cloth(DrawnCloth& cloth, Draws& draws) {
  cloth.height_px = draw_relief(cloth.shape, cloth.albedo.size(), draws);
  for (int y = 0; y < cloth.albedo.height(); ++y) {
    for (int x = 0; x < cloth.albedo.width(); ++x) {
      const auto [p, q] = slope_at(cloth.height_px, x, y);
      const Vec3 normal = normalized({-p, -q, 1});
      cloth.inside(x, y) = 1;
      for (const auto& [c, n] : {std::pair{0, normal.x}, {1, normal.y}, {2, normal.z}})
        cloth.normal(x, y, c) = static_cast<float>(n);
    }
  }
}

// Two colours in stripes, checks or clouds, and grain.
void paint(Image<float>& albedo, Draws& draws) {
  std::array<std::array<double, 3>, 2> colours = {};
  const double contrast = draws.between(0, 0.8);
  for (std::size_t c = 0; c < 3; ++c) {
    colours[0][c] = draws.between(0.2, 0.8);
    colours[1][c] = colours[0][c] * (1 - contrast * draws.between(0.5, 1));
  }
  const int pattern = draws.below(3);
  const double period = draws.of_ratio(8, 60);
  const Image<float> clouds = waves(albedo.size(), 4, period, 2 * period, draws);
  const double grain = draws.between(0, 0.05);
  for (int y = 0; y < albedo.height(); ++y) {
    for (int x = 0; x < albedo.width(); ++x) {
      const bool stripe = std::sin(2 * kPi * x / period) > 0, bar = std::sin(2 * kPi * y / period) > 0;
      const bool second = pattern == 0 ? stripe : pattern == 1 ? stripe != bar : clouds(x, y) > 0;
      const double own = std::max(0.2, 1 + grain * draws.normal());
      for (int c = 0; c < 3; ++c)
        albedo(x, y, c) = static_cast<float>(own * colours[second ? 1 : 0][static_cast<std::size_t>(c)]);
    }
  }
}

// Whether something stands between a pixel and a lamp.
bool is_shaded(const Image<float>& height, int x, int y, const Vec3& toward, double highest) {
  const double flat = std::hypot(toward.x, toward.y);
  if (flat < 1e-6) return false;
  const double rise = toward.z / flat, dx = toward.x / flat, down = -toward.y / flat;
  const double from = static_cast<double>(height(x, y));
  for (double s = 1.5; from + s * rise < highest; s += 1) {
    const int ax = static_cast<int>(std::lround(x + s * dx)),
              ay = static_cast<int>(std::lround(y + s * down));
    if (ax < 0 || ay < 0 || ax >= height.width() || ay >= height.height()) return false;
    if (static_cast<double>(height(ax, ay)) > from + s * rise) return true;
  }
  return false;
}

double highest_of(const Image<float>& height) {
  float highest = height(0, 0);
  for (int y = 0; y < height.height(); ++y)
    highest =
        std::max(highest, *std::max_element(height.plane().row(y), height.plane().row(y) + height.width()));
  return static_cast<double>(highest);
}

}  // namespace

double Draws::between(double least, double most) {
  const auto bits = simulator::philox({drawn_++, 0, 0, 0}, {seed_, 0x5a});
  return least + (most - least) * simulator::uniform(bits[0], bits[1]);
}

double Draws::of_ratio(double least, double most) {
  return least * std::pow(most / least, between(0, 1));
}

int Draws::below(int count) {
  return std::min(count - 1, static_cast<int>(between(0, count)));
}

double Draws::normal() {
  return simulator::normal_pair(simulator::philox({drawn_++, 0, 0, 0}, {seed_, 0x5a})).first;
}

DrawnCloth draw_cloth(Size size, Draws& draws) {
  DrawnCloth cloth;
  cloth.shape = static_cast<Shape>(draws.below(4));
  cloth.height_px = Image<float>(size);
  cloth.inside = Image<float>(size);
  cloth.albedo = Image<float>(size, 3);
  cloth.normal = Image<float>(size, 3);
  if (cloth.shape == Shape::kBall) {
    make_ball(cloth, draws);
  } else {
    make_cloth(cloth, draws);
  }
  paint(cloth.albedo, draws);
  if (draws.with(0.25)) {
    cloth.shine = draws.between(0.05, 0.4);
    cloth.hardness = draws.of_ratio(8, 60);
  }
  return cloth;
}

Image<float> seen(const DrawnCloth& cloth, const DrawnLight& light) {
  const Size size = cloth.albedo.size();
  Image<float> image(size, 3);
  const double highest = highest_of(cloth.height_px);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (cloth.inside(x, y) == 0) continue;
      const Vec3 normal = {cloth.normal(x, y, 0), cloth.normal(x, y, 1), cloth.normal(x, y, 2)};
      Vec3 toward = light.direction;
      double strength = light.strength;
      if (light.distance_px > 0) {
        const Vec3 way = light.distance_px * light.direction -
                         Vec3{x - 0.5 * size.width, 0.5 * size.height - y, cloth.height_px(x, y)};
        toward = normalized(way);
        strength *= std::pow(light.distance_px / length(way), 2);
      }
      const double facing = dot(normal, toward);
      const bool is_lit = facing > 0 && !is_shaded(cloth.height_px, x, y, toward, highest);
      const double mirrored = (2 * facing * normal - toward).z;
      const double lobe = is_lit && mirrored > 0 ? cloth.shine * std::pow(mirrored, cloth.hardness) : 0;
      const double diffuse = (is_lit ? strength * facing : 0) + light.room * 0.5 * (1 + normal.z);
      for (int c = 0; c < 3; ++c)
        image(x, y, c) =
            static_cast<float>(static_cast<double>(cloth.albedo(x, y, c)) * diffuse + strength * lobe);
    }
  }
  return image;
}

}  // namespace weft::bench
