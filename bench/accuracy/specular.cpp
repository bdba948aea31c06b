// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/contenders.h"
#include "core/parallel.h"
#include "core/solve_record.h"

namespace weft::bench {
namespace {

constexpr double kWarnFrom = 0.2;
constexpr std::uint32_t kDarkSatinSeeds = 10, kOtherSeeds = 6;

struct Share {
  double share = 0;
  std::string scene;
};

double specular_share(const Patch& patch, const SolvedMaps& maps) {
  const Rect part = patch.measured();
  double specular = 0;
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) specular += (maps.status(x, y) & kSpecular) != 0 ? 1 : 0;
  }
  return specular / static_cast<double>(part.pixels());
}

Json row_of(const std::string& method, const char* cloths, std::vector<Share> shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const Share& a, const Share& b) { return a.share < b.share; });
  const auto warned =
      std::count_if(shares.begin(), shares.end(), [](const Share& share) { return share.share > kWarnFrom; });
  return {{"method", method},
          {"cloths", cloths},
          {"scenes", shares.size()},
          {"warned", warned},
          {"least", shares.front().share},
          {"median", shares[shares.size() / 2].share},
          {"largest", shares.back().share},
          {"largest_on", shares.back().scene}};
}

}  // namespace

Result<Rows> specular_warnings(const AccuracyTableOptions& options) {
  Result<std::vector<Contender>> all = contenders_named(options.methods);
  if (!all) return std::move(all).error();
  std::erase_if(*all, [](const Contender& contender) { return contender.is_yardstick; });
  const int threads = resolved_threads(options.threads);
  std::vector<std::vector<Share>> dark(all->size()), other(all->size());
  for (std::uint32_t seed = 1; seed <= kDarkSatinSeeds; ++seed) {
    for (const AccuracyScene& scene : accuracy_scenes(options.set, seed, true)) {
      const bool is_dark = scene.material == "dark-satin";
      if (!is_dark && seed > kOtherSeeds) continue;
      const Result<Patch> patch = render_patch(scene.scene, scene.patches.front(), threads);
      if (!patch) return patch.error();
      for (std::size_t i = 0; i < all->size(); ++i) {
        SolvedMaps maps(patch->size());
        if (Result<void> ok = (*all)[i].solve(*patch, threads, maps); !ok) return std::move(ok).error();
        (is_dark ? dark : other)[i].push_back({specular_share(*patch, maps), scene.name});
      }
    }
  }
  Rows rows;
  for (std::size_t i = 0; i < all->size(); ++i) {
    rows.push_back(row_of((*all)[i].name, "dark satin", dark[i]));
    rows.push_back(row_of((*all)[i].name, "other", other[i]));
  }
  return rows;
}

}  // namespace weft::bench
