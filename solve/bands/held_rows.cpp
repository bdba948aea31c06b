// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/held_rows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace weft::solve {
namespace {

enum Held : int {
  kHeldNormal = 0,
  kHeldAlbedo = 3,
  kHeldSigmaAlbedo = 6,
  kHeldSigmaNormal = 9,
  kHeldModelAlbedo = 10,
  kHeldModelNormal = 13,
  kHeldResidual = 14,
  kHeldPlanes = 15
};

template <typename T>
void copy_rows(View<const T> from, int first, View<T> to, int to_first, int count) {
  for (int y = 0; y < count; ++y) std::copy_n(from.row(first + y), from.width(), to.row(to_first + y));
}

// The image, at least `height` rows high, with the rows that it had.
template <typename T>
void heighten(Image<T>& image, int height) {
  if (image.height() >= height) return;
  Image<T> higher({image.width(), height}, image.planes());
  for (int p = 0; p < image.planes(); ++p)
    copy_rows<T>(image.plane(p), 0, higher.plane(p), 0, image.height());
  image = std::move(higher);
}

}  // namespace

HeldRows::HeldRows(int width) : maps_({width, 1}, kHeldPlanes), status_({width, 1}) {}

void HeldRows::append(const MapBand& band) {
  has_model_ = !band.model_normal_deg.empty();
  const int needed = std::max(band.rows.y1, band.albedo_rows.y1) - first_;
  heighten(maps_, needed);
  heighten(status_, needed);
  const auto take = [&](View<const float> from, int plane, const Rect& rows) {
    copy_rows<float>(from, 0, maps_.plane(plane), rows.y0 - first_, rows.height());
  };
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    take(band.normal[i], kHeldNormal + c, band.rows);
    take(band.albedo[i], kHeldAlbedo + c, band.albedo_rows);
    take(band.sigma_albedo[i], kHeldSigmaAlbedo + c, band.albedo_rows);
    if (has_model_) take(band.model_albedo[i], kHeldModelAlbedo + c, band.albedo_rows);
  }
  take(band.sigma_normal_deg, kHeldSigmaNormal, band.albedo_rows);
  if (has_model_) take(band.model_normal_deg, kHeldModelNormal, band.albedo_rows);
  take(band.residual, kHeldResidual, band.rows);
  copy_rows<std::uint16_t>(band.status, 0, status_.plane(), band.rows.y0 - first_, band.rows.height());
  end_ = std::min(band.rows.y1, band.albedo_rows.y1);
}

void HeldRows::forget_above(int row) {
  const int gone = row - first_, kept = maps_.height() - gone;
  for (int p = 0; p < kHeldPlanes; ++p) copy_rows<float>(maps_.plane(p), gone, maps_.plane(p), 0, kept);
  copy_rows<std::uint16_t>(status_.plane(), gone, status_.plane(), 0, kept);
  first_ = row;
}

MapBand HeldRows::of(Rect rows) const {
  const Rect held = {rows.x0, rows.y0 - first_, rows.x1, rows.y1 - first_};
  const auto one = [&](int plane) { return maps_.plane(plane).crop(held); };
  const auto three = [&](int plane) {
    return std::array<View<const float>, 3>{one(plane), one(plane + 1), one(plane + 2)};
  };
  MapBand band = {.rows = rows,
                  .normal = three(kHeldNormal),
                  .residual = one(kHeldResidual),
                  .status = status_.plane().crop(held),
                  .albedo_rows = rows,
                  .albedo = three(kHeldAlbedo),
                  .sigma_albedo = three(kHeldSigmaAlbedo),
                  .sigma_normal_deg = one(kHeldSigmaNormal),
                  .model_albedo = {},
                  .model_normal_deg = {}};
  if (has_model_) {
    band.model_albedo = three(kHeldModelAlbedo);
    band.model_normal_deg = one(kHeldModelNormal);
  }
  return band;
}

}  // namespace weft::solve
