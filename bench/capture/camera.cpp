// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/camera.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

#include "capture/camera/camera_link.h"
#include "capture/camera/worker_lines.h"
#include "capture/camera/worker_process.h"
#include "core/error_json.h"
#include "core/files.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

constexpr double kBar = 1.15;
constexpr auto kPatience = std::chrono::seconds(10);

Result<Json> ask(capture::WorkerProcess& worker, const Json& request, Steady::duration patience) {
  if (Result<void> sent = worker.send(request.dump()); !sent) return std::move(sent).error();
  const Result<std::string> line = worker.read_line(Steady::now() + patience);
  if (!line) return line.error();
  const Json answer = Json::parse(*line, nullptr, false);
  if (answer.is_object() && answer.contains("ok")) return answer["ok"];
  return error_of_json(answer.is_object() ? answer.value("error", Json()) : Json(), "weft-camera");
}

capture::ExposureSettings exposure_of(const CaptureCameraBenchOptions& options) {
  return {options.exposure_us, 100, 8};
}

Result<void> add_bare(const CaptureCameraBenchOptions& options, const fs::path& home,
                      std::vector<double>& seconds) {
  const auto worker =
      capture::WorkerProcess::start(capture::weft_camera_program(), {{"HOME", home.string()}});
  if (!worker) return worker.error();
  const Json open = {
      {"id", 1}, {"do", "open"}, {"profile", options.profile}, {"port", options.port}, {"serial", ""}};
  if (const auto opened = ask(**worker, open, kPatience); !opened) return opened.error();
  const Json set = {{"id", 2}, {"do", "set"}, {"exposure", capture::line_of(exposure_of(options))}};
  if (const auto done = ask(**worker, set, kPatience); !done) return done.error();
  const Json bare = {{"id", 3}, {"do", "bare"}, {"shots", options.shots}};
  const Result<Json> taken = ask(**worker, bare, options.shots * kPatience);
  if (!taken) return taken.error();
  for (const Json& each : (*taken)["seconds"]) seconds.push_back(each.get<double>());
  (*worker)->end(Steady::now() + std::chrono::seconds(1));
  return {};
}

Result<void> add_ours(const CaptureCameraBenchOptions& options, const fs::path& home, const fs::path& folder,
                      std::vector<double>& seconds) {
  capture::CameraLinkOptions link_options;
  link_options.port = options.port;
  link_options.profile = options.profile;
  link_options.state = home;
  const auto link = capture::CameraLink::make(std::move(link_options));
  if (!link) return link.error();
  if (const auto facts = (*link)->connect(); !facts) return facts.error();
  if (const auto facts = (*link)->set(exposure_of(options)); !facts) return facts.error();
  for (int shot = 0; shot < options.shots; ++shot) {
    const auto begin = Steady::now();
    const auto taken = (*link)->take(folder / ("shot" + std::to_string(shot)), [] {});
    if (!taken) return taken.error();
    seconds.push_back(std::chrono::duration<double>(Steady::now() - begin).count());
    std::error_code ignored;
    fs::remove(taken->file, ignored);
  }
  return {};
}

}  // namespace

Result<std::vector<double>> bare_shots_s(const CaptureCameraBenchOptions& options) {
  const TemporaryFolder scratch;
  std::vector<double> seconds;
  if (Result<void> ok = add_bare(options, scratch.path(), seconds); !ok) return std::move(ok).error();
  return seconds;
}

Result<Rows> capture_camera_table(const CaptureCameraBenchOptions& options) {
  const TemporaryFolder scratch;
  const fs::path folder = options.folder.empty() ? scratch.path() : options.folder;
  if (Result<void> made = make_writable_folder(folder); !made) return std::move(made).error();
  std::vector<double> bare, ours;
  for (int round = 0; round < options.rounds; ++round) {
    if (Result<void> ok = add_bare(options, scratch.path(), bare); !ok) return std::move(ok).error();
    if (Result<void> ok = add_ours(options, scratch.path(), folder, ours); !ok) return std::move(ok).error();
  }
  const double yardstick = median(bare);
  return Rows{
      {{"loop", "bare"}, {"shots", bare.size()}, {"seconds", yardstick}, {"ratio", 1.0}, {"bar", kBar}},
      {{"loop", "weft"},
       {"shots", ours.size()},
       {"seconds", median(ours)},
       {"ratio", median(ours) / yardstick},
       {"bar", kBar}}};
}

}  // namespace weft::bench
