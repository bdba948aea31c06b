// SPDX-License-Identifier: Apache-2.0
#include "material/assets/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/base/files.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

// All maps in float, and as much again of mips and a mask.
std::uint64_t bytes_of(const MaterialNode& node) {
  return 120 * static_cast<std::uint64_t>(node.size.pixels()) + (std::uint64_t{1} << 20);
}

// Which scans it is made of, as they are today.
void add_scans(Json scans, Json& document) {
  document["draft"] = std::ranges::any_of(scans, [](const Json& scan) { return scan.value("draft", false); });
  document["scans"] = std::move(scans);
}

class Builder {
 public:
  Builder(const MaterialTree& tree, const BuildOptions& options, const JobContext& context,
          BuildReport& report)
      : tree_(tree), options_(options), context_(context), report_(report) {}

  // A node below `parent`, after those that it lies on.
  Result<void> build(std::size_t index, const fs::path& parent) {
    if (!done_.insert({parent, index}).second) return {};
    const MaterialNode& node = tree_.nodes[index];
    for (const std::vector<std::size_t>* below : {&node.layers, &node.runtime}) {
      for (const std::size_t each : *below) {
        if (Result<void> ok = build(each, parent); !ok) return ok;
      }
    }
    if (context_.stop.stop_requested()) return interrupted();
    const Product product = {kMaterialProduct, node.id, parent / node.id};
    const Result<std::optional<Json>> found = find_finished(product);
    if (!found) return found.error();
    if (*found) {
      // Two files that say the same are one material.
      if (made_.insert(product.folder).second) ++report_.kept;
      return {};
    }
    made_.insert(product.folder);
    was_made_.insert(product.folder);
    ++report_.built;
    return make(index, product);
  }

  bool was_made(const fs::path& folder) const { return was_made_.contains(folder); }

 private:
  Result<void> make(std::size_t index, const Product& product) {
    const MaterialNode& node = tree_.nodes[index];
    std::vector<MapSet> layers;
    for (const std::size_t each : node.layers) {
      Result<MapSet> set = open_map_set(product.folder.parent_path() / tree_.nodes[each].id, true);
      if (!set) return std::move(set).error();
      layers.push_back(std::move(*set));
    }
    PartialFolder aside(product.folder);
    if (Result<void> begun = begin(aside, bytes_of(node)); !begun) return begun;
    Result<Json> document =
        compose_material(node, std::move(layers), aside.path(), options_.compose, context_);
    if (!document) return std::move(document).error();
    add_scans(scans_of(tree_, index), *document);
    if (Result<void> ok = write_json(aside.path() / kMaterialProduct.document, *document); !ok) return ok;
    Result<void> published = aside.publish();
    if (published) return {};
    // Another build may have been quicker.
    const Result<std::optional<Json>> found = find_finished(product);
    return found && *found ? Result<void>() : std::move(published);
  }

  const MaterialTree& tree_;
  const BuildOptions& options_;
  const JobContext& context_;
  BuildReport& report_;
  std::set<std::pair<fs::path, std::size_t>> done_;
  std::set<fs::path> made_, was_made_;
};

Result<fs::path> parent_of(const BuildOptions& options, const MaterialPlace& place) {
  if (!options.output.empty()) return absolute_folder(options.output);
  if (!place.is_shipped()) return build_folder_of(place);
  return Error{ErrorKind::kUsage, "nothing tells where to build", place.name,
               "it is weft's own and lies in no folder", "name one with -o"};
}

// Digests are remembered beside what they decide.
fs::path digests_file(const BuildOptions& options) {
  if (options.materials.empty()) return {};
  const Result<fs::path> parent = parent_of(options, options.materials.front());
  return parent ? *parent / "digests.json" : fs::path();
}

}  // namespace

fs::path build_folder_of(const MaterialPlace& place) {
  return place.is_shipped() ? fs::path() : place.file.parent_path() / "build";
}

Result<BuildReport> build_materials(const BuildOptions& options, const JobContext& context) {
  std::vector<fs::path> parents;
  for (const MaterialPlace& place : options.materials) {
    Result<fs::path> parent = parent_of(options, place);
    if (!parent) return std::move(parent).error();
    parents.push_back(std::move(*parent));
  }
  DigestCache digests(digests_file(options));
  context.progress("plan", 0);
  const Result<MaterialTree> tree = plan_materials(options.materials, materials_on_disk(), digests);
  if (!tree) return tree.error();
  BuildReport report;
  Builder builder(*tree, options, context, report);
  for (std::size_t i = 0; i < tree->roots.size(); ++i) {
    if (Result<void> ok = builder.build(tree->roots[i], parents[i]); !ok) return std::move(ok).error();
  }
  for (std::size_t i = 0; i < tree->roots.size(); ++i) {
    const MaterialNode& node = tree->nodes[tree->roots[i]];
    const fs::path folder = parents[i] / node.id;
    Result<Json> document = read_json(folder / kMaterialProduct.document, kMaterialProduct.schema, 1);
    if (!document) return std::move(document).error();
    add_scans(scans_of(*tree, tree->roots[i]), *document);
    report.materials.push_back(
        {node.material.place, node.id, folder, !builder.was_made(folder), std::move(*document)});
  }
  report.hashed = digests.hashed();
  report.files = files_of(*tree);
  if (Result<void> ok = digests.save(); !ok) return std::move(ok).error();
  context.progress("compose", 1);
  return report;
}

}  // namespace weft::material
