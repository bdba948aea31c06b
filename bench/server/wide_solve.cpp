// SPDX-License-Identifier: Apache-2.0
#include "bench/server/wide_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/image_io/image_io.h"
#include "core/solve/solve.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSession = "wide";
constexpr const char* kSolve = "0123456789abcdef";
constexpr int kRowsAtOnce = 64;
constexpr int kTile = 512;

/// Rows of hashed values around `middle`.
void fill(std::uint32_t row, float middle, Image<float>& band) {
  for (int p = 0; p < band.planes(); ++p) {
    for (int y = 0; y < band.height(); ++y) {
      std::uint32_t seed =
          (row + static_cast<std::uint32_t>(y)) * 2654435761U + static_cast<std::uint32_t>(p);
      for (int x = 0; x < band.width(); ++x) {
        seed = seed * 1664525U + 1013904223U;
        band(x, y, p) = middle + 0.2F * (static_cast<float>(seed >> 8) / 16777216.0F - 0.5F);
      }
    }
  }
}

Result<void> write_map(const fs::path& file, Size size, const std::vector<std::string>& channels,
                       SampleType type, float middle) {
  WriteOptions options;
  options.type = type;
  Result<ImageWriter> writer = ImageWriter::open(file, size, channels, options);
  if (!writer) return std::move(writer).error();
  for (int y = 0; y < size.height; y += kRowsAtOnce) {
    Image<float> band({size.width, std::min(kRowsAtOnce, size.height - y)},
                      static_cast<int>(channels.size()));
    fill(static_cast<std::uint32_t>(y), middle, band);
    std::vector<View<const float>> planes;
    for (int p = 0; p < band.planes(); ++p) planes.push_back(band.plane(p));
    if (Result<void> ok = writer->write_rows(planes); !ok) return ok;
  }
  return writer->finish();
}

}  // namespace

Size wide_size(int megapixels) {
  const int width = static_cast<int>(std::lround(std::sqrt(1.5e6 * megapixels)));
  return {width, width * 2 / 3};
}

Result<void> write_wide_solve(const fs::path& sessions, Size size) {
  const fs::path session = sessions / fmt::format("{}.weft", kSession);
  const fs::path folder = session / "solve" / kSolve;
  fs::create_directories(folder);
  if (Result<void> ok = write_map(folder / "normal.exr", size, {"X", "Y", "Z"}, SampleType::kFloat, 0.5F);
      !ok)
    return ok;
  if (Result<void> ok = write_map(folder / "albedo.exr", size, {"R", "G", "B"}, SampleType::kHalf, 0.5F); !ok)
    return ok;
  SolveFacts facts;
  facts.id = kSolve;
  facts.method = "standard";
  facts.size = size;
  facts.albedo_scale = AlbedoScale::kAbsolute;
  if (Result<void> ok = write_json(folder / kSolveProduct.document, json_of(facts)); !ok) return ok;
  return write_json(session / "session.json", {{"schema", "weft.session/1"},
                                               {"fabric", kSession},
                                               {"cloth_height_mm", 0},
                                               {"rig", "bench"},
                                               {"calibration", ""},
                                               {"state", "complete"},
                                               {"shots", Json::array()}});
}

std::string wide_tile(const std::string& layer, int level, int column, int row) {
  return fmt::format("{}/tiles/{}/{}/{}_{}.{}", kWideSolve, layer, level, column, row,
                     layer == "normal" ? "raw" : "jpg");
}

std::vector<std::string> wide_tiles(Size size, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::string> calls;
  for (int i = 0; i < count; ++i) {
    const int level = static_cast<int>(random() % 3);
    const auto place = [&](int side) {
      return static_cast<int>(random() % static_cast<std::uint64_t>(std::max(1, (side >> level) / kTile)));
    };
    const int column = place(size.width), row = place(size.height);
    calls.push_back(
        wide_tile(kWideLayers[static_cast<std::size_t>(i) % kWideLayers.size()], level, column, row));
  }
  return calls;
}

}  // namespace weft::bench
