// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/bundle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calibration/camera/normal_equations.h"
#include "calibration/camera/opencv_camera.h"

namespace weft::calibration {
namespace {

double squares_of(const std::vector<const BoardView*>& views, const Bundle& bundle) {
  double sum = 0;
  for (std::size_t b = 0; b < views.size(); ++b) {
    for (const PixelPoint& r : residuals_of(*views[b], bundle.camera, bundle.camera_from_board[b],
                                            bundle.board_z_mm[b], bundle.log_stretch))
      sum += r.x * r.x + r.y * r.y;
  }
  return sum;
}

// The bundle after a share of a Gauss-Newton step.
Bundle stepped(Bundle bundle, const std::vector<std::string>& names, const Vector& camera,
               const std::vector<Vector6>& boards, double share) {
  for (std::size_t p = 0; p < names.size(); ++p) {
    double& number = names[p] == kLogStretch ? bundle.log_stretch : *number_of(bundle.camera, names[p]);
    number += share * camera[static_cast<Eigen::Index>(p)];
  }
  for (std::size_t b = 0; b < boards.size(); ++b) {
    const Vector6 s = share * boards[b];
    bundle.camera_from_board[b] = moved(bundle.camera_from_board[b], {s[0], s[1], s[2]}, {s[3], s[4], s[5]});
  }
  return bundle;
}

}  // namespace

bool fit(const std::vector<const BoardView*>& views, const std::vector<std::string>& distortion,
         Bundle& bundle) {
  const std::vector<std::string> names = camera_parameters(distortion);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const NormalEquations equations = normal_equations(views, names, bundle);
    Vector gradient = equations.camera_gradient;
    for (std::size_t b = 0; b < views.size(); ++b)
      gradient -= equations.mixed[b] * equations.board[b].ldlt().solve(equations.board_gradient[b]);
    const Vector camera = -solved(reduced(equations), gradient);
    std::vector<Vector6> boards;
    for (std::size_t b = 0; b < views.size(); ++b) {
      boards.emplace_back(-equations.board[b].ldlt().solve(equations.board_gradient[b] +
                                                           equations.mixed[b].transpose() * camera));
    }
    if (!camera.allFinite() || !std::isfinite(equations.squares)) return false;
    double share = 1;
    Bundle next = stepped(bundle, names, camera, boards, share);
    while (!(squares_of(views, next) <= equations.squares * (1 + 1e-12)) && share > 1e-3)
      next = stepped(bundle, names, camera, boards, share /= 2);
    if (share <= 1e-3) return true;  // at the minimum, as far as sums can tell
    bundle = next;
    if (share == 1 && std::abs(camera[0]) < 1e-9 * bundle.camera.fx && std::abs(camera[2]) < 1e-6)
      return true;
  }
  return bundle.camera.fx > 0 && bundle.camera.fy > 0;
}

ParameterCovariance covariance_of(const std::vector<const BoardView*>& views,
                                  const std::vector<std::string>& distortion, const Bundle& bundle,
                                  std::size_t table, double corner_sigma_px) {
  std::vector<std::string> names = camera_parameters(distortion);
  const NormalEquations equations = normal_equations(views, names, bundle);
  const auto n = static_cast<Eigen::Index>(names.size());
  const Matrix camera = solved(reduced(equations), Matrix::Identity(n, n));
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> all =
      corner_sigma_px * corner_sigma_px * with_pose_of(equations, table, camera);
  if (const auto print = std::find(names.begin(), names.end(), kLogStretch); print != names.end()) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index i = 0; i < all.rows(); ++i)
      if (i != print - names.begin()) others.push_back(i);
    all = all(others, others).eval();
    names.erase(print);
  }
  for (const char* group : {"camera_from_rig_rotation", "camera_from_rig_translation_mm"}) {
    for (const char* axis : {".x", ".y", ".z"}) names.push_back(std::string(group) + axis);
  }
  return {std::move(names), std::vector<double>(all.data(), all.data() + all.size())};
}

double stretch_sigma(const std::vector<const BoardView*>& views, const std::vector<std::string>& terms,
                     const Bundle& bundle, double corner_sigma_px) {
  const std::vector<std::string> names = camera_parameters(terms);
  const auto n = static_cast<Eigen::Index>(names.size());
  const auto at = std::find(names.begin(), names.end(), kLogStretch) - names.begin();
  const Matrix variance = solved(reduced(normal_equations(views, names, bundle)), Matrix::Identity(n, n));
  return corner_sigma_px * std::sqrt(variance(at, at));
}

std::optional<double> squares_with_pose_fitted(const BoardView& view, const CameraModel& camera,
                                               const Pose& start, double board_z_mm, double log_stretch) {
  Bundle bundle = {camera, {start}, {board_z_mm}, log_stretch};
  for (int iteration = 0; iteration < 20; ++iteration) {
    const NormalEquations equations = normal_equations({&view}, {}, bundle);
    const Vector6 step = -equations.board[0].ldlt().solve(equations.board_gradient[0]);
    if (!step.allFinite()) return std::nullopt;
    bundle = stepped(bundle, {}, {}, {step}, 1);
    if (step.head<3>().norm() < 1e-9 && step.tail<3>().norm() < 1e-6) break;
  }
  return squares_of({&view}, bundle);
}

Pose pose_by_opencv(const BoardView& view, const CameraModel& camera) {
  std::vector<cv::Point3d> places;
  std::vector<cv::Point2d> seen;
  for (const BoardCorner& c : view.corners) {
    places.emplace_back(c.u_mm, c.v_mm, 0);
    seen.emplace_back(c.px.x, c.px.y);
  }
  cv::Mat turn, shift;
  cv::solvePnP(places, seen, camera_matrix(camera), calibration::distortion(camera), turn, shift, false,
               cv::SOLVEPNP_IPPE);
  return pose_of(turn, shift);
}

Vec3 place_of(const BoardCorner& corner, double board_z_mm, double log_stretch) {
  const double half = std::exp(log_stretch / 2);
  return {corner.u_mm / half, corner.v_mm * half, board_z_mm};
}

std::vector<PixelPoint> residuals_of(const BoardView& view, const CameraModel& camera,
                                     const Pose& camera_from_board, double board_z_mm, double log_stretch) {
  const CameraModel here = at_origin(camera);
  std::vector<PixelPoint> residuals;
  for (const BoardCorner& corner : view.corners) {
    const PixelPoint at = seen_by(here, camera_from_board(place_of(corner, board_z_mm, log_stretch)));
    residuals.push_back({corner.px.x - at.x, corner.px.y - at.y});
  }
  return residuals;
}

double* number_of(CameraModel& camera, const std::string& parameter) {
  struct Named {
    const char* name;
    double CameraModel::*number;
  };
  static constexpr std::array<Named, 9> kNumbers = {{{"fx", &CameraModel::fx},
                                                     {"fy", &CameraModel::fy},
                                                     {"cx", &CameraModel::cx},
                                                     {"cy", &CameraModel::cy},
                                                     {"k1", &CameraModel::k1},
                                                     {"k2", &CameraModel::k2},
                                                     {"k3", &CameraModel::k3},
                                                     {"p1", &CameraModel::p1},
                                                     {"p2", &CameraModel::p2}}};
  for (const Named& each : kNumbers) {
    if (parameter == each.name) return &(camera.*each.number);
  }
  return nullptr;
}

double step_of(const std::string& parameter) {
  if (parameter.starts_with("camera_from_rig_rotation")) return kTurnStep;
  if (parameter.starts_with("camera_from_rig_translation_mm")) return kShiftStep_mm;
  return parameter[0] == 'k' || parameter[0] == 'p' ? 1e-4 : 1e-2;
}

double rms_of(const std::vector<PixelPoint>& residuals) {
  double sum = 0;
  for (const PixelPoint& r : residuals) sum += r.x * r.x + r.y * r.y;
  return std::sqrt(sum / std::max<double>(1, static_cast<double>(residuals.size())));
}

}  // namespace weft::calibration
