// SPDX-License-Identifier: Apache-2.0
// Batches on a farm, as far as that needs none: tests/farm runs them on a real Slurm.
#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "tests/system/batch_test.h"

namespace weft::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A variable of the environment, as it was again at the end.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    const char* const before = std::getenv(name);
    if (before != nullptr) before_ = before;
    ::setenv(name, value, 1);
  }
  ~Variable() {
    if (before_) {
      ::setenv(name_, before_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST_F(BatchTest, WithoutSlurmItSaysWhatOtherFarmsTake) {
  fill_archive(2);
  plan({"--sample", "0", "--task-minutes", "0.001"});
  const Variable path("PATH", "/nowhere");
  const Outcome refused = run_weft({"batch", "submit", plan_file().string()});
  EXPECT_EQ(refused.exit_code, 66);
  EXPECT_THAT(refused.error, HasSubstr("there is no Slurm on this machine"));
  EXPECT_THAT(refused.error, HasSubstr("weft batch commands"));
  EXPECT_EQ(run_weft({"batch", "cancel", plan_file().string()}).exit_code, 66);
  const Outcome status = run_weft({"batch", "status", plan_file().string()});
  EXPECT_EQ(status.exit_code, 2);
  EXPECT_THAT(status.error, IsEmpty()) << "a plan that was never submitted is no matter of Slurm";
  const Outcome commands = run_weft({"batch", "submit", plan_file().string(), "--backend", "commands"});
  EXPECT_EQ(commands.exit_code, 0);
  EXPECT_THAT(commands.output, HasSubstr("batch run " + plan_file().string() + " --task 0 -q\n"));
  EXPECT_EQ(run_weft({"batch", "submit", plan_file().string(), "--cores", "0"}).exit_code, 64);
}

TEST_F(BatchTest, ATaskOfAnArrayIsThatOfItsIndex) {
  fill_archive(2);
  plan({"--task-minutes", "0.001", "--sample", "1"});
  const Outcome outside = run({"--array-from", "0", "-q"});
  EXPECT_EQ(outside.exit_code, 64);
  EXPECT_THAT(outside.error, HasSubstr("SLURM_ARRAY_TASK_ID"));
  const Variable index("SLURM_ARRAY_TASK_ID", "0");
  EXPECT_EQ(run({"--array-from", "2", "-q"}).exit_code, 64) << "there are tasks 0 and 1";
  const Outcome second = run({"--array-from", "1", "-q"});
  EXPECT_EQ(second.exit_code, 0) << second.error;
  EXPECT_THAT(solves_of(session(0)), IsEmpty());
  EXPECT_THAT(solves_of(session(1)), SizeIs(1));
}

}  // namespace
}  // namespace weft::test
