// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene_page.h"

#include <set>
#include <sstream>

#include "core/base/files.h"
#include "tests/simulator/scene/scenes.h"

namespace weft::simulator {
namespace {

TEST(ScenePage, IsWhatTheDocsHave) {
  const Result<std::string> kept = read_text(kSource / "docs/reference/scenes.md");
  ASSERT_TRUE(kept) << kept.error().message();
  EXPECT_EQ(scene_page() + "\n", *kept) << "weft schema --page scenes >docs/reference/scenes.md";
}

/// The rows of the page that begin so: "| `seed` |", each below the heading of its section.
std::set<std::string> sections_and_keys_of_page() {
  std::set<std::string> keys;
  std::istringstream page(scene_page());
  std::string heading;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) heading = line.substr(3);
    if (line.starts_with("| `")) keys.insert(heading + " " + line.substr(3, line.find('`', 3) - 3));
  }
  return keys;
}

TEST(ScenePage, HasEachKeyOfEachKindInItsSection) {
  const std::set<std::string> page = sections_and_keys_of_page();
  std::set<std::string> written;
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    std::istringstream toml(to_toml(everything(i)));
    std::string heading = "Outside of all sections";
    for (std::string line; std::getline(toml, line);) {
      if (line.starts_with("[")) heading = line;
      if (const std::size_t equals = line.find(" = "); equals != line.npos)
        written.insert(heading + " " + line.substr(0, equals));
    }
  }
  const std::string top = "Outside of all sections ";
  for (const std::string& each : {top + "effects", top + "to"}) written.insert(each);  // "auto"
  for (const char* read_alone : {"[geometry] family", "[material] preset", "[lights] rig"})
    written.insert(read_alone);  // and written as others
  EXPECT_EQ(page, written);
}

TEST(ScenePage, SaysWhatEachKeyIs) {
  std::istringstream page(scene_page());
  for (std::string line; std::getline(page, line);) {
    EXPECT_FALSE(line.starts_with("| `") && line.ends_with("|  |")) << line;
  }
}

}  // namespace
}  // namespace weft::simulator
