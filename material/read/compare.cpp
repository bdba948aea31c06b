// SPDX-License-Identifier: Apache-2.0
#include "material/read/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/base/vec.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve.h"
#include "material/read/compared_map.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

struct Pair {
  ComparedMap tested, truth;
  std::optional<LoadedImage> mask;
  std::vector<LoadedImage> status;  // of the solves that the maps are of
};

// Adds the status of the solve that a map of this size is of; nothing where it is of none.
Result<void> add_status(const fs::path& map, Size size, std::vector<LoadedImage>& all) {
  const fs::path folder = map.parent_path(), file = folder / "status.png";
  if (!is_there(folder / kSolveProduct.document) || !is_there(file)) return {};
  Result<LoadedImage> status = read_image(file);
  if (!status) return std::move(status).error();
  if (status->info.size == size) all.push_back(std::move(*status));
  return {};
}

bool is_unsolved(const std::vector<LoadedImage>& status, int x, int y) {
  return std::ranges::any_of(status, [&](const LoadedImage& each) {
    return (std::lround(65535 * each.planes(x, y)) & kNoSolution) != 0;
  });
}

Result<Pair> read_pair(const fs::path& tested_file, const fs::path& truth_file, const fs::path& mask_file) {
  Result<ComparedMap> tested = read_compared(tested_file);
  if (!tested) return std::move(tested).error();
  Result<ComparedMap> truth = read_compared(truth_file);
  if (!truth) return std::move(truth).error();
  Pair pair = {std::move(*tested), std::move(*truth), std::nullopt, {}};
  const Size size = pair.tested.image.info.size;
  const auto check_size = [&](const LoadedImage& image, const fs::path& file) -> Result<void> {
    if (image.info.size == size) return {};
    return Error{ErrorKind::kBadData, "images differ in size", file.string(),
                 fmt::format("{} x {} pixels, {} has {} x {}", image.info.size.width, image.info.size.height,
                             tested_file.string(), size.width, size.height),
                 "compare maps of the same photographs"};
  };
  if (Result<void> ok = check_size(pair.truth.image, truth_file); !ok) return std::move(ok).error();
  if (!mask_file.empty()) {
    Result<LoadedImage> mask = read_image(mask_file);
    if (!mask) return std::move(mask).error();
    if (Result<void> ok = check_size(*mask, mask_file); !ok) return std::move(ok).error();
    pair.mask = std::move(*mask);
  }
  for (const fs::path& file : {tested_file, truth_file}) {
    if (Result<void> ok = add_status(file, size, pair.status); !ok) return std::move(ok).error();
  }
  return pair;
}

using Triple = std::array<double, 3>;

bool counts(const Pair& pair, int x, int y) {
  return !(pair.mask && !(pair.mask->planes(x, y) > 0.5f)) && !is_unsolved(pair.status, x, y);
}

// Calls visit(tested, truth) for every pixel that counts and is not all zero in the truth, row by row.
void for_each_counted(const Pair& pair, const Triples& tested, const Triples& truth,
                      const std::function<void(const Triple&, const Triple&)>& visit) {
  const auto finite = [](const Triple& t) {
    return std::isfinite(t[0]) && std::isfinite(t[1]) && std::isfinite(t[2]);
  };
  const Size size = pair.tested.image.info.size;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (!counts(pair, x, y) || truth.are_zero(x, y)) continue;
      const Triple a = tested.at(x, y), b = truth.at(x, y);
      if (finite(a) && finite(b)) visit(a, b);
    }
  }
}

Error nothing_counts(const fs::path& tested) {
  return {ErrorKind::kBadData, "nothing to compare", tested.string(),
          "no pixel is inside the mask, finite and solved", "check the mask and that both files are maps"};
}

Result<solve::NormalComparison> compare_as_normals(const Pair& pair) {
  const Result<Triples> tested = pair.tested.normals();
  if (!tested) return tested.error();
  const Result<Triples> truth = pair.truth.normals();
  if (!truth) return truth.error();
  std::vector<float> angles;
  double flipped_deg = 0;
  for_each_counted(pair, *tested, *truth, [&](const Triple& a, const Triple& b) {
    const Vec3 n = {b[0], b[1], b[2]};
    angles.push_back(static_cast<float>(angle_deg({a[0], a[1], a[2]}, n)));
    flipped_deg += angle_deg({a[0], -a[1], a[2]}, n);
  });
  if (angles.empty()) return nothing_counts(pair.tested.file);
  solve::NormalComparison comparison = solve::summarize(angles);
  comparison.flipped_mean_deg = flipped_deg / static_cast<double>(angles.size());
  return comparison;
}

Result<AlbedoComparison> compare_as_albedo(const Pair& pair) {
  const Result<Triples> tested = pair.tested.colors();
  if (!tested) return tested.error();
  const Result<Triples> truth = pair.truth.colors();
  if (!truth) return truth.error();
  AlbedoComparison c;
  std::int64_t samples = 0;
  for_each_counted(pair, *tested, *truth, [&](const Triple& a, const Triple& b) {
    ++c.pixels;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(b[i] > 0)) continue;
      ++samples;
      c.mean_rel += std::abs(a[i] - b[i]) / b[i];
      c.bias_rel += (a[i] - b[i]) / b[i];
    }
  });
  if (samples == 0) return nothing_counts(pair.tested.file);
  c.mean_rel /= static_cast<double>(samples);
  c.bias_rel /= static_cast<double>(samples);
  return c;
}

Result<NumberComparison> compare_numbers(const Pair& pair, std::size_t tested_channel,
                                         std::size_t truth_channel) {
  const Size size = pair.tested.image.info.size;
  NumberComparison c;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (!counts(pair, x, y)) continue;
      const double off = pair.tested.number(tested_channel, x, y) - pair.truth.number(truth_channel, x, y);
      if (!std::isfinite(off)) continue;
      ++c.pixels;
      c.mean_abs += std::abs(off);
      c.bias += off;
      c.max_abs = std::max(c.max_abs, std::abs(off));
    }
  }
  if (c.pixels == 0) return nothing_counts(pair.tested.file);
  c.mean_abs /= static_cast<double>(c.pixels);
  c.bias /= static_cast<double>(c.pixels);
  return c;
}

// Compares each number that both have by its name; a single one whatever it is called.
Result<std::vector<NumberComparison>> compare_as_numbers(const Pair& pair) {
  const std::vector<std::string> tested = pair.tested.numbers(), truth = pair.truth.numbers();
  std::vector<NumberComparison> all;
  for (const std::string& name : tested) {
    if (name.empty() || std::ranges::find(truth, name) == truth.end()) continue;
    Result<NumberComparison> one = compare_numbers(pair, pair.tested.meaning.find({name})->front(),
                                                   pair.truth.meaning.find({name})->front());
    if (!one) return std::move(one).error();
    one->name = name;
    one->unit = exchange::channel_named(name)->unit;
    all.push_back(std::move(*one));
  }
  const bool are_single = pair.tested.meaning.channels.size() == 1 && pair.truth.meaning.channels.size() == 1;
  const bool is_unknown =
      (!tested.empty() && tested.front().empty()) || (!truth.empty() && truth.front().empty());
  if (all.empty() && are_single && is_unknown) {
    Result<NumberComparison> one = compare_numbers(pair, 0, 0);
    if (!one) return std::move(one).error();
    all.push_back(std::move(*one));
  }
  if (!all.empty()) return all;
  return Error{ErrorKind::kBadData, "the maps cannot be compared", pair.tested.file.string(),
               fmt::format("{} holds nothing of the same name", pair.truth.file.string()),
               "compare two maps of one kind"};
}

}  // namespace

Result<MapComparison> compare_maps(const fs::path& tested, const fs::path& truth, const fs::path& mask,
                                   std::optional<ComparedKind> kind) {
  const Result<Pair> pair = read_pair(tested, truth, mask);
  if (!pair) return pair.error();
  if (!kind) {
    const Result<ComparedKind> told = kind_of_both(pair->tested, pair->truth);
    if (!told) return told.error();
    kind = *told;
  }
  const auto as_any = [](auto compared) -> Result<MapComparison> {
    if (!compared) return std::move(compared).error();
    return MapComparison(std::move(*compared));
  };
  if (*kind == ComparedKind::kNormal) return as_any(compare_as_normals(*pair));
  return *kind == ComparedKind::kAlbedo ? as_any(compare_as_albedo(*pair))
                                        : as_any(compare_as_numbers(*pair));
}

Result<solve::NormalComparison> compare_normals(const fs::path& tested, const fs::path& truth,
                                                const fs::path& mask) {
  const Result<MapComparison> compared = compare_maps(tested, truth, mask, ComparedKind::kNormal);
  if (!compared) return compared.error();
  return std::get<solve::NormalComparison>(*compared);
}

Result<AlbedoComparison> compare_albedo(const fs::path& tested, const fs::path& truth, const fs::path& mask) {
  const Result<MapComparison> compared = compare_maps(tested, truth, mask, ComparedKind::kAlbedo);
  if (!compared) return compared.error();
  return std::get<AlbedoComparison>(*compared);
}

}  // namespace weft::material
