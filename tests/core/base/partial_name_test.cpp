// SPDX-License-Identifier: Apache-2.0
#include "core/base/partial_name.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "core/base/files.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

TEST(PartialName, TellsAProcessThatRunsFromOneThatIsGone) {
  const std::string own = partial_name("a.b.weft");
  const auto maker = maker_of_partial("/archive/" + own);
  ASSERT_TRUE(maker) << own;
  EXPECT_TRUE(maker->is_of_this_machine) << own;
  EXPECT_TRUE(maker->runs) << own;

  const pid_t child = fork();
  if (child == 0) _exit(0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  std::string gone = own;
  const std::string process = std::to_string(getpid());
  gone.replace(gone.rfind(process), process.size(), std::to_string(child));
  const auto dead = maker_of_partial(gone);
  ASSERT_TRUE(dead) << gone;
  EXPECT_TRUE(dead->is_of_this_machine) << gone;
  EXPECT_FALSE(dead->runs) << gone;
}

TEST(PartialName, OfAnotherMachineSaysSo) {
  const auto maker =
      maker_of_partial(".a.weft.far-" + machine_name() + "." + std::to_string(getpid()) + ".partial");
  ASSERT_TRUE(maker);
  EXPECT_FALSE(maker->is_of_this_machine);
}

TEST(PartialName, IsNoneOfAnotherForm) {
  for (const char* name :
       {"a.partial", ".partial", ".a.partial", ".a.vm.x1.partial", ".a.vm.0.partial", ".a.vm.1.parts"})
    EXPECT_FALSE(maker_of_partial(name)) << name;
}

TEST(PartialName, IsWhatAFolderIsCalledWhileItIsMade) {
  const ScratchFolder work;
  EXPECT_EQ(PartialFolder(work / "a.weft").path().filename(), partial_name("a.weft"));
}

}  // namespace
}  // namespace weft
