// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/studies.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <string>

#include "bench/base/libraw_alone.h"
#include "bench/base/rig.h"
#include "bench/solve/write_alone.h"
#include "core/parallel.h"
#include "core/session.h"
#include "core/temporary_folder.h"
#include "simulator/simulate.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

// Standard output of a command, parsed as JSON.
Result<Json> json_of_command(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return Error{ErrorKind::kTryAgain, "cannot start", command, "", ""};
  std::string text;
  std::array<char, 4096> block = {};
  for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    text.append(block.data(), n);
  const int status = pclose(pipe);
  Json json = Json::parse(text, nullptr, false);
  if (status != 0 || json.is_discarded())
    return Error{ErrorKind::kInternal, "the solve failed", command, text, ""};
  return json;
}

// OpenEXR and libpng alone: the maps of a solve, as they are on disk, written again in one call each.
Result<double> write_seconds(const fs::path& maps, const fs::path& folder) {
  double sum = 0;
  for (const char* name : {"normal.exr", "albedo.exr", "sigma.exr", "residual.exr", "status.png"}) {
    const Result<double> seconds = write_alone_seconds(maps / name, folder / name);
    if (!seconds) return seconds.error();
    sum += *seconds;
  }
  return sum;
}

}  // namespace

/// From eleven DNG files to maps on disk by `weft solve --quality fast`, next to LibRaw's unpacking of the
/// same files and OpenEXR's and libpng's writing of the same maps, with the same threads: `ratio` is decode
/// to write over their sum, without compression, syncing and hashing. Memory is the peak of the process.
Result<Rows> end_to_end(const StudyOptions& options) {
  const TemporaryFolder scratch;
  const Size size = bench_size(options.megapixels);
  const int threads = resolved_threads(options.threads);
  simulator::Scene scene;
  scene.camera.width = size.width;
  scene.camera.height = size.height;
  scene.camera.mm_per_pixel = 200.0 / size.width;
  scene.geometry.kind = simulator::GeometryKind::kTwill;
  scene.effects.near_light = true;
  scene.effects.noise = true;
  const fs::path folder = scratch.path() / "cloth.weft";
  const auto simulated =
      simulator::simulate_session(scene, folder, {.tiles = {.threads = threads}, .stop = {}, .progress = {}});
  if (!simulated) return simulated.error();

  // Without digests in the journal nothing is hashed while solving.
  Result<Session> session = read_session(folder);
  if (!session) return std::move(session).error();
  std::vector<fs::path> files;
  for (Shot& shot : session->shots) {
    shot.sha256.clear();
    files.push_back(session->path_of(shot));
  }
  if (Result<void> written = write_session(*session); !written) return std::move(written).error();

  const Result<double> unpack = unpack_seconds(files, threads);
  if (!unpack) return unpack.error();
  double best = 0, peak = 0;
  Json seconds;
  fs::path maps;
  for (int i = 0; i < 3; ++i) {
    maps = scratch.path() / fmt::format("maps{}", i);
    const Result<Json> solved = json_of_command(
        fmt::format("'{}' solve '{}' -o '{}' --quality fast --no-previews --quiet --json --threads {}",
                    (options.programs / "weft").string(), folder.string(), maps.string(), threads));
    if (!solved) return solved.error();
    const Json& s = (*solved)["seconds"];
    const double work = s["read"].get<double>() + s["solve"].get<double>() + s["write"].get<double>();
    if (i == 0 || work < best) {
      best = work;
      seconds = s;
    }
    peak = std::max(peak, (*solved)["peak_bytes"].get<double>());
  }
  const Result<double> write = write_seconds(maps, scratch.path());
  if (!write) return write.error();
  return Rows{{{"quality", "fast"},
               {"megapixels", static_cast<double>(size.pixels()) * 1e-6},
               {"threads", threads},
               {"read_s", seconds["read"]},
               {"solve_s", seconds["solve"]},
               {"write_s", seconds["write"]},
               {"decode_to_write_s", best},
               {"unpack_alone_s", *unpack},
               {"write_alone_s", *write},
               {"ratio", best / (*unpack + *write)},
               {"ns_per_pixel", best * 1e9 / static_cast<double>(size.pixels())},
               {"peak_mb", peak / (1 << 20)}}};
}

}  // namespace weft::bench
