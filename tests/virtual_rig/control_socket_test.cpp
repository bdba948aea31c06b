// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/control_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "core/base/files.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<ControlSocket> echoing(const fs::path& path) {
  auto socket = ControlSocket::listen(path, [](const std::string& line) { return "<" + line + ">"; });
  EXPECT_TRUE(socket) << socket.error().message();
  return socket ? std::move(*socket) : nullptr;
}

/// A client that says what it likes.
class Client {
 public:
  explicit Client(const fs::path& path) : fd_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    std::copy(path.native().begin(), path.native().end(), address.sun_path);
    connected = ::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { ::close(fd_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void say(const std::string& bytes) { ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  /// What comes until there are `lines` line ends, the other side closes, or two seconds have passed.
  std::string hear(int lines) {
    std::string heard;
    pollfd waiting = {fd_, POLLIN, 0};
    while (std::count(heard.begin(), heard.end(), '\n') < lines && ::poll(&waiting, 1, 2000) == 1) {
      char bytes[256];
      const ssize_t n = ::recv(fd_, bytes, sizeof bytes, 0);
      if (n <= 0) return heard + "(closed)";
      heard.append(bytes, static_cast<std::size_t>(n));
    }
    return heard;
  }
  bool connected = false;

 private:
  int fd_;
};

TEST(ControlSocket, AnswersEachLineWithOneLine) {
  const fs::path path = fresh_folder() / "control";
  const auto socket =
      ControlSocket::listen(path, [](const std::string& line) { return line + "\nand more"; });
  ASSERT_TRUE(socket) << socket.error().message();
  const Result<std::string> answer = send_command(path, "board reset");
  ASSERT_TRUE(answer) << answer.error().message();
  EXPECT_EQ(*answer, "board reset and more");
}

TEST(ControlSocket, TakesSeveralLinesInOnePieceAndOneLineInSeveral) {
  const fs::path path = fresh_folder() / "control";
  const auto socket = echoing(path);
  Client client(path);
  ASSERT_TRUE(client.connected);
  client.say("one\r\ntwo\nthr");
  EXPECT_EQ(client.hear(2), "<one>\n<two>\n");
  client.say("ee\n");
  EXPECT_EQ(client.hear(1), "<three>\n");
}

TEST(ControlSocket, IsNotHeldUpBySilentClients) {
  const fs::path path = fresh_folder() / "control";
  const auto socket = echoing(path);
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 20; ++i) silent.push_back(std::make_unique<Client>(path));
  silent[3]->say("half a li");
  EXPECT_EQ(send_command(path, "status", 2).value(), "<status>");
}

TEST(ControlSocket, DropsAClientWhoseLineNeverEnds) {
  const fs::path path = fresh_folder() / "control";
  const auto socket = echoing(path);
  Client client(path);
  client.say(std::string(5000, 'x'));
  EXPECT_EQ(client.hear(1), "(closed)");
}

TEST(ControlSocket, ServesManyClientsAtOnce) {
  const fs::path path = fresh_folder() / "control";
  const auto socket = echoing(path);
  std::vector<std::thread> clients;
  for (int c = 0; c < 8; ++c) {
    clients.emplace_back([&, c] {
      for (int i = 0; i < 20; ++i) {
        const std::string said = std::to_string(c) + "/" + std::to_string(i);
        const Result<std::string> answer = send_command(path, said);
        ASSERT_TRUE(answer) << answer.error().message();
        EXPECT_EQ(*answer, "<" + said + ">");
      }
    });
  }
  for (std::thread& client : clients) client.join();
}

TEST(ControlSocket, IsGoneWithItsObjectAndNobodyWaitsForIt) {
  const fs::path path = fresh_folder() / "control";
  echoing(path).reset();
  EXPECT_FALSE(is_there(path));
  const Result<std::string> answer = send_command(path, "status");
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().kind, ErrorKind::kNoDevice);
}

TEST(ControlSocket, TakesThePlaceOfOneThatWasKilled) {
  const fs::path path = fresh_folder() / "control";
  ASSERT_TRUE(write_file(path, "left"));
  const auto socket = echoing(path);
  EXPECT_EQ(send_command(path, "a").value(), "<a>");
}

TEST(ControlSocket, RefusesAPathThatNoSocketCanHave) {
  const fs::path path = fresh_folder() / std::string(120, 'x');
  const auto socket = ControlSocket::listen(path, [](const std::string&) { return ""; });
  ASSERT_FALSE(socket);
  EXPECT_EQ(socket.error().kind, ErrorKind::kCannotCreate);
}

TEST(ControlSocket, TellsAHostThatGetsNoAnswerInTime) {
  const fs::path path = fresh_folder() / "control";
  const int silent = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::copy(path.native().begin(), path.native().end(), address.sun_path);
  ASSERT_EQ(::bind(silent, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(silent, 1), 0);
  const Result<std::string> answer = send_command(path, "status", 0.05);
  ::close(silent);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().kind, ErrorKind::kTryAgain);
}

}  // namespace
}  // namespace weft::virtual_rig
