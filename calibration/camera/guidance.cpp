// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/guidance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "calibration/camera/normal_equations.h"
#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

const std::vector<std::string> kDistortion = {"k1", "k2", "p1", "p2"};
constexpr double kRadians = std::numbers::pi / 180;
constexpr double kFree = 0.015;    // of the frame's width stays free around a board
constexpr std::size_t kToFit = 3;  // views that tell more of a camera than its data sheet
constexpr double kFarOff = 3;      // times the focal length of the start, or a third: the fit went astray
constexpr int kGrid = 6;           // places over the frame at which the error is looked at
constexpr int kEachOf = 2;         // rows and columns of a candidate that are looked at

struct Priors {
  double centre = 0.05, radial = 0.3, tangential = 0.01;
};

/// What is known before, as information in corners of unit noise.
Matrix prior_information(const CameraModel& camera, double focal_sigma, double corner_sigma_px) {
  constexpr Priors kPriors;
  const double focal_px = focal_sigma * camera.fx, centre_px = kPriors.centre * camera.size.width;
  const std::array<double, 8> sigma = {focal_px,           focal_px,          centre_px,
                                       centre_px,          kPriors.radial,    kPriors.radial,
                                       kPriors.tangential, kPriors.tangential};
  Matrix information = Matrix::Zero(8, 8);
  for (Eigen::Index i = 0; i < 8; ++i)
    information(i, i) = std::pow(corner_sigma_px / sigma[static_cast<std::size_t>(i)], 2);
  return information;
}

Pose pose_of_camera(const CameraModel& camera) {
  return {camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm};
}

void stand_at(CameraModel& camera, const Pose& camera_from_rig) {
  camera.camera_from_rig_rotation = camera_from_rig.rotation;
  camera.camera_from_rig_translation_mm = camera_from_rig.translation_mm;
}

std::vector<const BoardView*> pointers_to(std::span<const BoardView> views) {
  std::vector<const BoardView*> pointers;
  for (const BoardView& view : views) pointers.push_back(&view);
  return pointers;
}

/// Camera and poses as the views have them so far.
Bundle known_so_far(const CameraModel& start, std::span<const BoardView> views) {
  Bundle bundle = {start, {}, std::vector<double>(views.size(), 0)};
  for (const BoardView& view : views) bundle.camera_from_board.push_back(pose_by_opencv(view, start));
  if (views.size() < kToFit) return bundle;
  Bundle fitted = bundle;
  const bool is_fit = fit(pointers_to(views), {"k1", "k2"}, fitted);
  const double times = fitted.camera.fx / start.fx;
  return is_fit && times < kFarOff && times > 1 / kFarOff ? fitted : bundle;
}

/// The board's inner corners, or every `each`th of a row and of the rows, as `camera` sees them in a pose.
BoardView view_of(const Board& board, const CameraModel& camera, const Pose& rig_from_board, int each) {
  BoardView view;
  for (int j = 1; j < board.squares_y; j += each) {
    for (int i = 1; i < board.squares_x; i += each) {
      const double u_mm = (i - 0.5 * board.squares_x) * board.square_mm;
      const double v_mm = (0.5 * board.squares_y - j) * board.square_mm;
      const Vec3 p = project(camera, rig_from_board({u_mm, v_mm, 0}));
      view.corners.push_back({u_mm, v_mm, {p.x, p.y}});
    }
  }
  return view;
}

std::array<Vec3, 4> print_of(const Board& board) {
  const double u = 0.5 * board.squares_x * board.square_mm, v = 0.5 * board.squares_y * board.square_mm;
  return {{{-u, v, 0}, {u, v, 0}, {u, -v, 0}, {-u, -v, 0}}};
}

bool is_in_frame(const Board& board, const CameraModel& camera, const Pose& rig_from_board) {
  const double free_px = kFree * camera.size.width;
  // A quarter of a square around them is white.
  for (const Vec3 corner : print_of(board)) {
    const double grown = 1 + 0.5 / std::min(board.squares_x, board.squares_y);
    const Vec3 p = project(camera, rig_from_board(grown * corner));
    if (!(p.z > 0 && p.x >= free_px && p.y >= free_px && p.x <= camera.size.width - 1 - free_px &&
          p.y <= camera.size.height - 1 - free_px))
      return false;
  }
  return true;
}

/// Information on the camera of one view after its own pose has followed.
Matrix information_of(const BoardView& view, const CameraModel& camera, const Pose& camera_from_board) {
  return reduced(
      normal_equations({&view}, camera_parameters(kDistortion), {camera, {camera_from_board}, {0}}));
}

/// How a place on the table follows camera and pose, at places all over the frame: two rows each.
Matrix place_slopes(const CameraModel& camera) {
  std::vector<std::string> names = camera_parameters(kDistortion);
  for (const char* group : {"camera_from_rig_rotation", "camera_from_rig_translation_mm"}) {
    for (const char* axis : {".x", ".y", ".z"}) names.push_back(std::string(group) + axis);
  }
  Matrix slopes(2 * kGrid * kGrid, static_cast<Eigen::Index>(names.size()));
  for (std::size_t p = 0; p < names.size(); ++p) {
    const double h = step_of(names[p]);
    const CameraModel up = changed(camera, names[p], h), down = changed(camera, names[p], -h);
    Eigen::Index row = 0;
    for (int j = 0; j < kGrid; ++j) {
      for (int i = 0; i < kGrid; ++i) {
        const double x = (i + 0.5) * camera.size.width / kGrid - 0.5,
                     y = (j + 0.5) * camera.size.height / kGrid - 0.5;
        const Vec3 by = (0.5 / h) * (point_on_plane(up, x, y, 0) - point_on_plane(down, x, y, 0));
        slopes(row++, static_cast<Eigen::Index>(p)) = by.x;
        slopes(row++, static_cast<Eigen::Index>(p)) = by.y;
      }
    }
  }
  return slopes;
}

/// What is predicted of a camera that is known by so much information.
class Forecaster {
 public:
  Forecaster(const CameraModel& camera, NormalEquations of_table, double sigma_px)
      : camera_(camera), of_table_(std::move(of_table)), slopes_(place_slopes(camera)), sigma_px_(sigma_px) {}

  LensForecast operator()(const Matrix& information) const {
    const Matrix covariance = solved(information, Matrix::Identity(information.rows(), information.cols()));
    const Matrix all = with_pose_of(of_table_, 0, covariance);
    const double places = (slopes_ * all).cwiseProduct(slopes_).sum() / (kGrid * kGrid);
    return {100 * sigma_px_ * std::sqrt(std::max(covariance(0, 0), covariance(1, 1))) / camera_.fx,
            sigma_px_ * std::sqrt(places)};
  }

 private:
  const CameraModel& camera_;
  NormalEquations of_table_;
  Matrix slopes_;
  double sigma_px_;
};

/// Poses in which the board is whole in the frame, as far out as they are asked to be or as the frame allows.
std::vector<BoardPose> candidates(const Board& board, const CameraModel& camera,
                                  const GuidanceOptions& options) {
  const Vec3 middle = point_on_plane(camera, 0.5 * camera.size.width, 0.5 * camera.size.height, 0);
  const Vec3 corner = point_on_plane(camera, 0, 0, 0);
  std::vector<BoardPose> poses;
  const auto add = [&](double tilt_deg, double azimuth_deg, double height_mm) {
    for (int j = -2; j <= 2; ++j) {
      for (int i = -2; i <= 2; ++i) {
        for (double out = 1; out > 0; out -= 0.05) {
          BoardPose pose;
          pose.tilt_deg = tilt_deg, pose.azimuth_deg = azimuth_deg, pose.height_mm = height_mm;
          pose.x_mm = middle.x + 0.5 * i * out * (corner.x - middle.x);
          pose.y_mm = middle.y + 0.5 * j * out * (corner.y - middle.y);
          pose = board_pose(board, camera, pose);
          if (!is_in_frame(board, camera, pose.rig_from_board)) continue;
          poses.push_back(pose);
          break;
        }
      }
    }
  };
  for (const double height_mm : {0.0, options.lift_mm}) {
    add(0, 0, height_mm);
    for (const double tilt_deg : {15.0, 30.0, options.most_tilt_deg}) {
      for (int side = 0; side < 8; ++side) add(tilt_deg, 45 * side, height_mm);
    }
  }
  return poses;
}

int parts_with(const std::vector<int>& corners) {
  return static_cast<int>(std::count_if(corners.begin(), corners.end(), [](int n) { return n > 0; }));
}

/// Parts of the frame that a view shows and nobody saw before.
int new_parts(const BoardView& view, const std::vector<int>& seen, Size size,
              const GuidanceOptions& options) {
  const std::vector<int> here = corner_counts({&view, 1}, size, options.columns, options.rows);
  int more = 0;
  for (std::size_t i = 0; i < here.size(); ++i) more += here[i] > 0 && seen[i] == 0 ? 1 : 0;
  return more;
}

bool is_met(const LensForecast& forecast, const GuidanceOptions& options) {
  return forecast.focal_percent <= options.asked_focal_percent && forecast.place_mm <= options.asked_place_mm;
}

/// How far both are from what is asked.
double missing(const LensForecast& forecast, const GuidanceOptions& options) {
  return std::hypot(forecast.focal_percent / options.asked_focal_percent,
                    forecast.place_mm / options.asked_place_mm);
}

/// 1 where two poses are the same, 0 from a tenth of the distance or 10 degrees apart.
double likeness(const Pose& a, const Pose& b) {
  const Mat3 between = (inverse(a) * b).rotation;
  const double cosine = 0.5 * (between[0][0] + between[1][1] + between[2][2] - 1);
  const double turned_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) / kRadians;
  const double moved = length(a.translation_mm - b.translation_mm) / std::abs(a.translation_mm.z);
  return std::max(0.0, 1 - std::max(turned_deg / 10, moved / 0.1));
}

/// The camera as far as it is known, above the board on the table or where `start` has it.
CameraModel standing_over_the_table(const Bundle& bundle, const CameraModel& start,
                                    std::optional<std::size_t> table, double thickness_mm) {
  CameraModel camera = bundle.camera;
  stand_at(camera, table ? bundle.camera_from_board[*table] * Pose{Pose().rotation, {0, 0, -thickness_mm}}
                         : pose_of_camera(start));
  return camera;
}

/// Residuals of the views, and how much each is like one before it.
void compare_views(std::span<const BoardView> views, const Bundle& bundle, BoardGuidance& guidance) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Pose& pose = bundle.camera_from_board[i];
    guidance.residuals_px.push_back(rms_of(residuals_of(views[i], bundle.camera, pose, 0)));
    double most = 0;
    for (std::size_t before = 0; before < i; ++before)
      most = std::max(most, likeness(pose, bundle.camera_from_board[before]));
    guidance.alike.push_back(most);
  }
}

double tilt_to_table_deg(const CameraModel& camera, const Pose& camera_from_board) {
  const Vec3 up = {0, 0, 1};
  return angle_deg(camera.camera_from_rig_rotation * up, camera_from_board.rotation * up);
}

/// Mean residuals of all corners in each part of the frame.
std::vector<PixelPoint> mean_residuals(std::span<const BoardView> views, const Bundle& bundle,
                                       const std::vector<int>& corners, const GuidanceOptions& options) {
  if (views.size() < kToFit) return {};
  std::vector<PixelPoint> means(corners.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto residuals = residuals_of(views[i], bundle.camera, bundle.camera_from_board[i], 0);
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      const std::size_t part =
          part_of_frame(views[i].corners[k].px, bundle.camera.size, options.columns, options.rows);
      means[part].x += residuals[k].x / corners[part];
      means[part].y += residuals[k].y / corners[part];
    }
  }
  return means;
}

/// What the residuals show; few of them are of the camera's errors too.
double corner_sigma(const std::vector<double>& residuals_px, const GuidanceOptions& options) {
  if (residuals_px.size() < kToFit) return options.corner_sigma_px;
  return std::clamp(median(residuals_px) / std::numbers::sqrt2, options.least_corner_sigma_px,
                    options.corner_sigma_px);
}

/// Candidates that nobody photographed yet.
std::vector<BoardPose> new_poses(const Board& board, const Bundle& bundle, const CameraModel& camera,
                                 const GuidanceOptions& options) {
  std::vector<BoardPose> poses = candidates(board, camera, options);
  std::erase_if(poses, [&](const BoardPose& pose) {
    const Pose here = pose_of_camera(camera) * pose.rig_from_board;
    return std::ranges::any_of(bundle.camera_from_board, [&](const Pose& before) {
      return likeness(here, before) > options.most_alike;
    });
  });
  return poses;
}

/// What views tell of a camera.
struct Known {
  double sigma_px = 0;
  Matrix information;
  NormalEquations of_table;
};

Known known_by(const Board& board, double thickness_mm, std::span<const BoardView> views,
               std::optional<std::size_t> table, const Bundle& bundle, const BoardGuidance& guidance,
               const GuidanceOptions& options) {
  const CameraModel& camera = guidance.camera;
  const double sigma_px = corner_sigma(guidance.residuals_px, options);
  const Pose camera_from_rig = pose_of_camera(camera);
  const Pose flat = {Pose().rotation, {0, 0, thickness_mm}};
  const BoardView on_table = table ? views[*table] : view_of(board, camera, flat, 1);
  Matrix information = prior_information(camera, options.start_focal_sigma, sigma_px);
  for (std::size_t i = 0; i < views.size(); ++i)
    information += information_of(views[i], camera, bundle.camera_from_board[i]);
  if (!table) information += information_of(on_table, camera, camera_from_rig * flat);
  return {sigma_px, std::move(information),
          normal_equations({&on_table}, camera_parameters(kDistortion),
                           {camera, {camera_from_rig}, {thickness_mm}})};
}

/// What a photograph in this pose would tell, by some of its corners.
Matrix information_in(const Board& board, const CameraModel& camera, const BoardPose& pose) {
  const BoardView some = view_of(board, camera, pose.rig_from_board, kEachOf);
  const double scale = static_cast<double>(board.corners()) / static_cast<double>(some.corners.size());
  return scale * information_of(some, camera, pose_of_camera(camera) * pose.rig_from_board);
}

/// The pose after which most is known, if it adds enough.
void choose_by_information(const Board& board, const std::vector<BoardPose>& poses, const Matrix& information,
                           const Forecaster& forecast, const GuidanceOptions& options,
                           BoardGuidance& guidance) {
  std::optional<BoardPose> best;
  LensForecast then = guidance.now;
  for (const BoardPose& pose : poses) {
    const LensForecast with_it = forecast(information + information_in(board, guidance.camera, pose));
    if (missing(with_it, options) >= missing(then, options)) continue;
    best = pose;
    then = with_it;
  }
  if (!best || missing(then, options) > (1 - options.worth) * missing(guidance.now, options)) return;
  guidance.next = best;
  guidance.then = then;
}

/// The pose that shows most parts of the frame in which nothing was seen.
void choose_by_coverage(const Board& board, const std::vector<BoardPose>& poses,
                        const GuidanceOptions& options, BoardGuidance& guidance) {
  int most = 0;
  for (const BoardPose& pose : poses) {
    const BoardView all = view_of(board, guidance.camera, pose.rig_from_board, 1);
    const int parts = new_parts(all, guidance.corners, guidance.camera.size, options);
    if (parts <= most) continue;
    most = parts;
    guidance.next = pose;
  }
}

}  // namespace

BoardPose board_pose(const Board& board, const CameraModel& camera, BoardPose pose) {
  const double a = pose.azimuth_deg * kRadians, t = pose.tilt_deg * kRadians;
  const Mat3 tilted = rotation_of(t * Vec3{-std::sin(a), std::cos(a), 0});
  double lowest = 0;
  for (const Vec3 corner : print_of(board)) lowest = std::min(lowest, (tilted * corner).z);
  pose.rig_from_board = {tilted, {pose.x_mm, pose.y_mm, pose.height_mm - lowest}};
  Vec3 raised;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 corner = pose.rig_from_board(print_of(board)[i]);
    const Vec3 p = project(camera, corner);
    pose.outline_px[i] = {p.x, p.y};
  }
  const double reach_mm = 0.5 * board.squares_y * board.square_mm;
  raised = project(camera, pose.rig_from_board.translation_mm - reach_mm * Vec3{std::cos(a), std::sin(a), 0});
  pose.raised_px = {raised.x, raised.y};
  return pose;
}

BoardGuidance guide_board(const Board& board, double thickness_mm, const CameraModel& start,
                          std::span<const BoardView> views, std::optional<std::size_t> table,
                          const GuidanceOptions& options) {
  const Bundle bundle = known_so_far(start, views);
  BoardGuidance guidance;
  guidance.camera = standing_over_the_table(bundle, start, table, thickness_mm);
  compare_views(views, bundle, guidance);
  for (const Pose& pose : bundle.camera_from_board)
    guidance.tilt_deg.push_back(tilt_to_table_deg(guidance.camera, pose));
  if (table) guidance.table_tilt_deg = tilt_to_table_deg(start, bundle.camera_from_board[*table]);
  guidance.corners = corner_counts(views, guidance.camera.size, options.columns, options.rows);
  guidance.parts_seen = parts_with(guidance.corners);
  guidance.mean_residual_px = mean_residuals(views, bundle, guidance.corners, options);

  const Known known = known_by(board, thickness_mm, views, table, bundle, guidance, options);
  const Forecaster forecast(guidance.camera, known.of_table, known.sigma_px);
  guidance.now = guidance.then = forecast(known.information);
  if (!table) return guidance;

  const bool is_known = is_met(guidance.now, options);
  const std::vector<BoardPose> poses = new_poses(board, bundle, guidance.camera, options);
  if (!is_known) choose_by_information(board, poses, known.information, forecast, options, guidance);
  if (!guidance.next) choose_by_coverage(board, poses, options, guidance);
  guidance.is_done = is_known && !guidance.next;
  return guidance;
}

std::vector<LensForecast> forecasts_ahead(const Board& board, double thickness_mm, const CameraModel& start,
                                          std::span<const BoardView> views, std::optional<std::size_t> table,
                                          int more, const GuidanceOptions& options) {
  const Bundle bundle = known_so_far(start, views);
  BoardGuidance guidance;
  guidance.camera = standing_over_the_table(bundle, start, table, thickness_mm);
  compare_views(views, bundle, guidance);
  Known known = known_by(board, thickness_mm, views, table, bundle, guidance, options);
  const Forecaster forecast(guidance.camera, known.of_table, known.sigma_px);
  std::vector<Matrix> candidates_tell;
  for (const BoardPose& pose : new_poses(board, bundle, guidance.camera, options))
    candidates_tell.push_back(information_in(board, guidance.camera, pose));
  std::vector<LensForecast> ahead = {forecast(known.information)};
  while (static_cast<int>(ahead.size()) <= more && !candidates_tell.empty()) {
    std::size_t best = 0;
    LensForecast then;
    for (std::size_t i = 0; i < candidates_tell.size(); ++i) {
      const LensForecast with_it = forecast(known.information + candidates_tell[i]);
      if (i > 0 && missing(with_it, options) >= missing(then, options)) continue;
      best = i;
      then = with_it;
    }
    known.information += candidates_tell[best];
    candidates_tell.erase(candidates_tell.begin() + static_cast<std::ptrdiff_t>(best));
    ahead.push_back(then);
  }
  return ahead;
}

}  // namespace weft::calibration
