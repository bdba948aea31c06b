// SPDX-License-Identifier: Apache-2.0
#include "calibration/ball/ball_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/ball/lamp_rays.h"

namespace weft::calibration {
namespace {

constexpr double kReach = 0.12;  // of the radius: an outline is this near to what votes say
constexpr double kMirrorQuality = 0.6;
constexpr double kMattQuality = 0.85;
constexpr double kLeastTravel = 0.05;  // of the radius, of highlights from shot to shot
constexpr double kLeastOfBest = 0.4;   // of the best ball's score: a second one
constexpr double kMostApart_deg = 25;  // what two balls say of one lamp
constexpr double kGlass = 0.04;        // what a glossy ball mirrors at right angles
constexpr double kMoved_px = 1.5, kMovedShare = 0.02, kMovedScatters = 6;

Error no_lights(std::string where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "lights cannot be told from a ball", std::move(where), std::move(why),
          std::move(remedy)};
}

/// A circle that may be a ball.
struct Candidate {
  FoundBall ball;
  double score = 0;
};

double travel_of(const std::vector<LampOnBall>& lamps) {
  double most = 0;
  for (const LampOnBall& a : lamps) {
    for (const LampOnBall& b : lamps) {
      if (a.found && b.found) most = std::max(most, std::hypot(a.x - b.x, a.y - b.y));
    }
  }
  return most;
}

/// The ball within an outline, of the kind that is told or that suits its shots.
Candidate read_ball(const BallPhotographs& photographs, const SharedPictures& shared, const Outline& outline,
                    const BallOptions& options) {
  const Size size = photographs.shots.front().size();
  const double focal_px = options.fov_deg > 0 ? size.width / (2 * std::tan(radians(options.fov_deg) / 2)) : 0;
  const BallView view(outline, size, focal_px);
  Candidate candidate;
  candidate.ball.outline = outline;
  candidate.ball.centre_mm = options.ball_mm > 0 ? view.centre_mm(options.ball_mm / 2) : Vec3{};
  BallReading mirror, matt;
  const auto kind = options.kind;
  if (kind != BallKind::kMatt) {
    mirror = read_mirror_ball(photographs.shots, shared.median, view, outline.sigma_px,
                              kind == BallKind::kGlossy ? kGlass : 1);
    if (photographs.shots.size() > 1 && travel_of(mirror.lamps) < kLeastTravel * outline.circle.radius)
      mirror.quality = 0;
  }
  if (!kind || kind == BallKind::kMatt) matt = read_matt_ball(photographs.shots, view, outline.sigma_px);
  const bool mirrors = mirror.quality >= kMirrorQuality && mirror.quality >= matt.quality - 0.1;
  candidate.ball.kind = kind.value_or(mirrors ? BallKind::kMirror : BallKind::kMatt);
  const bool is_matt = candidate.ball.kind == BallKind::kMatt;
  BallReading& reading = is_matt ? matt : mirror;
  candidate.ball.lamps = std::move(reading.lamps);
  const bool suits = reading.quality >= (is_matt ? kMattQuality : kMirrorQuality);
  candidate.score = suits ? outline.support * reading.quality : 0;
  return candidate;
}

bool overlap(const Circle& a, const Circle& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < 0.9 * (a.radius + b.radius);
}

/// Mean over the shots that both show; 180 where there is none.
double angle_between(const FoundBall& a, const FoundBall& b) {
  double sum = 0;
  int shots = 0;
  for (std::size_t k = 0; k < a.lamps.size(); ++k) {
    if (!a.lamps[k].found || !b.lamps[k].found) continue;
    sum += angle_deg(a.lamps[k].direction, b.lamps[k].direction);
    ++shots;
  }
  return shots > 0 ? sum / shots : 180;
}

std::vector<FoundBall> looked_for(const BallPhotographs& photographs, const SharedPictures& shared,
                                  const BallOptions& options) {
  std::vector<Candidate> candidates;
  for (const Circle& circle : voted_circles(shared)) {
    const std::optional<Outline> outline = fitted_outline(shared, circle, kReach);
    if (!outline) continue;
    const bool known = std::ranges::any_of(candidates, [&](const Candidate& other) {
      const Circle &a = outline->circle, &b = other.ball.outline.circle;
      return std::hypot(a.x - b.x, a.y - b.y) + std::abs(a.radius - b.radius) < 1;
    });
    if (known) continue;
    candidates.push_back(read_ball(photographs, shared, *outline, options));
  }
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::score);
  std::vector<FoundBall> balls;
  for (Candidate& candidate : candidates) {
    if (!(candidate.score > kLeastOfBest * candidates.front().score) || !(candidate.score > 0)) break;
    const bool fits = std::ranges::all_of(balls, [&](const FoundBall& ball) {
      return !overlap(ball.outline.circle, candidate.ball.outline.circle) &&
             angle_between(ball, candidate.ball) < kMostApart_deg;
    });
    if (fits) balls.push_back(std::move(candidate.ball));
  }
  return balls;
}

std::vector<FoundBall> told_balls(const BallPhotographs& photographs, const SharedPictures& shared,
                                  const BallOptions& options) {
  std::vector<FoundBall> balls;
  for (const Circle& told : options.told) {
    std::optional<Outline> outline = fitted_outline(shared, told, kReach);
    const bool as_told = !outline;
    if (as_told) outline = Outline{told, 1, 0, {}};
    balls.push_back(read_ball(photographs, shared, *outline, options).ball);
    balls.back().as_told = as_told;
  }
  return balls;
}

std::string place_of(const Circle& c) {
  return fmt::format("a ball at {:.0f}, {:.0f} with a radius of {:.0f} pixels", c.x, c.y, c.radius);
}

Result<void> check_place(const FoundBall& ball, Size size) {
  const Circle& c = ball.outline.circle;
  if (c.x - c.radius > -0.5 && c.y - c.radius > -0.5 && c.x + c.radius < size.width - 0.5 &&
      c.y + c.radius < size.height - 0.5)
    return {};
  return no_lights(place_of(c), "the border of the picture cuts it",
                   "photograph the whole ball, or name another with --ball X,Y,R");
}

Result<void> check_still(const FoundBall& ball, const BallPhotographs& photographs) {
  const Circle& c = ball.outline.circle;
  for (std::size_t k = 0; k < photographs.shots.size(); ++k) {
    const std::optional<OutlineShift> shift = outline_shift(photographs.shots[k], c);
    if (!shift) continue;
    const double moved = std::hypot(shift->x, shift->y);
    if (moved < std::max({kMoved_px, kMovedShare * c.radius, kMovedScatters * shift->scatter_px})) continue;
    return no_lights(
        photographs.names[k],
        fmt::format("{} has moved by {:.1f} pixels against the other photographs", place_of(c), moved),
        "take the photographs again with the ball fixed, or leave out those where it lies "
        "elsewhere");
  }
  return {};
}

Result<void> check_lamps(const std::vector<FoundBall>& balls, const BallPhotographs& photographs) {
  for (std::size_t k = 0; k < photographs.shots.size(); ++k) {
    for (const FoundBall& ball : balls) {
      if (ball.lamps[k].is_double)
        return no_lights(
            photographs.names[k],
            fmt::format("{} has two highlights: two lamps are lit", place_of(ball.outline.circle)),
            "light one lamp a photograph; cover windows and screens");
    }
    if (std::ranges::any_of(balls, [&](const FoundBall& ball) { return ball.lamps[k].found; })) continue;
    const bool matt = balls.front().kind == BallKind::kMatt;
    return no_lights(photographs.names[k],
                     matt ? "no ball has the shading of one lamp: it is unlit, too low, or in a shadow"
                          : "no ball has a highlight: the lamp is unlit, behind the ball, or hidden",
                     "leave this photograph out, or raise its lamp");
  }
  return {};
}

/// What a lamp gives in the middle of the picture over what it gives a ball.
double fall_off(const FoundLamp& lamp, const Vec3& ball_mm) {
  if (!lamp.position_mm) return 1;
  return std::pow(length(*lamp.position_mm - ball_mm) / length(*lamp.position_mm), 2);
}

/// Their strengths by the first ball that tells all of them.
void add_strengths(const std::vector<Vec3>& centres_mm, BallLights& lights) {
  for (std::size_t b = 0; b < lights.balls.size(); ++b) {
    const FoundBall& ball = lights.balls[b];
    if (ball.kind == BallKind::kMirror) continue;
    if (!std::ranges::all_of(ball.lamps, [](const LampOnBall& lamp) { return lamp.found && !lamp.clipped; }))
      continue;
    double sum = 0;
    for (std::size_t k = 0; k < ball.lamps.size(); ++k) {
      const double there = fall_off(lights.lamps[k], centres_mm[b]);
      lights.lamps[k].strength = there * ball.lamps[k].strength;
      lights.lamps[k].strength_sigma = there * ball.lamps[k].strength_sigma;
      sum += *lights.lamps[k].strength;
    }
    const double mean = sum / static_cast<double>(ball.lamps.size());
    for (FoundLamp& lamp : lights.lamps) {
      *lamp.strength /= mean;
      lamp.strength_sigma /= mean;
    }
    return;
  }
}

/// Balls' centres about the middle of the picture at their own height.
std::vector<Vec3> centres_on_table(const std::vector<FoundBall>& balls) {
  double height = 0;
  for (const FoundBall& ball : balls) height += ball.centre_mm.z / static_cast<double>(balls.size());
  std::vector<Vec3> centres;
  for (const FoundBall& ball : balls) centres.push_back(ball.centre_mm - Vec3{0, 0, height});
  return centres;
}

FoundLamp lamp_by(const std::vector<FoundBall>& balls, std::size_t k, const std::vector<Vec3>& centres_mm,
                  double radius_mm) {
  FoundLamp lamp;
  Vec3 sum = {};
  double weights = 0;
  std::vector<LampRay> rays;
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const LampOnBall& seen = balls[b].lamps[k];
    if (!seen.found) continue;
    const double weight = 1 / (seen.sigma_deg * seen.sigma_deg);
    sum = sum + weight * seen.direction;
    weights += weight;
    if (radius_mm > 0)
      rays.push_back({centres_mm[b] + radius_mm * seen.from, seen.direction, seen.sigma_deg});
  }
  lamp.direction = normalized(sum);
  lamp.sigma_deg = 1 / std::sqrt(weights);
  const std::optional<LampPlace> place = meeting_of(rays);
  if (!place) return lamp;
  lamp.position_mm = place->position_mm;
  lamp.position_sigma_mm = place->sigma_mm;
  lamp.direction = normalized(place->position_mm);
  return lamp;
}

double angle_between_balls(const std::vector<FoundBall>& balls) {
  double sum = 0;
  for (std::size_t b = 1; b < balls.size(); ++b)
    sum += angle_between(balls[0], balls[b]) / static_cast<double>(balls.size() - 1);
  return sum;
}

}  // namespace

Result<BallLights> lights_of_balls(const BallPhotographs& photographs, const BallOptions& options) {
  const SharedPictures shared = shared_pictures(photographs.shots);
  BallLights lights;
  lights.balls = options.told.empty() ? looked_for(photographs, shared, options)
                                      : told_balls(photographs, shared, options);
  if (lights.balls.empty()) {
    return no_lights(fmt::format("{} photographs", photographs.shots.size()),
                     "no ball is seen: no round outline that all share holds one moving highlight, or the "
                     "shading of a matt ball",
                     "name it in pixels with --ball X,Y,R, its centre and radius");
  }
  for (const FoundBall& ball : lights.balls) {
    if (Result<void> ok = check_place(ball, photographs.shots.front().size()); !ok) return ok.error();
    if (Result<void> ok = check_still(ball, photographs); !ok) return ok.error();
  }
  if (Result<void> ok = check_lamps(lights.balls, photographs); !ok) return ok.error();
  const std::vector<Vec3> centres_mm = centres_on_table(lights.balls);
  for (std::size_t k = 0; k < photographs.shots.size(); ++k)
    lights.lamps.push_back(lamp_by(lights.balls, k, centres_mm, options.ball_mm / 2));
  add_strengths(centres_mm, lights);
  lights.apart_deg = angle_between_balls(lights.balls);
  return lights;
}

}  // namespace weft::calibration
