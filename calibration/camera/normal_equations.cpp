// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/normal_equations.h"

namespace weft::calibration {

std::vector<std::string> camera_parameters(const std::vector<std::string>& distortion) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy"};
  names.insert(names.end(), distortion.begin(), distortion.end());
  return names;
}

PixelPoint seen_by(const CameraModel& camera, Vec3 in_camera_mm) {
  const Vec3 p = project(camera, in_camera_mm);
  return {p.x, p.y};
}

CameraModel at_origin(CameraModel camera) {
  camera.camera_from_rig_rotation = Pose().rotation;
  camera.camera_from_rig_translation_mm = {};
  return camera;
}

namespace {

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
      if (name == kLogStretch) {
        steps_.push_back({camera_, camera_, 0});
        continue;
      }
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
      if (steps_[p].h == 0) {
        const Vec3 by = kStretchStep / 2 * (pose.rotation * Vec3{-point.x, point.y, 0});
        out.camera.col(static_cast<Eigen::Index>(p)) =
            slope(seen_by(camera_, here + by), seen_by(camera_, here - by), kStretchStep);
        continue;
      }
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
    double h;  ///< 0: it is the print that changes
  };
  static Eigen::Vector2d slope(PixelPoint up, PixelPoint down, double h) {
    return {(up.x - down.x) / (2 * h), (up.y - down.y) / (2 * h)};
  }

  CameraModel camera_;
  std::vector<Step> steps_;
};

}  // namespace

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
      const Vec3 point = place_of(corner, bundle.board_z_mm[b], bundle.log_stretch);
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

Matrix reduced(const NormalEquations& equations) {
  Matrix schur = equations.camera;
  for (std::size_t b = 0; b < equations.board.size(); ++b)
    schur -= equations.mixed[b] * equations.board[b].ldlt().solve(equations.mixed[b].transpose());
  return schur;
}

Matrix solved(const Matrix& normal, const Matrix& right) {
  const Vector scale = normal.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix> ldlt(scale.asDiagonal() * normal * scale.asDiagonal());
  return scale.asDiagonal() * ldlt.solve(scale.asDiagonal() * right);
}

Matrix with_pose_of(const NormalEquations& equations, std::size_t table, const Matrix& camera) {
  const Eigen::Index n = camera.rows();
  const Matrix6 board = equations.board[table].ldlt().solve(Matrix6::Identity());
  const Matrix follows = -equations.mixed[table] * board;  // of the board's pose, by the camera
  Matrix all(n + 6, n + 6);
  all.topLeftCorner(n, n) = camera;
  all.topRightCorner(n, 6) = camera * follows;
  all.bottomLeftCorner(6, n) = all.topRightCorner(n, 6).transpose();
  all.bottomRightCorner(6, 6) = board + follows.transpose() * camera * follows;
  return 0.5 * (all + all.transpose());
}

}  // namespace weft::calibration
