// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/studies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/oracles/simulated_cloth.h"
#include "capture/framing/focus.h"

namespace weft::bench {
namespace {

constexpr std::array kCloths = {"smooth", "plain", "twill", "satin", "deep"};
constexpr std::array kBlurs_px = {0.0, 2.0, 4.0, 8.0};
constexpr double kFinest_px = 2;  // the simulator's disc is of whole pixels: a smaller one is none
constexpr int kRepeats = 20;      // photographs of each blur
constexpr int kWidth = 480, kHeight = 360;

struct Scores {
  double mean = 0, sigma = 0;
};

/// A corner of the cloth at its own scale, by one LED.
simulator::Scene cut(simulator::Scene scene, double blur_px) {
  scene.camera.width = kWidth;
  scene.camera.height = kHeight;
  scene.effects.defocus = true;
  scene.effects.noise = true;
  scene.camera.blur.defocus_px = blur_px;
  scene.lights.rings = {simulator::LedRing()};
  scene.lights.leds.clear();
  return scene;
}

Scores scores_of(const simulator::Scene& scene, int repeats) {
  const test::SimulatedCloth cloth(scene);
  const std::optional<Response>& response = cloth.calibration().response;
  const capture::PhotositeNoise noise = {response->electrons_per_count, response->read_noise_counts};
  double sum = 0, squares = 0;
  for (int i = 0; i < repeats; ++i) {
    const RawFrame frame =
        cloth.photograph({{{1, 1.0}}, 0}, cloth.scene_exposure_us(), static_cast<std::uint32_t>(i + 1));
    const double score = capture::focus_of(frame, noise).score;
    sum += score;
    squares += score * score;
  }
  const double mean = sum / repeats;
  return {mean, std::sqrt(std::max(squares / repeats - mean * mean, 0.0) * repeats / (repeats - 1))};
}

}  // namespace

/// How well the focus score tells blur. A row a cloth and diameter of the disc that blurs it, in raw pixels:
/// "score" (mean of the repeats), "drop" (percent of the score in focus), "sigmas" (that drop over the
/// standard deviation of a photograph's score), and for two pixels across "just_told_px", the diameter whose
/// drop is one sigma, the score falling with its square. By one LED; the lens's own spread is in all of them.
/// Errors: those of read_scene().
Result<Rows> capture_focus_table(const StudyOptions& options) {
  const int repeats = options.runs > 1 ? options.runs : kRepeats;
  Rows rows;
  int done = 0;
  for (const char* cloth : kCloths) {
    Result<simulator::Scene> scene = simulator::read_scene(options.scenes / (std::string(cloth) + ".toml"));
    if (!scene) return std::move(scene).error();
    Scores sharp;
    for (const double blur_px : kBlurs_px) {
      const Scores scores = scores_of(cut(*scene, blur_px), repeats);
      if (blur_px == 0) sharp = scores;
      const double drop = 1 - scores.mean / sharp.mean;
      const double sigmas = drop * sharp.mean / sharp.sigma;
      rows.push_back({{"cloth", cloth},
                      {"blur_px", blur_px},
                      {"score", scores.mean},
                      {"drop", 100 * drop},
                      {"sigmas", sigmas},
                      {"just_told_px",
                       blur_px == kFinest_px && sigmas > 0 ? Json(kFinest_px / std::sqrt(sigmas)) : Json()}});
      options.progress(++done, static_cast<int>(kCloths.size() * kBlurs_px.size()));
    }
  }
  return rows;
}

}  // namespace weft::bench
