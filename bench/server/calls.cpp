// SPDX-License-Identifier: Apache-2.0
#include "bench/server/server_studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "bench/server/served_rig.h"
#include "bench/server/wide_solve.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/base/temporary_folder.h"
#include "library/catalogue/catalogue.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRig = "bench";
constexpr int kServed = 40'000, kRebuilt = 10'000, kSearched = 100'000;  // sessions without photographs
constexpr int kUnfinishedEach = 1000;                                    // one of so many sessions
constexpr std::array<const char*, 5> kFabrics = {"wool twill", "cotton satin", "silk crepe", "linen canvas",
                                                 "polyester velvet"};
constexpr std::array<const char*, 4> kTags = {"autumn", "spring", "coat", "lining"};

std::string barcode(int i) {
  return fmt::format("{:013}", 4'006'381'000'000 + i);
}

// What a scan of ten LEDs leaves, without its photographs.
Json session_of(int i) {
  const auto at = static_cast<std::size_t>(i);
  Json shots = Json::array();
  for (int led = 0; led <= 10; ++led) {
    shots.push_back({{"index", led},
                     {"led", led},
                     {"role", led == 0 ? "dark" : "lit"},
                     {"file", fmt::format("raw/{:02}_led{:02}.nef", led, led)},
                     {"sha256", std::string(64, 'a')},
                     {"exposure_us", 20000},
                     {"iso", 100},
                     {"f_number", 8},
                     {"time", fmt::format("20{:02}-{:02}-{:02}T10:{:02}:{:02}Z", 10 + i % 17, 1 + i % 12,
                                          1 + i % 28, i % 60, led)}});
  }
  return {{"schema", "weft.session/1.1"},
          {"fabric", fmt::format("{} {}", kFabrics[at % kFabrics.size()], i % 977)},
          {"cloth_height_mm", 0.5},
          {"rig", kRig},
          {"calibration", ""},
          {"state", i % kUnfinishedEach == 0 ? "capturing" : "complete"},
          {"metadata",
           {{"id", barcode(i)},
            {"tags", {kTags[at % kTags.size()]}},
            {"composition", fmt::format("{} % of it", i % 100)},
            {"notes", fmt::format("roll {} of the mill, shelf {}", i % 499, i % 83)}}},
          {"shots", std::move(shots)}};
}

void write_sessions(const fs::path& folder, int count) {
  fs::create_directories(folder);
  parallel_for(static_cast<std::size_t>(count), 0, [&](std::size_t i, int) {
    const fs::path session = folder / fmt::format("s{:06}.weft", i);
    fs::create_directory(session);
    std::ofstream(session / "session.json") << session_of(static_cast<int>(i)).dump();
  });
}

double milliseconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

Json row_of(const std::string& what, int sessions, const std::vector<double>& times_ms, double asked_ms) {
  const double most = *std::ranges::max_element(times_ms);
  return {{"what", what},    {"sessions", sessions}, {"median_ms", median(times_ms)},
          {"most_ms", most}, {"asked_ms", asked_ms}, {"holds", most < asked_ms}};
}

// Until the server has read all of them.
Result<void> wait_for(const app::RigClient& client, int sessions) {
  for (;;) {
    const Result<Json> page = client.get("/api/v1/sessions?limit=1");
    if (!page) return page.error();
    if (page->at("total") == sessions) return {};
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

Result<void> measure_calls(const StudyOptions& options, Rows& rows) {
  const TemporaryFolder folder;
  write_sessions(folder.path() / "scans", kServed);
  const auto server = server_without_devices(kRig, folder.path() / "scans", folder.path() / "state");
  if (!server) return server.error();
  const Result<app::RigClient> client = app::RigClient::connect((*server)->address());
  if (!client) return client.error();
  if (Result<void> ok = wait_for(*client, kServed); !ok) return ok;

  const std::string scan = "/api/v1/scan";
  for (const auto& [what, path] : {std::pair<std::string, std::string>("POST scan, its choice", scan),
                                   {"GET rig", "/api/v1/rig"},
                                   {"GET sessions, a search", "/api/v1/sessions?query=wool%20auto%20shelf"},
                                   {"GET sessions, a word", "/api/v1/sessions?query=satin"},
                                   {"GET sessions, a tag", "/api/v1/sessions?tag=coat"},
                                   {"GET sessions, a page of 100", "/api/v1/sessions?limit=100"}}) {
    std::vector<double> times_ms;
    for (int i = 0; i < options.runs; ++i) {
      Result<Json> answer = Json();
      times_ms.push_back(milliseconds_of([&] {
        const Json body = {{"fabric", fmt::format("{} {}", kFabrics[0], i)}, {"dry_run", true}};
        answer = path == scan ? client->post(path, body) : client->get(path);
      }));
      if (!answer) return answer.error();
    }
    rows.push_back(row_of(what, kServed, times_ms, 50));
  }
  return {};
}

Result<void> measure_reading(const StudyOptions&, Rows& rows) {
  const TemporaryFolder folder;
  write_sessions(folder.path() / "scans", kRebuilt);
  Result<library::Catalogue> catalogue = library::Catalogue::open(folder.path() / "library.sqlite");
  if (!catalogue) return catalogue.error();
  for (const auto& [what, asked_ms] : {std::pair("rebuild", 10'000.0), {"refresh", 1000.0}}) {
    Result<library::RefreshFacts> facts = library::RefreshFacts();
    const double time_ms =
        milliseconds_of([&] { facts = catalogue->refresh({folder.path() / "scans"}, {.threads = 1}); });
    if (!facts) return facts.error();
    rows.push_back(row_of(what, kRebuilt, {time_ms}, asked_ms));
  }
  return {};
}

Result<void> measure_search(const StudyOptions& options, Rows& rows) {
  const TemporaryFolder folder;
  write_sessions(folder.path() / "scans", kSearched);
  Result<library::Catalogue> catalogue = library::Catalogue::open(folder.path() / "library.sqlite");
  if (!catalogue) return catalogue.error();
  if (const auto facts = catalogue->refresh({folder.path() / "scans"}, {}); !facts) return facts.error();
  const library::Query by_word = {.words = "wool"}, by_barcode = {.words = barcode(kSearched / 2)},
                       by_id = {.id = barcode(kSearched / 2)};
  for (const auto& [what, query] :
       {std::pair("search by word, ranked", by_word), {"search by barcode", by_barcode}, {"by id", by_id}}) {
    std::vector<double> times_ms;
    for (int i = 0; i < options.runs; ++i) {
      Result<library::CataloguePage> page = library::CataloguePage();
      times_ms.push_back(milliseconds_of([&] { page = catalogue->find(query); }));
      if (!page) return page.error();
    }
    rows.push_back(row_of(what, kSearched, times_ms, 100));
  }
  return {};
}

}  // namespace

/// A row a number that is asked of the library: what, of how many sessions, median and worst in ms, what is
/// asked in ms, whether it holds. The first rows are calls of a server without devices over HTTP (the choice
/// of POST scan by its dry run), the others of a catalogue: made from nothing, looked through where nothing
/// changed, searched by a word that a fifth of the sessions have and by a barcode. Errors: those of
/// RigServer::start() and Catalogue::open().
Result<Rows> server_library_table(const StudyOptions& options) {
  Rows rows;
  int done = 0;
  for (const auto& measure : {measure_calls, measure_reading, measure_search}) {
    options.progress(done++, 3);
    if (Result<void> ok = measure(options, rows); !ok) return std::move(ok).error();
  }
  return rows;
}

namespace {

constexpr double kFirstAsked_ms = 500;
constexpr std::array kSizes_mp = {16, 100};

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
  for (const int megapixels : kSizes_mp) {
    if (Result<void> ok = measure_size(options, megapixels, rows); !ok) return std::move(ok).error();
    options.progress(++done, static_cast<int>(kSizes_mp.size()));
  }
  return rows;
}

}  // namespace weft::bench
