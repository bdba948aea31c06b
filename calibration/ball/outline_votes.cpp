// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "calibration/ball/outline.h"
#include "core/base/statistics.h"
#include "core/base/vec.h"

namespace weft::calibration {
namespace {

constexpr int kLongestSide = 480;  // votes are counted in pictures this small
constexpr double kBand = 1.25;     // the greatest radius of a band over its least
constexpr std::size_t kMostCircles = 40;
constexpr std::size_t kPeaksOfBand = 6;

/// A pixel where a picture is steeper than its neighbours along the slope.
struct SteepPixel {
  float x, y, along_x, along_y;
};

Image<float> shrunken(View<const float> picture, int by) {
  Image<float> small(Size{picture.width() / by, picture.height() / by});
  for (int y = 0; y < small.height(); ++y) {
    for (int x = 0; x < small.width(); ++x) {
      float sum = 0;
      for (int j = 0; j < by; ++j) {
        for (int i = 0; i < by; ++i) sum += picture(x * by + i, y * by + j);
      }
      small(x, y) = sum / static_cast<float>(by * by);
    }
  }
  return small;
}

/// So that dark edges count.
void take_roots(Image<float>& picture) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) picture(x, y) = std::sqrt(picture(x, y));
  }
}

/// (1 4 6 4 1) / 16 along rows and columns.
Image<float> smooth(const Image<float>& picture) {
  const auto pass = [](const Image<float>& in, int dx, int dy) {
    Image<float> out(in.size());
    constexpr float kWeights[] = {1.0F / 16, 4.0F / 16, 6.0F / 16, 4.0F / 16, 1.0F / 16};
    for (int y = 0; y < in.height(); ++y) {
      for (int x = 0; x < in.width(); ++x) {
        float sum = 0;
        for (int k = -2; k <= 2; ++k)
          sum += kWeights[k + 2] *
                 in(std::clamp(x + k * dx, 0, in.width() - 1), std::clamp(y + k * dy, 0, in.height() - 1));
        out(x, y) = sum;
      }
    }
    return out;
  };
  return pass(pass(picture, 1, 0), 0, 1);
}

void add_steep_pixels(const Image<float>& picture, std::vector<SteepPixel>& steep) {
  const Image<float> p = smooth(smooth(picture));
  Image<float> slope(p.size());
  std::vector<float> slopes;
  for (int y = 1; y + 1 < p.height(); ++y) {
    for (int x = 1; x + 1 < p.width(); ++x) {
      slope(x, y) = std::hypot(p(x + 1, y) - p(x - 1, y), p(x, y + 1) - p(x, y - 1));
      slopes.push_back(slope(x, y));
    }
  }
  const float least = std::max(quantile(slopes, 0.7), 1e-6F);
  for (int y = 2; y + 2 < p.height(); ++y) {
    for (int x = 2; x + 2 < p.width(); ++x) {
      const float s = slope(x, y);
      if (s <= least) continue;
      const float gx = (p(x + 1, y) - p(x - 1, y)) / s, gy = (p(x, y + 1) - p(x, y - 1)) / s;
      const int sx = static_cast<int>(std::lround(gx)), sy = static_cast<int>(std::lround(gy));
      if (slope(x + sx, y + sy) > s || slope(x - sx, y - sy) > s) continue;
      steep.push_back({static_cast<float>(x), static_cast<float>(y), gx, gy});
    }
  }
}

/// Votes for centres of circles whose radius is in one band: a whole circle has about 1.
Image<float> votes_of(const std::vector<SteepPixel>& steep, Size size, double least, double most) {
  Image<float> votes(size);
  const float weight = static_cast<float>(1 / (2 * kPi * 0.5 * (least + most)));
  for (const SteepPixel& pixel : steep) {
    for (const float side : {-1.0F, 1.0F}) {
      for (double r = least; r < most; r += 1) {
        const int x = static_cast<int>(std::lround(pixel.x + side * r * pixel.along_x));
        const int y = static_cast<int>(std::lround(pixel.y + side * r * pixel.along_y));
        if (x >= 0 && y >= 0 && x < size.width && y < size.height) votes(x, y) += weight;
      }
    }
  }
  return smooth(votes);
}

/// The radius in a band on which most slopes point to or from a centre, and its share of the circle.
Circle with_radius(const std::vector<SteepPixel>& steep, double x, double y, double least, double most,
                   double& share) {
  std::vector<double> counts(static_cast<std::size_t>(most) + 3);
  for (const SteepPixel& p : steep) {
    const double dx = p.x - x, dy = p.y - y, d = std::hypot(dx, dy);
    if (d < least || d > most || std::abs(dx * p.along_x + dy * p.along_y) < 0.94 * d) continue;
    counts[static_cast<std::size_t>(std::lround(d))] += 1 / (2 * kPi * d);
  }
  Circle best = {x, y, least};
  share = 0;
  for (std::size_t r = 1; r + 1 < counts.size(); ++r) {
    const double here = counts[r - 1] + counts[r] + counts[r + 1];
    if (here <= share) continue;
    share = here;
    best.radius = static_cast<double>(r);
  }
  return best;
}

struct Voted {
  Circle circle;
  double share;
};

void add_peaks(Image<float>& votes, const std::vector<SteepPixel>& steep, double least, double most,
               std::vector<Voted>& all) {
  for (std::size_t n = 0; n < kPeaksOfBand; ++n) {
    int px = 0, py = 0;
    for (int y = 0; y < votes.height(); ++y) {
      for (int x = 0; x < votes.width(); ++x) {
        if (votes(x, y) > votes(px, py)) px = x, py = y;
      }
    }
    if (!(votes(px, py) > 0)) return;
    Voted voted = {};
    voted.circle = with_radius(steep, px, py, least, most, voted.share);
    all.push_back(voted);
    const int clear = std::max(3, static_cast<int>(0.2 * least));
    for (int y = std::max(0, py - clear); y <= std::min(votes.height() - 1, py + clear); ++y) {
      for (int x = std::max(0, px - clear); x <= std::min(votes.width() - 1, px + clear); ++x)
        votes(x, y) = 0;
    }
  }
}

}  // namespace

std::vector<Circle> voted_circles(const SharedPictures& shared) {
  const Size size = shared.mean.size();
  const int by = std::max(1, (std::max(size.width, size.height) + kLongestSide - 1) / kLongestSide);
  std::vector<SteepPixel> steep;
  for (const Image<float>* picture : {&shared.greatest, &shared.mean}) {
    Image<float> small = shrunken(picture->plane(), by);
    take_roots(small);
    add_steep_pixels(small, steep);
  }
  const Size small = {size.width / by, size.height / by};
  const double shorter = std::min(small.width, small.height);
  std::vector<Voted> all;
  for (double least = std::max(8.0 / by, shorter / 30); least < 0.6 * shorter; least *= kBand) {
    const double most = std::min(least * kBand, 0.6 * shorter) + 1;
    Image<float> votes = votes_of(steep, small, least, most);
    add_peaks(votes, steep, least, most, all);
  }
  std::ranges::sort(all, std::greater(), &Voted::share);
  std::vector<Circle> circles;
  for (const Voted& voted : all) {
    const Circle c = {voted.circle.x * by + (by - 1) / 2.0, voted.circle.y * by + (by - 1) / 2.0,
                      voted.circle.radius * by};
    const bool known = std::ranges::any_of(circles, [&](const Circle& other) {
      return std::hypot(c.x - other.x, c.y - other.y) < 0.1 * c.radius &&
             std::abs(c.radius - other.radius) < 0.1 * c.radius;
    });
    if (!known) circles.push_back(c);
    if (circles.size() == kMostCircles) break;
  }
  return circles;
}

}  // namespace weft::calibration
