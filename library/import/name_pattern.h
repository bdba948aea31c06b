// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

// What names of files say.

namespace weft::library {

/// What a name says where it follows a pattern. What the pattern does not hold is empty.
struct NameParts {
  std::string session, fabric;
  std::optional<int> led;  ///< 0: "dark", "00"
  std::optional<std::int64_t> index;
};

/// "{session}/{fabric}_{led}.{ext}": {led} is a number or "dark", {index} a number that counts shots, {any}
/// and {ext} are passed over, {session} and {fabric} are any text without a '/'. It speaks of the last parts
/// of a path, as many as it has itself, and of all of each.
class NamePattern {
 public:
  /// kUsage for a word in braces that is none of these, for one that stands twice, and for none at all.
  static Result<NamePattern> parse(const std::string& text);

  /// Nothing where the path does not follow the pattern.
  std::optional<NameParts> match(const std::filesystem::path& file) const;
  bool has(std::string_view word) const;
  /// How many parts of a path it speaks of.
  std::size_t depth() const { return depth_; }

 private:
  std::regex expression_;
  std::vector<std::string> groups_;  ///< the word of each group of the expression
  std::size_t depth_ = 1;
};

}  // namespace weft::library
