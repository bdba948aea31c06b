// SPDX-License-Identifier: Apache-2.0
#include "material/opacity/opacity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"

namespace weft::material {
namespace {

constexpr double kFoundFrom = 0.005;       // share of pixels that an end of T needs
constexpr double kMostSaturated = 0.001;   // share of pixels
constexpr double kLevelWithin = 1.0 / 12;  // of the range of T
constexpr double kNoContrast = 0.1;        // of T between its ends
constexpr double kBeyond = 0.05;           // of opacity, until it is counted as clipped

Error no_opacity(ErrorKind kind, std::string why, std::string remedy) {
  return {kind, "opacity cannot be found", "light from below", std::move(why), std::move(remedy)};
}

Result<void> check(const Transmission& seen) {
  const Size size = seen.share.size();
  if (size.pixels() == 0)
    return no_opacity(ErrorKind::kUsage, "there are no pixels", "give a map that has some");
  if (seen.saturated.empty()) return {};
  if (seen.saturated.size() != size) {
    return no_opacity(ErrorKind::kUsage, "the map of saturated pixels has another size",
                      "give that of this frame");
  }
  std::int64_t saturated = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) saturated += seen.saturated(x, y) != 0;
  }
  const double share = static_cast<double>(saturated) / static_cast<double>(size.pixels());
  if (share <= kMostSaturated) return {};
  return no_opacity(ErrorKind::kBadData,
                    fmt::format("{:.1f} percent of the pixels are saturated", 100 * share),
                    "photograph cloth and bare table again with a shorter exposure");
}

/// T between which all but a thousandth of pixels lie.
struct Ends {
  double low = 0, high = 1;
  double range() const { return high - low; }
};

Ends ends_of(View<const float> t) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(t.size().pixels()));
  for (int y = 0; y < t.height(); ++y) {
    for (int x = 0; x < t.width(); ++x) {
      if (std::isfinite(t(x, y))) values.push_back(t(x, y));
    }
  }
  if (values.empty()) return {1, 1};
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = [&](double share) {
    return double{value_of_rank<float>(values, static_cast<std::size_t>(share * last + 0.5))};
  };
  return {at(0.001), at(0.999)};
}

// Whether T changes by no more than `most` among a pixel and its neighbours.
bool lies_level(View<const float> t, int x, int y, double most) {
  float least = t(x, y), largest = t(x, y);
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, t.height() - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, t.width() - 1); ++i) {
      if (!std::isfinite(t(i, j))) return false;
      least = std::min(least, t(i, j));
      largest = std::max(largest, t(i, j));
    }
  }
  return double{largest} - double{least} <= most;
}

/// T of pixels that lie level, in the upper and in the lower third of its range.
struct Level {
  std::vector<float> open, closed;
};

Level level_pixels(View<const float> t, const Ends& ends) {
  Level level;
  for (int y = 0; y < t.height(); ++y) {
    for (int x = 0; x < t.width(); ++x) {
      const double share = (double{t(x, y)} - ends.low) / ends.range();
      const bool is_open = share > 2.0 / 3, is_closed = share < 1.0 / 3;
      if (!(is_open || is_closed) || !lies_level(t, x, y, kLevelWithin * ends.range())) continue;
      (is_open ? level.open : level.closed).push_back(t(x, y));
    }
  }
  return level;
}

OpacityFacts facts_of(View<const float> t) {
  using Way = OpacityFacts::Way;
  const Ends ends = ends_of(t);
  OpacityFacts facts;
  if (!(ends.range() > kNoContrast)) {
    const double middle = (ends.low + ends.high) / 2;
    facts.way = middle > 1 - kNoContrast ? Way::kBareTable
                : middle < kNoContrast   ? Way::kOpaque
                                         : Way::kTransmission;
    return facts;
  }
  const Level level = level_pixels(t, ends);
  const auto pixels = static_cast<double>(t.size().pixels());
  facts.open_share = static_cast<double>(level.open.size()) / pixels;
  facts.closed_share = static_cast<double>(level.closed.size()) / pixels;
  if (facts.closed_share < kFoundFrom) return facts;
  const bool has_holes = facts.open_share >= kFoundFrom;
  const double open = has_holes ? double{median(level.open)} : 1;
  const double through = std::max(double{median(level.closed)} / open, 0.0);
  // A closed yarn that lets most light through is a blurred mesh.
  if (!(open > 0 && through < 0.6)) return facts;
  facts.way = has_holes ? Way::kCoverage : Way::kClosedCoverage;
  facts.open = open;
  facts.through_yarns = through;
  return facts;
}

/// What the rows of a map say of it, added in their order.
struct OpacityCounts {
  double sum = 0;
  std::int64_t clipped = 0, unreadable = 0;
};

Opacity opacity_of(View<const float> t, const OpacityFacts& found, int threads) {
  Opacity made = {Image<float>(t.size()), found};
  std::vector<OpacityCounts> rows(static_cast<std::size_t>(t.height()));
  parallel_for(rows.size(), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < t.width(); ++x) {
      const bool readable = std::isfinite(t(x, y));
      const double a = readable ? (1 - double{t(x, y)} / found.open) / (1 - found.through_yarns) : 1;
      const double kept = std::clamp(a, 0.0, 1.0);
      made.map(x, y) = static_cast<float>(kept);
      rows[row].sum += kept;
      rows[row].clipped += std::abs(a - kept) > kBeyond;
      rows[row].unreadable += !readable;
    }
  });
  double sum = 0;
  for (const OpacityCounts& row : rows) {
    sum += row.sum;
    made.facts.clipped += row.clipped;
    made.facts.unreadable += row.unreadable;
  }
  made.facts.mean = sum / static_cast<double>(t.size().pixels());
  return made;
}

}  // namespace

const char* name_of(OpacityFacts::Way way) {
  using Way = OpacityFacts::Way;
  switch (way) {
    case Way::kCoverage:
      return "coverage";
    case Way::kClosedCoverage:
      return "closed-coverage";
    case Way::kTransmission:
      return "transmission";
    case Way::kBareTable:
      return "bare-table";
    case Way::kOpaque:
      return "opaque";
    case Way::kMarkedHoles:
      return "marked-holes";
  }
  return "";
}

Result<Opacity> opacity_from_transmission(const Transmission& seen, int threads) {
  if (Result<void> ok = check(seen); !ok) return std::move(ok).error();
  return opacity_of(seen.share, facts_of(seen.share), threads);
}

Result<TableFacts> remove_table(Surface& surface, const std::array<double, 3>& table, int threads) {
  const auto refused = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kUsage, "the table cannot be taken out", "albedo", std::move(why),
                 std::move(remedy)};
  };
  if (surface.opacity.empty()) return refused("the surface has no opacity", "find the opacity first");
  if (!std::ranges::all_of(table, [](double t) { return t >= 0 && t <= 1; })) {
    return refused("the table's albedo is not in 0 to 1", "measure the bare table");
  }
  std::vector<TableFacts> rows(static_cast<std::size_t>(surface.size().height));
  parallel_for(rows.size(), threads, [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < surface.size().width; ++x) {
      const double a = double{surface.opacity(x, y)};
      if (a >= 1 || (surface.status(x, y) & kNoSolution) != 0) continue;
      const Vec3 n = normalized({-double{surface.slope(x, y, 0)}, -double{surface.slope(x, y, 1)}, 1});
      Vec3 grey;
      std::array<double, 3> albedo{};
      bool is_cloth = a > kLeastCloth;
      for (int c = 0; is_cloth && c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        const Vec3 b =
            (1 / a) * (double{surface.albedo(x, y, c)} * n - ((1 - a) * table[at]) * Vec3{0, 0, 1});
        albedo[at] = length(b);
        is_cloth = b.z > 0;
        grey = grey + b;
      }
      if (!is_cloth) {
        surface.slope(x, y, 0) = surface.slope(x, y, 1) = 0;
        surface.sigma_deg(x, y) = 180;
        surface.status(x, y) = static_cast<std::uint16_t>(surface.status(x, y) | kNoSolution);
        ++rows[row].left;
        continue;
      }
      surface.slope(x, y, 0) = static_cast<float>(-grey.x / grey.z);
      surface.slope(x, y, 1) = static_cast<float>(-grey.y / grey.z);
      for (int c = 0; c < 3; ++c) {
        surface.albedo(x, y, c) = static_cast<float>(albedo[static_cast<std::size_t>(c)]);
      }
      surface.sigma_deg(x, y) = static_cast<float>(std::min(double{surface.sigma_deg(x, y)} / a, 180.0));
      ++rows[row].unmixed;
    }
  });
  TableFacts all;
  for (const TableFacts& row : rows) {
    all.unmixed += row.unmixed;
    all.left += row.left;
  }
  return all;
}

}  // namespace weft::material
