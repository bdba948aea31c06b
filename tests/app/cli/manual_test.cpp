// SPDX-License-Identifier: Apache-2.0
// Pages and completions of a program of few verbs.
#include "app/cli/manual.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "app/cli/completion.h"
#include "app/cli/options.h"

namespace weft::app {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Run add_dye(Options& options) {
  const auto cloth = std::make_shared<std::filesystem::path>();
  const auto color = std::make_shared<std::string>("madder");
  const auto hours = std::make_shared<double>(2);
  options.add("cloth", cloth.get(), "What is dyed. .Xr is no macro here").required();
  options.add("-c,--color", color.get(), "Which colour; it's dear")
      .one_of({"madder", "indigo"})
      .shows_default();
  options.add("--hours", hours.get(), "How long, \\ hours").above_zero();
  return [cloth, color, hours](const CommonArguments&) { return 0; };
}

Program dyer() {
  return {.name = "weft",
          .help = "weft: a dyer",
          .verbs = {{.name = "dye", .help = "Dye a cloth", .add = add_dye},
                    {.name = "vat",
                     .help = "Keep vats",
                     .verbs = {{.name = "fill", .help = "Fill one", .add = add_dye}}},
                    {.name = "weigh", .help = "Weigh", .program = "weft-scales"}}};
}

std::string page(const std::string& file) {
  for (const ManualPage& each : manual_pages(tree_of(dyer()), "1.2.3", "June 1, 2026")) {
    if (each.file == file) return each.text;
  }
  return "";
}

TEST(CommandTree, HasWhatAnOptionTakes) {
  const CommandWord tree = tree_of(dyer());
  ASSERT_EQ(tree.verbs.size(), 3U);
  const CommandWord& dye = tree.verbs[0];
  ASSERT_GE(dye.options.size(), 3U);
  EXPECT_TRUE(dye.options[0].is_positional);
  EXPECT_TRUE(dye.options[0].is_required);
  EXPECT_EQ(dye.options[0].value, "PATH");
  EXPECT_THAT(dye.options[1].names, testing::ElementsAre("-c", "--color"));
  EXPECT_THAT(dye.options[1].choices, testing::UnorderedElementsAre("madder", "indigo"));
  EXPECT_EQ(dye.options[1].otherwise, "madder");
  EXPECT_EQ(dye.options[2].range, "above 0");
  const auto quiet =
      std::ranges::find(dye.options, std::vector<std::string>{"-q", "--quiet"}, &CommandOption::names);
  ASSERT_NE(quiet, dye.options.end());
  EXPECT_FALSE(quiet->takes_value);
}

TEST(Manual, HasAPageOfTheProgramAndOneOfEachVerbThatItRuns) {
  EXPECT_THAT(page("weft.1"),
              AllOf(HasSubstr(".Dd June 1, 2026"), HasSubstr(".Os weft 1.2.3"), HasSubstr(".Nd a dyer\n"),
                    HasSubstr(".It Xr weft-dye 1\nDye a cloth."), HasSubstr(".It 65\nbad data")));
  EXPECT_THAT(page("weft-dye.1"), AllOf(HasSubstr(".Nm weft dye\n.Ar \\&cloth\n.Op Ar options"),
                                        HasSubstr(".It Fl \\&c , Fl \\&\\-color Ar \\&TEXT")));
  EXPECT_THAT(page("weft-vat.1"), AllOf(HasSubstr(".Ss weft vat fill"), HasSubstr("Fl \\&\\-hours")));
  EXPECT_EQ(page("weft-weigh.1"), "");
}

TEST(Manual, TakesNoWordOfAHelpForAMacro) {
  EXPECT_THAT(page("weft-dye.1"), AllOf(HasSubstr("What is dyed.\n\\&.Xr is no macro here.\n"),
                                        HasSubstr("How long, \\e hours."), Not(HasSubstr("\n.Xr is"))));
}

TEST(Completion, QuotesWhatShellsWouldRead) {
  const CommandWord tree = tree_of(dyer());
  EXPECT_THAT(bash_completion(tree), HasSubstr("'weft dye -c'|'weft dye --color') words='"));
  EXPECT_THAT(zsh_completion(tree), HasSubstr("'(-c --color)--color[Which colour; it'\\''s dear]:TEXT:("));
  EXPECT_THAT(fish_completion(tree), HasSubstr("-s c -l color -x -a '"));
  EXPECT_THAT(fish_completion(tree), HasSubstr("-d 'Which colour; it\\'s dear'"));
}

}  // namespace
}  // namespace weft::app
