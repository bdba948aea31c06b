// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

// A product is a folder of files that depends on its inputs alone: a solve, rectified maps. Its name is the
// hash of those inputs, so that the same work is done once. It is made aside and published whole.

namespace weft {

/// What tells products of one kind apart from those of another.
struct ProductKind {
  const char* schema;    ///< of its document: "weft.solve"
  const char* document;  ///< the file that says what the folder holds: "solve.json"
  const char* noun;      ///< for messages: "solve"
  const char* remedy;    ///< where there is none: "solve the session first with weft solve"
};

/// 16 hexadecimal digits of the SHA-256 of `inputs`. They name all that the bytes depend on and nothing else:
/// no machine, no date, no threads.
std::string product_id(const Json& inputs);

/// A product that is wanted.
struct Product {
  ProductKind kind;
  std::string id;
  std::filesystem::path folder;  ///< absolute
};

/// The product of these inputs, in `output`, or below `parent` under its id where `output` is empty.
Product product_of(const ProductKind& kind, const Json& inputs, const std::filesystem::path& parent,
                   const std::filesystem::path& output);

/// Its document if the folder holds it complete; nothing if there is no such folder. kCannotCreate where the
/// folder holds anything else.
Result<std::optional<Json>> find_finished(const Product& product);

/// kInputOutput where the disk of `folder` has less than `bytes` free.
Result<void> check_room(const std::filesystem::path& folder, std::uint64_t bytes);

/// Makes the folder aside in which the product is to be written: PartialFolder::publish() ends it. Errors as
/// of check_room(), which asks for `bytes`, and kCannotCreate.
Result<void> begin(const PartialFolder& partial, std::uint64_t bytes);

/// The complete products of this kind below `parent`, the oldest first, of two alike by name.
std::vector<Product> list_products(const ProductKind& kind, const std::filesystem::path& parent);

/// The one of list_products() that has this id. kNoInput where there is none.
Result<Product> find_product(const ProductKind& kind, const std::filesystem::path& parent,
                             const std::string& id);

}  // namespace weft
