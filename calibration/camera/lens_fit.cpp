// SPDX-License-Identifier: Apache-2.0
#include "calibration/camera/lens_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <utility>

#include "calibration/camera/bundle.h"
#include "calibration/camera/opencv_camera.h"

#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

using Terms = std::vector<std::string>;

constexpr std::size_t kFolds = 5;
constexpr double kStandardErrors = 2;
constexpr double kStretchSigmas = 4, kLeastStretch = 5e-4;
constexpr double kGoodMisfit_px = 0.2;  ///< a board on the table that misses by less is flat

Terms with(Terms terms, const Terms& more) {
  terms.insert(terms.end(), more.begin(), more.end());
  return terms;
}

std::string join(const Terms& terms) {
  std::string text;
  for (const std::string& term : terms) text += (text.empty() ? "" : " ") + term;
  return text;
}

Error too_alike(const std::string& why) {
  return {ErrorKind::kBadData, "the boards do not tell focal length from distance",
          "photographs of the board", why,
          "photograph the board tilted by 20 to 40 degrees to different sides"};
}

// Where everything is, as OpenCV finds it; nothing where it finds nothing.
std::optional<Bundle> start_of(const std::vector<const BoardView*>& views, Size size, std::size_t table,
                               double thickness_mm) {
  std::vector<std::vector<cv::Point3f>> places;
  std::vector<std::vector<cv::Point2f>> seen;
  for (const BoardView* view : views) {
    places.emplace_back();
    seen.emplace_back();
    for (const BoardCorner& c : view->corners) {
      places.back().emplace_back(static_cast<float>(c.u_mm), static_cast<float>(c.v_mm), 0.0F);
      seen.back().emplace_back(static_cast<float>(c.px.x), static_cast<float>(c.px.y));
    }
  }
  cv::Mat matrix, lens;
  std::vector<cv::Mat> turns, shifts;
  try {
    cv::calibrateCamera(places, seen, {size.width, size.height}, matrix, lens, turns, shifts,
                        cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST,
                        {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 60, 1e-8});
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  Bundle bundle;
  bundle.camera.size = size;
  bundle.camera.fx = matrix.at<double>(0, 0), bundle.camera.fy = matrix.at<double>(1, 1);
  bundle.camera.cx = matrix.at<double>(0, 2), bundle.camera.cy = matrix.at<double>(1, 2);
  bundle.camera.k1 = lens.at<double>(0), bundle.camera.k2 = lens.at<double>(1);
  for (std::size_t i = 0; i < views.size(); ++i) {
    bundle.camera_from_board.push_back(pose_of(turns[i], shifts[i]));
    bundle.board_z_mm.push_back(0);
  }
  // The board on the table is counted from the table's frame, so that its pose is that of the rig.
  bundle.board_z_mm[table] = thickness_mm;
  bundle.camera_from_board[table] =
      bundle.camera_from_board[table] * Pose{Pose().rotation, {0, 0, -thickness_mm}};
  return bundle;
}

// The boards of all folds but one, and where they are.
std::vector<const BoardView*> without_fold(const std::vector<const BoardView*>& views, const Bundle& bundle,
                                           std::size_t fold, Bundle& left) {
  std::vector<const BoardView*> others;
  left.camera = bundle.camera;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i % kFolds == fold) continue;
    others.push_back(views[i]);
    left.camera_from_board.push_back(bundle.camera_from_board[i]);
    left.board_z_mm.push_back(bundle.board_z_mm[i]);
  }
  return others;
}

// Squared error of each board by cameras that were fitted to the others.
std::optional<std::vector<double>> held_out(const std::vector<const BoardView*>& views, const Bundle& start,
                                            const Terms& terms) {
  std::vector<double> squares(views.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    Bundle fitted;
    const std::vector<const BoardView*> others = without_fold(views, start, fold, fitted);
    if (!fit(others, terms, fitted)) return std::nullopt;
    for (std::size_t i = fold; i < views.size(); i += kFolds) {
      const auto sum = squares_with_pose_fitted(*views[i], fitted.camera, start.camera_from_board[i],
                                                start.board_z_mm[i], fitted.log_stretch);
      if (!sum) return std::nullopt;
      squares[i] = *sum;
    }
  }
  return squares;
}

// Mean fall from one list to the other, in standard errors of that mean over boards.
double better_by(const std::vector<double>& before, const std::vector<double>& after) {
  const auto n = static_cast<double>(before.size());
  double mean = 0, variance = 0;
  for (std::size_t i = 0; i < before.size(); ++i) mean += (before[i] - after[i]) / n;
  for (std::size_t i = 0; i < before.size(); ++i)
    variance += std::pow(before[i] - after[i] - mean, 2) / (n - 1);
  return variance > 0 ? mean / std::sqrt(variance / n) : 0;
}

// Distortion terms by cross-validation: what has earned its place step by step.
std::optional<Terms> choose_terms(const std::vector<const BoardView*>& views, const Bundle& start,
                                  std::vector<LensTrial>& trials) {
  const auto corners = static_cast<double>(
      std::accumulate(views.begin(), views.end(), std::size_t{0},
                      [](std::size_t n, const BoardView* v) { return n + v->corners.size(); }));
  const auto tried = [&](const Terms& terms, const std::vector<double>& squares) {
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    trials.push_back({join(terms), std::sqrt(sum / corners), 0, "", false});
  };
  Terms chosen = {"k1", "k2"};
  auto error = held_out(views, start, chosen);
  if (!error) return std::nullopt;
  tried(chosen, *error);
  trials.back().chosen = true;
  std::vector<Terms> candidates = {{"p1", "p2"}, {"k3"}};
  while (!candidates.empty()) {
    std::size_t best = candidates.size();
    double best_gain = kStandardErrors;
    std::vector<double> best_error;
    const std::size_t first = trials.size();
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      const auto squares = held_out(views, start, with(chosen, candidates[c]));
      if (!squares) continue;
      tried(with(chosen, candidates[c]), *squares);
      trials.back().than = join(chosen);
      trials.back().better_by = better_by(*error, *squares);
      if (trials.back().better_by <= best_gain) continue;
      best = c, best_gain = trials.back().better_by, best_error = *squares;
    }
    if (best == candidates.size()) break;
    chosen = with(chosen, candidates[best]);
    error = best_error;
    for (std::size_t t = 0; t < trials.size(); ++t)
      trials[t].chosen = t >= first && trials[t].terms == join(chosen);
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return chosen;
}

// Noise of a corner along x or y, as the residuals of a fit with k1 and k2 show it.
double sigma_of(const std::vector<const BoardView*>& views, const Bundle& bundle) {
  double squares = 0, freedom = -6;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const PixelPoint& r : residuals_of(*views[i], bundle.camera, bundle.camera_from_board[i],
                                            bundle.board_z_mm[i], bundle.log_stretch)) {
      squares += r.x * r.x + r.y * r.y;
      freedom += 2;
    }
    freedom -= 6;
  }
  return std::sqrt(squares / freedom);
}

// Whether held-out boards are better predicted with a term of the print than without.
bool predicts_better(const std::vector<const BoardView*>& views, const Bundle& start, const Terms& lens) {
  const auto before = held_out(views, start, lens), after = held_out(views, start, with(lens, {kLogStretch}));
  return before && after && better_by(*before, *after) > kStandardErrors;
}

// The print's stretch as these boards show it; `bundle`, of k1 and k2, is with it where it is used. What a
// lens that is not centred does to boards is no stretch.
PrintStretch stretch_of(const std::vector<const BoardView*>& views, Bundle& bundle) {
  const Terms lens = {"k1", "k2", "p1", "p2"}, terms = with(lens, {kLogStretch});
  Bundle stretched = bundle;
  PrintStretch print = {0, std::numeric_limits<double>::infinity(), false};
  if (!fit(views, terms, stretched)) return print;
  const double sigma = stretch_sigma(views, terms, stretched, sigma_of(views, stretched));
  if (!std::isfinite(sigma)) return print;
  print = {std::expm1(stretched.log_stretch), sigma, false};
  print.is_used = std::abs(print.share) > std::max(kStretchSigmas * sigma, kLeastStretch) &&
                  predicts_better(views, bundle, lens);
  if (!print.is_used) return print;
  stretched = bundle;
  print.is_used = fit(views, {"k1", "k2", kLogStretch}, stretched);
  if (print.is_used) bundle = stretched;
  return print;
}

// Gives corners the places where they were printed; by what they were stretched.
double stretch(std::vector<BoardView>& views, Bundle& bundle) {
  for (BoardView& view : views) {
    for (BoardCorner& corner : view.corners) {
      const Vec3 place = place_of(corner, 0, bundle.log_stretch);
      corner.u_mm = place.x, corner.v_mm = place.y;
    }
  }
  return std::exchange(bundle.log_stretch, 0);
}

Result<void> check_focal(const CameraModel& camera, const ParameterCovariance& covariance,
                         const LensOptions& options) {
  const double sigma =
      propagated(camera, covariance, [](const CameraModel& c) { return std::sqrt(c.fx * c.fy); });
  const double share = sigma / camera.fx;
  if (share <= options.most_focal_sigma) return {};  // false for what is not a number, too
  return too_alike(
      fmt::format("the predicted standard deviation of the focal length is {:.2f} percent, and {:.2f} are "
                  "allowed",
                  100 * share, 100 * options.most_focal_sigma));
}

Error too_few(std::size_t usable, std::size_t needed, const std::string& left_out) {
  return {ErrorKind::kBadData, "too few photographs of the board", "photographs of the board",
          fmt::format("{} can be used, and {} are needed{}", usable, needed, left_out),
          "take 15 in different places of the frame, tilted by 20 to 40 degrees to different sides"};
}

std::size_t needed(const LensOptions& options) {
  return std::max<std::size_t>(options.least_boards, 3);
}

Result<void> check_views(std::span<const BoardView> views, const LensOptions& options) {
  if (views.size() < needed(options)) return too_few(views.size(), needed(options), "");
  for (const BoardView& view : views) {
    if (view.corners.size() >= 8) continue;
    return Error{ErrorKind::kBadData, "a board shows too few corners", view.name,
                 fmt::format("{} were found, and 8 are needed", view.corners.size()),
                 "leave the photograph out"};
  }
  return {};
}

LensFit facts_of(std::span<const BoardView> views, const std::vector<bool>& used, const Bundle& bundle,
                 std::size_t table_of_used, const Terms& terms, double thickness_mm) {
  LensFit out;
  std::vector<const BoardView*> kept;
  std::size_t next = 0;
  const Pose rig_from_camera = inverse(bundle.camera_from_board[table_of_used]);
  double squares = 0;
  std::size_t corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    BoardFit board;
    board.used = used[i];
    Pose camera_from_board;
    double z_mm = 0;
    if (used[i]) {
      camera_from_board = bundle.camera_from_board[next];
      z_mm = bundle.board_z_mm[next++];
      kept.push_back(&views[i]);
    } else {
      camera_from_board = pose_by_opencv(views[i], bundle.camera);
    }
    board.residual_px = residuals_of(views[i], bundle.camera, camera_from_board, z_mm);
    board.rms_px = rms_of(board.residual_px);
    if (used[i]) {
      squares += std::pow(board.rms_px, 2) * static_cast<double>(views[i].corners.size());
      corners += views[i].corners.size();
    }
    board.rig_from_board = rig_from_camera * camera_from_board;
    if (z_mm != 0) board.rig_from_board.translation_mm = board.rig_from_board({0, 0, thickness_mm});
    out.boards.push_back(std::move(board));
  }
  const double freedom = 2.0 * static_cast<double>(corners) - 4 - static_cast<double>(terms.size()) -
                         6 * static_cast<double>(kept.size());
  out.rms_px = std::sqrt(squares / static_cast<double>(corners));
  out.corner_sigma_px = std::sqrt(squares / freedom);
  out.camera = bundle.camera;
  out.camera.camera_from_rig_rotation = bundle.camera_from_board[table_of_used].rotation;
  out.camera.camera_from_rig_translation_mm = bundle.camera_from_board[table_of_used].translation_mm;
  out.covariance = covariance_of(kept, terms, bundle, table_of_used, out.corner_sigma_px);
  return out;
}

// Says in `used` which boards fit the others; false where one does not and is to be left out.
Result<bool> leave_out_misfits(const std::vector<BoardView>& views, const Bundle& bundle,
                               const LensOptions& options, std::vector<bool>& used) {
  std::vector<double> rms;
  for (std::size_t i = 0; i < views.size(); ++i)
    rms.push_back(
        rms_of(residuals_of(views[i], bundle.camera, bundle.camera_from_board[i], bundle.board_z_mm[i])));
  const double most = options.most_misfit * median(rms);
  for (std::size_t i = 0; i < views.size(); ++i)
    used[i] = rms[i] <= (i == options.table ? std::max(most, kGoodMisfit_px) : most);
  if (!used[options.table]) {
    return Error{ErrorKind::kBadData, "the board on the table does not fit the others",
                 views[options.table].name,
                 fmt::format("its corners miss by {:.2f} pixels, the others by {:.2f}", rms[options.table],
                             median(rms)),
                 "lay the board flat and photograph it again"};
  }
  const auto left = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  if (left == used.size()) return true;
  if (left >= needed(options)) return false;
  std::string misfits;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!used[i])
      misfits += fmt::format("; {}: its corners miss by {:.2f} pixels, the median is {:.2f} (bent or moved?)",
                             views[i].name, rms[i], median(rms));
  }
  return too_few(left, needed(options), misfits);
}

}  // namespace

Result<LensFit> fit_lens(std::span<const BoardView> views, Size size, const LensOptions& options) {
  if (const Result<void> ok = check_views(views, options); !ok) return ok.error();
  std::vector<bool> used(views.size(), true);
  for (bool again = false;; again = true) {
    std::vector<BoardView> printed(views.begin(), views.end());
    std::vector<const BoardView*> kept;
    std::size_t table = 0;
    for (std::size_t i = 0; i < printed.size(); ++i) {
      if (!used[i]) continue;
      if (i == options.table) table = kept.size();
      kept.push_back(&printed[i]);
    }
    std::optional<Bundle> bundle = start_of(kept, size, table, options.thickness_mm);
    if (!bundle || !fit(kept, {"k1", "k2"}, *bundle)) return too_alike("no camera could be fitted to them");
    PrintStretch print = stretch_of(kept, *bundle);
    double log_stretch = stretch(printed, *bundle);

    if (!again) {  // boards that do not fit the others go, once
      const Result<bool> all_fit = leave_out_misfits(printed, *bundle, options, used);
      if (!all_fit) return all_fit.error();
      if (!*all_fit) continue;
    }
    const Terms of_print = print.is_used ? Terms{kLogStretch} : Terms{};
    // More terms only add to what is not known.
    const ParameterCovariance least =
        covariance_of(kept, with({"k1", "k2"}, of_print), *bundle, table, sigma_of(kept, *bundle));
    if (const Result<void> ok = check_focal(bundle->camera, least, options); !ok) return ok.error();
    std::vector<LensTrial> trials;
    const std::optional<Terms> lens = choose_terms(kept, *bundle, trials);
    const Terms terms = lens ? with(*lens, of_print) : of_print;
    if (!lens || !fit(kept, terms, *bundle)) return too_alike("no camera could be fitted to parts of them");
    log_stretch += stretch(printed, *bundle);
    LensFit out = facts_of(printed, used, *bundle, table, terms, options.thickness_mm);
    if (print.is_used)
      print = {std::expm1(log_stretch), stretch_sigma(kept, terms, *bundle, out.corner_sigma_px), true};
    out.print = print;
    out.trials = std::move(trials);
    if (const Result<void> ok = check_focal(out.camera, out.covariance, options); !ok) return ok.error();
    return out;
  }
}

CameraModel changed(CameraModel camera, const std::string& parameter, double by) {
  if (double* number = number_of(camera, parameter)) {
    *number += by;
    return camera;
  }
  const auto axis = [&](char name) { return parameter.back() == name ? by : 0.0; };
  const Vec3 along = {axis('x'), axis('y'), axis('z')};
  const bool turns = parameter.starts_with("camera_from_rig_rotation");
  const Pose pose = moved({camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm},
                          turns ? along : Vec3{}, turns ? Vec3{} : along);
  camera.camera_from_rig_rotation = pose.rotation;
  camera.camera_from_rig_translation_mm = pose.translation_mm;
  return camera;
}

double propagated(const CameraModel& camera, const ParameterCovariance& covariance,
                  const std::function<double(const CameraModel&)>& value) {
  const std::size_t n = covariance.parameters.size();
  std::vector<double> slope;
  for (const std::string& parameter : covariance.parameters) {
    const double h = step_of(parameter);
    slope.push_back((value(changed(camera, parameter, h)) - value(changed(camera, parameter, -h))) / (2 * h));
  }
  double variance = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) variance += slope[i] * covariance.matrix[i * n + j] * slope[j];
  }
  return std::sqrt(variance);
}

ParameterCovariance lens_bound(const CameraModel& camera, std::span<const Pose> rig_from_board,
                               std::span<const BoardView> views, std::size_t table,
                               const std::vector<std::string>& distortion, double corner_sigma_px) {
  const Pose camera_from_rig = {camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm};
  Bundle bundle;
  bundle.camera = camera;
  std::vector<const BoardView*> all;
  for (std::size_t i = 0; i < views.size(); ++i) {
    all.push_back(&views[i]);
    bundle.camera_from_board.push_back(i == table ? camera_from_rig : camera_from_rig * rig_from_board[i]);
    bundle.board_z_mm.push_back(i == table ? rig_from_board[i].translation_mm.z : 0);
  }
  return covariance_of(all, distortion, bundle, table, corner_sigma_px);
}

std::size_t part_of_frame(const PixelPoint& px, Size size, int columns, int rows) {
  const int i = std::clamp(static_cast<int>((px.x + 0.5) * columns / size.width), 0, columns - 1);
  const int j = std::clamp(static_cast<int>((px.y + 0.5) * rows / size.height), 0, rows - 1);
  return static_cast<std::size_t>(j * columns + i);
}

std::vector<int> corner_counts(std::span<const BoardView> views, Size size, int columns, int rows) {
  std::vector<int> counts(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (const BoardView& view : views) {
    for (const BoardCorner& corner : view.corners) ++counts[part_of_frame(corner.px, size, columns, rows)];
  }
  return counts;
}

}  // namespace weft::calibration
