// SPDX-License-Identifier: Apache-2.0
// What every file of the repository has, and what none may hold.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "tests/repository/source_tree.h"

namespace weft::repository {
namespace {

constexpr std::string_view kLicence = "SPDX-License-Identifier: Apache-2.0";
constexpr std::string_view kGpl = "SPDX-License-Identifier: GPL-3.0-or-later";
constexpr std::size_t kMostLines = 600;

bool is_source(std::string_view path) {
  return ends_in(path, {".h", ".cpp", ".c"});
}

/// What begins a comment in files of this kind; "" for those that need no licence line.
std::string_view comment_mark(std::string_view path, std::string_view text) {
  if (is_source(path) || path.ends_with(".ts")) return "// ";
  const bool is_script = text.starts_with("#!");
  return is_script || ends_in(path, {"CMakeLists.txt", ".cmake", ".sh", ".py"}) ? "# " : "";
}

/// Whether the first line, or the one after "#!", says under which licence a file is.
bool names_licence(std::string_view path, std::string_view text) {
  const std::string_view mark = comment_mark(path, text);
  const auto lines = lines_of(text);
  const std::size_t at = text.starts_with("#!") ? 1 : 0;
  if (lines.size() <= at || !lines[at].starts_with(mark)) return false;
  const std::string_view said = lines[at].substr(mark.size());
  const bool may_be_gpl = path.starts_with("virtual_rig/board/");  // links simavr
  return said == kLicence || (may_be_gpl && said == kGpl);
}

/// Whether a path that begins with one of these folders of the machine's root starts somewhere in the line,
/// and not in the middle of a longer path.
bool names_machine_path(std::string_view line) {
  for (const std::string_view folder : {"root", "home", "work", "Users"}) {
    const std::string wanted = "/" + std::string(folder) + "/";
    for (std::size_t at = line.find(wanted); at != line.npos; at = line.find(wanted, at + 1)) {
      const char before = at == 0 ? ' ' : line[at - 1];
      const bool goes_on = std::isalnum(static_cast<unsigned char>(before)) ||
                           std::string_view("_.-~})>*").find(before) != line.npos;
      if (!goes_on) return true;
    }
  }
  return false;
}

bool names_registry_host(std::string_view path, std::string_view line) {
  return (path.ends_with("package-lock.json") && line.find("\"resolved\"") != line.npos) ||
         (path.ends_with(".npmrc") && line.find("registry=") != line.npos);
}

std::vector<std::string> forbidden_content(std::string_view path, std::string_view text) {
  std::vector<std::string> found;
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (names_machine_path(lines[i])) found.push_back(place(path, i + 1) + ": names a path of one machine");
    if (names_registry_host(path, lines[i]))
      found.push_back(place(path, i + 1) + ": names a package registry");
  }
  return found;
}

/// What a source, a build file or a script lacks; nothing for other files.
std::vector<std::string> missing_content(std::string_view path, std::string_view text) {
  std::vector<std::string> found;
  const bool needs_licence = !comment_mark(path, text).empty();
  if (needs_licence && !names_licence(path, text)) found.push_back(place(path, 1) + ": no SPDX line");
  if (!is_source(path)) return found;
  const auto lines = lines_of(text);
  // A kernel's -inl.h is read again for every SIMD target.
  const bool read_once = path.ends_with(".h") && !path.ends_with("-inl.h");
  if (read_once && std::ranges::find(lines, "#pragma once") == lines.end()) {
    found.push_back(place(path, 1) + ": no #pragma once");
  }
  if (lines.size() > kMostLines) {
    found.push_back(place(path, lines.size()) + ": over " + std::to_string(kMostLines) + " lines");
  }
  return found;
}

/// The text of the comment that begins in `line`; "" where none does, or where it goes on from the line
/// before.
std::string_view begun_comment(std::string_view before, std::string_view line) {
  const auto first = [](std::string_view text) {
    return text.substr(std::min(text.find_first_not_of(' '), text.size()));
  };
  const std::size_t at = first(line).starts_with("//") ? line.find("//") : line.find(" //");
  if (at == line.npos || (first(line).starts_with("//") && first(before).starts_with("//"))) return {};
  std::string_view said = first(line.substr(at));
  return said.substr(std::min(said.find_first_not_of("/!< "), said.size()));
}

/// Whether a comment begins with what its thing is of, and so leaves the thing out.
bool leaves_out_its_thing(std::string_view comment) {
  if (comment.starts_with("Of ")) return true;
  const bool is_of = comment.starts_with("of ");
  const std::string_view next = is_of ? comment.substr(3, comment.find_first_of(" ,.;:", 3) - 3) : "";
  return next == "that" || next == "it" || next == "them" || next == "those";
}

std::vector<std::string> nameless_comments(const TextFile& file) {
  std::vector<std::string> found;
  std::string_view before;
  const auto lines = lines_of(file.text);
  for (std::size_t i = 0; i < lines.size(); before = lines[i++]) {
    if (leaves_out_its_thing(begun_comment(before, lines[i]))) found.push_back(place(file.path, i + 1));
  }
  return found;
}

TEST(Content, NoFileNamesAMachineOrARegistry) {
  for (const TextFile& file : text_files()) {
    for (const std::string& found : forbidden_content(file.path, file.text)) ADD_FAILURE() << found;
  }
}

TEST(Content, EverySourceHasItsLicenceItsGuardAndAModestLength) {
  for (const TextFile& file : text_files()) {
    for (const std::string& found : missing_content(file.path, file.text)) ADD_FAILURE() << found;
  }
}

TEST(Content, NoCommentBeginsWithWhatItsThingIsOf) {
  for (const TextFile& file : text_files()) {
    const bool is_ours =
        is_source(file.path) || (ends_in(file.path, {".ts", ".tsx"}) && !file.path.ends_with(".d.ts"));
    if (!is_ours) continue;
    for (const std::string& found : nameless_comments(file)) ADD_FAILURE() << found << ": begins with \"of\"";
  }
}

TEST(Content, ACommentWithoutItsThingIsFoundAndAFieldsIsNot) {
  const auto found = [](std::string text) { return nameless_comments({"core/a.h", std::move(text)}).size(); };
  EXPECT_EQ(found("/// Of the board.\n"), 1U);
  EXPECT_EQ(found("int a;  ///< of that\n"), 1U);
  EXPECT_EQ(found("// of them, the first\n"), 1U);
  EXPECT_EQ(found("int a;  ///< of the board\n"), 0U);
  EXPECT_EQ(found("// The first\n// of them.\n"), 0U);
  EXPECT_EQ(found("// Often.\nconst char* kSaid = \"Of it\";\n"), 0U);
}

TEST(Content, AMachinePathIsFoundWhereverItStarts) {
  const std::string home = std::string("/") + "home/", work = std::string("/") + "work/";
  for (const std::string& line : {home + "me", "see " + work + "x", "'" + home + "'", "(" + work + "a)",
                                  "=" + home, "`" + work + "`", "file://" + home + "me"}) {
    EXPECT_EQ(forbidden_content("a.md", line).size(), 1U) << line;
  }
  for (const std::string& line : {"net" + work + "x", "${DIR}" + home + "me", ".." + work, "~" + work,
                                  std::string("/") + "homely/x", std::string("/") + "homes"}) {
    EXPECT_THAT(forbidden_content("a.md", line), testing::IsEmpty()) << line;
  }
  EXPECT_THAT(forbidden_content("a.md", "one\n" + home),
              testing::ElementsAre(testing::StartsWith("a.md:2: ")));
}

TEST(Content, ARegistryIsFoundInLockFilesOnly) {
  EXPECT_EQ(forbidden_content("app/web/package-lock.json", "\"resolved\": \"https://host/a.tgz\"").size(),
            1U);
  EXPECT_EQ(forbidden_content("app/web/.npmrc", "registry=https://host/").size(), 1U);
  EXPECT_THAT(forbidden_content("app/web/a.ts", "\"resolved\""), testing::IsEmpty());
  EXPECT_THAT(forbidden_content("app/web/.npmrc", "omit-lockfile-registry-resolved=true"),
              testing::IsEmpty());
}

TEST(Content, ASourceWithoutLicenceGuardOrEndIsFound) {
  const std::string licence = "// " + std::string(kLicence) + "\n";
  std::string lines;
  for (std::size_t i = 1; i < kMostLines; ++i) lines += "\n";
  EXPECT_THAT(missing_content("core/a.h", licence + "#pragma once\n"), testing::IsEmpty());
  EXPECT_THAT(missing_content("core/a-inl.h", licence), testing::IsEmpty());
  EXPECT_THAT(missing_content("core/a.cpp", licence + lines), testing::IsEmpty());
  EXPECT_THAT(missing_content("docs/a.md", "words"), testing::IsEmpty());
  EXPECT_EQ(missing_content("core/a.h", licence).size(), 1U);
  EXPECT_EQ(missing_content("core/a.h", "#pragma once\n").size(), 1U);
  EXPECT_EQ(missing_content("core/a.h", "").size(), 2U);
  EXPECT_EQ(missing_content("core/a.cpp", "\n" + licence).size(), 1U);
  EXPECT_EQ(missing_content("core/a.cpp", licence + lines + "\n").size(), 1U);
}

TEST(Content, ABuildFileOrAScriptWithoutLicenceIsFound) {
  const std::string hash = "# " + std::string(kLicence) + "\n", shell = "#!/usr/bin/env bash\n";
  for (const char* path : {"core/CMakeLists.txt", "cmake/a.cmake", "a.py"}) {
    EXPECT_THAT(missing_content(path, hash), testing::IsEmpty()) << path;
    EXPECT_EQ(missing_content(path, "#SPDX - License - Identifier\n").size(), 1U) << path;
    EXPECT_EQ(missing_content(path, "").size(), 1U) << path;
  }
  EXPECT_THAT(missing_content("dev", shell + hash), testing::IsEmpty());
  EXPECT_EQ(missing_content("dev", shell).size(), 1U);
  EXPECT_EQ(missing_content("a.sh", shell + "set -e\n" + hash).size(), 1U);
  EXPECT_THAT(missing_content("app/web/a.ts", "// " + std::string(kLicence)), testing::IsEmpty());
  EXPECT_EQ(missing_content("app/web/a.ts", hash).size(), 1U);
}

}  // namespace
}  // namespace weft::repository
