// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gloss.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/solve_record.h"
#include "pipeline/corrected_tile.h"
#include "pipeline/left_out.h"
#include "pipeline/light_correction.h"
#include "pipeline/samples.h"
#include "pipeline/tile_reader.h"
#include "solver/reflectance/glossy_method.h"
#include "solver/sample_tiles.h"
#include "solver/uncertainty/calibration_sigma.h"

namespace weft::pipeline {
namespace {

// A prime: pixel i times it meets every pixel once.
constexpr std::size_t kFarApart = 2654435761U;

// Pixels of sample tiles and where a solve left them.
struct GlossSamples {
  std::vector<solver::LobeReading> readings;  // as many of each pixel
  std::vector<Vec3> start;
  std::vector<std::size_t> part;  // quarter of the frame

  std::span<const solver::LobeReading> of(std::size_t pixel) const {
    const std::size_t each = readings.size() / start.size();
    return {readings.data() + pixel * each, each};
  }
};

// Takes pixels of one sample tile after another; one a worker.
class Sampler {
 public:
  Sampler(const Photographs& photographs, const solver::Method& base, const LightCorrection* correction,
          int step)
      : reader_(photographs, {.width = solver::kSampleTile, .height = solver::kSampleTile}),
        base_(base),
        correction_(correction),
        step_(step),
        frame_(photographs.size),
        sight_(sight_of(photographs)) {}

  void take(Rect tile, GlossSamples& samples) {
    solver::TileInput input = reader_.read(tile);
    // Light from the cloth itself is taken off, and shadows are marked.
    if (correction_ != nullptr) corrected_.apply(*correction_, input);
    const SampleMaps maps = solve_sample(input, base_);
    solver::LobeReader reader(input, sight_);
    std::vector<solver::LobeReading> readings(reader.count());
    for (int y = 0; y < tile.height(); y += step_) {
      for (int x = 0; x < tile.width(); x += step_) {
        if (maps.status(x, y) & (kNoSolution | kDark)) continue;
        reader.read(x, y, readings);
        if (solver::used_of(readings) < solver::kLeastLobeReadings) continue;
        samples.readings.insert(samples.readings.end(), readings.begin(), readings.end());
        samples.start.push_back(static_cast<double>(maps.albedo(x, y)) *
                                Vec3{maps.normal(x, y, 0), maps.normal(x, y, 1), maps.normal(x, y, 2)});
        samples.part.push_back(part_of(tile.x0 + x, tile.y0 + y));
      }
    }
  }

 private:
  std::size_t part_of(int x, int y) const {
    return (2 * y < frame_.height ? 0U : 2U) + (2 * x < frame_.width ? 0U : 1U);
  }

  TileReader reader_;
  const solver::Method& base_;
  const LightCorrection* correction_;
  int step_;
  Size frame_;
  solver::Sight sight_;
  CorrectedTile corrected_;
};

// What the calibration does not know of the lights, as the centre of the frame sees them.
Result<void> add_calibration(const Photographs& photographs, std::vector<solver::MeasuredLobe>& lobes) {
  if (!photographs.light_covariance) return {};
  const Result<solver::CalibrationSigmas> sigmas =
      solver::CalibrationSigmas::make(*photographs.field, photographs.size, photographs.leds,
                                      *photographs.light_covariance, photographs.noise());
  if (!sigmas) return sigmas.error();
  const std::vector<double> covariance =
      sigmas->light_errors_at(photographs.size.width / 2, photographs.size.height / 2);
  for (solver::MeasuredLobe& lobe : lobes) {
    if (lobe.is_measured()) solver::add_light_errors(covariance, lobe);
  }
  return {};
}

std::vector<solver::KnownLobe> lobes_of(const GlossFacts& facts) {
  std::vector<solver::KnownLobe> lobes;
  for (const solver::MeasuredLobe& measured : facts.lobes)
    lobes.push_back({measured.lobe, solver::one_sigma_off(measured.lobe, measured.covariance)});
  return lobes;
}

}  // namespace

solver::Sight sight_of(const Photographs& photographs) {
  std::optional<Vec3> centre;
  if (photographs.camera) centre = centre_of(*photographs.camera);
  return solver::Sight(centre, photographs.field->cloth_height_mm());
}

Result<std::vector<solver::MeasuredLobe>> measure_gloss(const Photographs& photographs,
                                                        const solver::Method& base,
                                                        LightCorrection* correction, int threads) {
  const std::vector<Rect> tiles = solver::sample_tiles(photographs.size);
  const int step = solver::sample_step(tiles, 4 * kGlossPixels);
  std::vector<Sampler> samplers;
  for (int i = 0; i < resolved_threads(threads); ++i)
    samplers.emplace_back(photographs, base, correction, step);
  std::vector<GlossSamples> parts(tiles.size());
  // A correction is traced for one row of tiles after another.
  for (std::size_t begin = 0, end = 0; begin < tiles.size(); begin = end) {
    while (end < tiles.size() && tiles[end].y0 == tiles[begin].y0) ++end;
    if (correction != nullptr) {
      const Rect rows = {0, tiles[begin].y0, photographs.size.width, tiles[begin].y1};
      if (Result<void> ok = correction->prepare(rows); !ok) return std::move(ok).error();
    }
    parallel_for(end - begin, threads, [&](std::size_t i, int worker) {
      samplers[static_cast<std::size_t>(worker)].take(tiles[begin + i], parts[begin + i]);
    });
  }
  GlossSamples all;
  for (const GlossSamples& part : parts) {
    all.readings.insert(all.readings.end(), part.readings.begin(), part.readings.end());
    all.start.insert(all.start.end(), part.start.begin(), part.start.end());
    all.part.insert(all.part.end(), part.part.begin(), part.part.end());
  }
  // Pixels that follow each other are far apart in the frame, so that the first of them stand for all.
  solver::LobeSamples samples(photographs.count(), photographs.parallel ? 2 : 1);
  std::vector<Vec3> start;
  std::vector<std::size_t> part;
  const std::size_t pixels = all.start.size();
  for (std::size_t i = 0; i < std::min(pixels, kGlossPixels); ++i) {
    const std::size_t pixel = i * kFarApart % pixels;
    samples.add(all.of(pixel));
    start.push_back(all.start[pixel]);
    part.push_back(all.part[pixel]);
  }
  std::vector<solver::MeasuredLobe> lobes = solver::measure_materials(samples, start, threads);
  if (Result<void> ok = add_calibration(photographs, lobes); !ok) return std::move(ok).error();
  solver::MeasuredLobe& lobe = lobes.front();
  if (lobes.size() == 1 && lobe.is_measured())
    lobe.parts = solver::measure_parts(samples, lobe.fit, part, lobe.sigma_alpha, threads);
  return lobes;
}

Result<Gloss> Gloss::find(const Photographs& photographs, const solver::Method& base,
                          LightCorrection* correction, const JobContext& context) {
  Gloss gloss(sight_of(photographs));
  Result<std::vector<solver::MeasuredLobe>> lobes =
      measure_gloss(photographs, base, correction, context.threads);
  if (!lobes) return std::move(lobes).error();
  gloss.facts.lobes = std::move(*lobes);
  gloss.facts.of_film_pair = photographs.parallel.has_value();
  if (!gloss.facts.is_measured()) return gloss;
  const auto glossy = solver::glossy_method(base, lobes_of(gloss.facts), gloss.sight_);
  const auto variant = [&](const solver::Method& method) {
    return SolveVariant{.method = &method, .correction = correction, .judged_by_parallel = true};
  };
  Result<solver::BlockChoice> choice = choose_by_block(photographs, variant(base), variant(*glossy), context);
  if (!choice) return std::move(choice).error();
  gloss.facts.share = choice->share();
  if (gloss.facts.share > 0) gloss.choice_ = std::move(*choice);
  return gloss;
}

const solver::Method& Gloss::over(const solver::Method& base) {
  if (!choice_) return base;
  methods_.push_back(solver::glossy_method(base, lobes_of(facts), sight_));
  methods_.push_back(solver::blended_method(base, *methods_.back(), *choice_));
  return *methods_.back();
}

}  // namespace weft::pipeline
