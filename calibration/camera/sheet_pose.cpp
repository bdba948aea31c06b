// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "calibration/camera/markers.h"
#include "calibration/camera/opencv_camera.h"

namespace weft::calibration {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kLeastScatter_px = 0.02;
constexpr double kTellsApart = 2;  // times as large a residual: the other of two poses is not meant

struct Corner {
  Vec3 on_sheet_mm;
  PixelPoint seen_px;
};

std::vector<Corner> corners_of(std::span<const TagSighting> sightings, std::span<const SheetTag> tags) {
  std::vector<Corner> corners;
  for (const SheetTag& tag : tags) {
    const auto seen = std::find_if(sightings.begin(), sightings.end(), [&](const TagSighting& s) {
      return s.id == tag.id && s.dictionary == tag.dictionary;
    });
    if (seen == sightings.end()) continue;
    constexpr std::array<std::array<int, 2>, 4> kSigns = {{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      corners.push_back({{tag.centre_u_mm + kSigns[i][0] * tag.side_mm / 2,
                          tag.centre_v_mm + kSigns[i][1] * tag.side_mm / 2, 0},
                         seen->corners_px[i]});
    }
  }
  return corners;
}

// Least squares over the reprojection of corners, by Gauss-Newton, from a pose nearby.
class PoseFit {
 public:
  PoseFit(const CameraModel& camera, const std::vector<Corner>& corners, Pose start)
      : camera_(&camera), corners_(&corners), pose_(start) {
    for (int i = 0; i < 20; ++i) {
      linearize();
      const Vector6 step = normal_.ldlt().solve(-gradient_);
      if (!step.allFinite()) break;
      pose_ = moved(pose_, {step[0], step[1], step[2]}, {step[3], step[4], step[5]});
      if (step.head<3>().norm() < 1e-10 && step.tail<3>().norm() < 1e-7) break;
    }
    linearize();
  }

  const Pose& pose() const { return pose_; }
  /// Infinite where the pose went behind the camera.
  double rms_px() const { return rms_; }
  Matrix6 covariance() const {
    const double n = 2.0 * static_cast<double>(corners_->size());
    const double scatter = std::max(rms_ * std::sqrt(n / 2 / (n - 6)), kLeastScatter_px);
    return scatter * scatter * normal_.ldlt().solve(Matrix6::Identity());
  }
  Vec3 normal() const { return pose_.rotation * Vec3{0, 0, 1}; }
  bool faces_camera() const {
    const Vec3 centre =
        inverse(Pose{camera_->camera_from_rig_rotation, camera_->camera_from_rig_translation_mm})
            .translation_mm;
    return dot(normal(), centre - pose_.translation_mm) > 0;
  }

 private:
  void linearize() {
    constexpr double kTurn = 1e-6, kShift_mm = 1e-4;
    normal_.setZero();
    gradient_.setZero();
    double sum = 0;
    bool in_front = true;
    for (const Corner& corner : *corners_) {
      const auto at = [&](int parameter, double by) {
        const std::array<double, 3> d = {parameter % 3 == 0 ? by : 0, parameter % 3 == 1 ? by : 0,
                                         parameter % 3 == 2 ? by : 0};
        const Vec3 v = {d[0], d[1], d[2]};
        return project(*camera_,
                       (parameter < 3 ? moved(pose_, v, {}) : moved(pose_, {}, v))(corner.on_sheet_mm));
      };
      const Vec3 here = at(0, 0);
      in_front = in_front && here.z > 0;
      const Eigen::Vector2d error(here.x - corner.seen_px.x, here.y - corner.seen_px.y);
      Eigen::Matrix<double, 2, 6> jacobian;
      for (int p = 0; p < 6; ++p) {
        const double h = p < 3 ? kTurn : kShift_mm;
        const Vec3 up = at(p, h), down = at(p, -h);
        jacobian.col(p) << (up.x - down.x) / (2 * h), (up.y - down.y) / (2 * h);
      }
      normal_ += jacobian.transpose() * jacobian;
      gradient_ += jacobian.transpose() * error;
      sum += error.squaredNorm();
    }
    rms_ = std::sqrt(sum / static_cast<double>(corners_->size()));
    if (!in_front || !std::isfinite(rms_)) rms_ = std::numeric_limits<double>::infinity();
  }

  const CameraModel* camera_;
  const std::vector<Corner>* corners_;
  Pose pose_;
  Matrix6 normal_;
  Vector6 gradient_;
  double rms_ = 0;
};

// Both poses of a plane, refined, the better one first.
std::vector<PoseFit> fits_of(const CameraModel& camera, const std::vector<Corner>& corners) {
  std::vector<cv::Point3d> on_sheet;
  std::vector<cv::Point2d> seen;
  for (const Corner& c : corners) {
    on_sheet.emplace_back(c.on_sheet_mm.x, c.on_sheet_mm.y, 0);
    seen.emplace_back(c.seen_px.x, c.seen_px.y);
  }
  std::vector<cv::Mat> turns, shifts;
  try {
    cv::solvePnPGeneric(on_sheet, seen, camera_matrix(camera), distortion(camera), turns, shifts, false,
                        cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {  // corners on one line
    return {};
  }
  const Pose rig_from_camera =
      inverse({camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm});
  std::vector<PoseFit> fits;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    fits.emplace_back(camera, corners, rig_from_camera * pose_of(turns[i], shifts[i]));
    if (!std::isfinite(fits.back().rms_px()) || !fits.back().faces_camera()) fits.pop_back();
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PoseFit& a, const PoseFit& b) { return a.rms_px() < b.rms_px(); });
  return fits;
}

}  // namespace

Result<SheetPose> sheet_pose(const CameraModel& camera, std::span<const TagSighting> sightings,
                             std::span<const SheetTag> tags, const std::string& where,
                             double most_residual_px) {
  const std::vector<Corner> corners = corners_of(sightings, tags);
  const auto refused = [&](std::string what, std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, std::move(what), where, std::move(why), std::move(remedy)};
  };
  if (corners.size() < 8) {
    return refused("too few tags of the sheet are in sight",
                   fmt::format("{} of {} were found, and 2 are needed", corners.size() / 4, tags.size()),
                   "lay the sheet so that its tags are in the frame, sharp and evenly lit");
  }
  const std::vector<PoseFit> fits = fits_of(camera, corners);
  if (fits.empty() || fits.front().rms_px() > most_residual_px) {
    return refused("the tags do not lie where the sheet has them",
                   fits.empty()
                       ? "no pose puts them in front of the camera"
                       : fmt::format("the best pose misses their corners by {:.2f} pixels, and {:.2f} are "
                                     "allowed",
                                     fits.front().rms_px(), most_residual_px),
                   "measure the tags on the sheet again and lay it flat");
  }
  const PoseFit& best = fits.front();
  const Matrix6 covariance = best.covariance();
  if (fits.size() > 1) {
    const PoseFit& other = fits.back();
    const double apart = radians(angle_deg(best.normal(), other.normal()));
    const double sigma = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
    if (other.rms_px() < kTellsApart * std::max(best.rms_px(), kLeastScatter_px) &&
        apart > 5 * sigma + 1e-6) {
      return refused(
          "two poses of the sheet explain its tags alike",
          fmt::format("they are {:.1f} degrees apart and miss the corners by {:.3f} and {:.3f} pixels",
                      degrees(apart), best.rms_px(), other.rms_px()),
          "use a larger sheet with tags in its corners");
    }
  }
  SheetPose pose = {best.pose(), {}, best.rms_px(), static_cast<int>(corners.size() / 4)};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(pose.covariance.data()) = covariance;
  return pose;
}

}  // namespace weft::calibration
