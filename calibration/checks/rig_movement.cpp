// SPDX-License-Identifier: Apache-2.0
#include "calibration/checks/rig_movement.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calibration/checks/light_at.h"
#include "calibration/checks/rig_state.h"
#include "calibration/lights/paper_model.h"
#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr int kMostSteps = 30;
constexpr double kSmallStep = 1e-6;  // in standard deviations

/// What happened, with the numbers of each change, one after the other.
struct Story {
  std::vector<RigChange> changes;
  Eigen::VectorXd numbers;
  Eigen::MatrixXd covariance;  ///< of the numbers
  double chi_square = std::numeric_limits<double>::infinity();
  double penalty = 0;  ///< BIC without chi-square

  /// BIC, less is better, where noise is `inflation` times in variance what it was taken to be.
  double criterion(double inflation) const { return chi_square / inflation + penalty; }
};

RigState state_of(const RigModel& model, const Story& story, const Eigen::VectorXd& numbers) {
  RigState state = model.calibrated();
  Eigen::Index first = 0;
  for (const RigChange& change : story.changes) {
    const int n = parameters_of(change.kind);
    state = changed(std::move(state), change, {numbers.data() + first, static_cast<std::size_t>(n)});
    first += n;
  }
  return state;
}

/// How many things of this kind might have happened, on a rig of so many LEDs.
double choices(ChangeKind kind, int leds) {
  switch (kind) {
    case ChangeKind::kLedMoved:
    case ChangeKind::kLedFaded:
      return leds;
    case ChangeKind::kLedsSwapped:
      return std::max(leds * (leds - 1) / 2, 1);
    default:
      return 1;
  }
}

/// Everything that might have happened once, beyond what did.
std::vector<RigChange> candidates(const Story& story, int leds) {
  std::vector<RigChange> all;
  const auto add = [&](ChangeKind kind, int led, int other) {
    const auto same = [&](const RigChange& c) {
      return c.kind == kind && c.led == led && c.other_led == other;
    };
    if (std::any_of(story.changes.begin(), story.changes.end(), same)) return;
    all.push_back({.kind = kind, .led = led, .other_led = other});
  };
  add(ChangeKind::kCamera, 0, 0);
  add(ChangeKind::kTable, 0, 0);
  add(ChangeKind::kAllFaded, 0, 0);
  for (int i = 1; i <= leds; ++i) {
    add(ChangeKind::kLedFaded, i, 0);
    add(ChangeKind::kLedMoved, i, 0);
    for (int j = i + 1; j <= leds; ++j) add(ChangeKind::kLedsSwapped, i, j);
  }
  return all;
}

/// Generalized least squares: everything divided by the Cholesky factor of the covariance of what is
/// measured.
class Judge {
 public:
  Judge(const RigModel& model, const RigState& order)
      : model_(model), measured_(model.measured()), factor_(model.covariance(order)) {}

  /// The best numbers for the changes, from `start`, by Gauss-Newton with halved steps.
  Story fitted(std::vector<RigChange> changes, const Eigen::VectorXd& start) const {
    Story story;
    story.changes = std::move(changes);
    int n = 0;
    for (const RigChange& change : story.changes) n += parameters_of(change.kind);
    story.numbers = Eigen::VectorXd::Zero(n);
    story.numbers.head(start.size()) = start;
    Eigen::VectorXd residual = whitened(story, story.numbers);
    double chi_square = residual.squaredNorm();
    if (!std::isfinite(chi_square)) return story;
    Eigen::MatrixXd slopes;
    for (int step = 0; n > 0 && step < kMostSteps; ++step) {
      slopes = jacobian(story);
      const Eigen::VectorXd full = slopes.colPivHouseholderQr().solve(residual);
      if (!full.allFinite()) break;
      bool better = false;
      for (double share = 1; share > 1e-3 && !better; share /= 2) {
        const Eigen::VectorXd there = story.numbers + share * full;
        const Eigen::VectorXd left = whitened(story, there);
        if (!(left.squaredNorm() < chi_square)) continue;
        better = true;
        story.numbers = there, residual = left, chi_square = left.squaredNorm();
      }
      if (!better || (slopes * full).norm() < kSmallStep) break;
    }
    story.chi_square = chi_square;
    story.penalty = n * std::log(model_.observations());
    for (const RigChange& change : story.changes)
      story.penalty += 2 * std::log(choices(change.kind, model_.leds()));
    if (n > 0) {
      slopes = jacobian(story);
      story.covariance = (slopes.transpose() * slopes).completeOrthogonalDecomposition().pseudoInverse();
    }
    return story;
  }

 private:
  Eigen::VectorXd whitened(const Story& story, const Eigen::VectorXd& numbers) const {
    return factor_.matrixL().solve(measured_ - model_.predicted(state_of(model_, story, numbers)));
  }
  /// How what is predicted changes with the numbers, divided by the same factor.
  Eigen::MatrixXd jacobian(const Story& story) const {
    constexpr double kStep = 1e-6;
    Eigen::MatrixXd slopes(model_.observations(), story.numbers.size());
    for (Eigen::Index p = 0; p < story.numbers.size(); ++p) {
      Eigen::VectorXd up = story.numbers, down = story.numbers;
      up[p] += kStep, down[p] -= kStep;
      slopes.col(p) =
          (model_.predicted(state_of(model_, story, up)) - model_.predicted(state_of(model_, story, down))) /
          (2 * kStep);
    }
    factor_.matrixL().solveInPlace(slopes);
    return slopes;
  }

  const RigModel& model_;
  Eigen::VectorXd measured_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// Tells a story on by the change that explains most; nothing where none explains enough.
std::optional<Story> told_on(const RigModel& model, const Judge& judge, const Story& so_far,
                             double least_evidence) {
  std::vector<Story> all;
  for (const RigChange& next : candidates(so_far, model.leds())) {
    // A swap has no numbers: it stands at the end or at the start alike.
    std::vector<RigChange> changes = so_far.changes;
    changes.push_back(next);
    Story story = judge.fitted(std::move(changes), so_far.numbers);
    if (next.kind == ChangeKind::kLedsSwapped && story.chi_square < so_far.chi_square) {
      // What is unknown of a LED goes with it.
      story = Judge(model, state_of(model, story, story.numbers)).fitted(story.changes, so_far.numbers);
    }
    all.push_back(std::move(story));
  }
  // What no change explains is taken for noise: it must not make small changes look certain (Lebreton et al.,
  // Ecological Monographs 1992, the variance inflation factor).
  double least = so_far.chi_square;
  for (const Story& story : all) least = std::min(least, story.chi_square);
  const double inflation = std::max(least / model.observations(), 1.0);
  std::stable_sort(all.begin(), all.end(), [&](const Story& a, const Story& b) {
    return a.criterion(inflation) < b.criterion(inflation);
  });
  const double before = so_far.criterion(inflation);
  if (all.empty() || !(all.front().criterion(inflation) < before - least_evidence)) return std::nullopt;
  Story best = all.front();
  RigChange& found = best.changes.back();
  found.evidence = before - best.criterion(inflation);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double criterion = all[i].criterion(inflation);
    if (criterion < best.criterion(inflation) + least_evidence && criterion < before - least_evidence)
      found.alternatives.push_back(all[i].changes.back());
  }
  return best;
}

void put_numbers(Story& story) {
  Eigen::Index i = 0;
  const auto three = [&](double scale) {
    const Vec3 value = {scale * story.numbers[i], scale * story.numbers[i + 1], scale * story.numbers[i + 2]};
    const auto sigma = [&](Eigen::Index j) {
      return scale * std::sqrt(std::max(story.covariance(j, j), 0.0));
    };
    const Vec3 sigmas = {sigma(i), sigma(i + 1), sigma(i + 2)};
    i += 3;
    return std::pair{value, sigmas};
  };
  for (RigChange& change : story.changes) {
    const int n = parameters_of(change.kind);
    if (n == 6) std::tie(change.turn_deg, change.turn_sigma_deg) = three(degrees(1));
    if (n >= 3) std::tie(change.shift_mm, change.shift_sigma_mm) = three(1);
    if (n != 1) continue;
    change.factor = std::exp(story.numbers[i]);
    change.factor_sigma = change.factor * std::sqrt(std::max(story.covariance(i, i), 0.0));
    ++i;
  }
}

/// The covariance of the LEDs' parameters among the numbers.
ParameterCovariance covariance_of_leds(const Story& story) {
  ParameterCovariance out;
  std::vector<Eigen::Index> kept;
  Eigen::Index i = 0;
  for (const RigChange& change : story.changes) {
    const int n = parameters_of(change.kind);
    const std::string led = fmt::format("led{:02}.", change.led);
    if (change.kind == ChangeKind::kLedMoved)
      for (const char* axis : {"x", "y", "z"}) out.parameters.push_back(led + "position_mm." + axis);
    if (change.kind == ChangeKind::kLedFaded) out.parameters.push_back(led + "log_flux");
    for (int j = 0; j < n; ++j, ++i) {
      if (change.kind == ChangeKind::kLedMoved || change.kind == ChangeKind::kLedFaded) kept.push_back(i);
    }
  }
  for (const Eigen::Index a : kept) {
    for (const Eigen::Index b : kept) out.matrix.push_back(story.covariance(a, b));
  }
  return out;
}

/// What a rig that was calibrated as `before` makes of a white surface with this normal at a pixel, while it
/// is `after`: the normal, as long as the albedo.
std::optional<Vec3> solved_surface(const NearLights& before, Vec3 seen_at_mm, const NearLights& after,
                                   Vec3 point_mm, Vec3 normal, std::array<double, 2> place) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < before.leds.size(); ++k) {
    const auto light = light_at(after.leds[k], point_mm), believed = light_at(before.leds[k], seen_at_mm);
    if (!light || !believed) continue;
    const double cosine = dot(normal, light->direction);
    if (!(cosine > 0)) continue;
    const double log_ratio = std::log(after.leds[k].flux_rgb[1] / before.leds[k].flux_rgb[1]) +
                             after.log_gain(k, 1, place[0], place[1]) -
                             before.log_gain(k, 1, place[0], place[1]);
    const double reading = cosine * std::exp(light->log_geometry - believed->log_geometry + log_ratio);
    const Eigen::Vector3d l(believed->direction.x, believed->direction.y, believed->direction.z);
    a += l * l.transpose();
    b += reading * l;
  }
  const Eigen::Vector3d n = a.ldlt().solve(b);
  if (!n.allFinite() || !(n.norm() > 0)) return std::nullopt;
  return Vec3{n[0], n[1], n[2]};
}

/// ln of the green light of a LED on a place; nothing where it gives none.
std::optional<double> log_irradiance(const NearLight& led, const LitPlace& place) {
  const std::optional<LightAt> light = light_at(led, place.point_mm);
  const double cosine = light ? dot(light->direction, place.normal) : 0;
  if (!(cosine > 0) || !(led.flux_rgb[1] > 0)) return std::nullopt;
  return std::log(cosine * led.flux_rgb[1]) + light->log_geometry;
}

/// Mean, and the largest departure from it.
void put_albedo(const std::vector<double>& albedo, MovementCost& cost) {
  if (albedo.empty()) return;
  cost.albedo_factor =
      std::accumulate(albedo.begin(), albedo.end(), 0.0) / static_cast<double>(albedo.size());
  for (const double each : albedo)
    cost.albedo_unevenness = std::max(cost.albedo_unevenness, std::abs(each / cost.albedo_factor - 1));
}

}  // namespace

Result<Movement> find_movement(const Calibration& calibration, const RigEvidence& evidence,
                               const MovementOptions& options) {
  const auto refused = [](std::string what, std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, std::move(what), "rig", std::move(why), std::move(remedy)};
  };
  if (!calibration.camera || !calibration.lights ||
      !std::holds_alternative<NearLights>(*calibration.lights)) {
    return refused("the calibration cannot be checked", "it has no camera or no near lights",
                   "calibrate camera and lights first");
  }
  const RigModel model(calibration, evidence, options);
  if (model.observations() == 0) {
    return refused("nothing in sight tells whether the rig moved",
                   "no tag or fixed point that the calibration knows, no white patch and no sheet was found",
                   "calibrate the camera with tags on the table, or show a sheet of white paper");
  }
  Story story = Judge(model, model.calibrated()).fitted({}, Eigen::VectorXd());
  Movement movement;
  movement.corners = model.corners();
  movement.points = static_cast<int>(evidence.points.size());
  movement.readings = model.readings();
  movement.chi_square_before = story.chi_square / model.observations();
  for (int i = 0; i < options.most_changes; ++i) {
    const Judge judge(model, state_of(model, story, story.numbers));
    std::optional<Story> next = told_on(model, judge, story, options.least_evidence);
    if (!next) break;
    story = std::move(*next);
  }
  put_numbers(story);
  movement.chi_square_after = story.chi_square / static_cast<double>(std::max<Eigen::Index>(
                                                     model.observations() - story.numbers.size(), 1));
  const RigState state = state_of(model, story, story.numbers);
  movement.camera = model.camera_after(state);
  movement.lights = model.lights_after(state);
  movement.covariance = covariance_of_leds(story);
  movement.changes = std::move(story.changes);
  return movement;
}

MovementCost cost_of(const CameraModel& camera_before, const NearLights& before,
                     const CameraModel& camera_after, const NearLights& after) {
  constexpr double kSlope_deg = 20;
  const double s = std::sin(radians(kSlope_deg)), c = std::cos(radians(kSlope_deg));
  const Vec3 kNormals[] = {{0, 0, 1}, {s, 0, c}, {-s, 0, c}, {0, s, c}, {0, -s, c}};
  const Size frame = camera_before.size;
  MovementCost cost;
  int counted = 0;
  std::vector<double> flat_albedo;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 5; ++i) {
      const double x = (frame.width - 1) * i / 4.0, y = (frame.height - 1) * j / 2.0;
      const Vec3 believed = point_on_plane(camera_before, x, y, 0),
                 real = point_on_plane(camera_after, x, y, 0);
      for (const Vec3 normal : kNormals) {
        const auto solved = solved_surface(before, believed, after, real, normal, frame_place(frame, x, y));
        if (!solved) continue;
        if (normal.z == 1) flat_albedo.push_back(length(*solved));
        const double off = angle_deg(normalized(*solved), normal);
        cost.mean_deg += off;
        cost.worst_deg = std::max(cost.worst_deg, off);
        ++counted;
      }
    }
  }
  if (counted > 0) cost.mean_deg /= counted;
  put_albedo(flat_albedo, cost);
  return cost;
}

bool matters(const MovementCost& cost) {
  return cost.mean_deg >= kLeastCost_deg || std::abs(cost.albedo_factor - 1) >= kLeastCostAlbedo ||
         cost.albedo_unevenness >= kLeastCostAlbedo;
}

NearLights levelled(const NearLights& before, const NearLights& after, std::span<const LitPlace> places) {
  NearLights lights = before;
  for (std::size_t k = 0; k < std::min(before.leds.size(), after.leds.size()); ++k) {
    std::vector<double> log_ratios;
    for (const LitPlace& place : places) {
      if (!place.on_table || place.reading_rgb.size() <= k || !(place.reading_rgb[k][1] > 0)) continue;
      const std::optional<double> is = log_irradiance(after.leds[k], place),
                                  was = log_irradiance(before.leds[k], place);
      if (is && was) log_ratios.push_back(*is - *was);
    }
    if (log_ratios.empty()) continue;
    const double factor = std::exp(median(std::move(log_ratios)));
    for (double& flux : lights.leds[k].flux_rgb) flux *= factor;
  }
  return lights;
}

}  // namespace weft::calibration
