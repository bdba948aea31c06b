// SPDX-License-Identifier: Apache-2.0
#include "bench/export/solved_cloth.h"

#include <algorithm>
#include <cmath>

#include "bench/accuracy/scenes.h"
#include "core/vec.h"
#include "pipeline/frame.h"
#include "simulator/scene/scene.h"
#include "solver/method.h"

namespace weft::bench {
namespace {

// A cell of the mosaic stays whole.
Rect middle_of(Size frame, Size most) {
  const int width = std::min(frame.width, most.width) & ~1, height = std::min(frame.height, most.height) & ~1;
  const int x0 = (frame.width - width) / 2 & ~1, y0 = (frame.height - height) / 2 & ~1;
  return {x0, y0, x0 + width, y0 + height};
}

void keep_rows(const std::array<View<const float>, 3>& band, Rect rows, Image<float>& map) {
  for (int p = 0; p < 3; ++p) {
    for (int y = 0; y < rows.height(); ++y) {
      std::copy_n(band[static_cast<std::size_t>(p)].row(y), rows.width(), map.plane(p).row(rows.y0 + y));
    }
  }
}

double mean_tilt(const Image<float>& normal) {
  double sum = 0;
  for (int y = 0; y < normal.height(); ++y) {
    for (int x = 0; x < normal.width(); ++x) {
      sum += degrees(std::acos(std::clamp(static_cast<double>(normal(x, y, 2)), -1.0, 1.0)));
    }
  }
  return sum / static_cast<double>(normal.size().pixels());
}

}  // namespace

Result<SolvedCloth> solved_cloth(const std::filesystem::path& scene_file, Size most, int threads) {
  const Result<simulator::Scene> scene = simulator::read_scene(scene_file);
  if (!scene) return scene.error();
  const Rect area = middle_of({scene->camera.width, scene->camera.height}, most);
  const Result<Patch> patch = render_patch(*scene, area, threads);
  if (!patch) return patch.error();
  SolvedCloth cloth{Image<float>(patch->size(), 3), Image<float>(patch->size(), 3)};
  JobContext context;
  context.threads = threads;
  const auto keep = [&](const pipeline::MapBand& band) -> Result<void> {
    keep_rows(band.normal, band.rows, cloth.normal);
    keep_rows(band.albedo, band.albedo_rows, cloth.albedo);
    return {};
  };
  const auto solved = pipeline::solve_frame(patch->photographs, *solver::find_method("standard"),
                                            pipeline::kSolveTile, context, keep);
  if (!solved) return solved.error();
  cloth.mean_tilt_deg = mean_tilt(cloth.normal);
  return cloth;
}

}  // namespace weft::bench
