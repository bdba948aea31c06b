// SPDX-License-Identifier: Apache-2.0
#include "simulator/captures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/calibration.h"
#include "core/camera.h"
#include "core/files.h"
#include "simulator/captures_layout.h"
#include "simulator/plan.h"
#include "simulator/sampling/random.h"
#include "simulator/spectra/observer.h"

namespace weft::simulator {
namespace {

namespace fs = std::filesystem;

constexpr double kTableAlbedo = 0.08;
constexpr double kThickness_mm = 3;  // of the board
constexpr double kWhite = 0.88;      // of paper, where the scene has none
constexpr double kBright = 0.85;     // of full scale: the brightest spot of white paper
constexpr double kTrapShare = 0.15;  // of the frame's height
constexpr CapturePose kTurned = {.rotation_deg = 90};
constexpr CapturePose kPlane = {.tilt_deg = 15, .azimuth_deg = 210};

/// The rig of a scene over a bare dark table, every effect of the cloth left out.
Result<Scene> bare_table(const Scene& given) {
  const Result<Plan> plan = plan_of(given);
  if (!plan) return plan.error();
  Scene scene = plan->scene;
  scene.fabric = "calibration";
  scene.geometry = {};
  scene.material = {};
  scene.targets = furniture(plan->scene, plan->rig.camera);
  scene.damage.clear();
  scene.frames = FrameFormat::kDng;
  scene.camera.retakes.repeat = false;
  scene.camera.retakes.bracket.reset();
  EffectSettings& on = scene.effects;
  on.relief = on.cast_shadows = on.interreflection = on.translucency = on.reflectance = on.movement = false;
  if (on.spectral) {
    scene.material.dye = flat_spectrum(kTableAlbedo);
  } else {
    scene.material.albedo.fill(kTableAlbedo);
  }
  return scene;
}

TargetSettings paper_of(const Scene& scene) {
  const auto paper = std::find_if(scene.targets.begin(), scene.targets.end(), [](const TargetSettings& t) {
    return kind_of(t.pattern) == TargetKind::kPaper;
  });
  TargetSettings plain;
  plain.white = kWhite;
  return paper == scene.targets.end() ? plain : *paper;
}

/// LED positions as a tape measure gives them.
std::vector<Vec3> taped(const NearLights& lights, double error_mm, std::int64_t seed) {
  constexpr std::uint32_t kTapeStream = 1;
  std::vector<Vec3> positions_mm;
  for (std::size_t k = 0; k < lights.leds.size(); ++k) {
    const auto n = static_cast<std::uint32_t>(k);
    const std::array<std::uint32_t, 2> key = {static_cast<std::uint32_t>(seed), kTapeStream};
    const NormalPair xy = normal_pair(philox({n, 0, 0, 0}, key));
    const NormalPair z = normal_pair(philox({n, 1, 0, 0}, key));
    const Vec3 off = error_mm * normalized({xy.first, xy.second, z.first});
    positions_mm.push_back(lights.leds[k].position_mm + off);
  }
  return positions_mm;
}

Calibration start_of(const Scene& scene, const SceneRig& rig, const std::vector<Vec3>& positions_mm) {
  Calibration start;
  start.subject = exact_calibration(scene, rig).subject;
  start.subject.albedo_scale = AlbedoScale::kRelative;
  start.camera = overhead_camera(rig.camera.size, scene.camera.distance_mm, scene.camera.mm_per_pixel);
  start.response = response_of(rig.sensor);
  NearLights lights;
  for (const Vec3 position : positions_mm) {
    NearLight& led = lights.leds.emplace_back();
    led.position_mm = position;
    led.aim = normalized(-1.0 * position);
    led.flux_rgb.fill(scene.lights.flux);
  }
  start.lights = std::move(lights);
  return start;
}

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

std::string sheet_toml(const SheetLayout& sheet, double reflectance) {
  std::string text = fmt::format("width_mm = {}\nheight_mm = {}\nreflectance = {}\nmargin_mm = {}\n",
                                 sheet.width_mm, sheet.height_mm, reflectance, sheet.margin_mm);
  for (const CaptureTag& tag : sheet.tags) {
    text +=
        fmt::format("\n[[tag]]\ndictionary = \"{}\"\nid = {}\nside_mm = {}\ncentre_mm = [{:.4f}, {:.4f}]\n",
                    TagSettings().dictionary, tag.id, sheet.tag_mm, tag.centre_mm[0], tag.centre_mm[1]);
  }
  return text;
}

std::string rig_toml(const std::vector<Vec3>& positions_mm) {
  std::string text = "# Tape-measured.\n";
  for (const Vec3 p : positions_mm)
    text += fmt::format("\n[[led]]\nposition_mm = [{:.1f}, {:.1f}, {:.1f}]\n", p.x, p.y, p.z);
  return text;
}

// The patches as the observer sees them.
std::string chart_toml(const std::vector<Spectrum>& patches) {
  std::string text = "rec709 = [\n";
  for (const Spectrum& patch : patches) {
    const auto [r, g, b] = rec709_albedo(patch);
    text += fmt::format("  [{:.6f}, {:.6f}, {:.6f}],\n", r, g, b);
  }
  return text + "]\n";
}

std::string board_toml(const CharucoSettings& board) {
  return fmt::format(
      "kind = \"charuco\"\nsquares_x = {}\nsquares_y = {}\nsquare_mm = {}\nmarker_share = {}\ndictionary = "
      "\"{}\"\nthickness_mm = {}\n",
      board.squares_x, board.squares_y, board.square_mm, board.marker_share, board.dictionary, kThickness_mm);
}

class CaptureWriter {
 public:
  CaptureWriter(Scene scene, SceneRig rig, TargetSettings paper, const CapturesOptions& options)
      : scene_(std::move(scene)),
        rig_(std::move(rig)),
        paper_(std::move(paper)),
        options_(options),
        positions_mm_(taped(rig_.leds, options.tape_error_mm, options.seed)) {
    for (std::size_t k = 1; k <= rig_.leds.leds.size(); ++k) all_leds_.push_back(static_cast<int>(k));
    simulate_ = options.simulate;
    simulate_.calibration = start_of(scene_, rig_, positions_mm_);
    simulate_.truth = false;
  }

  Result<void> write_start(const fs::path& folder) {
    const Result<Calibration> written = write_calibration(folder, *simulate_.calibration);
    return written ? Result<void>() : written.error();
  }

  Result<void> write_camera(const fs::path& folder) {
    const CharucoSettings board = board_pattern(scene_);
    std::vector<TargetSettings> poses =
        board_poses(scene_, rig_.camera, board, options_.boards, options_.seed);
    const int other = opposite_of_first(rig_.leds);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::vector<int> leds = i % 3 == 2 || other == 1 ? std::vector{1} : std::vector{1, other};
      Scene scene = with({poses[i]});
      if (Result<void> ok = photograph(scene, poses[i], leds, folder / fmt::format("board{:02}.dng", i + 1));
          !ok)
        return ok;
    }
    TargetSettings flat;
    flat.pattern = board;
    flat.centre_mm.z = kThickness_mm;
    const std::vector<int> leds = other == 1 ? std::vector{1} : std::vector{1, other};
    if (Result<void> ok = photograph(with({flat}), flat, leds, folder / "table01.dng"); !ok) return ok;
    return write_file(folder / "board.toml", board_toml(board));
  }

  Result<void> write_response(const fs::path& folder) {
    constexpr double kShares[] = {0.125, 0.25, 0.5, 1};
    const std::vector<int> both = leds() > 1 ? std::vector{1, 2} : std::vector{1};
    const std::vector<TargetSettings> sheet = laid(lights_sheet(), {}, paper_);
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
    return scene_.effects.veil ? write_trap(folder / "trap", sheet) : Result<void>();
  }

  Result<void> write_color(const fs::path& folder) {
    TargetSettings chart;
    ChartSettings pattern;
    pattern.patch_mm = std::floor(0.6 * scene_.camera.width * scene_.camera.mm_per_pixel / 6 / 1.1);
    pattern.gap_mm = 0.1 * pattern.patch_mm;
    pattern.frame_mm = 0.2 * pattern.patch_mm;
    chart.pattern = pattern;
    chart.centre_mm.z = 1;
    Scene scene = with({chart});
    scene.camera.exposure_us = session_exposure_us({chart});
    scene.fabric = "colour chart";
    if (Result<void> ok = session(scene, folder / "chart.weft"); !ok) return ok;
    return write_file(folder / "chart.toml", chart_toml(scene_.spectra.chart));
  }

  Result<void> write_lights(const fs::path& folder) {
    const SheetLayout sheet = lights_sheet();
    const std::vector<CapturePose> poses = five_poses();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Scene scene = with(laid(sheet, poses[i], paper_));
      scene.camera.exposure_us = sheets_exposure_us(sheet, poses);
      scene.fabric = "white sheet";
      if (Result<void> ok = session(scene, folder / fmt::format("sheet{:02}.weft", i + 1)); !ok) return ok;
    }
    if (Result<void> ok = write_file(folder / "sheet.toml", sheet_toml(sheet, paper_.white)); !ok) return ok;
    return write_file(folder / "rig.toml", rig_toml(positions_mm_));
  }

  Result<void> write_check(const fs::path& folder) {
    const SheetLayout sheet = lights_sheet();
    const std::tuple<const char*, CapturePose, bool> kSessions[] = {
        {"turned", kTurned, true}, {"other", {}, false}, {"plane", kPlane, false}};
    for (const auto& [name, pose, same_sheet] : kSessions) {
      Scene scene = with(laid(sheet, pose, paper_, same_sheet));
      scene.camera.exposure_us = sheets_exposure_us(sheet, {pose});
      scene.camera.retakes.repeat = true;
      scene.fabric = fmt::format("white sheet, {}", name);
      if (Result<void> ok = session(scene, folder / fmt::format("{}.weft", name)); !ok) return ok;
    }
    if (Result<void> ok = write_file(folder / "sheet.toml", sheet_toml(sheet, paper_.white)); !ok) return ok;
    return write_file(folder / "check.toml",
                      fmt::format("[[plane]]\nsession = \"plane.weft\"\ntilt_deg = {}\nazimuth_deg = {}\n",
                                  kPlane.tilt_deg, kPlane.azimuth_deg));
  }

  const CapturesReport& report() const { return report_; }

 private:
  int leds() const { return static_cast<int>(rig_.leds.leds.size()); }

  SheetLayout lights_sheet() const {
    std::vector<CapturePose> poses = five_poses();
    poses.push_back(kPlane);
    return sheet_layout(scene_, rig_.camera, poses);
  }

  /// The table with these things on it. What was there keeps its number behind them.
  Scene with(std::vector<TargetSettings> targets) const {
    Scene scene = scene_;
    scene.targets.insert(scene.targets.begin(), targets.begin(), targets.end());
    return scene;
  }

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
    TargetSettings scale;
    GreyScaleSettings pattern;
    const double width_mm = 0.8 * scene_.camera.width * scene_.camera.mm_per_pixel;
    pattern.patch_mm = std::floor(width_mm / static_cast<double>(pattern.reflectances.size()) / 1.1);
    pattern.gap_mm = 0.1 * pattern.patch_mm;
    scale.pattern = pattern;
    scale.centre_mm.z = 1;
    const double exposure_us = exposure_for(scene_, rig_, {scale}, {1}, kBright);
    if (Result<void> ok = pair(with({scale}), {1}, exposure_us, folder); !ok) return ok;
    return write_file(folder / "scale.toml",
                      fmt::format("reflectances = [{}]\ncorners_px = [{}]\n",
                                  fmt::join(pattern.reflectances, ", "), corners_px(scale, pattern)));
  }

  /// The sheet with a hole in its middle that sends nothing back.
  Result<void> write_trap(const fs::path& folder, std::vector<TargetSettings> things) {
    TargetSettings trap;
    const double height_mm = scene_.camera.height * scene_.camera.mm_per_pixel;
    trap.pattern = GreyScaleSettings{
        .reflectances = {0}, .patch_mm = kTrapShare * height_mm, .gap_mm = 0, .margin_mm = 0};
    trap.white = 0;
    trap.centre_mm.z = 1;
    const double exposure_us = exposure_for(scene_, rig_, {things.front()}, {1}, kBright);
    things.insert(things.begin(), std::move(trap));
    return pair(with(things), {1}, exposure_us, folder);
  }

  /// Of the row of patches, clockwise from the upper left of the first.
  std::string corners_px(const TargetSettings& scale, const GreyScaleSettings& pattern) const {
    const auto patches = static_cast<double>(pattern.reflectances.size());
    const double u = (patches * pattern.patch_mm + (patches - 1) * pattern.gap_mm) / 2,
                 v = pattern.patch_mm / 2;
    std::string text;
    for (const auto& [x, y] : {std::pair{-u, v}, {u, v}, {u, -v}, {-u, -v}}) {
      const Vec3 p = project(rig_.camera, scale.centre_mm + Vec3{x, y, 0});
      text += fmt::format("{}[{:.2f}, {:.2f}]", text.empty() ? "" : ", ", p.x, p.y);
    }
    return text;
  }

  Scene scene_;
  SceneRig rig_;
  TargetSettings paper_;
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

bool has_chart(const Scene& scene) {
  return !scene.spectra.chart.empty() && scene.effects.spectral;
}

Result<std::vector<std::string>> chosen(const CapturesOptions& options, const Scene& scene) {
  std::vector<std::string> parts = options.parts;
  if (parts.empty()) {
    parts = capture_parts();
    if (!has_chart(scene)) std::erase(parts, "color");
  }
  for (const std::string& part : parts) {
    const std::vector<std::string>& all = capture_parts();
    if (std::find(all.begin(), all.end(), part) == all.end()) {
      return Error{ErrorKind::kUsage, "there are no such captures", part,
                   fmt::format("there are {}", fmt::join(all, ", ")), "name one of these"};
    }
    if (part == "color" && !has_chart(scene)) {
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
  Result<Scene> scene = bare_table(given);
  if (!scene) return scene.error();
  const Result<SceneRig> rig = rig_of(*scene);
  if (!rig) return rig.error();
  const Result<std::vector<std::string>> parts = chosen(options, *scene);
  if (!parts) return parts.error();
  CaptureWriter writer(*scene, *rig, paper_of(given), options);
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
