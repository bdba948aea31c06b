// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <cmath>

#include "bench/oracles/board_views.h"
#include "bench/oracles/oracle_rig.h"
#include "calibration/camera/lens_fit.h"
#include "calibration/color/color_fit.h"
#include "calibration/lights/paper_model.h"
#include "calibration/response/photon_transfer.h"
#include "core/image/color_spaces.h"
#include "core/rig/camera.h"
#include "torture/hard_case.h"

namespace weft::torture {
namespace {

/// As Result has it: refused, or how far off the answer is.
template <typename Value, typename Off>
void judge(HardCase& hard, const Result<Value>& answer, const Off& off) {
  if (answer) {
    hard.ours = off(*answer);
  } else {
    hard.flag = "refused: " + answer.error().what;
  }
}

HardCase wide_lens() {
  CameraModel camera = overhead_camera({1600, 1200}, 600, 1);
  camera.k1 = -0.3;
  camera.k2 = 0.1;
  const double slope = 0.9 / std::sqrt(2.0);  // from the axis, by x and by y
  const Vec3 truth = {600 * slope, -600 * slope, 0}, seen = project(camera, truth);
  // As OpenCV's undistortPoints has it: five rounds.
  const double xd = (seen.x - camera.cx) / camera.fx, yd = (seen.y - camera.cy) / camera.fy;
  double x = xd, y = yd;
  for (int round = 0; round < 5; ++round) {
    const double r2 = x * x + y * y, stretch = 1 + camera.k1 * r2 + camera.k2 * r2 * r2;
    x = xd / stretch;
    y = yd / stretch;
  }
  const double pixels_per_mm = camera.fx / 600;
  return {.stage = "calibration",
          .what = "the corner of a wide lens, its distortion undone",
          .unit = "pixels",
          .plain = camera.fx * std::hypot(x - slope, y - slope),
          .ours = pixels_per_mm * length(point_on_plane(camera, seen.x, seen.y, 0) - truth),
          .within = 1e-6};
}

/// f^2 = -(h11 h12 + h21 h22) / (h31 h32) of the homography of one board (Zhang, PAMI 2000), the principal
/// point being known.
std::optional<double> focal_of(const calibration::BoardView& view, const CameraModel& camera) {
  Eigen::MatrixXd a(2 * view.corners.size(), 8);
  Eigen::VectorXd b(a.rows());
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    const auto& [u, v, px] = view.corners[i];
    const double x = px.x - camera.cx, y = px.y - camera.cy;
    const auto row = static_cast<Eigen::Index>(2 * i);
    a.row(row) << u, v, 1, 0, 0, 0, -x * u, -x * v;
    a.row(row + 1) << 0, 0, 0, u, v, 1, -y * u, -y * v;
    b[row] = x;
    b[row + 1] = y;
  }
  const Eigen::VectorXd h = a.householderQr().solve(b);
  const double square = -(h[0] * h[1] + h[3] * h[4]) / (h[6] * h[7]);
  return square > 0 ? std::optional(std::sqrt(square)) : std::nullopt;
}

HardCase flat_boards() {
  test::BoardRig rig;
  rig.camera.k1 = rig.camera.k2 = 0;
  rig.boards = 6;
  rig.tilts_deg = {1};
  const auto views = test::views_of(rig, 0.1, 1);
  const auto focal = focal_of(views[1], rig.camera);
  HardCase hard = {.stage = "calibration",
                   .what = "boards within a degree of flat to the camera",
                   .unit = "% of the focal length",
                   .plain = focal ? std::optional(100 * std::abs(*focal / rig.camera.fx - 1)) : std::nullopt,
                   .ours = {},
                   .within = 0.3,
                   .must_say = "refused"};
  judge(hard, calibration::fit_lens(views, rig.camera.size, {}),
        [&](const auto& fit) { return 100 * std::abs(fit.camera.fx / rig.camera.fx - 1); });
  return hard;
}

HardCase grey_chart() {
  test::Random random(3);
  std::vector<calibration::ChartSample> samples(24);
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero(), squares = products;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double grey = 0.03 + 0.035 * static_cast<double>(i);
    Eigen::Vector3d seen, known;
    for (Eigen::Index c = 0; c < 3; ++c) {
      samples[i].reference[static_cast<std::size_t>(c)] = known[c] = grey;
      samples[i].camera[static_cast<std::size_t>(c)] = seen[c] = grey * (1 + 1e-3 * random.normal());
    }
    products += known * seen.transpose();
    squares += seen * seen.transpose();
  }
  const Rgb red = {0.4, 0.05, 0.05};
  const auto off = [&](const Eigen::Vector3d& shown) {
    return calibration::ciede2000_of({shown[0], shown[1], shown[2]}, red);
  };
  HardCase hard = {.stage = "calibration",
                   .what = "a chart that has greys alone, then a red cloth",
                   .unit = "CIEDE2000",
                   .plain = off(products * squares.inverse() * Eigen::Vector3d(red[0], red[1], red[2])),
                   .ours = {},
                   .within = 1,
                   .must_say = "refused"};
  judge(hard, calibration::fit_color(samples, calibration::ChartLight::kEven, false), [&](const auto& fit) {
    const Vec3 shown = fit.rec709_from_camera * Vec3{red[0], red[1], red[2]};
    return off({shown.x, shown.y, shown.z});
  });
  return hard;
}

HardCase narrow_exposures() {
  constexpr double kElectrons = 4, kFull = 15000, kRead = 3;
  test::Random random(11);
  std::vector<calibration::TransferPoint> points;
  Eigen::MatrixXd a(60, 2);
  Eigen::VectorXd b(60);
  for (int i = 0; i < 60; ++i) {
    const double v = 0.40 + 0.0004 * i, variance = kRead * kRead + v * kFull / kElectrons;
    const double measured = variance * (1 + std::sqrt(2.0 / 1000) * random.normal());
    points.push_back({i % 3, v, measured, 1000});
    a.row(i) << v * kFull, 1;
    b[i] = measured;
  }
  const Eigen::Vector2d line = a.householderQr().solve(b);
  HardCase hard = {.stage = "calibration",
                   .what = "a sensor's noise from exposures that are nearly alike",
                   .unit = "% of the gain",
                   .plain = 100 * std::abs(1 / line[0] / kElectrons - 1),
                   .ours = {},
                   .within = 5,
                   .must_say = "refused"};
  judge(hard, calibration::fit_photon_transfer(points, {}, kFull),
        [&](const auto& fit) { return 100 * std::abs(fit.electrons_per_count / kElectrons - 1); });
  return hard;
}

HardCase led_below_sheet() {
  NearLight led;
  led.position_mm = {200, 0, -0.1};
  led.aim = {-1, 0, 0};
  const Vec3 normal = {0, 0, 1}, to_led = led.position_mm;
  const double plain = std::log(dot(normal, to_led) / length(to_led)) - 2 * std::log(length(to_led));
  const auto ours = calibration::paper_term({{0, 0, 600}, {0, 0, -1}}, led, {}, {});
  return {.stage = "calibration",
          .what = "the log of what a LED 0.1 mm below the plane of the sheet gives",
          .unit = "of the log",
          .plain = std::isfinite(plain) ? std::optional(std::abs(plain)) : std::nullopt,
          .ours = ours ? std::optional(ours->log_value) : std::nullopt,
          .flag = ours ? "" : "not lit",
          .within = 0,
          .must_say = "not lit"};
}

HardCase black_patch() {
  const Xyz black = {0, 0, 0};
  const double plain = black[0] / (black[0] + black[1] + black[2]);
  const Xyy ours = xyy_of_xyz(black), white = xyy_of_xyz(kWhiteD65);
  return {.stage = "calibration",
          .what = "the chromaticity of a black patch",
          .unit = "of x and y",
          .plain = std::isfinite(plain) ? std::optional(std::abs(plain - white[0])) : std::nullopt,
          .ours = std::hypot(ours[0] - white[0], ours[1] - white[1]),
          .within = 1e-12};
}

}  // namespace

std::vector<HardCase> hard_calibrations() {
  return {wide_lens(), flat_boards(), grey_chart(), narrow_exposures(), led_below_sheet(), black_patch()};
}

}  // namespace weft::torture
