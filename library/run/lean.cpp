// SPDX-License-Identifier: Apache-2.0
#include "library/run/lean.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/base/product.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

// Normals are unit vectors: a half float holds them to 0.03 degrees.
Result<void> halve_normals(const fs::path& file, Compression compression) {
  const Result<LoadedImage> map = read_image(file);
  if (!map) return map.error();
  std::vector<View<const float>> planes;
  for (int p = 0; p < map->planes.planes(); ++p) planes.push_back(map->planes.plane(p));
  return write_image(file, planes, map->info.channels,
                     {.type = SampleType::kHalf, .compression = compression, .pitch_mm = map->info.pitch_mm});
}

}  // namespace

std::string lean_id(const std::string& solve, const BatchProduct& product) {
  if (product.is_whole()) return solve;
  return product_id({{"solve", solve}, {"keep", sorted(product.keep)}, {"half", product.half}});
}

Compression compression_of(const BatchProduct& product) {
  const auto found = std::ranges::find(kCompressionNames, product.compression);
  return found == kCompressionNames.end() ? Compression::kNone
                                          : static_cast<Compression>(found - kCompressionNames.begin());
}

Result<void> make_lean(const fs::path& solve, const BatchProduct& product, const std::string& id) {
  const auto is_kept = [&](const std::string& name) {
    return product.keep.empty() || std::ranges::find(product.keep, name) != product.keep.end();
  };
  std::error_code failed;
  std::vector<fs::path> gone;
  for (const auto& entry : fs::directory_iterator(solve, failed)) {
    const fs::path& file = entry.path();
    const bool is_map = file.extension() == ".exr" || file.filename() == "status.png";
    if (is_map && !is_kept(file.stem().string())) gone.push_back(file);
  }
  for (const fs::path& file : gone) fs::remove(file, failed);
  if (failed) return cannot_write(solve, failed.value());
  const fs::path normal = solve / "normal.exr";
  if (product.half && is_there(normal)) {
    if (Result<void> ok = halve_normals(normal, compression_of(product)); !ok) return ok;
  }
  const fs::path document = solve / kSolveProduct.document;
  Result<Json> facts = read_json(document, kSolveProduct.schema, 1);
  if (!facts) return std::move(facts).error();
  (*facts)["made_from"] = (*facts)["id"];
  (*facts)["id"] = id;
  (*facts)["kept"] = sorted(product.keep);
  (*facts)["half"] = product.half;
  return write_json(document, *facts);
}

}  // namespace weft::library
