// SPDX-License-Identifier: Apache-2.0
#include "core/base/product.h"
#include "core/base/sha256.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace weft {
namespace {

namespace fs = std::filesystem;

Error no_product(const ProductKind& kind, const fs::path& where, std::string why) {
  return {ErrorKind::kNoInput, fmt::format("there is no complete {}", kind.noun), where.string(),
          std::move(why), kind.remedy};
}

}  // namespace

std::string product_id(const Json& inputs) {
  return sha256_of(inputs.dump()).substr(0, 16);
}

Product product_of(const ProductKind& kind, const Json& inputs, const fs::path& parent,
                   const fs::path& output) {
  const std::string id = product_id(inputs);
  return {kind, id, fs::absolute(output.empty() ? parent / id : output).lexically_normal()};
}

Result<std::optional<Json>> find_finished(const Product& product) {
  if (!is_there(product.folder)) return std::optional<Json>();
  const fs::path file = product.folder / product.kind.document;
  if (is_there(file)) {
    Result<Json> document = read_json(file, product.kind.schema, 1);
    if (!document) return std::move(document).error();
    if (JsonFields(*document, file.string()).text_or("id", "") == product.id)
      return std::optional<Json>(std::move(*document));
  }
  return Error{ErrorKind::kCannotCreate, "output folder is taken", product.folder.string(),
               fmt::format("it holds something other than this {}", product.kind.noun),
               "name another folder with -o, or remove it"};
}

Result<void> check_room(const fs::path& folder, std::uint64_t bytes) {
  const std::uint64_t free = free_disk_bytes(folder);
  if (free >= bytes) return {};
  return Error{ErrorKind::kInputOutput, "not enough disk space", folder.string(),
               fmt::format("{} MB are needed, {} MB are free", bytes >> 20, free >> 20),
               "free disk space or choose another disk with -o"};
}

Result<void> begin(const PartialFolder& partial, std::uint64_t bytes) {
  if (Result<void> room = check_room(partial.path().parent_path(), bytes); !room) return room;
  return make_writable_folder(partial.path());
}

std::vector<Product> list_products(const ProductKind& kind, const fs::path& parent) {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(parent, failure)) {
    const fs::path document = entry.path() / kind.document;
    if (entry.path().filename().string().starts_with('.') || !is_there(document)) continue;
    found.emplace_back(fs::last_write_time(document, failure), entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<Product> products;
  for (const auto& [written, folder] : found) products.push_back({kind, folder.filename().string(), folder});
  return products;
}

Result<Product> find_product(const ProductKind& kind, const fs::path& parent, const std::string& id) {
  const bool is_name = !id.empty() && fs::path(id).filename() == id && !id.starts_with('.');
  if (is_name && is_there(parent / id / kind.document)) return Product{kind, id, parent / id};
  return no_product(kind, parent / id, fmt::format("it holds no {}", kind.document));
}

}  // namespace weft
