// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace weft::repository {

/// A file of the repository.
struct TextFile {
  std::string path;  ///< from the root of the repository, "core/image/image.h"
  std::string text;
};

/// Every text file of the repository in the order of paths, without what .gitignore keeps out. A file with a
/// zero byte among its first 8000 is not text (the rule git goes by).
std::vector<TextFile> text_files();

/// Whether .gitignore keeps this path out: build results, caches, sessions.
bool is_ignored(std::string_view path);

/// The lines of a text, without their ends.
std::vector<std::string_view> lines_of(std::string_view text);

/// Whether a path ends in one of these.
bool ends_in(std::string_view path, std::initializer_list<std::string_view> endings);

/// Where in a file, for messages: "core/image/image.h:12".
std::string place(std::string_view path, std::size_t line);

}  // namespace weft::repository
