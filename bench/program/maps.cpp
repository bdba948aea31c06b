// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "bench/maps/parts.h"
#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

Result<Rows> measure(const std::string& name, const MapsBenchOptions& options) {
  for (const MapsPart& part : maps_parts()) {
    if (name == part.name) return part.measure(options);
  }
  return Error{ErrorKind::kUsage, "no such part", name, "", "weft bench maps --help lists the parts"};
}

app::Run add_maps(app::Options& options) {
  std::vector<std::string> names;
  std::string help = "Which table:";
  for (const MapsPart& part : maps_parts()) {
    names.emplace_back(part.name);
    help += std::string(names.size() > 1 ? ";" : "") + " " + part.name + ", " + part.what;
  }
  const auto part = std::make_shared<std::string>(names.front());
  const auto asked = std::make_shared<MapsBenchOptions>();
  options.add("--part", part.get(), help).one_of(names).shows_default();
  options
      .add("--megapixels", &asked->megapixels, "Size of the map that times are of; 0 is that of docs/maps.md")
      .in_range(0.0, 200.0)
      .shows_default();
  return [part, asked](const app::CommonArguments& common) {
    asked->threads = common.threads;
    return print_rows(measure(*part, *asked), common);
  };
}

}  // namespace

app::Verb maps_verb() {
  return {"maps", "Derived maps of a cloth: error and price of each way to make them", add_maps};
}

}  // namespace weft::bench
