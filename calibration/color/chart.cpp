// SPDX-License-Identifier: Apache-2.0
#include "calibration/color/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>
#include <optional>
#include <utility>

#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

constexpr int kLargestSide = 1400;  // of the picture that is searched
constexpr double kWhiteQuantile = 0.995;
constexpr double kMiddle = 0.5;  // of a patch's side that is read
constexpr double kLeastCorrelation = 0.8;
constexpr double kDarkest = 0.005;  // of white: below it, logarithms say nothing
// mcc's box has a margin of a tenth of a patch around patches that stand 1.1 of their side apart.
constexpr double kBoxWidth = 16.75, kBoxHeight = 11.25, kBoxMargin = 0.25;

cv::Matx33d homography(const std::array<cv::Point2f, 4>& from, const std::array<cv::Point2f, 4>& to) {
  return cv::getPerspectiveTransform(from.data(), to.data());
}

std::array<double, 2> mapped(const cv::Matx33d& h, double x, double y) {
  const cv::Vec3d p = h * cv::Vec3d(x, y, 1);
  return {p[0] / p[2], p[1] / p[2]};
}

cv::Point2f point(const std::array<double, 2>& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1])};
}

// NaN where no sample is finite.
double white_of(const Image<float>& rgb, int channel) {
  std::vector<float> values;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(rgb.size().pixels()) / 4e5)));
  for (int y = 0; y < rgb.height(); y += step) {
    for (int x = 0; x < rgb.width(); x += step) {
      values.push_back(rgb(x, y, channel));
    }
  }
  return static_cast<double>(lower_quantile(finite(std::move(values)), kWhiteQuantile));
}

// 8-bit BGR with display values, every `step`th pixel as a mean of its square.
cv::Mat display_of(const Image<float>& rgb, int step, const Rgb& white) {
  cv::Mat picture(rgb.height() / step, rgb.width() / step, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      Rgb mean = {};
      for (std::size_t c = 0; c < 3; ++c) {
        for (int j = 0; j < step; ++j) {
          for (int i = 0; i < step; ++i) {
            const double v = static_cast<double>(rgb(x * step + i, y * step + j, static_cast<int>(c)));
            mean[c] += std::isfinite(v) ? std::clamp(v / white[c], 0.0, 1.0) : 1.0;
          }
        }
        mean[c] /= step * step;
      }
      const Rgb display = srgb_of_rec709(mean);
      for (int c = 0; c < 3; ++c) {
        picture.at<cv::Vec3b>(y, x)[2 - c] =
            static_cast<std::uint8_t>(std::lround(255 * display[static_cast<std::size_t>(c)]));
      }
    }
  }
  return picture;
}

Error no_chart(std::string why) {
  return {ErrorKind::kBadData, "no colour chart was found", "picture", std::move(why),
          "let the chart fill more of the frame, or name its corners with --corners"};
}

// Corners of the chart that mcc finds; none where there is none. Its own choice of parameters misses charts
// whose patches stand closer than 1.25 of their side, and those with other squares in the picture.
std::vector<cv::Point2f> box_of(const cv::Mat& picture) {
  for (const float pitch : {1.1F, 1.25F}) {
    const auto parameters = cv::mcc::DetectorParameters::create();
    parameters->B0factor = pitch;
    parameters->minInterCheckerDistance = 100000;
    const auto detector = cv::mcc::CCheckerDetector::create();
    if (detector->process(picture, cv::mcc::MCC24, 1, false, parameters)) {
      return detector->getBestColorChecker()->getBox();
    }
  }
  return {};
}

// Pixels of one patch, and means of its four quarters.
struct PatchSums {
  std::array<double, 3> sum = {}, square = {};
  std::array<double, 4> quarter = {}, quarter_count = {};
  double count = 0, full = 0;
};

PatchReading reading_of(const PatchSums& s) {
  PatchReading reading;
  const double all = s.count + s.full;
  reading.full_share = all > 0 ? s.full / all : 0;
  if (s.count == 0) return reading;
  for (std::size_t c = 0; c < 3; ++c) {
    reading.mean[c] = s.sum[c] / s.count;
    const double variance = std::max(s.square[c] / s.count - reading.mean[c] * reading.mean[c], 0.0);
    reading.sigma[c] = std::sqrt(variance / s.count);
  }
  double least = 1e300, most = -1e300;
  for (std::size_t q = 0; q < 4; ++q) {
    if (s.quarter_count[q] == 0) continue;
    least = std::min(least, s.quarter[q] / s.quarter_count[q]);
    most = std::max(most, s.quarter[q] / s.quarter_count[q]);
  }
  if (reading.mean[1] > 0 && most >= least) reading.unevenness = (most - least) / reading.mean[1];
  return reading;
}

Error bad_corners(std::string why) {
  return {ErrorKind::kUsage, "these are not the corners of a chart", "corners", std::move(why),
          "name the outer corners of the first and the last patch of the first row and of the last and the "
          "first of the last, in pixels"};
}

// Why these are not the corners of a chart with `fewest` patches along its shorter side.
std::optional<std::string> fault_of(const ChartCorners& corners, Size picture, int fewest) {
  double turn = 0;  // of the outline: the sign of every corner must agree
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % 4], &c = corners[(i + 2) % 4];
    const bool inside = a[0] >= 0 && a[1] >= 0 && a[0] <= picture.width - 1 && a[1] <= picture.height - 1;
    if (!inside) {  // nor is NaN
      return fmt::format("({:.0f}, {:.0f}) is outside the picture of {} x {} pixels", a[0], a[1],
                         picture.width, picture.height);
    }
    const double cross = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    if (cross == 0 || (i > 0 && (cross > 0) != (turn > 0))) return "their outline is not convex";
    turn = cross;
    if (std::hypot(b[0] - a[0], b[1] - a[1]) < 4.0 * fewest) return "they are too close";
  }
  return std::nullopt;
}

// Chart units: a patch and its gap are 1; the outer edges of the patches are the outline.
cv::Matx33d chart_from_picture(const ChartCorners& corners, int columns, int rows) {
  const float w = static_cast<float>(columns - 1 + kPatchShare);
  const float h = static_cast<float>(rows - 1 + kPatchShare);
  return homography({point(corners[0]), point(corners[1]), point(corners[2]), point(corners[3])},
                    {cv::Point2f(0, 0), cv::Point2f(w, 0), cv::Point2f(w, h), cv::Point2f(0, h)});
}

void add_pixel(const Rgb& pixel, std::size_t quarter, PatchSums& s) {
  if (!std::all_of(pixel.begin(), pixel.end(), [](double p) { return std::isfinite(p); })) {
    ++s.full;
    return;
  }
  ++s.count;
  for (std::size_t c = 0; c < 3; ++c) {
    s.sum[c] += pixel[c];
    s.square[c] += pixel[c] * pixel[c];
  }
  s.quarter[quarter] += pixel[1];
  ++s.quarter_count[quarter];
}

// Over the middles of the patches.
std::vector<PatchSums> sums_of_patches(const Image<float>& rgb, const ChartCorners& corners,
                                       const cv::Matx33d& to_chart, int columns, int rows) {
  std::vector<PatchSums> sums(static_cast<std::size_t>(columns * rows));
  const auto [x0, x1] = std::minmax({corners[0][0], corners[1][0], corners[2][0], corners[3][0]});
  const auto [y0, y1] = std::minmax({corners[0][1], corners[1][1], corners[2][1], corners[3][1]});
  for (int y = static_cast<int>(y0); y <= static_cast<int>(y1); ++y) {
    for (int x = static_cast<int>(x0); x <= static_cast<int>(x1); ++x) {
      const auto [u, v] = mapped(to_chart, x, y);
      const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
      if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
      const double du = (u - column) / kPatchShare - 0.5, dv = (v - row) / kPatchShare - 0.5;
      if (std::max(std::abs(du), std::abs(dv)) > kMiddle / 2) continue;
      const auto quarter = static_cast<std::size_t>((du > 0 ? 1 : 0) + (dv > 0 ? 2 : 0));
      add_pixel({static_cast<double>(rgb(x, y, 0)), static_cast<double>(rgb(x, y, 1)),
                 static_cast<double>(rgb(x, y, 2))},
                quarter, sums[static_cast<std::size_t>(row * columns + column)]);
    }
  }
  return sums;
}

// Correlation over patches and channels of the logarithm of light, each channel about its mean.
double correlation(std::span<const PatchReading> patches, const ChartReference& reference,
                   int (*place)(int column, int row)) {
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    double brightest = 0;
    for (const PatchReading& p : patches) brightest = std::max(brightest, p.mean[c]);
    std::array<double, kChartPatches> x = {}, y = {};
    double mean_x = 0, mean_y = 0;
    for (int i = 0; i < kChartPatches; ++i) {
      const auto at = static_cast<std::size_t>(i);
      x[at] = std::log(std::max(patches[at].mean[c], kDarkest * brightest + 1e-12));
      const auto from = static_cast<std::size_t>(place(i % kChartColumns, i / kChartColumns));
      y[at] = std::log(std::max(reference[from][c], kDarkest));
      mean_x += x[at] / kChartPatches;
      mean_y += y[at] / kChartPatches;
    }
    for (std::size_t i = 0; i < kChartPatches; ++i) {
      if (patches[i].full_share > 0) continue;
      xy += (x[i] - mean_x) * (y[i] - mean_y);
      xx += (x[i] - mean_x) * (x[i] - mean_x);
      yy += (y[i] - mean_y) * (y[i] - mean_y);
    }
  }
  return xx > 0 ? xy / std::sqrt(xx * yy) : 0;
}

}  // namespace

Result<ChartCorners> find_chart(const Image<float>& rgb) {
  const int step = std::max(1, std::max(rgb.width(), rgb.height()) / kLargestSide);
  const Rgb white = {white_of(rgb, 0), white_of(rgb, 1), white_of(rgb, 2)};
  if (!std::ranges::all_of(white, [](double v) { return v > 0; }))
    return no_chart("the picture is black, or full everywhere");
  const cv::Mat picture = display_of(rgb, step, white);
  std::vector<cv::Point2f> box;
  try {
    box = box_of(picture);
  } catch (const cv::Exception& e) {
    return no_chart(fmt::format("OpenCV says {}", e.what()));
  }
  if (box.empty()) return no_chart("nothing in it looks like 6 x 4 patches");
  if (box.size() != 4) return no_chart("its outline is not a rectangle");
  const float w = kBoxWidth, h = kBoxHeight;
  const cv::Matx33d to_picture =
      homography({cv::Point2f(0, 0), cv::Point2f(w, 0), cv::Point2f(w, h), cv::Point2f(0, h)},
                 {box[0], box[1], box[2], box[3]});
  const double right = kBoxWidth - kBoxMargin, bottom = kBoxHeight - kBoxMargin;
  ChartCorners corners = {mapped(to_picture, kBoxMargin, kBoxMargin), mapped(to_picture, right, kBoxMargin),
                          mapped(to_picture, right, bottom), mapped(to_picture, kBoxMargin, bottom)};
  for (auto& corner : corners) {
    for (double& v : corner) v = (v + 0.5) * step - 0.5;
  }
  return corners;
}

Result<std::vector<PatchReading>> read_patches(const Image<float>& rgb, const ChartCorners& corners,
                                               int columns, int rows) {
  if (const auto fault = fault_of(corners, rgb.size(), std::min(columns, rows))) return bad_corners(*fault);
  const cv::Matx33d to_chart = chart_from_picture(corners, columns, rows), to_picture = to_chart.inv();
  const std::vector<PatchSums> sums = sums_of_patches(rgb, corners, to_chart, columns, rows);
  std::vector<PatchReading> patches(sums.size());
  for (int i = 0; i < columns * rows; ++i) {
    const auto at = static_cast<std::size_t>(i);
    patches[at] = reading_of(sums[at]);
    patches[at].centre_px = mapped(to_picture, i % columns + kPatchShare / 2, i / columns + kPatchShare / 2);
    if (sums[at].count + sums[at].full < 4)
      return bad_corners(fmt::format("patch {} is under 4 pixels", i + 1));
  }
  return patches;
}

ChartSide side_of(std::span<const PatchReading> patches, const ChartReference& reference) {
  using Place = int (*)(int, int);
  constexpr int kLastColumn = kChartColumns - 1, kLastRow = kChartRows - 1;
  const std::array<std::pair<ChartSide, Place>, 4> sides = {
      {{ChartSide::kUpright, [](int x, int y) { return y * kChartColumns + x; }},
       {ChartSide::kUpsideDown,
        [](int x, int y) { return (kLastRow - y) * kChartColumns + kLastColumn - x; }},
       {ChartSide::kMirrored, [](int x, int y) { return y * kChartColumns + kLastColumn - x; }},
       {ChartSide::kMirrored, [](int x, int y) { return (kLastRow - y) * kChartColumns + x; }}}};
  ChartSide best = ChartSide::kNoChart;
  double most = kLeastCorrelation;
  for (const auto& [side, place] : sides) {
    const double r = correlation(patches, reference, place);
    if (r > most) {
      most = r;
      best = side;
    }
  }
  return best;
}

}  // namespace weft::calibration
