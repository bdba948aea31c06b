// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/height.h"

#include <memory>

#include "app/cli/options.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

app::Run add_height(app::Options& options) {
  const auto megapixels = std::make_shared<double>(4);
  options.add("--megapixels", megapixels.get(), "Size of the normal map, millions of pixels")
      .in_range(0.01, 200.0)
      .shows_default();
  return [megapixels](const app::CommonArguments& common) {
    return print_rows(height_speed({*megapixels, common.threads}), common);
  };
}

}  // namespace

app::Verb height_verb() {
  return {"height", "Error, time and memory from normals to heights", add_height};
}

}  // namespace weft::bench
