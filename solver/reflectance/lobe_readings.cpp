// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe_readings.h"

#include <algorithm>
#include <cmath>

#include "core/base/statistics.h"
#include "solver/in_double/pixel.h"

namespace weft::solver {
namespace {

// A quantity of a grid line at a column, counted from the cell that the tile begins in.
double along(const LightField::RowLine& line, int column) {
  const auto cell = static_cast<std::size_t>(column / LightField::kCell);
  return line.value[cell] + line.step[cell] * static_cast<float>(column % LightField::kCell);
}

}  // namespace

LobeReader::LobeReader(const TileInput& input, Sight sight) : input_(input), sight_(sight) {}

void LobeReader::read_row(int y) {
  if (row_ == y || sight_.is_far()) return;
  row_ = y;
  const int x0 = input_.tile.x0 / LightField::kCell * LightField::kCell;
  input_.field->read_row(input_.tile.y0 + y, x0, input_.tile.x1, points_);
}

std::size_t LobeReader::count() const {
  return input_.field->count() * (input_.parallel.empty() ? 1 : 2);
}

void LobeReader::read(int x, int y, std::span<LobeReading> readings) {
  read_row(y);
  const std::size_t lights = input_.field->count();
  read_state(x, y, input_.readings, input_.lobe_share, readings.first(lights));
  if (!input_.parallel.empty())
    read_state(x, y, input_.parallel, kParallelLobeShare, readings.subspan(lights));
}

void LobeReader::read_plane(int x, int y, int plane, std::span<const LobeReading> mixed,
                            std::span<LobeReading> readings) const {
  const std::size_t lights = input_.field->count();
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const auto& state = k < lights ? input_.readings : input_.parallel;
    const double strength =
        input_.field->at(k % lights, plane, input_.tile.x0 + x, input_.tile.y0 + y).strength;
    const double value =
        state[k % lights * 3 + static_cast<std::size_t>(plane)](x, y) / std::max(strength, 1e-30);
    readings[k] = {mixed[k].from, value, 0};
    readings[k].from.channel = plane;
    if (mixed[k].weight == 0 || !std::isfinite(value)) continue;
    readings[k].weight = 1 / std::pow(kLobeModelShare * std::max(value, kLeastModelled), 2);
  }
}

void LobeReader::read_state(int x, int y, std::span<const View<const float>> state, double lobe_share,
                            std::span<LobeReading> readings) {
  const int px = input_.tile.x0 + x, py = input_.tile.y0 + y;
  const int column = px - input_.tile.x0 / LightField::kCell * LightField::kCell;
  const Vec3 view =
      sight_.is_far() ? Vec3{0, 0, 1} : sight_.from(along(points_.x_mm, column), along(points_.y_mm, column));
  const auto planes = static_cast<std::size_t>(input_.planes);
  bright_.clear();
  for (std::size_t k = 0; k < readings.size(); ++k) {
    double value = 0, variance = 0;
    bool is_lit = true;
    Vec3 direction;
    for (std::size_t p = 0; p < planes; ++p) {
      const int channel = planes == 1 ? input_.cfa.channel_at(px, py) : static_cast<int>(p);
      const LightField::Light light = input_.field->at(k, channel, px, py);
      const double reading = state[k * planes + p](x, y);
      direction = light.direction;
      is_lit &= light.strength > 0;
      value += (planes == 1 ? 1 : input_.plane_weights[p]) * reading / light.strength;
      if (planes == 1 && input_.noise)
        variance = input_.noise->variance(std::max(reading, 0.0)) / (light.strength * light.strength);
    }
    LobeReading& r = readings[k];
    r = {LitFrom(direction, view, lobe_share), value, 0};
    if (planes == 1) r.from.channel = input_.cfa.channel_at(px, py);
    if (!is_lit || !std::isfinite(value)) continue;
    r.weight = 1 / (variance + std::pow(kLobeModelShare * std::max(value, kLeastModelled), 2));
    bright_.push_back(value);
  }
  const auto rank = static_cast<std::size_t>(bright_rank(readings.size()));
  if (bright_.size() < rank) return;
  const double threshold = kShadowShare * value_of_rank<double>(bright_, bright_.size() - rank);
  for (LobeReading& r : readings) {
    if (r.weight > 0 && r.x < threshold) r.weight = 0;
  }
}

}  // namespace weft::solver
