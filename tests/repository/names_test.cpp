// SPDX-License-Identifier: Apache-2.0
// A name of the product stands for one thing: a header's, a type's of a header, a room's and its namespace's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/repository/source_tree.h"

namespace weft::repository {
namespace {

using Places = std::map<std::string, std::vector<std::string>>;

bool is_of_the_product(std::string_view path) {
  const std::string_view room = path.substr(0, path.find('/'));
  return ends_in(path, {".h", ".cpp"}) && room != "tests" && room != "bench" && room != "firmware";
}

std::string file_name(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

/// The type that a line without indent begins to define; empty where it defines none.
std::string defined_type(std::string_view line) {
  for (const std::string_view word : {"struct ", "enum class ", "class [[nodiscard]] ", "class "}) {
    if (!line.starts_with(word) || line.ends_with(';')) continue;
    const std::string_view rest = line.substr(word.size());
    const std::size_t end = rest.find_first_of(" :{<");
    const bool is_specialized = end != rest.npos && rest[end] == '<';
    return is_specialized ? "" : std::string(rest.substr(0, end));
  }
  return "";
}

/// "solve" of "namespace weft::solve {"; "" of "namespace weft {"; nothing of another line.
std::optional<std::string> opened_namespace(std::string_view line) {
  constexpr std::string_view kOpen = "namespace weft";
  if (!line.starts_with(kOpen) || !line.ends_with(" {")) return {};
  line.remove_prefix(kOpen.size());
  line.remove_suffix(2);
  if (line.starts_with("::")) line.remove_prefix(2);
  return std::string(line.substr(0, line.find(':')));
}

/// Those of more than one place.
Places repeated(Places places) {
  std::erase_if(places, [](const auto& each) { return each.second.size() < 2; });
  return places;
}

TEST(Names, OfHeadersAndOfTheirTypesStandOnce) {
  Places headers, types;
  for (const TextFile& file : text_files()) {
    if (!is_of_the_product(file.path) || !file.path.ends_with(".h")) continue;
    headers[file_name(file.path)].push_back(file.path);
    for (const std::string_view line : lines_of(file.text)) {
      if (const std::string type = defined_type(line); !type.empty()) types[type].push_back(file.path);
    }
  }
  EXPECT_GT(headers.size(), 400U);
  EXPECT_GT(types.size(), 600U);
  EXPECT_THAT(repeated(headers), testing::IsEmpty());
  EXPECT_THAT(repeated(types), testing::IsEmpty());
}

TEST(Names, OfNamespacesAreThoseOfTheirRooms) {
  for (const TextFile& file : text_files()) {
    if (!is_of_the_product(file.path)) continue;
    const bool is_core = file.path.starts_with("core/");  // whose nouns need no name before them
    const std::string room = is_core ? "" : file.path.substr(0, file.path.find('/'));
    for (const std::string_view line : lines_of(file.text)) {
      const std::optional<std::string> opened = opened_namespace(line);
      if (!opened) continue;
      const bool declares_for_core = opened->empty() && file.path.ends_with(".h");
      const bool is_hidden = is_core && *opened == "detail";
      EXPECT_TRUE(*opened == room || declares_for_core || is_hidden) << file.path << ": " << line;
    }
  }
}

TEST(Names, AreReadOfWhatIsDefinedAlone) {
  EXPECT_EQ(defined_type("struct Plan {"), "Plan");
  EXPECT_EQ(defined_type("enum class Kind : int {"), "Kind");
  EXPECT_EQ(defined_type("class Door final : public Wall {"), "Door");
  EXPECT_EQ(defined_type("class [[nodiscard]] Result<void> {"), "");
  EXPECT_EQ(defined_type("class Door;"), "");
  EXPECT_EQ(defined_type("  struct Inner {"), "");
  EXPECT_EQ(opened_namespace("namespace weft::virtual_rig::ptp {"), "virtual_rig");
  EXPECT_EQ(opened_namespace("namespace weft {"), "");
  EXPECT_EQ(opened_namespace("namespace fs = std::filesystem;"), std::nullopt);
}

}  // namespace
}  // namespace weft::repository
