// SPDX-License-Identifier: Apache-2.0
#include "app/server/service_manager.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

#include "core/base/descriptor.h"

namespace weft::app {
namespace {

/// A service manager that listens at `name`, which may begin with '@'.
class Listener {
 public:
  explicit Listener(const std::string& name)
      : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path, sizeof address.sun_path - 1);
    if (name[0] == '@') address.sun_path[0] = '\0';
    const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), bytes), 0) << name;
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~Listener() { unsetenv("NOTIFY_SOCKET"); }
  std::string heard() const {
    std::array<char, 256> text = {};
    const ssize_t bytes = recv(socket_.get(), text.data(), text.size(), 0);
    return bytes > 0 ? std::string(text.data(), static_cast<std::size_t>(bytes)) : "";
  }

 private:
  Descriptor socket_;
};

TEST(ServiceManager, HearsWhatItIsTold) {
  const std::string path = testing::TempDir() + "weft_notify_" + std::to_string(getpid());
  for (const std::string& name : {path, "@" + path}) {
    const Listener listener(name);
    tell_service_manager("READY=1");
    EXPECT_EQ(listener.heard(), "READY=1") << name;
    unlink(path.c_str());
  }
  tell_service_manager("READY=1");  // nobody listens: nothing happens
}

TEST(ServiceManager, IsToldTwiceInItsInterval) {
  unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(watchdog_interval(), std::nullopt);
  setenv("WATCHDOG_USEC", "30000000", 1);
  EXPECT_EQ(watchdog_interval(), std::chrono::seconds(15));
  setenv("WATCHDOG_USEC", "soon", 1);
  EXPECT_EQ(watchdog_interval(), std::nullopt);
  unsetenv("WATCHDOG_USEC");
}

}  // namespace
}  // namespace weft::app
