// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/photos.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

struct PhotosArguments {
  std::filesystem::path folder;
  int pick = 10;
  int subsets = 20;
  std::uint32_t seed = 1;
  std::vector<std::string> methods;
};

app::Run add_photos(app::Options& options) {
  const auto a = std::make_shared<PhotosArguments>();
  options.add("folder", &a->folder, "Photographs in the layout of the DiLiGenT benchmark, with normal_gt.exr")
      .required();
  options.add("--pick", &a->pick, "Well-spread lights a subset; 0 is all of them")
      .not_negative()
      .shows_default();
  options.add("--subsets", &a->subsets, "Subsets to average over").in_range(1, 10000).shows_default();
  options.add("--seed", &a->seed, "Of the subsets").shows_default();
  options.add("--method", &a->methods, "These levels and methods alone: fast,least-squares").by_commas();
  return [a](const app::CommonArguments& common) {
    return print_rows(photos_table({a->folder, a->pick, a->subsets, a->seed, a->methods, common.threads}),
                      common);
  };
}

}  // namespace

app::Verb photos_verb() {
  return {"photos", "Errors on real photographs under known distant lights", add_photos};
}

}  // namespace weft::bench
