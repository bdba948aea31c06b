// SPDX-License-Identifier: Apache-2.0
// The pages: their links lead somewhere, and their index has all of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "solve/levels/stages.h"
#include "solver/method.h"
#include "tests/core/places.h"
#include "tests/repository/source_tree.h"

namespace weft::repository {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIndex = "docs/README.md";

/// A relative link of a page, split at its '#'.
struct Link {
  std::size_t line = 0;
  std::string path;     ///< from the root of the repository; the page itself where the link names no file
  std::string heading;  ///< as an anchor; empty: none
};

/// The name by which a heading is linked to: lower case, spaces as hyphens, without punctuation.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char letter : heading) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == ' ') {
      anchor += '-';
    } else if (std::isalnum(byte) || letter == '-' || letter == '_' || byte >= 0x80) {
      anchor += static_cast<char>(std::tolower(byte));
    }
  }
  return anchor;
}

/// The lines of a page with their numbers, without blocks of code.
std::vector<std::pair<std::size_t, std::string_view>> prose_of(std::string_view text) {
  std::vector<std::pair<std::size_t, std::string_view>> prose;
  bool code = false;
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t indent = std::min(lines[i].find_first_not_of(' '), lines[i].size());
    if (lines[i].substr(indent).starts_with("```")) {
      code = !code;
    } else if (!code) {
      prose.emplace_back(i + 1, lines[i]);
    }
  }
  return prose;
}

/// Anchors of all headings of a page; the second of one name ends in "-1", the third in "-2".
std::set<std::string> anchors_in(std::string_view text) {
  std::set<std::string> anchors;
  std::map<std::string, int> so_far;
  for (const auto& [number, line] : prose_of(text)) {
    const std::size_t level = line.find_first_not_of('#');
    if (level == 0 || level == line.npos || line[level] != ' ') continue;
    const std::string anchor = anchor_of(line.substr(level + 1));
    const int before = so_far[anchor]++;
    anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
  }
  return anchors;
}

std::vector<Link> links_in(const TextFile& page) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  std::vector<Link> found;
  for (const auto& [number, line] : prose_of(page.text)) {
    const std::string text(line);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1];
      if (target.find("://") != target.npos) continue;
      const std::size_t hash = std::min(target.find('#'), target.size());
      const fs::path to = fs::path(page.path).parent_path() / target.substr(0, hash);
      found.push_back({number, hash == 0 ? page.path : to.lexically_normal().generic_string(),
                       hash == target.size() ? "" : target.substr(hash + 1)});
    }
  }
  return found;
}

std::vector<TextFile> pages() {
  std::vector<TextFile> found = text_files();
  std::erase_if(found, [](const TextFile& file) { return !file.path.ends_with(".md"); });
  return found;
}

TEST(Docs, EveryLinkLeadsToAFileAndAHeading) {
  std::map<std::string, std::set<std::string>> headings;
  for (const TextFile& page : pages()) headings[page.path] = anchors_in(page.text);
  std::size_t followed = 0;
  for (const TextFile& page : pages()) {
    for (const Link& link : links_in(page)) {
      ++followed;
      EXPECT_TRUE(fs::exists(source_folder() / link.path))
          << place(page.path, link.line) << ": no " << link.path;
      if (link.heading.empty()) continue;
      EXPECT_TRUE(headings[link.path].contains(link.heading))
          << place(page.path, link.line) << ": no heading " << link.heading << " in " << link.path;
    }
  }
  EXPECT_GT(followed, 100U);
}

TEST(Docs, TheReadmeHasEveryLevelInItsOrder) {
  std::vector<std::string> levels, rows;
  for (const solver::MethodName& each : solver::method_names()) {
    if (each.level) levels.emplace_back(each.name);
  }
  static const std::regex row(R"(\| `(\w+)` \|.*)");
  bool is_table = false;
  for (const TextFile& page : pages()) {
    if (page.path != "README.md") continue;
    for (const auto& [number, line] : prose_of(page.text)) {
      std::cmatch cells;
      if (line.starts_with("| `--quality`")) is_table = true;
      if (!line.starts_with("|")) is_table = false;
      if (is_table && std::regex_match(line.begin(), line.end(), cells, row)) rows.push_back(cells[1]);
    }
  }
  EXPECT_EQ(rows, levels);
}

/// The first level whose list has the stage.
std::string least_level_with(const std::string& stage) {
  for (const solver::MethodName& each : solver::method_names()) {
    const std::vector<solve::Stage> stages = solve::stages_of(each);
    if (each.level && std::ranges::find(stages, stage, &solve::Stage::name) != stages.end()) return each.name;
  }
  return "";
}

TEST(Docs, ThePageOnAccuracyHasTheStagesOfTheLevelsInTheirOrder) {
  std::string table = "| stage | from | what it does |\n|---|---|---|\n";
  const std::vector<solve::Stage> all = solve::stages_of(solver::method_of(solver::Level::kReference));
  for (auto stage = all.begin() + 1; stage != all.end(); ++stage)
    table += "| `" + stage->name + "` | `" + least_level_with(stage->name) + "` | " + stage->does + " |\n";
  const auto each = pages();
  const auto page = std::ranges::find(each, "docs/accuracy.md", &TextFile::path);
  ASSERT_NE(page, each.end());
  EXPECT_THAT(page->text, testing::HasSubstr(table + "\n"));
}

/// A code is a word for a sentence: the sentence is said somewhere, and the page has the word.
TEST(Docs, TheCodesOfErrorsAreSaidByTheServerAndExplained) {
  const std::string table = "app/server/http/error_reply.cpp";
  std::string page, said;
  std::vector<std::pair<std::string, std::string>> codes;
  static const std::regex row(R"re(\{"([^"]+)", "(\w+)"\})re");
  for (const TextFile& file : text_files()) {
    if (file.path == "docs/http.md") page = file.text;
    const bool is_said = ends_in(file.path, {".cpp"}) && !file.path.starts_with("tests/");
    if (is_said && file.path != table) said += file.text;
    if (file.path != table) continue;
    for (std::sregex_iterator at(file.text.begin(), file.text.end(), row), end; at != end; ++at) {
      codes.emplace_back((*at)[1], (*at)[2]);
    }
  }
  EXPECT_GT(codes.size(), 20U);
  for (const auto& [sentence, code] : codes) {
    EXPECT_NE(said.find('"' + sentence + '"'), std::string::npos)
        << code << ": nobody says '" << sentence << "'";
    EXPECT_NE(page.find("| `" + code + "` |"), std::string::npos) << "docs/http.md leaves out " << code;
  }
}

TEST(Docs, TheIndexHasEveryPage) {
  std::set<std::string> indexed = {kIndex};
  for (const TextFile& page : pages()) {
    if (page.path != kIndex) continue;
    for (const Link& link : links_in(page)) indexed.insert(link.path);
  }
  for (const TextFile& page : pages()) {
    if (!page.path.starts_with("docs/")) continue;
    EXPECT_TRUE(indexed.contains(page.path)) << kIndex << " leaves out " << page.path;
  }
}

/// As its file writes it: TEST(Suite, Name), test('name', or a check of a script.
bool has_test(const TextFile& file, const std::string& name) {
  const std::size_t dot = name.find('.');
  if (file.path.ends_with(".cpp") && dot != name.npos) {
    const std::regex written("TEST(_F|_P)?\\(" + name.substr(0, dot) + ", " + name.substr(dot + 1) + "\\)");
    return std::regex_search(file.text, written);
  }
  return file.text.find((file.path.ends_with(".test.mjs") ? "test('" : "'") + name + '\'') != file.text.npos;
}

TEST(Docs, EachOfTheTwelveScenariosHasATestThatIsThere) {
  static const std::regex row(R"(\| (\d+)? ?\| `(tests/[^`]+)` \| ([^|]+) \|.*)");
  const std::vector<TextFile> files = text_files();
  std::set<int> scenarios;
  for (const TextFile& page : files) {
    if (page.path != "docs/reliability.md") continue;
    for (const auto& [number, line] : prose_of(page.text)) {
      std::cmatch cells;
      if (!std::regex_match(line.begin(), line.end(), cells, row)) continue;
      if (cells[1].matched) scenarios.insert(std::stoi(cells[1]));
      const auto file = std::ranges::find(files, cells[2].str(), &TextFile::path);
      ASSERT_NE(file, files.end()) << place(page.path, number) << ": no " << cells[2];
      EXPECT_TRUE(has_test(*file, cells[3]))
          << place(page.path, number) << ": " << cells[2] << " has no '" << cells[3] << "'";
    }
  }
  EXPECT_EQ(scenarios, (std::set<int>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST(Docs, LinksAreReadRelativeToTheirPageAndNotInCode) {
  const std::vector<Link> links =
      links_in({"docs/a.md",
                "[x](b.md#of-c) ![y](../z.png)\n```\n[no](code.md)\n```\n[here](#d) "
                "[out](https://example.org/e)\n"});
  ASSERT_EQ(links.size(), 3U);
  EXPECT_EQ(links[0].path, "docs/b.md");
  EXPECT_EQ(links[0].heading, "of-c");
  EXPECT_EQ(links[1].path, "z.png");
  EXPECT_EQ(links[1].heading, "");
  EXPECT_EQ(links[2].path, "docs/a.md");
  EXPECT_EQ(links[2].heading, "d");
  EXPECT_EQ(links[2].line, 5U);
}

TEST(Docs, HeadingsHaveTheAnchorsThatAReaderLinksTo) {
  EXPECT_THAT(
      anchors_in("# `effects = \"auto\"`\n## A name that stays: udev\n## Numbers\n```\n# code\n```\n"
                 "## Numbers\n#no heading\n"),
      testing::UnorderedElementsAre("effects--auto", "a-name-that-stays-udev", "numbers", "numbers-1"));
}

}  // namespace
}  // namespace weft::repository
