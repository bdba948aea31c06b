// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/paper_faults.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/statistics.h"

namespace weft::calibration {
namespace {

double departure_of(const PaperSpot& spot) {
  return std::hypot(spot.common, spot.varying);
}

// A cell of the sheet, a few spots wide.
using Cell = std::pair<int, int>;

// Takes the cells that hang together with `from` out of `cells`.
std::vector<std::size_t> connected(std::map<Cell, std::vector<std::size_t>>& cells, Cell from) {
  std::vector<std::size_t> spots;
  std::vector<Cell> open = {from};
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    const auto found = cells.find(cell);
    if (found == cells.end()) continue;
    spots.insert(spots.end(), found->second.begin(), found->second.end());
    cells.erase(found);
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) open.push_back({cell.first + du, cell.second + dv});
    }
  }
  return spots;
}

PaperFault fault_of(std::span<const PaperSpot> spots, std::vector<std::size_t> members, double spacing_mm) {
  PaperFault fault;
  double common = 0, varying = 0;
  std::map<std::size_t, double> seen;  // spots by sheet
  for (const std::size_t i : members) {
    fault.u_mm += spots[i].u_mm / static_cast<double>(members.size());
    fault.v_mm += spots[i].v_mm / static_cast<double>(members.size());
    common += std::abs(spots[i].common);
    varying += spots[i].varying;
    fault.departure = std::max(fault.departure, departure_of(spots[i]));
    ++seen[spots[i].sheet];
  }
  double most = 0;
  for (const auto& [sheet, count] : seen) {
    fault.sheets.push_back(sheet);
    most = std::max(most, count);
  }
  fault.is_fold = varying > common;
  fault.area_mm2 = most * spacing_mm * spacing_mm;
  std::sort(members.begin(), members.end());
  fault.spots = std::move(members);
  return fault;
}

}  // namespace

std::vector<PaperSpot> spots_of(const PaperScene& scene, std::span<const PaperReading> readings) {
  std::vector<PaperSpot> spots;
  for (std::size_t begin = 0, end = 0; begin < readings.size(); begin = end) {
    const PaperReading& first = readings[begin];
    const auto belongs = [&](const PaperReading& r) {
      return r.sheet == first.sheet && r.x_px == first.x_px && r.y_px == first.y_px;
    };
    std::vector<double> by_led;
    for (; end < readings.size() && belongs(readings[end]); ++end) {
      double sum = 0;
      for (int c = 0; c < 3; ++c) {
        const PaperReading& r = readings[end];
        const auto predicted = scene.log_reading(r.sheet, r.led, c, r.x_px, r.y_px);
        if (predicted) sum += (std::log(r.reading_rgb[static_cast<std::size_t>(c)]) - *predicted) / 3;
      }
      by_led.push_back(sum);
    }
    const Pose& pose = scene.sheets[first.sheet].rig_from_sheet;
    const auto point = point_on_sheet(sight_of(scene.camera, first.x_px, first.y_px), pose);
    if (!point) continue;
    const auto count = static_cast<double>(by_led.size());
    PaperSpot spot = {first.sheet,
                      first.x_px,
                      first.y_px,
                      dot(*point - pose.translation_mm, u_axis(pose)),
                      dot(*point - pose.translation_mm, v_axis(pose)),
                      0,
                      0};
    for (const double r : by_led) spot.common += r / count;
    for (const double r : by_led) spot.varying += (r - spot.common) * (r - spot.common) / count;
    spot.varying = std::sqrt(spot.varying);
    spots.push_back(spot);
  }
  return spots;
}

std::vector<PaperFault> find_faults(std::span<const PaperSpot> spots, double spacing_mm) {
  if (spots.empty()) return {};
  std::vector<double> departures;
  for (const PaperSpot& spot : spots) departures.push_back(departure_of(spot));
  const double limit = std::max(kFaultFrom * median(std::move(departures)), kFaultFromRelative);
  std::map<Cell, std::vector<std::size_t>> cells;
  const double cell_mm = 1.5 * spacing_mm;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    if (departure_of(spots[i]) <= limit) continue;
    cells[{static_cast<int>(std::floor(spots[i].u_mm / cell_mm)),
           static_cast<int>(std::floor(spots[i].v_mm / cell_mm))}]
        .push_back(i);
  }
  std::vector<PaperFault> faults;
  while (!cells.empty())
    faults.push_back(fault_of(spots, connected(cells, cells.begin()->first), spacing_mm));
  std::stable_sort(faults.begin(), faults.end(),
                   [](const PaperFault& a, const PaperFault& b) { return a.area_mm2 > b.area_mm2; });
  return faults;
}

}  // namespace weft::calibration
