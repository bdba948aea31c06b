// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "calibration/ball/ball_shots.h"
#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr double kRimShare = 0.985;  // of the radius; beyond it the outline itself shines
constexpr double kSpotFrom = 0.5;    // of the brightest pixel
constexpr double kPlaceFrom = 0.15;  // its place is that of all that shines about it
constexpr double kMostSpot = 0.05;   // of the ball's disc
constexpr double kSecondFlux = 0.3;  // of the brightest spot's: another lamp
constexpr double kSecondPeak = 0.7;
constexpr double kLeastPeak = 0.1;     // of the median shot's
constexpr float kLeastValue = 0.004F;  // of full scale
constexpr double kLeastSpotSigma_px = 0.05;
constexpr double kClippedSpotSigma_px = 0.1;  // a pixel that shines in part is full all the same

/// What one shot has over the median of all, in the box of the ball.
struct Box {
  Rect rect;
  Image<float> over;
};

Box box_of(const Image<float>& shot, const Image<float>& median, const Circle& circle) {
  Box box;
  const double reach = kRimShare * circle.radius;
  box.rect = {std::max(0, static_cast<int>(std::ceil(circle.x - reach))),
              std::max(0, static_cast<int>(std::ceil(circle.y - reach))),
              std::min(shot.width(), static_cast<int>(std::floor(circle.x + reach)) + 1),
              std::min(shot.height(), static_cast<int>(std::floor(circle.y + reach)) + 1)};
  box.over = Image<float>(Size{box.rect.width(), box.rect.height()});
  for (int y = box.rect.y0; y < box.rect.y1; ++y) {
    for (int x = box.rect.x0; x < box.rect.x1; ++x) {
      if (std::hypot(x - circle.x, y - circle.y) > reach) continue;
      box.over(x - box.rect.x0, y - box.rect.y0) = std::max(0.0F, std::min(shot(x, y), 1.0F) - median(x, y));
    }
  }
  return box;
}

/// Connected pixels over a threshold.
struct Spot {
  double flux = 0, weight = 0, x = 0, y = 0, peak = 0;
  int pixels = 0;
};

std::vector<Spot> spots_over(const Image<float>& over, float least) {
  Image<std::uint8_t> seen(over.size());
  std::vector<Spot> spots;
  std::vector<std::array<int, 2>> open;
  for (int y = 0; y < over.height(); ++y) {
    for (int x = 0; x < over.width(); ++x) {
      if (seen(x, y) || over(x, y) < least) continue;
      Spot spot;
      seen(x, y) = 1;
      open.push_back({x, y});
      while (!open.empty()) {
        const auto [px, py] = open.back();
        open.pop_back();
        const double value = over(px, py);
        const double weight = value - 0.98 * least;  // rises from nothing, so that no pixel counts by chance
        spot.flux += value;
        spot.weight += weight;
        spot.x += weight * px;
        spot.y += weight * py;
        spot.peak = std::max(spot.peak, value);
        ++spot.pixels;
        for (int j = std::max(0, py - 1); j <= std::min(over.height() - 1, py + 1); ++j) {
          for (int i = std::max(0, px - 1); i <= std::min(over.width() - 1, px + 1); ++i) {
            if (seen(i, j) || over(i, j) < least) continue;
            seen(i, j) = 1;
            open.push_back({i, j});
          }
        }
      }
      spot.x /= spot.weight;
      spot.y /= spot.weight;
      spots.push_back(spot);
    }
  }
  std::ranges::sort(spots, std::greater(), &Spot::flux);
  return spots;
}

/// The spot that holds (x, y) or is nearest to it.
Spot nearest(const std::vector<Spot>& spots, const Spot& to) {
  return *std::ranges::min_element(spots, {},
                                   [&](const Spot& s) { return std::hypot(s.x - to.x, s.y - to.y); });
}

struct Highlight {
  Spot spot;
  double flux = 0;  ///< with its halo
  double sigma_px = 0;
  bool is_double = false, compact = false, clipped = false;
};

/// Light about a spot beyond its threshold, less what lies farther out.
double flux_about(const Image<float>& over, const Spot& spot) {
  const double radius = 2.5 * std::sqrt(spot.pixels / kPi) + 2;
  double sum = 0;
  int pixels = 0;
  std::vector<float> ring;
  for (int y = 0; y < over.height(); ++y) {
    for (int x = 0; x < over.width(); ++x) {
      const double d = std::hypot(x - spot.x, y - spot.y);
      if (d > 1.5 * radius) continue;
      if (d > radius) {
        ring.push_back(over(x, y));
        continue;
      }
      sum += over(x, y);
      ++pixels;
    }
  }
  return ring.empty() ? sum : sum - double{median(ring)} * pixels;
}

Highlight highlight_of(const Image<float>& over, double radius, float peak) {
  const std::vector<Spot> spots = spots_over(over, static_cast<float>(kSpotFrom) * peak);
  Highlight h;
  h.spot = spots.front();
  h.compact = h.spot.pixels < kMostSpot * kPi * radius * radius;
  h.clipped = h.spot.peak >= kClippedFrom - 0.1F;
  h.flux = flux_about(over, h.spot);
  // How far it moves with the threshold says how much its shape and glare leave open.
  const Spot low = nearest(spots_over(over, static_cast<float>(kPlaceFrom) * peak), h.spot);
  h.sigma_px = std::max(h.clipped ? kClippedSpotSigma_px : kLeastSpotSigma_px,
                        std::hypot(h.spot.x - low.x, h.spot.y - low.y) / 2);
  h.spot.x = low.x;
  h.spot.y = low.y;
  h.is_double = std::any_of(spots.begin() + 1, spots.end(), [&](const Spot& s) {
    return s.flux > kSecondFlux * h.spot.flux && s.peak > kSecondPeak * h.spot.peak &&
           std::hypot(s.x - h.spot.x, s.y - h.spot.y) > 0.08 * radius;
  });
  return h;
}

double schlick(double f0, double cosine) {
  return f0 + (1 - f0) * std::pow(1 - cosine, 5);
}

LampOnBall lamp_of(const Highlight& h, double x, double y, const BallView& view, double sigma_px, double f0) {
  LampOnBall lamp;
  lamp.x = x;
  lamp.y = y;
  const std::optional<BallPoint> point = view.at(x, y);
  if (!point) return lamp;
  lamp.found = true;
  const double facing = dot(point->normal, point->to_camera);
  lamp.from = point->normal;
  lamp.direction = normalized(2 * facing * point->normal - point->to_camera);
  // A pixel turns the normal by 1 / (radius facing) along the radius, and the lamp by twice that.
  lamp.sigma_deg =
      degrees(2 * std::hypot(h.sigma_px, sigma_px) / (view.circle().radius * std::max(facing, 0.05)));
  lamp.clipped = h.clipped;
  lamp.is_double = h.is_double;
  lamp.strength = h.flux / schlick(f0, facing);
  return lamp;
}

}  // namespace

BallReading read_mirror_ball(const std::vector<Image<float>>& shots, const Image<float>& median_picture,
                             const BallView& view, double sigma_px, double f0) {
  std::vector<Box> boxes;
  std::vector<float> peaks;
  for (const Image<float>& shot : shots) {
    boxes.push_back(box_of(shot, median_picture, view.circle()));
    float peak = 0;
    const Image<float>& over = boxes.back().over;
    for (int y = 0; y < over.height(); ++y)
      peak = std::max(peak, *std::max_element(over.plane().row(y), over.plane().row(y) + over.width()));
    peaks.push_back(peak);
  }
  const float least = std::max(kLeastValue, static_cast<float>(kLeastPeak) * median(peaks));
  BallReading reading;
  int compact = 0, lit = 0;
  for (std::size_t k = 0; k < shots.size(); ++k) {
    reading.lamps.emplace_back();
    if (peaks[k] < least) continue;
    ++lit;
    const Highlight h = highlight_of(boxes[k].over, view.circle().radius, peaks[k]);
    if (!h.compact) continue;
    ++compact;
    reading.lamps.back() =
        lamp_of(h, h.spot.x + boxes[k].rect.x0, h.spot.y + boxes[k].rect.y0, view, sigma_px, f0);
  }
  reading.quality = lit == 0 ? 0 : static_cast<double>(compact) / static_cast<double>(shots.size());
  return reading;
}

}  // namespace weft::calibration
