// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/scans.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "bench/capture/camera.h"
#include "bench/capture/process_size.h"
#include "capture/raw/decode.h"
#include "capture/scan/scan.h"
#include "core/files.h"
#include "core/job.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kRows = 10, kTurns = 13;

/// What frames show, whatever their times and numbers.
using Digests = std::map<std::string, std::string>;

Result<Digests> digests_of(const Session& session) {
  Digests digests;
  for (const Shot& shot : session.shots) {
    const Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
    if (!frame) return frame.error();
    const View<const std::uint16_t> counts = frame->counts.plane();
    std::string bytes;
    for (int y = 0; y < counts.size().height; ++y) {
      bytes.append(reinterpret_cast<const char*>(counts.row(y)),
                   static_cast<std::size_t>(counts.size().width) * sizeof(std::uint16_t));
    }
    digests[shot.file] = sha256_of(bytes);
  }
  return digests;
}

struct OneScan {
  double seconds = 0;
  std::size_t frames = 0;
  Digests digests;
  ProcessSize camera;  ///< weft-camera at its end
};

/// Seconds of a turn of the bare loop, in the mean.
Result<double> bare_s(const ScansOptions& options) {
  const Result<std::vector<double>> turns = bare_shots_s({.port = options.rig.camera.port,
                                                          .profile = options.rig.camera.profile,
                                                          .exposure_us = options.exposure_us,
                                                          .shots = kTurns});
  if (!turns) return turns.error();
  return std::accumulate(turns->begin(), turns->end(), 0.0) / kTurns;
}

Result<OneScan> scan_once(const ScansOptions& options, const fs::path& folder) {
  Stopwatch watch;
  Result<capture::RigDevices> devices = options.open(options.rig);
  if (!devices) return std::move(devices).error();
  capture::ScanRequest request;
  request.session = folder;
  request.fabric = "bench";
  request.rig = options.rig.name;
  request.calibration = options.rig.scan.calibration;
  request.exposure = {options.exposure_us, options.rig.scan.iso, options.rig.scan.f_number};
  const Result<capture::ScanOutcome> outcome = capture::scan(request, *devices->lamps, *devices->camera, {},
                                                             {.cancel = options.stop, .pause = nullptr});
  if (!outcome) return outcome.error();
  OneScan one;
  one.seconds = watch.lap();
  one.frames = outcome->session.shots.size();
  if (const auto worker = child_of(::getpid(), "weft-camera"))
    one.camera = size_of(*worker).value_or(ProcessSize{});
  Result<Digests> digests = digests_of(outcome->session);
  if (!digests) return std::move(digests).error();
  one.digests = std::move(*digests);
  return one;
}

}  // namespace

Result<Rows> capture_scans_table(const ScansOptions& options) {
  const TemporaryFolder scratch;
  const Result<double> bare = bare_s(options);
  if (!bare) return bare.error();
  Rows rows;
  Digests first;
  std::vector<double> seconds;
  int differ = 0;
  for (int i = 1; i <= options.scans; ++i) {
    const fs::path session = scratch.path() / "scan.weft";
    const Result<OneScan> one = scan_once(options, session);
    if (!one) return one.error();
    if (i == 1) first = one->digests;
    for (const auto& [file, digest] : one->digests) differ += first[file] == digest ? 0 : 1;
    seconds.push_back(one->seconds);
    std::error_code failed;
    fs::remove_all(session, failed);
    if (failed) return cannot_write(session, failed.value());
    options.progress(i);
    if (i != 1 && i != options.scans && i % std::max(1, options.scans / kRows) != 0) continue;
    const double middle = median(seconds);
    const ProcessSize size = size_of(::getpid()).value_or(ProcessSize{});
    rows.push_back({{"scans", i},
                    {"frames", one->frames},
                    {"least_s", *std::ranges::min_element(seconds)},
                    {"median_s", middle},
                    {"over_bare_loop", middle / (*bare * static_cast<double>(one->frames))},
                    {"resident_mb", static_cast<double>(size.resident_bytes) / 1e6},
                    {"descriptors", size.descriptors},
                    {"camera_resident_mb", static_cast<double>(one->camera.resident_bytes) / 1e6},
                    {"camera_descriptors", one->camera.descriptors},
                    {"frames_that_differ", differ}});
  }
  return rows;
}

}  // namespace weft::bench
