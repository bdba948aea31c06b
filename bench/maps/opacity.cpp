// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/studies.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bench/oracles/mesh.h"
#include "material/opacity/opacity.h"

namespace weft::bench {
namespace {

struct NamedMesh {
  std::string name;
  MeshScene scene;
};

std::vector<NamedMesh> meshes() {
  std::vector<NamedMesh> all;
  const auto add = [&](const std::string& name, MeshScene scene) {
    scene.side_px = 256;
    for (const auto& [through, back] :
         {std::pair{0.0, 0.0}, std::pair{0.08, 0.0}, std::pair{0.08, 0.25}, std::pair{0.2, 0.25}}) {
      scene.through_yarns = through;
      scene.thrown_back = back;
      all.push_back({name, scene});
    }
    scene.through_yarns = 0.08;
    scene.blur_px = 0.8;
    scene.defocus_px = 1.5;
    all.push_back({name + ", blurred", scene});
  };
  add("mesh 12 px, yarns 5", {.pitch_px = 12, .yarn_px = 5});
  add("lace 9 px, yarns 6", {.pitch_px = 9, .yarn_px = 6, .is_lace = true});
  add("mesh 6 px, yarns 2.5", {.pitch_px = 6, .yarn_px = 2.5});
  return all;
}

struct MapError {
  double rms = 0, mean = 0;
};

MapError error_against(const Image<float>& truth, const std::function<double(int, int)>& found) {
  double squares = 0, sum = 0;
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const double off = found(x, y) - double{truth(x, y)};
      squares += off * off;
      sum += off;
    }
  }
  const auto pixels = static_cast<double>(truth.size().pixels());
  return {std::sqrt(squares / pixels), sum / pixels};
}

}  // namespace

/// Opacity of rendered mesh and lace over a light: rms and mean error of 1 - T, and of what is found. `way`
/// says whether it was found; where it was not, both are the same.
Result<Rows> maps_opacity(const StudyOptions& options) {
  Rows rows;
  for (const NamedMesh& mesh : meshes()) {
    const RenderedMesh seen = rendered(mesh.scene);
    const Result<material::Opacity> found =
        material::opacity_from_transmission({seen.share.plane(), {}}, options.threads);
    if (!found) return found.error();
    const MapError straight = error_against(
        seen.coverage, [&](int x, int y) { return std::clamp(1 - double{seen.share(x, y)}, 0.0, 1.0); });
    const MapError error =
        error_against(seen.coverage, [&](int x, int y) { return double{found->map(x, y)}; });
    rows.push_back({{"cloth", mesh.name},
                    {"through", mesh.scene.through_yarns},
                    {"thrown_back", mesh.scene.thrown_back},
                    {"straight_rms", straight.rms},
                    {"straight_mean", straight.mean},
                    {"way", material::name_of(found->facts.way)},
                    {"through_found", found->facts.through_yarns},
                    {"open_found", found->facts.open},
                    {"found_rms", error.rms},
                    {"found_mean", error.mean}});
  }
  return rows;
}

}  // namespace weft::bench
