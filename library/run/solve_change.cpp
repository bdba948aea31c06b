// SPDX-License-Identifier: Apache-2.0
#include "library/run/solve_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/image_io/solve_maps.h"
#include "core/solve/solve.h"
#include "core/solve/solve_record.h"
#include "core/solve/status_blend.h"
#include "material/read/compare.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr int kBandRows = 64, kCell = 16, kWindow = 80;
const std::array<std::string, 3> kNormalChannels = {"X", "Y", "Z"}, kAlbedoChannels = {"R", "G", "B"};

// Sums over the pixels of a band, and over all of them in the order of the bands.
struct AlbedoSums {
  double rel = 0, bias = 0;
  std::int64_t samples = 0;
};

struct Solves {
  MapRows normal_before, normal_after, albedo_before, albedo_after;
  Size size;
};

Result<Solves> open_solves(const fs::path& before, const fs::path& after) {
  std::array<std::optional<MapRows>, 4> maps;
  const std::array<std::pair<fs::path, const std::array<std::string, 3>*>, 4> files = {
      {{before / "normal.exr", &kNormalChannels},
       {after / "normal.exr", &kNormalChannels},
       {before / "albedo.exr", &kAlbedoChannels},
       {after / "albedo.exr", &kAlbedoChannels}}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    Result<MapRows> opened = MapRows::open(files[i].first, *files[i].second);
    if (!opened) return std::move(opened).error();
    maps[i].emplace(std::move(*opened));
    if (maps[i]->size() == maps[0]->size()) continue;
    return Error{ErrorKind::kBadData, "solves differ in size", files[i].first.string(),
                 fmt::format("{} x {} pixels, {} has {} x {}", maps[i]->size().width, maps[i]->size().height,
                             files[0].first.string(), maps[0]->size().width, maps[0]->size().height),
                 "compare solves of one size"};
  }
  const Size size = maps[0]->size();
  return Solves{std::move(*maps[0]), std::move(*maps[1]), std::move(*maps[2]), std::move(*maps[3]), size};
}

using Triple = std::array<double, 3>;

Triple at(const Image<float>& image, int x, int y) {
  return {image(x, y, 0), image(x, y, 1), image(x, y, 2)};
}

bool is_finite(const Triple& t) {
  return std::isfinite(t[0]) && std::isfinite(t[1]) && std::isfinite(t[2]);
}

bool counts(const Triple& tested, const Triple& truth) {
  return is_finite(tested) && is_finite(truth) && (truth[0] != 0 || truth[1] != 0 || truth[2] != 0);
}

void add_angles(const Image<float>& before, const Image<float>& after, View<float> angles) {
  for (int y = 0; y < angles.height(); ++y) {
    for (int x = 0; x < angles.width(); ++x) {
      const Triple a = at(after, x, y), b = at(before, x, y);
      angles(x, y) = counts(a, b) ? static_cast<float>(angle_deg({a[0], a[1], a[2]}, {b[0], b[1], b[2]}))
                                  : std::numeric_limits<float>::quiet_NaN();
    }
  }
}

AlbedoSums albedo_sums(const Image<float>& before, const Image<float>& after) {
  AlbedoSums sums;
  for (int y = 0; y < before.height(); ++y) {
    for (int x = 0; x < before.width(); ++x) {
      const Triple a = at(after, x, y), b = at(before, x, y);
      if (!counts(a, b)) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        if (!(b[c] > 0)) continue;
        ++sums.samples;
        sums.rel += std::abs(a[c] - b[c]) / b[c];
        sums.bias += (a[c] - b[c]) / b[c];
      }
    }
  }
  return sums;
}

Result<void> compare_band(const Solves& solves, Rect band, View<float> angles, AlbedoSums& sums) {
  const Result<Image<float>> normal_before = solves.normal_before.read(band);
  if (!normal_before) return normal_before.error();
  const Result<Image<float>> normal_after = solves.normal_after.read(band);
  if (!normal_after) return normal_after.error();
  add_angles(*normal_before, *normal_after, angles);
  const Result<Image<float>> albedo_before = solves.albedo_before.read(band);
  if (!albedo_before) return albedo_before.error();
  const Result<Image<float>> albedo_after = solves.albedo_after.read(band);
  if (!albedo_after) return albedo_after.error();
  sums = albedo_sums(*albedo_before, *albedo_after);
  return {};
}

// Angles by cells of a grid.
struct Cells {
  int columns = 0, rows = 0;
  std::vector<double> sum;
  std::vector<std::int64_t> count;
};

Cells cells_of(View<const float> angles) {
  Cells cells;
  cells.columns = (angles.width() + kCell - 1) / kCell;
  cells.rows = (angles.height() + kCell - 1) / kCell;
  cells.sum.resize(static_cast<std::size_t>(cells.columns) * static_cast<std::size_t>(cells.rows));
  cells.count.resize(cells.sum.size());
  for (int y = 0; y < angles.height(); ++y) {
    for (int x = 0; x < angles.width(); ++x) {
      const auto cell = static_cast<std::size_t>(y / kCell * cells.columns + x / kCell);
      if (!std::isfinite(angles(x, y))) continue;
      cells.sum[cell] += static_cast<double>(angles(x, y));
      ++cells.count[cell];
    }
  }
  return cells;
}

WorstWindow worst_of(View<const float> angles) {
  const Cells cells = cells_of(angles);
  const int side = std::min({kWindow / kCell, cells.columns, cells.rows});
  WorstWindow worst = {0, 0, std::min({side * kCell, angles.width(), angles.height()}), 0};
  for (int row = 0; row + side <= cells.rows; ++row) {
    for (int column = 0; column + side <= cells.columns; ++column) {
      double sum = 0;
      std::int64_t count = 0;
      for (int y = row; y < row + side; ++y) {
        for (int x = column; x < column + side; ++x) {
          const auto cell = static_cast<std::size_t>(y * cells.columns + x);
          sum += cells.sum[cell];
          count += cells.count[cell];
        }
      }
      const double mean = count > 0 ? sum / static_cast<double>(count) : 0;
      if (mean <= worst.mean_deg) continue;
      worst.x = std::min(column * kCell, angles.width() - worst.side);
      worst.y = std::min(row * kCell, angles.height() - worst.side);
      worst.mean_deg = mean;
    }
  }
  return worst;
}

// Share of pixels whose status speaks otherwise; none where one of the two has none.
Result<std::optional<double>> changed_status(const fs::path& before, const fs::path& after) {
  if (!is_there(before / "status.png") || !is_there(after / "status.png")) return std::optional<double>();
  const Result<LoadedImage> a = read_image(after / "status.png"), b = read_image(before / "status.png");
  if (!a) return a.error();
  if (!b) return b.error();
  if (a->info.size != b->info.size) return std::optional<double>();
  const auto spoken = [](float value) {
    return static_cast<unsigned>(std::lround(65535 * value)) & ~(kHowSolved | kBlendBits);
  };
  std::int64_t differ = 0;
  for (int y = 0; y < a->info.size.height; ++y) {
    for (int x = 0; x < a->info.size.width; ++x) {
      if (spoken(a->planes(x, y)) != spoken(b->planes(x, y))) ++differ;
    }
  }
  return std::optional(static_cast<double>(differ) / static_cast<double>(a->info.size.pixels()));
}

Result<SolveFacts> facts_in(const fs::path& solve) {
  const fs::path file = solve / kSolveProduct.document;
  const Result<Json> document = read_json(file, kSolveProduct.schema, 1);
  if (!document) return document.error();
  return solve_facts_from_json(*document, file.string());
}

double unsolved_share(const SolveFacts& facts) {
  return static_cast<double>(facts.status.with(kNoSolution)) /
         static_cast<double>(std::max<std::int64_t>(1, facts.size.pixels()));
}

std::optional<double> sigma_median(const SolveFacts& facts) {
  return facts.sigma_normal_deg ? facts.sigma_normal_deg->median : std::nullopt;
}

Result<void> add_facts(const fs::path& before, const fs::path& after, MapChange& change) {
  const Result<SolveFacts> old = facts_in(before), now = facts_in(after);
  if (!old) return old.error();
  if (!now) return now.error();
  change.unsolved = {unsolved_share(*old), unsolved_share(*now)};
  const std::optional<double> old_sigma = sigma_median(*old), now_sigma = sigma_median(*now);
  if (old_sigma && now_sigma) change.sigma_deg = {*old_sigma, *now_sigma};
  if (old->check && now->check) change.left_out = {old->check->all.rms, now->check->all.rms};
  const Result<std::optional<double>> status = changed_status(before, after);
  if (!status) return status.error();
  change.status_changed = *status;
  return {};
}

}  // namespace

Result<MapRows> MapRows::open(const fs::path& file, std::span<const std::string> channels) {
  MapRows rows;
  rows.channels_.assign(channels.begin(), channels.end());
  const auto missing = [&](const std::string& channel) {
    return Error{ErrorKind::kBadData, "a map cannot be compared", file.string(),
                 fmt::format("it has no channel {}", channel), "solve the session again"};
  };
  Result<ExrWindow> window = ExrWindow::open(file);
  if (window) {
    for (const std::string& channel : channels) {
      if (!window->has(channel)) return missing(channel);
    }
    rows.window_.emplace(std::move(*window));
    return rows;
  }
  if (window.error().kind != ErrorKind::kUsage) return std::move(window).error();
  Result<LoadedImage> loaded = read_image(file);
  if (!loaded) return std::move(loaded).error();
  for (const std::string& channel : channels) {
    if (loaded->channel(channel).empty()) return missing(channel);
  }
  rows.loaded_.emplace(std::move(*loaded));
  return rows;
}

Size MapRows::size() const {
  return window_ ? window_->size() : loaded_->info.size;
}

Result<Image<float>> MapRows::read(Rect part) const {
  if (window_) return window_->read(part, channels_);
  Image<float> planes({part.width(), part.height()}, static_cast<int>(channels_.size()));
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const View<const float> from = loaded_->channel(channels_[c]).crop(part);
    for (int y = 0; y < part.height(); ++y)
      std::copy_n(from.row(y), part.width(), planes.plane(static_cast<int>(c)).row(y));
  }
  return planes;
}

Result<MapChange> compare_solves(const fs::path& before, const fs::path& after, int threads) {
  const Result<Solves> solves = open_solves(before, after);
  if (!solves) return solves.error();
  const Size size = solves->size;
  Image<float> angles(size);
  const auto bands = static_cast<std::size_t>((size.height + kBandRows - 1) / kBandRows);
  std::vector<AlbedoSums> sums(bands);
  std::optional<Error> failure;
  std::mutex mutex;
  parallel_for(bands, threads, [&](std::size_t i, int) {
    const int y0 = static_cast<int>(i) * kBandRows, y1 = std::min(y0 + kBandRows, size.height);
    const Rect band = {0, y0, size.width, y1};
    if (Result<void> ok = compare_band(*solves, band, angles.plane().crop(band), sums[i]); !ok) {
      const std::lock_guard lock(mutex);
      failure = std::move(ok).error();
    }
  });
  if (failure) return *failure;

  MapChange change;
  change.worst = worst_of(angles.plane());
  std::vector<float> all;
  all.reserve(static_cast<std::size_t>(size.pixels()));
  for (int y = 0; y < size.height; ++y) {
    std::copy_if(angles.plane().row(y), angles.plane().row(y) + size.width, std::back_inserter(all),
                 [](float angle) { return std::isfinite(angle); });
  }
  if (all.empty()) {
    return Error{ErrorKind::kBadData, "nothing to compare", after.string(),
                 "no pixel has a normal in both solves", "look at both reports"};
  }
  const solve::NormalComparison normal = solve::summarize(all);
  change.pixels = normal.pixels;
  change.mean_deg = normal.mean_deg;
  change.median_deg = normal.median_deg;
  change.p95_deg = normal.p95_deg;
  change.max_deg = normal.max_deg;
  AlbedoSums albedo;
  for (const AlbedoSums& each : sums)
    albedo.rel += each.rel, albedo.bias += each.bias, albedo.samples += each.samples;
  if (albedo.samples > 0) {
    change.albedo_rel = albedo.rel / static_cast<double>(albedo.samples);
    change.albedo_bias_rel = albedo.bias / static_cast<double>(albedo.samples);
  }
  if (Result<void> ok = add_facts(before, after, change); !ok) return std::move(ok).error();
  return change;
}

}  // namespace weft::library
