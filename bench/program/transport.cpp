// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/transport.h"

#include <memory>

#include "app/cli/options.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

app::Run add_transport(app::Options& options) {
  const auto megapixels = std::make_shared<double>(1);
  options.add("--megapixels", megapixels.get(), "Size of the height map, millions of pixels")
      .in_range(0.01, 200.0)
      .shows_default();
  return [megapixels](const app::CommonArguments& common) {
    return print_rows(transport({*megapixels, common.threads}), common);
  };
}

}  // namespace

app::Verb transport_verb() {
  return {"transport", "Light between yarns by horizons and by rays: time and error", add_transport};
}

}  // namespace weft::bench
