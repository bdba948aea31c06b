// SPDX-License-Identifier: Apache-2.0
#include "bench/server/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "bench/server/no_devices.h"
#include "core/files.h"
#include "core/image_io/image_io.h"
#include "core/solve.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSession = "wide";
constexpr const char* kSolve = "0123456789abcdef";
constexpr int kRowsAtOnce = 64;
constexpr double kFirstAsked_ms = 500;
constexpr std::array<const char*, 2> kLooked = {"normal", "albedo"};

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

/// A session with one solve, as far as a viewer looks.
Result<void> write_solve(const fs::path& sessions, Size size) {
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

std::string path_of_tile(const char* layer, int level, int column, int row) {
  return fmt::format("/api/v1/sessions/{}/solves/{}/tiles/{}/{}/{}_{}.{}", kSession, kSolve, layer, level,
                     column, row, layer == std::string("normal") ? "raw" : "jpg");
}

double quantile(std::vector<double> times, double share) {
  std::ranges::sort(times);
  return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1) + 0.5)];
}

Json tiles_row(const char* what, int megapixels, int clients, const std::vector<double>& times_ms,
               double asked_ms) {
  const double p95 = quantile(times_ms, 0.95);
  return {{"what", what},         {"megapixels", megapixels},
          {"clients", clients},   {"median_ms", quantile(times_ms, 0.5)},
          {"p95_ms", p95},        {"most_ms", quantile(times_ms, 1)},
          {"asked_ms", asked_ms}, {"holds", p95 < asked_ms}};
}

Result<double> fetched_ms(const app::RigClient& client, const std::string& path) {
  const auto begin = std::chrono::steady_clock::now();
  const Result<std::string> bytes = client.bytes(path);
  if (!bytes) return bytes.error();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

/// Each client asks for one tile after another; all times.
Result<std::vector<double>> crowd_ms(const std::string& address, int clients,
                                     const std::vector<std::string>& paths) {
  std::vector<std::vector<double>> times(static_cast<std::size_t>(clients));
  std::vector<Result<void>> ended(static_cast<std::size_t>(clients));
  std::vector<std::jthread> crowd;
  for (std::size_t i = 0; i < times.size(); ++i) {
    crowd.emplace_back([&, i] {
      const Result<app::RigClient> client = app::RigClient::connect(address);
      if (!client) {
        ended[i] = client.error();
        return;
      }
      for (std::size_t k = i; k < paths.size(); k += times.size()) {
        const Result<double> ms = fetched_ms(*client, paths[k]);
        if (!ms) {
          ended[i] = ms.error();
          return;
        }
        times[i].push_back(*ms);
      }
    });
  }
  crowd.clear();
  std::vector<double> all;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!ended[i]) return ended[i].error();
    all.insert(all.end(), times[i].begin(), times[i].end());
  }
  return all;
}

Result<void> measure_size(const ServerTilesOptions& options, int megapixels, Rows& rows) {
  const TemporaryFolder folder;
  const int width = static_cast<int>(std::lround(std::sqrt(1.5e6 * megapixels)));
  const Size size = {width, width * 2 / 3};
  if (Result<void> ok = write_solve(folder.path() / "scans", size); !ok) return ok;
  const auto server = server_without_devices("bench", folder.path() / "scans", folder.path() / "state");
  if (!server) return server.error();
  const std::string& address = (*server)->address();
  const Result<app::RigClient> client = app::RigClient::connect(address);
  if (!client) return client.error();
  const Result<Json> solve = client->get(fmt::format("/api/v1/sessions/{}/solves/{}", kSession, kSolve));
  if (!solve) return solve.error();
  const int top = solve->at("levels").get<int>() - 1;
  double first_ms = 0;
  for (const char* layer : kLooked) {
    const Result<double> ms = fetched_ms(*client, path_of_tile(layer, top, 0, 0));
    if (!ms) return ms.error();
    first_ms += *ms;
  }
  rows.push_back(tiles_row("first view", megapixels, 1, {first_ms}, kFirstAsked_ms));

  std::mt19937_64 random(options.seed);
  for (const int clients : options.clients) {
    std::vector<std::string> paths;
    for (int i = 0; i < options.tiles; ++i) {
      const int level = static_cast<int>(random() % 3);
      const auto places = [&](int side) {
        return std::max<std::uint64_t>(1, static_cast<std::uint64_t>((side >> level) / 512));
      };
      paths.push_back(path_of_tile(kLooked[static_cast<std::size_t>(i) % kLooked.size()], level,
                                   static_cast<int>(random() % places(size.width)),
                                   static_cast<int>(random() % places(size.height))));
    }
    const Result<std::vector<double>> times = crowd_ms(address, clients, paths);
    if (!times) return times.error();
    rows.push_back(tiles_row("tiles", megapixels, clients, *times, clients <= 2 ? 60 : 300));
  }
  return {};
}

}  // namespace

Result<Rows> server_tiles_table(const ServerTilesOptions& options) {
  Rows rows;
  int done = 0;
  for (const int megapixels : options.megapixels) {
    if (Result<void> ok = measure_size(options, megapixels, rows); !ok) return std::move(ok).error();
    options.progress(++done, static_cast<int>(options.megapixels.size()));
  }
  return rows;
}

}  // namespace weft::bench
