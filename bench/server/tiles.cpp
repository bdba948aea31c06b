// SPDX-License-Identifier: Apache-2.0
#include "bench/server/studies.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "bench/server/no_devices.h"
#include "bench/server/wide_solve.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

constexpr double kFirstAsked_ms = 500;
constexpr std::array kMegapixels = {16, 100};

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

Result<void> measure_size(const StudyOptions& options, int megapixels, Rows& rows) {
  const TemporaryFolder folder;
  const Size size = wide_size(megapixels);
  if (Result<void> ok = write_wide_solve(folder.path() / "scans", size); !ok) return ok;
  const auto server = server_without_devices("bench", folder.path() / "scans", folder.path() / "state");
  if (!server) return server.error();
  const std::string& address = (*server)->address();
  const Result<app::RigClient> client = app::RigClient::connect(address);
  if (!client) return client.error();
  const Result<Json> solve = client->get(kWideSolve);
  if (!solve) return solve.error();
  const int top = solve->at("levels").get<int>() - 1;
  double first_ms = 0;
  for (const char* layer : kWideLayers) {
    const Result<double> ms = fetched_ms(*client, wide_tile(layer, top, 0, 0));
    if (!ms) return ms.error();
    first_ms += *ms;
  }
  rows.push_back(tiles_row("first view", megapixels, 1, {first_ms}, kFirstAsked_ms));

  for (const int clients : {2, 16}) {
    const std::vector<std::string> paths = wide_tiles(size, options.runs, options.seed);
    const Result<std::vector<double>> times = crowd_ms(address, clients, paths);
    if (!times) return times.error();
    rows.push_back(tiles_row("tiles", megapixels, clients, *times, clients <= 2 ? 60 : 300));
  }
  return {};
}

}  // namespace

/// What a viewer waits for, over HTTP, of maps that are written for it into a temporary folder: slopes that
/// no codec can guess. A row a question: "what", "megapixels", "clients", "median_ms", "p95_ms", "most_ms",
/// "asked_ms", "holds". "first view" is the topmost tile of normals and albedo of a solve that nobody has
/// looked at, "tiles" are of levels 0 to 2 anywhere, each client asking for one after another.
/// Errors: of writing the maps, of RigServer::start().
Result<Rows> server_tiles_table(const StudyOptions& options) {
  Rows rows;
  int done = 0;
  for (const int megapixels : kMegapixels) {
    if (Result<void> ok = measure_size(options, megapixels, rows); !ok) return std::move(ok).error();
    options.progress(++done, static_cast<int>(kMegapixels.size()));
  }
  return rows;
}

}  // namespace weft::bench
