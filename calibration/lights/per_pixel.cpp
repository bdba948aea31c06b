// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/per_pixel.h"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace weft::calibration {
namespace {

Error cannot_solve(std::string where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "lights cannot be solved by the pixel", std::move(where), std::move(why),
          std::move(remedy)};
}

Eigen::Vector3d eigen(Vec3 v) {
  return {v.x, v.y, v.z};
}
// How a cell's light departs from the model's: across it (along two axes beside the model's direction), and
// in the log of its strength by channel.
struct Departure {
  std::size_t cell = 0;
  std::array<double, 5> value = {};
};

// Two unit vectors that make a right-handed frame with l, which is nowhere near the x axis; they turn as
// smoothly as l does.
std::array<Vec3, 2> axes_beside(Vec3 l) {
  const Vec3 a = normalized(cross({1, 0, 0}, l));
  return {a, cross(l, a)};
}

// A point light as its directions and intensities on the table show it.
struct MapCost {
  Vec3 point_mm, direction;
  double log_intensity;  // mean over the channels
  double direction_weight, intensity_weight;

  template <typename T>
  bool operator()(const T* position, const T* aim, const T* mu, const T* log_flux, T* residuals) const {
    const T v[3] = {position[0] - point_mm.x, position[1] - point_mm.y, position[2] - point_mm.z};
    const T d = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const T along = -(v[0] * aim[0] + v[1] * aim[1] + v[2] * aim[2]) / d;
    if (!(along > T(0))) return false;
    const auto [a, b] = axes_beside(direction);
    residuals[0] = direction_weight * (v[0] * a.x + v[1] * a.y + v[2] * a.z) / d;
    residuals[1] = direction_weight * (v[0] * b.x + v[1] * b.y + v[2] * b.z) / d;
    residuals[2] = intensity_weight * (log_flux[0] + mu[0] * log(along) - 2.0 * log(d) - log_intensity);
    return true;
  }
};

constexpr double kLeastSigma = 1e-4;  // of directions and log intensities, where there is no noise at all

// Share of the way to the refitted model that a round goes: a LED that is taken for too far away makes
// carried readings lean so that the next model has it up to three times too near.
constexpr double kStep = 0.3;

class PerPixel {
 public:
  PerPixel(const PaperScene& scene, std::span<const PaperReading> readings, const CellGrid& grid,
           const PerPixelOptions& options)
      : scene_(scene),
        readings_(readings),
        grid_(grid),
        options_(options),
        cells_(by_cell(readings, grid, scene.lights.leds.size())) {}

  Result<PerPixelLights> run() {
    if (Result<void> ok = check_poses(); !ok) return std::move(ok).error();
    const std::size_t leds = scene_.lights.leds.size();
    PerPixelLights result;
    result.grid = grid_;
    result.maps.resize(leds);
    std::vector<Result<void>> done(leds);
    for (int round = 0; round < options_.most_rounds; ++round) {
      std::vector<double> changes(leds);
      parallel_for(leds, options_.threads,
                   [&](std::size_t k, int) { done[k] = one_round(k, result.maps[k], changes[k]); });
      for (Result<void>& ok : done) {
        if (!ok) return std::move(ok).error();
      }
      result.changes_deg.push_back(*std::max_element(changes.begin(), changes.end()));
      if (result.changes_deg.back() < options_.settled_deg) return finished(std::move(result));
    }
    return cannot_solve("directions",
                        fmt::format("they still change by {:.3f} degrees after {} rounds",
                                    result.changes_deg.back(), options_.most_rounds),
                        "photograph the sheet in five poses that are tilted by 20 degrees");
  }

 private:
  Result<void> check_poses() const;
  Result<void> one_round(std::size_t led, LightMap& map, double& change_deg);
  std::optional<Departure> solve_cell(std::size_t led, std::size_t cell) const;
  void smooth(std::vector<Departure>& departures, std::array<double, 5>& scatter) const;
  Result<void> refit(std::size_t led, const LightMap& map, const std::array<double, 5>& scatter,
                     double mean_departure);
  PerPixelLights finished(PerPixelLights result) const;
  std::optional<CellLight> model_at(std::size_t led, std::size_t cell) const {
    const auto [x, y] = grid_.centre_px(cell);
    return light_on_table(scene_.camera, scene_.lights, led, x, y);
  }

  PaperScene scene_;
  std::span<const PaperReading> readings_;
  const CellGrid& grid_;
  const PerPixelOptions& options_;
  std::vector<std::vector<std::size_t>> cells_;
};

// The normals of all sheets must span space: their tilts, at least two directions of them.
Result<void> PerPixel::check_poses() const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const SheetPose& sheet : scene_.sheets) {
    const Eigen::Vector3d n = eigen(normal_of(sheet.rig_from_sheet));
    sum += n * n.transpose();
  }
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum, Eigen::EigenvaluesOnly).eigenvalues()[0];
  const double tilt_deg = degrees(std::asin(std::sqrt(std::min(std::max(least, 0.0), 1.0))));
  if (scene_.sheets.size() >= 3 && tilt_deg > 5) return {};
  return cannot_solve(
      fmt::format("{} sheets", scene_.sheets.size()),
      fmt::format("along one direction their normals spread by {:.1f} degrees in all; an intensity and a "
                  "direction are three unknowns",
                  tilt_deg),
      "photograph the sheet flat and tilted by 20 degrees to all four sides");
}

// b of one cell as it departs from the model, by least squares over its readings; nothing where they do not
// tell.
std::optional<Departure> PerPixel::solve_cell(std::size_t led, std::size_t cell) const {
  const std::optional<CellLight> model = model_at(led, cell);
  if (!model) return {};
  const Eigen::Vector3d l = eigen(model->direction);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  for (const std::size_t i : cells_[led * grid_.cells() + cell]) {
    const PaperReading& r = readings_[i];
    const Eigen::Vector3d n = eigen(normal_of(scene_.sheets[r.sheet].rig_from_sheet));
    for (int c = 0; c < 3; ++c) {
      const std::optional<double> predicted = scene_.log_reading(r.sheet, led, c, r.x_px, r.y_px);
      if (!predicted) return {};
      const double carried = r.reading_rgb[static_cast<std::size_t>(c)] * std::exp(-*predicted) * n.dot(l);
      if (c == 0) normal += n * n.transpose();
      right.col(c) += carried * n;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(normal);
  if (!(spread.eigenvalues()[0] > 1e-3 * spread.eigenvalues()[2])) return {};
  const Eigen::Matrix3d b = normal.ldlt().solve(right);  // a column a channel, over the model's intensity
  const Eigen::Vector3d mean = b.rowwise().mean(), direction = mean.normalized();
  const auto [across, up] = axes_beside(model->direction);
  Departure departure = {cell, {direction.dot(eigen(across)), direction.dot(eigen(up)), 0, 0, 0}};
  for (int c = 0; c < 3; ++c) {
    const double strength = b.col(c).dot(direction);
    if (!(strength > 0)) return {};
    departure.value[static_cast<std::size_t>(2 + c)] = std::log(strength);
  }
  return departure;
}

// Replaces departures by a bicubic B-spline over the frame (least squares); `scatter` is what they lose.
void PerPixel::smooth(std::vector<Departure>& departures, std::array<double, 5>& scatter) const {
  GainSpline spline = {options_.spline_columns, options_.spline_rows, {}};
  const int size = options_.spline_columns * options_.spline_rows;
  spline.coefficients.resize(static_cast<std::size_t>(size));
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(departures.size()), size);
  Eigen::MatrixXd values(basis.rows(), 5);
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    const Departure& departure = departures[static_cast<std::size_t>(i)];
    const auto [x, y] = grid_.centre_px(departure.cell);
    const auto [u, v] = frame_place(grid_.frame, x, y);
    for (int j = 0; j < size; ++j) {
      spline.coefficients[static_cast<std::size_t>(j)] = 1;
      basis(i, j) = spline.at(u, v);
      spline.coefficients[static_cast<std::size_t>(j)] = 0;
    }
    for (int p = 0; p < 5; ++p) values(i, p) = departure.value[static_cast<std::size_t>(p)];
  }
  // A trace of ridge keeps coefficients that no cell speaks of at 0.
  const Eigen::MatrixXd normal = basis.transpose() * basis + 1e-6 * Eigen::MatrixXd::Identity(size, size);
  const Eigen::MatrixXd smoothed = basis * normal.ldlt().solve(basis.transpose() * values);
  for (int p = 0; p < 5; ++p) {
    const auto channel = static_cast<std::size_t>(p);
    const double freedom = std::max(1.0, static_cast<double>(basis.rows() - size));
    scatter[channel] = std::sqrt((values.col(p) - smoothed.col(p)).squaredNorm() / freedom);
    for (std::size_t i = 0; i < departures.size(); ++i)
      departures[i].value[channel] = smoothed(static_cast<Eigen::Index>(i), p);
  }
}

Result<void> PerPixel::one_round(std::size_t led, LightMap& map, double& change_deg) {
  std::vector<Departure> departures;
  for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
    if (const auto departure = solve_cell(led, cell)) departures.push_back(*departure);
  }
  const auto needed = static_cast<std::size_t>(2 * options_.spline_columns * options_.spline_rows);
  if (departures.size() < needed) {
    return cannot_solve(fmt::format("LED {}", led + 1),
                        fmt::format("{} cells of the frame show paper in enough poses, {} are needed",
                                    departures.size(), needed),
                        "photograph a sheet that fills the frame in every pose");
  }
  std::array<double, 5> scatter = {};
  smooth(departures, scatter);
  LightMap next;
  next.direction.resize(grid_.cells());
  next.intensity_rgb.resize(grid_.cells());
  change_deg = map.direction.empty() ? 180 : 0;
  for (const Departure& departure : departures) {
    const CellLight model = *model_at(led, departure.cell);
    const auto [across, up] = axes_beside(model.direction);
    const auto& value = departure.value;
    next.direction[departure.cell] = normalized(model.direction + value[0] * across + value[1] * up);
    for (std::size_t c = 0; c < 3; ++c)
      next.intensity_rgb[departure.cell][c] = model.intensity_rgb[c] * std::exp(value[2 + c]);
    if (!map.direction.empty())
      change_deg =
          std::max(change_deg, angle_deg(next.direction[departure.cell], map.direction[departure.cell]));
  }
  map = std::move(next);
  double mean = 0;
  for (const Departure& departure : departures)
    mean += (departure.value[2] + departure.value[3] + departure.value[4]) / 3 /
            static_cast<double>(departures.size());
  return refit(led, map, scatter, mean);
}

Result<void> PerPixel::refit(std::size_t led, const LightMap& map, const std::array<double, 5>& scatter,
                             double mean_departure) {
  NearLight& light = scene_.lights.leds[led];
  std::array<double, 3> position = {light.position_mm.x, light.position_mm.y, light.position_mm.z};
  std::array<double, 3> aim = {light.aim.x, light.aim.y, light.aim.z};
  const auto mean_log = [](const std::array<double, 3>& rgb) {
    return (std::log(rgb[0]) + std::log(rgb[1]) + std::log(rgb[2])) / 3;
  };
  double mu = light.mu, log_flux = mean_log(light.flux_rgb);
  const double began = log_flux;
  log_flux += mean_departure;
  const double direction_sigma = std::max(std::hypot(scatter[0], scatter[1]) / std::sqrt(2.0), kLeastSigma);
  const double intensity_sigma = std::max((scatter[2] + scatter[3] + scatter[4]) / 3, kLeastSigma);
  ceres::Problem problem;
  for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
    if (!(map.intensity_rgb.at(cell)[0] > 0)) continue;
    const auto [x, y] = grid_.centre_px(cell);
    const auto [u, v] = frame_place(grid_.frame, x, y);
    double log_intensity = mean_log(map.intensity_rgb[cell]);
    for (int c = 0; c < 3; ++c) log_intensity -= scene_.lights.log_gain(led, c, u, v) / 3;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MapCost, 3, 3, 3, 1, 1>(
                                 new MapCost{point_on_plane(scene_.camera, x, y, 0), map.direction[cell],
                                             log_intensity, 1 / direction_sigma, 1 / intensity_sigma}),
                             nullptr, position.data(), aim.data(), &mu, &log_flux);
  }
  problem.SetManifold(aim.data(), new ceres::SphereManifold<3>());
  problem.SetParameterLowerBound(&mu, 0, 0);
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  how.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    return cannot_solve(fmt::format("LED {}", led + 1), "no point light gives what its maps hold",
                        "look whether its lens is clean, and whether something shades it");
  }
  const Vec3 found_mm = {position[0], position[1], position[2]};
  light.position_mm = light.position_mm + kStep * (found_mm - light.position_mm);
  light.aim = normalized(light.aim + kStep * (Vec3{aim[0], aim[1], aim[2]} - light.aim));
  light.mu += kStep * (mu - light.mu);
  for (double& flux : light.flux_rgb) flux *= std::exp(log_flux - began);
  return {};
}

PerPixelLights PerPixel::finished(PerPixelLights result) const {
  result.model = scene_.lights;
  for (std::size_t k = 0; k < result.maps.size(); ++k) {
    std::vector<double>& apart = result.apart_deg.emplace_back(grid_.cells());
    for (std::size_t cell = 0; cell < grid_.cells(); ++cell) {
      const auto model = model_at(k, cell);
      if (model && result.maps[k].intensity_rgb[cell][0] > 0)
        apart[cell] = angle_deg(result.maps[k].direction[cell], model->direction);
    }
  }
  return result;
}

}  // namespace

std::vector<std::size_t> PerPixelLights::parted() const {
  std::vector<std::size_t> leds;
  for (std::size_t k = 0; k < apart_deg.size(); ++k) {
    if (*std::max_element(apart_deg[k].begin(), apart_deg[k].end()) > kPartsFrom_deg) leds.push_back(k);
  }
  return leds;
}

Result<PerPixelLights> solve_per_pixel(const PaperScene& scene, std::span<const PaperReading> readings,
                                       const CellGrid& grid, const PerPixelOptions& options) {
  return PerPixel(scene, readings, grid, options).run();
}

}  // namespace weft::calibration
