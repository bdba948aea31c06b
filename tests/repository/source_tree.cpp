// SPDX-License-Identifier: Apache-2.0
#include "tests/repository/source_tree.h"
#include "tests/core/places.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace weft::repository {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kProbedBytes = 8000;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(kProbedBytes, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.find('\0') != std::string::npos) return {};
  text.append(std::istreambuf_iterator<char>(stream), {});
  return text;
}

}  // namespace

std::vector<TextFile> text_files() {
  const fs::path root = source_folder();
  std::vector<TextFile> files;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::end(entry); ++entry) {
    const std::string path = entry->path().lexically_relative(root).generic_string();
    if (is_ignored(path)) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file()) {
      if (std::string text = read_text(entry->path()); !text.empty())
        files.push_back({path, std::move(text)});
    }
  }
  std::ranges::sort(files, {}, &TextFile::path);
  return files;
}

bool is_ignored(std::string_view path) {
  for (const std::string_view folder : {".git", "build", ".cache", "demo", "CMakeUserPresets.json"}) {
    if (path == folder) return true;
  }
  return ends_in(path, {"/node_modules", "/dist"}) ||
         (path.ends_with(".weft") && !path.starts_with("testdata/"));
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

bool ends_in(std::string_view path, std::initializer_list<std::string_view> endings) {
  return std::ranges::any_of(endings, [&](std::string_view ending) { return path.ends_with(ending); });
}

std::string place(std::string_view path, std::size_t line) {
  return std::string(path) + ":" + std::to_string(line);
}

}  // namespace weft::repository
