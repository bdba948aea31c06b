// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <string>

#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"
#include "bench/server/door.h"
#include "bench/server/lease.h"
#include "bench/server/library.h"
#include "bench/server/scan_beside.h"
#include "bench/server/tiles.h"
#include "core/process.h"

namespace weft::bench {
namespace {

struct ServerArguments {
  std::string part = "lease";
  int runs = 0;
  std::uint64_t seed = 1;
};

Result<Rows> measure_library(const ServerArguments& a, app::ProgressLine& line) {
  ServerLibraryOptions options;
  if (a.runs > 0) options.questions = a.runs;
  options.progress = [&](int done, int steps) { line.update("library", static_cast<double>(done) / steps); };
  return server_library_table(options);
}

Result<Rows> measure_scan(const ServerArguments& a, app::ProgressLine& line) {
  ScanBesideOptions options;
  options.programs = program_beside("weft").parent_path();
  if (a.runs > 0) options.turns = a.runs;
  if (a.part == "viewers") options.viewers = 2;
  options.seed = a.seed;
  options.progress = [&](int done, int turns) { line.update("scan", static_cast<double>(done) / turns); };
  return scan_beside_table(options);
}

Result<Rows> measure_tiles(const ServerArguments& a, app::ProgressLine& line) {
  ServerTilesOptions options;
  if (a.runs > 0) options.tiles = a.runs;
  options.seed = a.seed;
  options.progress = [&](int done, int steps) { line.update("tiles", static_cast<double>(done) / steps); };
  return server_tiles_table(options);
}

Result<Rows> measure(const ServerArguments& a, bool quiet) {
  if (a.part == "door") return door_table({.requests = a.runs > 0 ? a.runs : 200, .seed = a.seed});
  app::ProgressLine line(quiet);
  if (a.part == "library") return measure_library(a, line);
  if (a.part == "scan" || a.part == "viewers") return measure_scan(a, line);
  if (a.part == "tiles") return measure_tiles(a, line);
  ServerLeaseOptions options;
  options.programs = program_beside("weft").parent_path();
  if (a.runs > 0) options.trials = a.runs;
  options.seed = a.seed;
  options.progress = [&](int done, int trials) { line.update("lease", static_cast<double>(done) / trials); };
  return server_lease_table(options);
}

app::Run add_server(app::Options& options) {
  const auto a = std::make_shared<ServerArguments>();
  options
      .add("--part", &a->part,
           "lease: how soon a LED is dark once its client or the daemon has died; door: answers beside "
           "malformed requests, silent clients and slow readers; library: answers with tens of thousands of "
           "sessions, which it makes in a temporary folder; scan: a scan beside malformed requests, silent "
           "clients "
           "and slow readers, over one alone; tiles: what a viewer waits for, of maps of 16 and 100 "
           "megapixels; viewers: a scan beside two who look at tiles, over one alone")
      .one_of({"lease", "door", "library", "scan", "tiles", "viewers"})
      .shows_default();
  options
      .add("--runs", &a->runs,
           "Trials of each death, requests or tiles of each row, or pairs of scans; 0 is as many as "
           "docs/reliability.md")
      .in_range(0, 1000000);
  options.add("--seed", &a->seed, "Of the moments, or of malformed requests").shows_default();
  return [a](const app::CommonArguments& common) { return print_rows(measure(*a, common.quiet), common); };
}

}  // namespace

app::Verb server_verb() {
  return {"server", "The server: what it promises, measured", add_server};
}

}  // namespace weft::bench
