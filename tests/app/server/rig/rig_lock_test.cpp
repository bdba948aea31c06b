// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/app/server/raw_client.h"
#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

mode_t mode_of(const fs::path& path) {
  struct stat about = {};
  EXPECT_EQ(stat(path.c_str(), &about), 0) << path;
  return about.st_mode & 0777;
}

/// Until its end this process is nobody's, which only root's can become.
class AsNobody {
 public:
  AsNobody() { EXPECT_EQ(seteuid(65534), 0); }
  ~AsNobody() { EXPECT_EQ(seteuid(0), 0); }
  AsNobody(const AsNobody&) = delete;
};

TEST(RigLock, IsSeenByAllUsersWhateverTheUmaskAndItsTokenByOne) {
  ScriptedRig scripted("modes");
  const mode_t before = umask(0077);
  Result<RigLock> lock = RigLock::take(scripted.rig);
  ASSERT_TRUE(lock) << lock.error().message();
  const Result<void> published = lock->publish("http://127.0.0.1:1", "0123456789abcdef");
  umask(before);
  ASSERT_TRUE(published) << published.error().message();
  const fs::path state = scripted.rig.daemon.state;
  EXPECT_EQ(mode_of(state), 0755U);
  EXPECT_EQ(mode_of(state / "lock"), 0644U);
  EXPECT_EQ(mode_of(state / "address"), 0644U);
  EXPECT_EQ(mode_of(state / "token"), 0600U);
}

TEST(RigLock, OfAnotherUserIsSaidToBeSo) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can be another user for a while";
  ScriptedRig scripted("another");
  const fs::path state = scripted.rig.daemon.state;
  { ASSERT_TRUE(RigLock::take(scripted.rig)); }
  {
    const AsNobody nobody;
    const Result<RigLock> taken = RigLock::take(scripted.rig);
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().kind, ErrorKind::kCannotCreate);
    EXPECT_THAT(taken.error().message(), HasSubstr("a daemon of another user owns this rig"));
    EXPECT_THAT(taken.error().remedy, HasSubstr("run weft serve"));
    EXPECT_EQ(address_of_owner(scripted.rig).value(), std::nullopt) << "it can be asked for all the same";
  }
  fs::permissions(state / "lock", fs::perms::none);
  {
    const AsNobody nobody;
    const Result<std::optional<std::string>> address = address_of_owner(scripted.rig);
    ASSERT_FALSE(address) << "nobody can tell whether there is an owner";
    EXPECT_THAT(address.error().message(), HasSubstr("a daemon of another user owns this rig"));
  }
}

TEST(RigLock, AServerWithATokenOfItsOwnAnswersItsUserAlone) {
  ScriptedRig scripted("owntoken");
  scripted.own_token = true;
  auto server = scripted.started();
  EXPECT_EQ(ask(server->port(), "POST", "/api/v1/scan/cancel", "{}").status, 401);
  const Result<std::string> token = token_of_owner(scripted.rig);
  ASSERT_TRUE(token) << token.error().message();
  EXPECT_EQ(token->size(), 64U);
  EXPECT_EQ(*token, server->token());
  wait_for_state(server->port(), "idle", *token);
  if (geteuid() == 0) {
    const AsNobody nobody;
    const Result<std::string> others = token_of_owner(scripted.rig);
    ASSERT_FALSE(others);
    EXPECT_EQ(others.error().kind, ErrorKind::kTryAgain);
    EXPECT_THAT(others.error().why, HasSubstr("a scan of root runs"));
  }
  server.reset();
  EXPECT_EQ(token_of_owner(scripted.rig).value(), "") << "it went with its server";
}

TEST(RigLock, LeavesNoTokenOfAServerThatWasKilled) {
  ScriptedRig scripted("stale");
  fs::create_directories(scripted.rig.daemon.state);
  std::ofstream(scripted.rig.daemon.state / "token") << "0123456789abcdef";
  const auto server = scripted.started();
  EXPECT_EQ(token_of_owner(scripted.rig).value(), "");
}

}  // namespace
}  // namespace weft::app
