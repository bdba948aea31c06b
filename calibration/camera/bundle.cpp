// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/bundle.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calibration/camera/opencv_camera.h"

namespace weft::calibration {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Columns6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr double kTurnStep = 1e-6, kShiftStep_mm = 1e-4;

std::vector<std::string> camera_parameters(const std::vector<std::string>& distortion) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy"};
  names.insert(names.end(), distortion.begin(), distortion.end());
  return names;
}

// Where a camera whose own pose is unity sees a point of its frame.
PixelPoint seen_by(const CameraModel& camera, Vec3 in_camera_mm) {
  const Vec3 p = project(camera, in_camera_mm);
  return {p.x, p.y};
}

CameraModel at_origin(CameraModel camera) {
  camera.camera_from_rig_rotation = Pose().rotation;
  camera.camera_from_rig_translation_mm = {};
  return camera;
}

// The normal equations: camera by camera, camera by board, board by board, and gradients.
struct NormalEquations {
  Matrix camera;
  Vector camera_gradient;
  std::vector<Columns6> mixed;
  std::vector<Matrix6> board;
  std::vector<Vector6> board_gradient;
  double squares = 0;
};

// Rows of the Jacobian at one corner: camera's parameters, then turn and shift of the board.
struct CornerRows {
  Eigen::Matrix<double, 2, Eigen::Dynamic> camera;
  Eigen::Matrix<double, 2, 6> board;
};

class Model {
 public:
  Model(const CameraModel& camera, const std::vector<std::string>& names) : camera_(at_origin(camera)) {
    for (const std::string& name : names) {
      const double h = step_of(name);
      CameraModel up = camera_, down = camera_;
      *number_of(up, name) += h;
      *number_of(down, name) -= h;
      steps_.push_back({up, down, h});
    }
  }

  PixelPoint at(const Pose& pose, Vec3 point) const { return seen_by(camera_, pose(point)); }

  CornerRows rows(const Pose& pose, Vec3 point) const {
    const Vec3 here = pose(point), arm = here - pose.translation_mm;
    CornerRows out = {Eigen::Matrix<double, 2, Eigen::Dynamic>(2, static_cast<Eigen::Index>(steps_.size())),
                      {}};
    for (std::size_t p = 0; p < steps_.size(); ++p) {
      out.camera.col(static_cast<Eigen::Index>(p)) =
          slope(seen_by(steps_[p].up, here), seen_by(steps_[p].down, here), steps_[p].h);
    }
    for (int p = 0; p < 6; ++p) {
      const Vec3 axis = {p % 3 == 0 ? 1.0 : 0.0, p % 3 == 1 ? 1.0 : 0.0, p % 3 == 2 ? 1.0 : 0.0};
      const double h = p < 3 ? kTurnStep : kShiftStep_mm;
      const Vec3 by = h * (p < 3 ? cross(axis, arm) : axis);
      out.board.col(p) = slope(seen_by(camera_, here + by), seen_by(camera_, here - by), h);
    }
    return out;
  }

 private:
  struct Step {
    CameraModel up, down;
    double h;
  };
  static Eigen::Vector2d slope(PixelPoint up, PixelPoint down, double h) {
    return {(up.x - down.x) / (2 * h), (up.y - down.y) / (2 * h)};
  }

  CameraModel camera_;
  std::vector<Step> steps_;
};

NormalEquations normal_equations(const std::vector<const BoardView*>& views,
                                 const std::vector<std::string>& names, const Bundle& bundle) {
  const auto n = static_cast<Eigen::Index>(names.size());
  NormalEquations out = {Matrix::Zero(n, n), Vector::Zero(n), {}, {}, {}, 0};
  const Model model(bundle.camera, names);
  for (std::size_t b = 0; b < views.size(); ++b) {
    Columns6 mixed = Columns6::Zero(n, 6);
    Matrix6 board = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    for (const BoardCorner& corner : views[b]->corners) {
      const Vec3 point = {corner.u_mm, corner.v_mm, bundle.board_z_mm[b]};
      const PixelPoint at = model.at(bundle.camera_from_board[b], point);
      const Eigen::Vector2d error(at.x - corner.px.x, at.y - corner.px.y);
      const CornerRows rows = model.rows(bundle.camera_from_board[b], point);
      out.camera += rows.camera.transpose() * rows.camera;
      out.camera_gradient += rows.camera.transpose() * error;
      mixed += rows.camera.transpose() * rows.board;
      board += rows.board.transpose() * rows.board;
      gradient += rows.board.transpose() * error;
      out.squares += error.squaredNorm();
    }
    out.mixed.push_back(mixed);
    out.board.push_back(board);
    out.board_gradient.push_back(gradient);
  }
  return out;
}

// What is left of the camera's equations once every pose follows its own (the Schur complement).
Matrix reduced(const NormalEquations& equations) {
  Matrix schur = equations.camera;
  for (std::size_t b = 0; b < equations.board.size(); ++b)
    schur -= equations.mixed[b] * equations.board[b].ldlt().solve(equations.mixed[b].transpose());
  return schur;
}

// Solves with unit diagonal, as parameters differ by many powers of ten.
Matrix solved(const Matrix& normal, const Matrix& right) {
  const Vector scale = normal.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix> ldlt(scale.asDiagonal() * normal * scale.asDiagonal());
  return scale.asDiagonal() * ldlt.solve(scale.asDiagonal() * right);
}

double squares_of(const std::vector<const BoardView*>& views, const Bundle& bundle) {
  double sum = 0;
  for (std::size_t b = 0; b < views.size(); ++b) {
    for (const PixelPoint& r :
         residuals_of(*views[b], bundle.camera, bundle.camera_from_board[b], bundle.board_z_mm[b]))
      sum += r.x * r.x + r.y * r.y;
  }
  return sum;
}

// The bundle after a share of a Gauss-Newton step.
Bundle stepped(Bundle bundle, const std::vector<std::string>& names, const Vector& camera,
               const std::vector<Vector6>& boards, double share) {
  for (std::size_t p = 0; p < names.size(); ++p)
    *number_of(bundle.camera, names[p]) += share * camera[static_cast<Eigen::Index>(p)];
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
  const Matrix6 board = equations.board[table].ldlt().solve(Matrix6::Identity());
  const Matrix follows = -equations.mixed[table] * board;  // of the board's pose, by the camera
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> all(n + 6, n + 6);
  all.topLeftCorner(n, n) = camera;
  all.topRightCorner(n, 6) = camera * follows;
  all.bottomLeftCorner(6, n) = all.topRightCorner(n, 6).transpose();
  all.bottomRightCorner(6, 6) = board + follows.transpose() * camera * follows;
  all = (0.5 * corner_sigma_px * corner_sigma_px * (all + all.transpose())).eval();
  for (const char* group : {"camera_from_rig_rotation", "camera_from_rig_translation_mm"}) {
    for (const char* axis : {".x", ".y", ".z"}) names.push_back(std::string(group) + axis);
  }
  return {std::move(names), std::vector<double>(all.data(), all.data() + all.size())};
}

std::optional<double> squares_with_pose_fitted(const BoardView& view, const CameraModel& camera,
                                               const Pose& start, double board_z_mm) {
  Bundle bundle = {camera, {start}, {board_z_mm}};
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

std::vector<PixelPoint> residuals_of(const BoardView& view, const CameraModel& camera,
                                     const Pose& camera_from_board, double board_z_mm) {
  const CameraModel here = at_origin(camera);
  std::vector<PixelPoint> residuals;
  for (const BoardCorner& corner : view.corners) {
    const PixelPoint at = seen_by(here, camera_from_board({corner.u_mm, corner.v_mm, board_z_mm}));
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

}  // namespace weft::calibration
