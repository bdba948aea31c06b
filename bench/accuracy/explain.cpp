// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/explain.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/vec.h"
#include "pipeline/forecast.h"
#include "pipeline/frame.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

// Mean angle between the normals of a level and the truth, over the part of the patch that is measured.
Result<double> true_deg(const Patch& patch, const solver::MethodName& level, int threads) {
  const bool half = level.extent == solver::Extent::kHalfSize;
  Result<pipeline::Photographs> halved = pipeline::Photographs();
  if (half) halved = pipeline::half_size(patch.photographs, threads);
  if (!halved) return halved.error();
  const Rect part = patch.measured();
  const int scale = half ? 2 : 1;
  double sum = 0;
  const auto compare = [&](const pipeline::MapBand& band) -> Result<void> {
    for (int y = part.y0; y < part.y1; ++y) {
      const int row = y / scale - band.rows.y0;
      if (row < 0 || row >= band.rows.height()) continue;
      for (int x = part.x0; x < part.x1; ++x) {
        const int column = x / scale;
        sum +=
            angle_deg({band.normal[0](column, row), band.normal[1](column, row), band.normal[2](column, row)},
                      {patch.normal(x, y, 0), patch.normal(x, y, 1), patch.normal(x, y, 2)});
      }
    }
    return {};
  };
  JobContext context;
  context.threads = threads;
  const Result<pipeline::FrameFacts> solved = pipeline::solve_frame(half ? *halved : patch.photographs, level,
                                                                    pipeline::kSolveTile, context, compare);
  if (!solved) return solved.error();
  return sum / (static_cast<double>(part.width()) * part.height());
}

struct Means {
  double predicted = 0, real = 0, noise = 0, misfit = 0, indirect = 0, shortcut = 0, gate = 0;
};

}  // namespace

Result<Rows> explain_table(const ExplainOptions& options) {
  const int threads = resolved_threads(options.threads);
  Rows rows;
  for (const AccuracyScene& scene : accuracy_scenes(options.set, options.seed, options.quick)) {
    Result<std::vector<Patch>> patches = render_patches(scene, threads);
    if (!patches) return std::move(patches).error();
    std::vector<Means> means;
    const double share = 1.0 / static_cast<double>(patches->size());
    for (Patch& patch : *patches) {
      patch.photographs.camera = patch.camera;
      const Result<pipeline::Forecast> forecast = pipeline::forecast_errors(patch.photographs, threads);
      if (!forecast) return forecast.error();
      means.resize(forecast->levels.size());
      for (std::size_t i = 0; i < means.size(); ++i) {
        const pipeline::ErrorForecast& level = forecast->levels[i];
        const Result<double> real = true_deg(patch, solver::method_of(level.level), threads);
        if (!real) return real.error();
        means[i].predicted += share * level.total_deg();
        means[i].real += share * *real;
        means[i].noise += share * level.noise_deg;
        means[i].misfit += share * level.misfit_deg;
        means[i].indirect += share * level.indirect_deg;
        means[i].shortcut += share * level.shortcut_deg;
        means[i].gate += share * forecast->gates.indirect.value;
      }
    }
    for (std::size_t i = 0; i < means.size(); ++i) {
      const Means& m = means[i];
      rows.push_back({{"scene", scene.name},
                      {"quality", solver::method_names()[i].name},
                      {"predicted_deg", m.predicted},
                      {"true_deg", m.real},
                      {"ratio", m.predicted / m.real},
                      {"noise_deg", m.noise},
                      {"misfit_deg", m.misfit},
                      {"indirect_deg", m.indirect},
                      {"shortcut_deg", m.shortcut},
                      {"indirect_share", m.gate}});
    }
  }
  return rows;
}

}  // namespace weft::bench
