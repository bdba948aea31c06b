// SPDX-License-Identifier: Apache-2.0
// docs/seeds.md: what it says is carried is there, and it leaves nothing numbered out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/repository/source_tree.h"

namespace weft::repository {
namespace {

constexpr const char* kSeeds = "docs/seeds.md";
constexpr std::size_t kColumns = 5;
enum Column : std::size_t { kWhere, kWhat, kCarriedBy, kTestedBy, kRemark };

/// A row of a table, without the header.
struct Row {
  std::size_t line = 0;
  std::vector<std::string> cells;
};
using Table = std::vector<Row>;

std::string trimmed(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
  return std::string(text.substr(first, text.find_last_not_of(' ') + 1 - first));
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  line.remove_prefix(1);
  for (std::size_t bar = line.find('|'); bar != line.npos; bar = line.find('|')) {
    cells.push_back(trimmed(line.substr(0, bar)));
    line.remove_prefix(bar + 1);
  }
  return cells;
}

/// The tables of a Markdown text: runs of lines that start with a bar, of which the first two are the header.
std::vector<Table> tables_of(std::string_view text) {
  std::vector<Table> tables;
  std::size_t rows_so_far = 0;
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].starts_with('|')) {
      rows_so_far = 0;
      continue;
    }
    if (rows_so_far++ == 0) tables.emplace_back();
    if (rows_so_far > 2) tables.back().push_back({i + 1, cells_of(lines[i])});
  }
  return tables;
}

std::vector<std::string> quoted_in(const std::string& cell) {
  static const std::regex quoted("`([^`]+)`");
  std::vector<std::string> found;
  for (std::sregex_iterator it(cell.begin(), cell.end(), quoted), end; it != end; ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

/// "Suite.Name" of every test that a source defines at the start of a line.
std::set<std::string> tests_in(const std::string& text) {
  static const std::regex test(R"((?:^|\n)TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\))");
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it) {
    found.insert((*it)[1].str() + "." + (*it)[2].str());
  }
  return found;
}

/// A name with a slash at its end is a folder.
bool exists(const std::string& name, const std::set<std::string>& files) {
  const auto at = files.lower_bound(name);
  return at != files.end() && (*at == name || (name.ends_with('/') && at->starts_with(name)));
}

std::vector<std::string> faults_of(const Row& row, const std::set<std::string>& files,
                                   const std::set<std::string>& tests) {
  std::vector<std::string> found;
  const auto fault = [&](const std::string& what) { found.push_back(place(kSeeds, row.line) + ": " + what); };
  if (row.cells.size() != kColumns) {
    fault("a row of " + std::to_string(row.cells.size()) + " cells");
    return found;
  }
  for (const std::string& cell : row.cells) {
    for (const std::string& name : quoted_in(cell)) {
      if (name.find('/') != name.npos && !exists(name, files)) fault("no file " + name);
    }
  }
  for (const std::string& name : quoted_in(row.cells[kTestedBy])) {
    if (!tests.contains(name)) fault("no test " + name);
  }
  if (row.cells[kWhere].empty() || row.cells[kWhat].empty()) fault("says not what it is about");
  const std::string& remark = row.cells[kRemark];
  if (row.cells[kCarriedBy].empty()) {
    if (!remark.starts_with("Later: ") && !remark.starts_with("Out: "))
      fault("neither carried nor explained");
  } else if (row.cells[kTestedBy].empty()) {
    fault("carried, and shown by no test");
  }
  return found;
}

/// Which of 1 .. last no row of the table names, as in "eq. 7", "eq. 3-5" or "listing 2, eq. 9".
std::vector<int> left_out(const Table& table, const std::string& kind, int last) {
  const std::regex named(kind + R"( (\d+)(?:-(\d+))?)");
  std::set<int> covered;
  for (const Row& row : table) {
    const std::string& where = row.cells.front();
    for (std::sregex_iterator it(where.begin(), where.end(), named), end; it != end; ++it) {
      const int from = std::stoi((*it)[1]);
      const int to = (*it)[2].matched ? std::stoi((*it)[2]) : from;
      for (int i = from; i <= to; ++i) covered.insert(i);
    }
  }
  std::vector<int> missing;
  for (int i = 1; i <= last; ++i) {
    if (!covered.contains(i)) missing.push_back(i);
  }
  return missing;
}

std::vector<Table> seed_tables() {
  const auto files = text_files();
  const auto seeds = std::ranges::find(files, kSeeds, &TextFile::path);
  return seeds == files.end() ? std::vector<Table>{} : tables_of(seeds->text);
}

TEST(Seeds, EveryRowNamesFilesAndTestsThatAreThere) {
  std::set<std::string> files, tests;
  for (const TextFile& file : text_files()) {
    files.insert(file.path);
    if (file.path.starts_with("tests/") && file.path.ends_with(".cpp")) tests.merge(tests_in(file.text));
  }
  for (const Table& table : seed_tables()) {
    for (const Row& row : table) {
      for (const std::string& fault : faults_of(row, files, tests)) ADD_FAILURE() << fault;
    }
  }
}

TEST(Seeds, EveryNumberedEquationListingAndAlgorithmHasARow) {
  const std::vector<Table> tables = seed_tables();
  ASSERT_EQ(tables.size(), 4U) << "one table a document";
  EXPECT_THAT(left_out(tables[0], "eq\\.", 37), testing::IsEmpty());
  EXPECT_THAT(left_out(tables[1], "eq\\.", 69), testing::IsEmpty());
  EXPECT_THAT(left_out(tables[1], "listing", 8), testing::IsEmpty());
  EXPECT_THAT(left_out(tables[1], "algorithm", 5), testing::IsEmpty());
  EXPECT_THAT(left_out(tables[2], "eq\\.", 20), testing::IsEmpty());
}

TEST(Seeds, TablesAreReadWithoutTheirHeaders) {
  const auto tables = tables_of("words\n| A | B |\n|---|---|\n| a b | |\n\n| C |\n|---|\n| c |\n| d |\n");
  ASSERT_EQ(tables.size(), 2U);
  ASSERT_EQ(tables[0].size(), 1U);
  EXPECT_EQ(tables[0][0].line, 4U);
  EXPECT_THAT(tables[0][0].cells, testing::ElementsAre("a b", ""));
  ASSERT_EQ(tables[1].size(), 2U);
  EXPECT_THAT(tables[1][1].cells, testing::ElementsAre("d"));
}

TEST(Seeds, ARowThatNamesNothingThereIsFound) {
  const std::set<std::string> files = {"core/image/image.h", "solver/a.cpp"};
  const std::set<std::string> tests = {"Suite.Name"};
  const auto faults = [&](std::array<const char*, 3> last) {
    return faults_of({7, {"eq. 1", "what", last[0], last[1], last[2]}}, files, tests);
  };
  EXPECT_THAT(faults({"`core/image/image.h`, `solver/`", "`Suite.Name`", ""}), testing::IsEmpty());
  EXPECT_THAT(faults({"", "", "Later: colour"}), testing::IsEmpty());
  EXPECT_THAT(faults({"", "", "Out: no cloth"}), testing::IsEmpty());
  EXPECT_THAT(faults({"`core/imag.h`", "`Suite.Name`", ""}),
              testing::ElementsAre("docs/seeds.md:7: no file core/imag.h"));
  EXPECT_THAT(faults({"`material/`", "`Suite.Name`", ""}), testing::SizeIs(1));
  EXPECT_THAT(faults({"", "", "Out: see `core/none.h`"}), testing::SizeIs(1));
  EXPECT_THAT(faults({"`core/image/image.h`", "`Suite.Other`", ""}),
              testing::ElementsAre("docs/seeds.md:7: no test Suite.Other"));
  EXPECT_THAT(faults({"", "`Suite.Name`", "a remark that says neither"}),
              testing::ElementsAre("docs/seeds.md:7: neither carried nor explained"));
  EXPECT_THAT(faults({"`core/image/image.h`", "", "a remark"}),
              testing::ElementsAre("docs/seeds.md:7: carried, and shown by no test"));
  EXPECT_THAT(faults_of({7, {"eq. 1", "what", "", "why"}}, files, tests), testing::SizeIs(1));
  EXPECT_THAT(faults_of({7, {"", "what", "", "", "Out: why"}}, files, tests), testing::SizeIs(1));
}

TEST(Seeds, TestsOfEveryKindAreFoundAndNamesInStringsAreNot) {
  EXPECT_THAT(tests_in("TEST(A, B) {\n}\nTEST_F(C,\n       D) {\nTEST_P(E, F) {\n  \"TEST(G, H)\"\n"),
              testing::ElementsAre("A.B", "C.D", "E.F"));
}

TEST(Seeds, ANumberWithoutARowIsFound) {
  const Table table = {{1, {"eq. 1-3, listing 2"}}, {2, {"eq. 5"}}};
  EXPECT_THAT(left_out(table, "eq\\.", 6), testing::ElementsAre(4, 6));
  EXPECT_THAT(left_out(table, "listing", 2), testing::ElementsAre(1));
}

}  // namespace
}  // namespace weft::repository
