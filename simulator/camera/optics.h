// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"
#include "simulator/camera/camera_settings.h"

namespace weft::simulator {

/// From the principal point to the farthest corner of the frame, at least 1.
double corner_distance_px(const CameraModel& camera);

/// Light that reaches a pixel over what reaches the principal point,
/// g = cos(theta)^power (1 - corner_loss r^2 / r_corner^2), with r in pixels from the principal point and
/// tan(theta) = r / focal length, the angle behind the lens: the law of cos^4 (Reiss, "The cos^4 law of
/// illumination", JOSA 35, 1945) holds for the image side, so distortion does not enter. r_corner is the
/// distance of the farthest corner of the frame. Between 0 and 1; beyond the frame the mechanical loss stays
/// below 0.99.
class Vignette {
 public:
  Vignette(const VignetteSettings& settings, const CameraModel& camera);
  double gain(double x, double y) const;

 private:
  double cx_, cy_, per_fx_, per_fy_, half_power_, loss_per_px2_;
};

/// The vignette as calibrations hold it: log gain(u, v) = mean + spline(u, v), where the spline has mean 0
/// over the frame and exp(mean) belongs into every LED's flux. u, v as in GainSpline.
struct GainFit {
  GainSpline spline;
  double mean_log_gain = 0;
  double max_error = 0;  ///< of log gain, largest of a 257 x 257 grid over the frame
};

/// Least squares over the frame. The default keeps every vignette of the settings under 1e-4 to 45
/// degrees from the axis.
GainFit fit_gain(const Vignette& vignette, Size size, int columns = 16, int rows = 12);

/// Where the light of a pixel goes: (2 radius + 1)^2 weights by rows, none negative, sum 1, the same under
/// every turn and mirror image.
struct BlurKernel {
  int radius = 0;
  std::vector<double> weights = {1};
};

/// Point spread (a Gaussian cut at 4 standard deviations) after defocus (a disc of even light), with
/// halo_share of the light in a disc of its own. Each is integrated exactly over the square of a pixel; the
/// radius is at most 40. Cost grows with its square: keep wide halos to small frames.
BlurKernel blur_kernel(const BlurSettings& settings);

/// Standard deviation of the kernel along x and along y, without its halo.
double spread_px(const BlurSettings& settings);

/// out = kernel * in, both with `channels` samples a pixel by rows; `in` lies on `out_rect` grown by the
/// kernel's radius on all sides, also beyond the frame. Every sample is the sum of the same products in the
/// same order, whatever the tile.
void convolve(const BlurKernel& kernel, std::span<const double> in, Rect out_rect, int channels,
              std::span<double> out);

}  // namespace weft::simulator
