// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/base/vec.h"
#include "material/surface.h"
#include "material/vec2.h"

// Woven cloths whose heights and slopes have a closed form, for tests.

namespace weft::material {

/// Over how many yarns a warp yarn lies, then under how many, and by how many the next one is shifted.
struct Binding {
  const char* name;
  int over, under, step;
  bool turns = false;  ///< every other warp yarn lies under what it would lie over
  int together = 1;    ///< yarns that lie beside each other alike, of warp and weft
  int period() const { return over + under; }
  /// Crossings of the smallest repeat.
  int crossings() const { return (turns ? 2 : 1) * period() * together * together; }
};
inline constexpr Binding kPlain = {"plain", 1, 1, 1}, kTwill = {"twill 2/2", 2, 2, 1},
                         kTwill31 = {"twill 3/1", 3, 1, 1}, kSatin5 = {"satin 5", 4, 1, 2},
                         kSatin8 = {"satin 8", 7, 1, 3}, kRib22 = {"rib 2/2", 2, 2, 2},
                         kRib21 = {"rib 2/1", 2, 1, 0, true}, kBasket = {"basket 2/2", 1, 1, 1, false, 2};

struct WeaveSettings {
  Binding binding = kPlain;
  double pitch_x_px = 12, pitch_y_px = 12;
  double turn_deg = 0;    ///< of the warp's normal from x, counterclockwise
  double skew_deg = 0;    ///< how much farther the weft's normal is turned
  double wander = 0;      ///< sideways shift of each yarn, standard deviation in pitches
  double noise_deg = 0;   ///< of the normals
  double tone = 0.08;     ///< standard deviation of the yarns' albedo, relative
  int stripe_yarns = 0;   ///< warp yarns of one tone, then as many of another; 0: none
  int stripe_other = 0;   ///< yarns of the other tone; 0: as many
  bool is_check = false;  ///< the weft is striped likewise
  Vec2 print_px = {};     ///< repeat of dots that are printed, along the frame; 0: none
  double twist = 0;       ///< height of the ridges that two plies make, in pitches
  double warp_px = 0;     ///< how far the cloth is pulled, largest of each axis
  double bow_px = 0;      ///< sagitta of the weft over the frame's width
  double crimp = 0.08;    ///< height of a yarn's wave in pitches
  double flank_deg = 36;  ///< of a yarn's section at its edge
  double mm_per_pixel = 0.04;
  unsigned seed = 1;
};

/// A cloth before it lies in pixels.
class Weave {
 public:
  explicit Weave(const WeaveSettings& settings) : settings_(settings) {
    std::mt19937 random(settings.seed);
    std::normal_distribution<double> normal;
    for (auto* each : {&shift_x_, &shift_y_, &tone_x_, &tone_y_}) {
      each->resize(4096);
      for (double& value : *each) value = normal(random);
    }
  }

  struct Point {
    double z = 0;           ///< pixels
    double dx = 0, dy = 0;  ///< of z, along x and up
    double albedo = 0;
  };

  /// Where the cloth's point lies that is seen at `at`, and how that changes with x and with y.
  struct Place {
    Vec2 at, by_x, by_y;
  };
  Place place(Vec2 at, Size size) const {
    const double u = at.x / size.width, v = at.y / size.height, t = 2 * kPi;
    const double pull = settings_.warp_px, bow = settings_.bow_px;
    const double c = std::cos(radians(settings_.turn_deg)), sine = std::sin(radians(settings_.turn_deg));
    const double weft_deg = settings_.turn_deg + settings_.skew_deg;
    const double weft_c = std::cos(radians(weft_deg)), weft_s = std::sin(radians(weft_deg));
    // Even along both axes, so that pulling neither turns nor stretches the cloth as a whole.
    const double wave = std::cos(t * u) * std::cos(t * v), along = -t * std::sin(t * u) * std::cos(t * v),
                 up = -t * std::cos(t * u) * std::sin(t * v);
    const Vec2 pulled = {at.x + pull * wave, at.y - pull * wave + 4 * bow * u * u};
    const Vec2 by_x = {1 + pull * along / size.width, (-pull * along + 8 * bow * u) / size.width};
    const Vec2 by_y = {pull * up / size.height, 1 - pull * up / size.height};
    const auto turned = [&](Vec2 a) { return Vec2{c * a.x + sine * a.y, weft_c * a.y - weft_s * a.x}; };
    return {turned(pulled), turned(by_x), turned(by_y)};
  }

  /// The highest of the two warp and two weft yarns that may lie on top, in the cloth's own axes.
  Point top(Vec2 at) const {
    const Near warp = near(at.x, settings_.pitch_x_px, shift_x_),
               weft = near(at.y, settings_.pitch_y_px, shift_y_);
    Point best;
    best.z = -1e9;
    for (std::size_t k = 0; k < 2; ++k) {
      const Section across_warp = section(warp.off[k], settings_.pitch_x_px);
      const Section wave = along(side(warp.yarn[k], weft.yarn[0]), side(warp.yarn[k], weft.yarn[1]),
                                 weft.off[0], settings_.pitch_y_px);
      if (across_warp.z + wave.z > best.z)
        best = plied(
            {across_warp.z + wave.z, across_warp.slope, wave.slope, albedo(tone_x_, warp.yarn[k], true)},
            {warp.off[k], weft.off[0]}, 1);
      const Section across_weft = section(weft.off[k], settings_.pitch_y_px);
      const Section rise = along(-side(warp.yarn[0], weft.yarn[k]), -side(warp.yarn[1], weft.yarn[k]),
                                 warp.off[0], settings_.pitch_x_px);
      if (across_weft.z + rise.z > best.z)
        best = plied(
            {across_weft.z + rise.z, rise.slope, across_weft.slope, albedo(tone_y_, weft.yarn[k], false)},
            {warp.off[0], weft.off[k]}, -1);
    }
    return best;
  }

  /// What is seen at `at` pixels from the centre of a frame of this size, y up.
  Point seen(Vec2 at, Size size) const {
    const Place here = place(at, size);
    Point point = top(here.at);
    const double dx = point.dx, dy = point.dy;
    point.dx = dx * here.by_x.x + dy * here.by_x.y;
    point.dy = dx * here.by_y.x + dy * here.by_y.y;
    if (is_printed(at)) point.albedo *= 0.4;
    return point;
  }

 private:
  struct Near {
    std::array<int, 2> yarn;
    std::array<double, 2> off;
  };
  struct Section {
    double z, slope;
  };

  static std::size_t index(int yarn) { return static_cast<std::size_t>(yarn + 2048) % 4096; }
  Near near(double at, double pitch, const std::vector<double>& shift) const {
    const int yarn = static_cast<int>(std::floor(at / pitch));
    const auto off = [&](int i) { return at - (i + 0.5 + settings_.wander * shift[index(i)]) * pitch; };
    const int next = off(yarn) < 0 ? yarn - 1 : yarn + 1;
    return {{yarn, next}, {off(yarn), off(next)}};
  }
  static int floored(int a, int n) { return (a - (a % n + n) % n) / n; }
  double side(int warp, int weft) const {
    const Binding& b = settings_.binding;
    const int i = floored(warp, b.together), j = floored(weft, b.together);
    const int place = ((j - b.step * i) % b.period() + b.period()) % b.period();
    return (place < b.over) == (b.turns && i % 2 != 0) ? -1 : 1;
  }
  // Two ridges from crossing to crossing, at half a right angle to the yarn.
  Point plied(Point point, Vec2 off, double turn) const {
    if (settings_.twist == 0) return point;
    const double height = settings_.twist * (settings_.pitch_x_px + settings_.pitch_y_px) / 2,
                 kx = 4 * kPi / settings_.pitch_x_px, ky = turn * 4 * kPi / settings_.pitch_y_px;
    const double phase = kx * off.x + ky * off.y;
    point.z += height * std::sin(phase);
    point.dx += height * kx * std::cos(phase);
    point.dy += height * ky * std::cos(phase);
    return point;
  }
  // Two dots of different size in each repeat.
  bool is_printed(Vec2 at) const {
    const Vec2 repeat = settings_.print_px;
    if (repeat.x == 0) return false;
    const auto is_within = [&](double x, double y, double radius) {
      return std::hypot(std::remainder(at.x / repeat.x - x, 1.0), std::remainder(at.y / repeat.y - y, 1.0)) <
             radius;
    };
    return is_within(0, 0, 0.26) || is_within(0.45, 0.3, 0.14);
  }
  Section section(double off, double pitch) const {
    const double flank = radians(settings_.flank_deg), radius = pitch / 2 / std::sin(flank);
    const double within = std::clamp(off, -pitch / 2, pitch / 2),
                 root = std::sqrt(radius * radius - within * within);
    const double beyond = std::abs(off) - std::abs(within);
    return {root - radius - std::tan(flank) * beyond, -within / root};
  }
  Section along(double from, double to, double off, double pitch) const {
    const double height = settings_.crimp * (settings_.pitch_x_px + settings_.pitch_y_px) / 2;
    const double t = std::min(std::abs(off) / pitch, 1.0), sign = off < 0 ? -1 : 1;
    return {height * (from + (to - from) * t * t * (3 - 2 * t)),
            t < 1 ? height * (to - from) * 6 * t * (1 - t) / pitch * sign : 0};
  }
  double albedo(const std::vector<double>& tones, int yarn, bool is_warp) const {
    const int one = settings_.stripe_yarns, other = settings_.stripe_other > 0 ? settings_.stripe_other : one;
    double value = 0.3 * std::max(0.1, 1 + settings_.tone * tones[index(yarn)]);
    if (one > 0 && (is_warp || settings_.is_check) &&
        ((yarn % (one + other)) + one + other) % (one + other) >= one)
      value *= 0.5;
    return value;
  }

  WeaveSettings settings_;
  std::vector<double> shift_x_, shift_y_, tone_x_, tone_y_;
};

/// The maps of a weave as a camera far above sees them, its centre at the frame's.
inline Surface weave_surface(const WeaveSettings& settings, Size size) {
  const Weave weave(settings);
  Surface surface;
  surface.mm_per_pixel = settings.mm_per_pixel;
  surface.slope = Image<float>(size, 2);
  surface.albedo = Image<float>(size, 3);
  surface.sigma_deg = Image<float>(size);
  surface.status = Image<std::uint16_t>(size);
  std::mt19937 random(settings.seed + 1000);
  std::normal_distribution<double> normal(0, radians(settings.noise_deg) / std::sqrt(2.0));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto point = weave.seen({x - (size.width - 1) / 2.0, (size.height - 1) / 2.0 - y}, size);
      surface.slope(x, y, 0) = static_cast<float>(point.dx + normal(random));
      surface.slope(x, y, 1) = static_cast<float>(point.dy + normal(random));
      for (int c = 0; c < 3; ++c) surface.albedo(x, y, c) = static_cast<float>(point.albedo);
      surface.sigma_deg(x, y) = 0.5F;
    }
  }
  return surface;
}

}  // namespace weft::material
