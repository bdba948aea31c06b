// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/swatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/files.h"
#include "core/image_io/encode_image.h"
#include "report/downsampler.h"
#include "report/preview.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr int kSamplesAside = 256;  // a side
constexpr float kUnsolvedDeg = 180;
constexpr double kMostUnsolved = 0.05;
constexpr int kSwatchRows = 64;

struct Place {
  double x = 0, y = 0;
};

// How far the nearest side of a square about a place is from the rectangle.
double reach_to(const Rect& rect, Place from) {
  const double across = std::max(rect.x0 - from.x, from.x - rect.x1);
  const double down = std::max(rect.y0 - from.y, from.y - rect.y1);
  return std::max({across, down, 0.0});
}

struct Samples {
  View<const float> sigma;
  double step_x = 1, step_y = 1;  // pixels of the maps

  Samples(View<const float> sigma_deg, Size size)
      : sigma(sigma_deg),
        step_x(double(size.width) / sigma_deg.width()),
        step_y(double(size.height) / sigma_deg.height()) {}

  bool is_solved(int column, int row) const { return sigma(column, row) < kUnsolvedDeg; }
  Place place(int column, int row) const { return {(column + 0.5) * step_x, (row + 0.5) * step_y}; }

  Place middle(Place otherwise) const {
    Place sum;
    int solved = 0;
    for (int row = 0; row < sigma.height(); ++row) {
      for (int column = 0; column < sigma.width(); ++column) {
        if (!is_solved(column, row)) continue;
        const Place at = place(column, row);
        sum = {sum.x + at.x, sum.y + at.y};
        ++solved;
      }
    }
    return solved == 0 ? otherwise : Place{sum.x / solved, sum.y / solved};
  }

  // Half the side of the largest square about a place of which enough is solved.
  double reach(Place from, double most) const {
    const double step = std::max(step_x, step_y);
    std::vector<std::array<int, 2>> rings(static_cast<std::size_t>(most / step) + 2);  // all, unsolved
    for (int row = 0; row < sigma.height(); ++row) {
      for (int column = 0; column < sigma.width(); ++column) {
        const Place at = place(column, row);
        const double away = std::max(std::abs(at.x - from.x), std::abs(at.y - from.y));
        if (away > most) continue;
        auto& ring = rings[static_cast<std::size_t>(away / step)];
        ++ring[0];
        if (!is_solved(column, row)) ++ring[1];
      }
    }
    double reach = 0;
    int all = 0, unsolved = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
      all += rings[i][0];
      unsolved += rings[i][1];
      if (unsolved <= kMostUnsolved * all) reach = static_cast<double>(i + 1) * step;
    }
    return std::min(reach, most);
  }
};

Result<std::string> jpeg_of(const Image<float>& picture) {
  std::vector<std::uint8_t> samples;
  samples.reserve(static_cast<std::size_t>(picture.size().pixels()) * 3);
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      for (int p = 0; p < 3; ++p)
        samples.push_back(static_cast<std::uint8_t>(std::lround(255 * picture(x, y, p))));
    }
  }
  return encode_image(samples, picture.size(), 3, PictureFormat::kJpeg);
}

Image<float> planes_from(const Image<float>& image, int first) {
  Image<float> three(image.size(), 3);
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < image.height(); ++y)
      std::copy_n(image.plane(first + p).row(y), image.width(), three.plane(p).row(y));
  }
  return three;
}

}  // namespace

Rect swatch_part(const SeenCloth& cloth, View<const float> sigma_deg) {
  const auto [width, height] = cloth.size;
  const double least = std::min(width, height) / 16.0;
  Place middle = {width / 2.0, height / 2.0};
  double half = std::min(width, height) / 2.0;
  if (!sigma_deg.empty()) {
    const Samples samples(sigma_deg, cloth.size);
    middle = samples.middle(middle);
    half = samples.reach(middle, std::min({middle.x, width - middle.x, middle.y, height - middle.y}));
  }
  for (const Rect& rect : cloth.beside) half = std::min(half, reach_to(rect, middle));
  if (cloth.mm_per_pixel > 0) half = std::min(half, kSwatchMm / 2 / cloth.mm_per_pixel);
  const int side = std::max(1, static_cast<int>(2 * std::max(half, least)));
  const int x = std::clamp(static_cast<int>(std::lround(middle.x - side / 2.0)), 0, width - side);
  const int y = std::clamp(static_cast<int>(std::lround(middle.y - side / 2.0)), 0, height - side);
  return {x, y, x + side, y + side};
}

Result<Image<float>> samples_of(Pyramid& layer) {
  const Size size = layer.size(0);
  const int step = std::max(1, (std::max(size.width, size.height) + kSamplesAside - 1) / kSamplesAside);
  Image<float> samples({(size.width + step - 1) / step, (size.height + step - 1) / step});
  for (int row = 0; row < samples.height(); ++row) {
    const int y = std::min(row * step + step / 2, size.height - 1);
    const Result<Image<float>> read = layer.read(0, {0, y, size.width, y + 1});
    if (!read) return read.error();
    for (int column = 0; column < samples.width(); ++column)
      samples(column, row) = (*read)(std::min(column * step + step / 2, size.width - 1), 0);
  }
  return samples;
}

Result<Image<float>> swatch_picture(Pyramid& normal, Pyramid& albedo, Rect part, bool is_relative) {
  report::Downsampler averages({part.width(), part.height()}, 6, kSwatchSide);
  for (int y = part.y0; y < part.y1; y += kSwatchRows) {
    const Rect rows = {part.x0, y, part.x1, std::min(y + kSwatchRows, part.y1)};
    const Result<Image<float>> n = normal.read(0, rows), rho = albedo.read(0, rows);
    if (!n) return n.error();
    if (!rho) return rho.error();
    averages.add_rows(std::vector<View<const float>>{n->plane(0), n->plane(1), n->plane(2), rho->plane(0),
                                                     rho->plane(1), rho->plane(2)});
  }
  const Image<float> seen = planes_from(averages.averages(), 3);
  const double scale = is_relative ? report::display_scale(seen) : 1;
  return report::relit_picture(seen, planes_from(averages.averages(), 0), scale);
}

Swatches::Swatches(fs::path folder, std::size_t most) : folder_(std::move(folder)), most_(most) {}

Result<std::string> Swatches::find_or(const std::string& content,
                                      const std::function<Result<Image<float>>()>& draw) {
  const fs::path file = folder_ / (content + ".jpg");
  if (Result<std::string> kept = read_text(file)) return kept;
  const Result<Image<float>> picture = draw();
  if (!picture) return picture.error();
  Result<std::string> bytes = jpeg_of(*picture);
  if (!bytes) return bytes;
  const std::lock_guard lock(mutex_);
  // A full disk takes no picture from anybody: it is drawn each time.
  if (!make_writable_folder(folder_) || !write_file(file, *bytes)) return bytes;
  if (++made_ > most_ / 10) prune();
  return bytes;
}

void Swatches::prune() {
  made_ = 0;
  std::error_code error;
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  for (const auto& entry : fs::directory_iterator(folder_, error))
    files.emplace_back(entry.last_write_time(error), entry.path());
  std::ranges::sort(files, std::greater{});
  for (std::size_t i = most_; i < files.size(); ++i) fs::remove(files[i].second, error);
}

}  // namespace weft::app
