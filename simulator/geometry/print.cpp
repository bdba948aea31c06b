// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/print.h"

#include <cmath>
#include <string>

namespace weft::simulator {

Result<void> check_print(const PrintSettings& print) {
  const Image<float>* albedo = print.albedo.get();
  if (albedo == nullptr) return {};
  const auto refuse = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, "printed pattern cannot be used", "material.print", std::move(why),
                 std::move(remedy)};
  };
  if (albedo->empty() || albedo->planes() != 3)
    return refuse("it has " + std::to_string(albedo->planes()) + " planes, not 3",
                  "give it red, green, blue");
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < albedo->height(); ++y) {
      for (int x = 0; x < albedo->width(); ++x) {
        const float a = (*albedo)(x, y, p);
        if (a >= 0 && a <= 1) continue;  // false for NaN
        return refuse(std::to_string(a) + " at column " + std::to_string(x) + ", row " + std::to_string(y) +
                          " is not between 0 and 1",
                      "scale it to linear albedo");
      }
    }
  }
  return {};
}

Print::Print(const PrintSettings& print)
    : albedo_(print.albedo), grid_(albedo_ ? albedo_->size() : Size{1, 1}, print.placement) {}

std::optional<Rgb> Print::at(double x_mm, double y_mm) const {
  const PictureGrid::Place place = grid_.place_of(x_mm, y_mm);
  if (!albedo_ || !grid_.holds(place)) return std::nullopt;
  const double column = std::floor(place.column), row = std::floor(place.row);
  const double right = place.column - column, down = place.row - row;
  const int x[2] = {grid_.column(column), grid_.column(column + 1)};
  const int y[2] = {grid_.row(row), grid_.row(row + 1)};
  Rgb albedo = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const View<const float> plane = albedo_->plane(static_cast<int>(c));
    const double above = (1 - right) * plane(x[0], y[0]) + right * plane(x[1], y[0]);
    const double below = (1 - right) * plane(x[0], y[1]) + right * plane(x[1], y[1]);
    albedo[c] = (1 - down) * above + down * below;
  }
  return albedo;
}

}  // namespace weft::simulator
