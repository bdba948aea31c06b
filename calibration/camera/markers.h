// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "calibration/camera/pose.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/camera.h"

// Square markers (ArUco, AprilTag) in photographs, and where the sheet lies that they are printed on.

namespace weft::calibration {

/// A picture to find boards and tags in: 8 bits, linear in light, the brightest 0.5 percent above 240. The
/// mosaic is balanced to grey by the means of its channels and smoothed by 1 2 1 in x and y, which weighs
/// red, green and blue 1 : 2 : 1 at every photosite of either phase, so that no edge moves.
Image<std::uint8_t> grey_picture(const RawFrame& frame);
/// The same of a photograph in linear R, G, B, without smoothing. What is not finite is black.
Image<std::uint8_t> grey_picture(std::span<const View<const float>> rgb);

/// A marker in a picture.
struct TagSighting {
  std::string dictionary;  ///< as OpenCV names it: "DICT_APRILTAG_36h11"
  int id = 0;
  std::array<PixelPoint, 4> corners_px;  ///< upper left of the upright tag first, then clockwise
};

/// Markers as OpenCV 4.6 detects them (cv::aruco::detectMarkers, on a picture of at most 1640 pixels a side),
/// in the order of their ids. Each corner is where the straight lines through its two edges meet; a line is
/// fitted to the places where brightness changes across the edge (as Wang and Olson 2016, section III-B),
/// away from the corners. OpenCV's own corners are not used: cornerSubPix follows the round that a lens makes
/// of an outer corner, inwards. Tags whose edges cannot be followed are left out; a tag needs a white margin
/// and about 4 pixels a cell, and is not found where it is under 25 pixels wide in the reduced picture.
/// kBadData for a dictionary that OpenCV does not have.
Result<std::vector<TagSighting>> find_tags(View<const std::uint8_t> grey, const std::string& dictionary);

/// A tag on a flat sheet: u to the right and v up from the sheet's centre, the tag upright in u and v.
struct SheetTag {
  std::string dictionary;
  int id = 0;
  double side_mm = 0;  ///< with its black border
  double centre_u_mm = 0, centre_v_mm = 0;
};

struct SheetPose {
  Pose rig_from_sheet;  ///< of points (u, v, 0); the sheet's normal is its third axis
  /// 6 x 6 by rows, of turn (radians) and shift (mm) in the rig frame as moved() takes them, for the camera
  /// as it is. From the scatter of the corners, taken as 0.02 pixels at least.
  std::array<double, 36> covariance = {};
  double residual_px = 0;  ///< rms distance of the corners to where the pose puts them
  int tags = 0;            ///< that it rests on
};

/// Where a sheet lies that these tags were seen on, by least squares over their corners. Starts from both
/// poses that a plane can have (Collins and Bartoli, IJCV 2014, in OpenCV) and keeps the one that fits.
/// Sightings of tags that the sheet does not have are ignored.
/// Errors, with `where`: kBadData for fewer than two of its tags in sight, corners that fit no pose to
/// `most_residual_px`, or two poses that fit alike.
Result<SheetPose> sheet_pose(const CameraModel& camera, std::span<const TagSighting> sightings,
                             std::span<const SheetTag> tags, const std::string& where,
                             double most_residual_px = 1);

}  // namespace weft::calibration
