// SPDX-License-Identifier: Apache-2.0
#include <utility>
#include <vector>

#include "core/solve/solve_record.h"
#include "material/opacity/opacity.h"

namespace weft::material {
namespace {

struct Place {
  int x = 0, y = 0;
};

// The patch of marked pixels around a place, by sides; takes their marks away.
std::vector<Place> taken_patch(Image<std::uint8_t>& marked, Place from) {
  std::vector<Place> patch = {from};
  marked(from.x, from.y) = 0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const Place at = patch[i];
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int x = at.x + dx, y = at.y + dy;
      if (x < 0 || y < 0 || x >= marked.width() || y >= marked.height() || marked(x, y) == 0) continue;
      marked(x, y) = 0;
      patch.push_back({x, y});
    }
  }
  return patch;
}

}  // namespace

Opacity opacity_from_status(View<const std::uint16_t> status, const MarkedHoleOptions& options) {
  const unsigned bits = options.bits != 0 ? options.bits : kNoSolution | kDark;
  Opacity made = {Image<float>(status.size()), {}};
  Image<std::uint8_t> marked(status.size());
  for (int y = 0; y < status.height(); ++y) {
    for (int x = 0; x < status.width(); ++x) {
      marked(x, y) = (status(x, y) & bits) != 0;
      made.map(x, y) = 1;
    }
  }
  for (int y = 0; y < status.height(); ++y) {
    for (int x = 0; x < status.width(); ++x) {
      if (marked(x, y) == 0) continue;
      const std::vector<Place> patch = taken_patch(marked, {x, y});
      if (patch.size() < static_cast<std::size_t>(options.least_pixels)) continue;
      for (const Place& at : patch) made.map(at.x, at.y) = 0;
      made.facts.holes += static_cast<std::int64_t>(patch.size());
    }
  }
  const auto pixels = static_cast<double>(status.size().pixels());
  made.facts.way = OpacityFacts::Way::kMarkedHoles;
  made.facts.mean = pixels > 0 ? 1 - static_cast<double>(made.facts.holes) / pixels : 1;
  return made;
}

}  // namespace weft::material
