// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "app/cli/options.h"
#include "bench/effects/auto.h"
#include "bench/effects/cost.h"
#include "bench/effects/embree.h"
#include "bench/effects/gallery.h"
#include "bench/effects/rays.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

struct EffectsArguments {
  double megapixels = 1;
  bool rays = false;
  bool embree = false;
  bool choice = false;            ///< --auto
  std::filesystem::path gallery;  ///< folder; empty: no pictures
};

Result<Rows> measure(const EffectsArguments& a, int threads) {
  if (a.rays) return effects_rays(threads);
  if (a.embree) return effects_embree();
  if (a.choice) return effects_auto(threads);
  if (!a.gallery.empty()) return effects_gallery(a.gallery, threads);
  return effects_cost({a.megapixels, threads});
}

app::Run add_effects(app::Options& options) {
  const auto a = std::make_shared<EffectsArguments>();
  const app::Option size = options.add("--megapixels", &a->megapixels, "Size of a frame, millions of pixels")
                               .in_range(0.01, 200.0)
                               .shows_default();
  const app::Option rays =
      options.add_flag("--rays", &a->rays, "Error and time of sampled effects at 1 to 4096 rays");
  const app::Option embree =
      options.add_flag("--embree", &a->embree, "Shadow and bounce rays against bare Embree");
  const app::Option choice = options.add_flag(
      "--auto", &a->choice, "What effects = \"auto\" at 0.25 sigma changes and saves against all effects");
  const app::Option gallery =
      options.add("--gallery", &a->gallery, "Folder for a picture of each effect off and on");
  rays.excludes(embree).excludes(choice).excludes(gallery).excludes(size);
  embree.excludes(choice).excludes(gallery).excludes(size);
  choice.excludes(gallery).excludes(size);
  gallery.excludes(size);
  return [a](const app::CommonArguments& common) { return print_rows(measure(*a, common.threads), common); };
}

}  // namespace

app::Verb effects_verb() {
  return {"effects", "Cost, error and pictures of the simulator's effects", add_effects};
}

}  // namespace weft::bench
