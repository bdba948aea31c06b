// SPDX-License-Identifier: Apache-2.0
#include "simulator/captures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "core/rig/camera.h"
#include "simulator/bare_rig.h"
#include "simulator/captures_layout.h"
#include "simulator/sampling/random.h"
#include "simulator/simulation_plan.h"
#include "simulator/spectra/observer.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;

constexpr double kBright = 0.85;  // of full scale: the brightest spot of white paper
constexpr CapturePose kTurned = {.rotation_deg = 90};

/// The LED that is farthest from LED 1 around the z axis, for even light from two.
int opposite_of_first(const NearLights& lights) {
  const auto across = [&](const NearLight& led) {
    const Vec3 a = led.position_mm, b = lights.leds.front().position_mm;
    return (a.x * b.x + a.y * b.y) / std::max(std::hypot(a.x, a.y) * std::hypot(b.x, b.y), 1e-9);
  };
  const auto least =
      std::min_element(lights.leds.begin(), lights.leds.end(),
                       [&](const NearLight& a, const NearLight& b) { return across(a) < across(b); });
  return static_cast<int>(least - lights.leds.begin()) + 1;
}

std::string rig_toml(const std::vector<Vec3>& positions_mm) {
  std::string text = "# Tape-measured.\n";
  for (const Vec3 p : positions_mm)
    text += fmt::format("\n[[led]]\nposition_mm = [{:.1f}, {:.1f}, {:.1f}]\n", p.x, p.y, p.z);
  return text;
}

class CaptureWriter {
 public:
  CaptureWriter(BareRig rig, const CapturesOptions& options)
      : bare_(std::move(rig)),
        options_(options),
        positions_mm_(bare_.taped(options.tape_error_mm, options.seed)) {
    for (int led = 1; led <= bare_.leds(); ++led) all_leds_.push_back(led);
    simulate_ = options.simulate;
    simulate_.calibration = bare_.start(positions_mm_);
    simulate_.truth = false;
  }

  Result<void> write_start(const fs::path& folder) {
    const Result<Calibration> written = write_calibration(folder, *simulate_.calibration);
    return written ? Result<void>() : written.error();
  }

  Result<void> write_camera(const fs::path& folder) {
    const std::vector<TargetSettings> poses =
        board_poses(scene_, rig_.camera, bare_.board(), options_.boards, options_.seed);
    const int other = opposite_of_first(rig_.leds);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::vector<int> leds = i % 3 == 2 || other == 1 ? std::vector{1} : std::vector{1, other};
      Scene scene = with({poses[i]});
      if (Result<void> ok = photograph(scene, poses[i], leds, folder / fmt::format("board{:02}.dng", i + 1));
          !ok)
        return ok;
    }
    const TargetSettings flat = bare_.flat_board();
    const std::vector<int> leds = other == 1 ? std::vector{1} : std::vector{1, other};
    if (Result<void> ok = photograph(with({flat}), flat, leds, folder / "table01.dng"); !ok) return ok;
    return write_file(folder / "board.toml", bare_.board_toml());
  }

  Result<void> write_response(const fs::path& folder) {
    constexpr double kShares[] = {0.125, 0.25, 0.5, 1};
    const std::vector<int> both = leds() > 1 ? std::vector{1, 2} : std::vector{1};
    const std::vector<TargetSettings> sheet = laid(bare_.sheet(), {}, paper_);
    const double longest_us = exposure_for(scene_, rig_, {sheet.front()}, both, kBright);
    Scene still = with(sheet);
    still.camera.exposure_us = longest_us;
    const std::pair<const char*, std::vector<int>> kFolders[] = {
        {"dark", {}}, {"led01", {1}}, {"led02", {2}}, {"led01+led02", both}};
    for (const auto& [name, lit] : kFolders) {
      if (leds() < 2 && (lit.size() > 1 || name == std::string("led02"))) continue;
      for (const double share : kShares) {
        const double exposure_us = std::round(share * longest_us);
        if (Result<void> ok = pair(still, lit, exposure_us, folder / name); !ok) return ok;
      }
    }
    if (Result<void> ok = write_scale(folder / "scale"); !ok) return ok;
    return scene_.effects.veil ? write_trap(folder / "trap") : Result<void>();
  }

  Result<void> write_color(const fs::path& folder) {
    const TargetSettings chart = bare_.chart();
    Scene scene = with({chart});
    scene.camera.exposure_us = session_exposure_us({chart});
    scene.fabric = "colour chart";
    if (Result<void> ok = session(scene, folder / "chart.weft"); !ok) return ok;
    return write_file(folder / "chart.toml", bare_.chart_toml());
  }

  Result<void> write_lights(const fs::path& folder) {
    const SheetLayout sheet = bare_.sheet();
    const std::vector<CapturePose> poses = five_poses();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Scene scene = with(laid(sheet, poses[i], paper_));
      scene.camera.exposure_us = sheets_exposure_us(sheet, poses);
      scene.fabric = "white sheet";
      if (Result<void> ok = session(scene, folder / fmt::format("sheet{:02}.weft", i + 1)); !ok) return ok;
    }
    if (Result<void> ok = write_file(folder / "sheet.toml", bare_.sheet_toml()); !ok) return ok;
    return write_file(folder / "rig.toml", rig_toml(positions_mm_));
  }

  Result<void> write_check(const fs::path& folder) {
    const SheetLayout sheet = bare_.sheet();
    const std::tuple<const char*, CapturePose, bool> kSessions[] = {
        {"turned", kTurned, true}, {"other", {}, false}, {"plane", plane_pose(), false}};
    for (const auto& [name, pose, same_sheet] : kSessions) {
      Scene scene = with(laid(sheet, pose, paper_, same_sheet));
      scene.camera.exposure_us = sheets_exposure_us(sheet, {pose});
      scene.camera.retakes.repeat = true;
      scene.fabric = fmt::format("white sheet, {}", name);
      if (Result<void> ok = session(scene, folder / fmt::format("{}.weft", name)); !ok) return ok;
    }
    if (Result<void> ok = write_file(folder / "sheet.toml", bare_.sheet_toml()); !ok) return ok;
    return write_file(folder / "check.toml",
                      fmt::format("[[plane]]\nsession = \"plane.weft\"\ntilt_deg = {}\nazimuth_deg = {}\n",
                                  plane_pose().tilt_deg, plane_pose().azimuth_deg));
  }

  const CapturesReport& report() const { return report_; }

 private:
  int leds() const { return bare_.leds(); }

  Scene with(const std::vector<TargetSettings>& things) const { return bare_.with(things); }

  double session_exposure_us(const std::vector<TargetSettings>& targets) const {
    double shortest = 1e9;
    for (const int led : all_leds_)
      shortest = std::min(shortest, exposure_for(scene_, rig_, targets, {led}, kBright));
    return shortest;
  }
  /// One exposure for a sheet in all of its poses.
  double sheets_exposure_us(const SheetLayout& sheet, const std::vector<CapturePose>& poses) const {
    std::vector<TargetSettings> papers;
    for (const CapturePose& pose : poses) papers.push_back(laid(sheet, pose, paper_).front());
    return session_exposure_us(papers);
  }

  /// Every session is another one for the noise, on the same sensor: its shots continue the numbers.
  Result<void> session(const Scene& scene, const fs::path& folder) {
    SimulateOptions options = simulate_;
    options.takes_before = takes_;
    const Result<SimulationReport> written = simulate_session(scene, folder, options);
    if (!written) return written.error();
    takes_ += 2 * leds() + 2;
    ++report_.sessions;
    return {};
  }

  Result<void> photograph(const Scene& scene, const std::vector<int>& lit, double exposure_us,
                          const fs::path& file) {
    SimulateOptions options = simulate_;
    options.takes_before = takes_;
    takes_ += leds() + 1;
    const Result<void> written = simulate_photograph(scene, {lit, exposure_us}, file, options);
    report_.photographs += written ? 1 : 0;
    return written;
  }
  Result<void> photograph(const Scene& scene, const TargetSettings& bright, const std::vector<int>& lit,
                          const fs::path& file) {
    return photograph(scene, lit, exposure_for(scene_, rig_, {bright}, lit, kBright), file);
  }
  Result<void> pair(const Scene& scene, const std::vector<int>& lit, double exposure_us,
                    const fs::path& folder) {
    if (Result<void> ok = make_writable_folder(folder); !ok) return ok;
    for (const char twin : {'a', 'b'}) {
      const fs::path file = folder / fmt::format("{:09}us_{}.dng", static_cast<long>(exposure_us), twin);
      if (Result<void> ok = photograph(scene, lit, exposure_us, file); !ok) return ok;
    }
    return {};
  }

  Result<void> write_scale(const fs::path& folder) {
    const TargetSettings scale = bare_.grey_scale();
    const double exposure_us = exposure_for(scene_, rig_, {scale}, {1}, kBright);
    if (Result<void> ok = pair(with({scale}), {1}, exposure_us, folder); !ok) return ok;
    return write_file(folder / "scale.toml", bare_.scale_toml());
  }

  Result<void> write_trap(const fs::path& folder) {
    const std::vector<TargetSettings> things = bare_.trap();
    const double exposure_us = exposure_for(scene_, rig_, {things[1]}, {1}, kBright);
    return pair(with(things), {1}, exposure_us, folder);
  }

  const BareRig bare_;
  const Scene& scene_ = bare_.table();
  const SceneRig& rig_ = bare_.rig();
  const TargetSettings& paper_ = bare_.paper();
  const CapturesOptions& options_;
  std::vector<Vec3> positions_mm_;
  std::vector<int> all_leds_;
  SimulateOptions simulate_;
  CapturesReport report_;
  int takes_ = 0;  ///< photographs so far
};

using Writer = Result<void> (CaptureWriter::*)(const fs::path&);
constexpr std::pair<const char*, Writer> kWriters[] = {
    {"start", &CaptureWriter::write_start},       {"camera", &CaptureWriter::write_camera},
    {"response", &CaptureWriter::write_response}, {"color", &CaptureWriter::write_color},
    {"lights", &CaptureWriter::write_lights},     {"check", &CaptureWriter::write_check}};

Result<std::vector<std::string>> chosen(const CapturesOptions& options, const BareRig& rig) {
  std::vector<std::string> parts = options.parts;
  if (parts.empty()) {
    parts = capture_parts();
    if (!rig.has_chart()) std::erase(parts, "color");
  }
  for (const std::string& part : parts) {
    const std::vector<std::string>& all = capture_parts();
    if (std::find(all.begin(), all.end(), part) == all.end()) {
      return Error{ErrorKind::kUsage, "there are no such captures", part,
                   fmt::format("there are {}", fmt::join(all, ", ")), "name one of these"};
    }
    if (part == "color" && !rig.has_chart()) {
      return Error{ErrorKind::kUsage, "the scene has no colour chart", "color",
                   "it names no spectra.chart or not the effect spectral",
                   "add them to the scene or leave color out"};
    }
  }
  if (options.boards < 1 || options.boards > 99 || !(options.tape_error_mm >= 0)) {
    return Error{ErrorKind::kUsage, "captures cannot be taken", "options",
                 "there can be 1 to 99 boards, and no tape measures better than 0 mm", "correct them"};
  }
  return parts;
}

}  // namespace

const std::vector<std::string>& capture_parts() {
  static const std::vector<std::string> kParts = [] {
    std::vector<std::string> names;
    for (const auto& [name, writer] : kWriters) names.emplace_back(name);
    return names;
  }();
  return kParts;
}

Result<CapturesReport> simulate_captures(const Scene& given, const fs::path& folder,
                                         const CapturesOptions& options) {
  Result<BareRig> rig = BareRig::of(given);
  if (!rig) return std::move(rig).error();
  const Result<std::vector<std::string>> parts = chosen(options, *rig);
  if (!parts) return parts.error();
  CaptureWriter writer(std::move(*rig), options);
  if (Result<void> ok = make_writable_folder(folder); !ok) return ok.error();
  for (const std::string& part : *parts) {
    if (is_there(folder / part)) {
      return Error{ErrorKind::kCannotCreate, "captures exist", (folder / part).string(),
                   "they are never overwritten", "choose another folder with -o or remove them"};
    }
    const auto found = std::find_if(std::begin(kWriters), std::end(kWriters),
                                    [&](const auto& each) { return part == each.first; });
    PartialFolder aside(folder / part);
    if (Result<void> ok = make_writable_folder(aside.path()); !ok) return ok.error();
    if (Result<void> ok = (writer.*found->second)(aside.path()); !ok) return ok.error();
    if (Result<void> ok = aside.publish(); !ok) return ok.error();
  }
  CapturesReport report = writer.report();
  report.parts = *parts;
  return report;
}

}  // namespace weft::simulator
