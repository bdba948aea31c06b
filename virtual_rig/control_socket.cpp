// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/control_socket.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/files.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kMostClients = 64;
constexpr std::chrono::seconds kPatience(10);

std::optional<sockaddr_un> address_of(const fs::path& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  const std::string& name = path.native();
  if (name.empty() || name.size() >= sizeof address.sun_path) return {};
  std::copy(name.begin(), name.end(), address.sun_path);
  return address;
}

int milliseconds_until(Clock::time_point when) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(when - Clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 60000));
}

struct Client {
  int fd;
  Clock::time_point until;
  std::string received = {};
};

/// The next whole line, without its end.
std::optional<std::string> take_line(std::string& received) {
  const std::size_t end = received.find('\n');
  if (end == std::string::npos) return {};
  std::string line = received.substr(0, end);
  received.erase(0, end + 1);
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

bool send_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;  // answers are short: a client that lets its buffer fill is not reading
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

/// Reads what has come and answers each whole line; false once the client is gone or not worth keeping.
bool serve_client(Client& client, const ControlSocket::Answer& answer) {
  char bytes[512];
  const ssize_t n = ::recv(client.fd, bytes, sizeof bytes, 0);
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  if (n == 0) return false;
  client.received.append(bytes, static_cast<std::size_t>(n));
  client.until = Clock::now() + kPatience;
  while (const std::optional<std::string> line = take_line(client.received)) {
    std::string reply = answer(*line);
    std::replace(reply.begin(), reply.end(), '\n', ' ');
    if (!send_all(client.fd, reply + '\n')) return false;
  }
  return client.received.size() <= kLongestLine;
}

}  // namespace

ControlSocket::ControlSocket(fs::path path, Answer answer)
    : path_(std::move(path)), answer_(std::move(answer)) {}

Result<std::unique_ptr<ControlSocket>> ControlSocket::listen(const fs::path& path, Answer answer) {
  const std::optional<sockaddr_un> address = address_of(path);
  if (!address) return cannot_write(path, ENAMETOOLONG);
  std::unique_ptr<ControlSocket> made(new ControlSocket(path, std::move(answer)));
  std::error_code ignored;
  fs::remove(path, ignored);
  made->listening_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  made->wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (made->listening_ < 0 || made->wake_ < 0 ||
      ::bind(made->listening_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0 ||
      ::listen(made->listening_, SOMAXCONN) != 0) {
    return cannot_write(path, errno);
  }
  made->thread_ = std::thread([socket = made.get()] { socket->serve(); });
  return made;
}

ControlSocket::~ControlSocket() {
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    while (::write(wake_, &one, sizeof one) < 0 && errno == EINTR) {
    }
    thread_.join();
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  for (const int fd : {listening_, wake_}) {
    if (fd >= 0) ::close(fd);
  }
}

void ControlSocket::serve() {
  std::vector<Client> clients;
  while (true) {
    std::vector<pollfd> waiting = {{wake_, POLLIN, 0}, {listening_, POLLIN, 0}};
    if (clients.size() >= kMostClients) waiting[1].fd = -1;
    Clock::time_point soonest = Clock::now() + kPatience;
    for (const Client& client : clients) {
      waiting.push_back({client.fd, POLLIN, 0});
      soonest = std::min(soonest, client.until);
    }
    if (::poll(waiting.data(), waiting.size(), milliseconds_until(soonest)) < 0 && errno != EINTR) break;
    if (waiting[0].revents != 0) break;
    std::vector<Client> kept;
    for (std::size_t i = 0; i < clients.size(); ++i) {
      const bool has_spoken = waiting[i + 2].revents != 0;
      const bool stays = has_spoken ? serve_client(clients[i], answer_) : clients[i].until > Clock::now();
      stays ? kept.push_back(std::move(clients[i])) : static_cast<void>(::close(clients[i].fd));
    }
    clients = std::move(kept);
    if (waiting[1].revents == 0) continue;
    const int fd = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd >= 0) clients.push_back({fd, Clock::now() + kPatience});
  }
  for (const Client& client : clients) ::close(client.fd);
}

Result<std::string> send_command(const fs::path& socket, const std::string& line, double deadline_s) {
  const auto gone = [&](int error_number) {
    return Error{ErrorKind::kNoDevice, "no virtual rig", socket.string(), system_reason(error_number),
                 "start weft-virtual-rig with this folder"};
  };
  const std::optional<sockaddr_un> address = address_of(socket);
  if (!address) return gone(ENAMETOOLONG);
  const auto until =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(deadline_s));
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return gone(errno);
  const auto answered = [&]() -> Result<std::string> {
    if (::connect(fd, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0) return gone(errno);
    if (!send_all(fd, line + '\n')) return gone(errno);
    std::string received;
    while (true) {
      if (std::optional<std::string> reply = take_line(received)) return *std::move(reply);
      pollfd waiting = {fd, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, milliseconds_until(until));
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0 && Clock::now() < until) continue;
      if (ready == 0) {
        return Error{ErrorKind::kTryAgain, "the virtual rig does not answer", socket.string(),
                     fmt::format("nothing came in {} s", deadline_s), "send the command again"};
      }
      char bytes[512];
      const ssize_t n = ::recv(fd, bytes, sizeof bytes, 0);
      if (n <= 0) return gone(n < 0 ? errno : ECONNRESET);
      received.append(bytes, static_cast<std::size_t>(n));
    }
  }();
  ::close(fd);
  return answered;
}

Result<std::string> tell_rig(const fs::path& socket, const std::string& line, double deadline_s) {
  Result<std::string> answer = send_command(socket, line, deadline_s);
  if (answer && answer->starts_with("error")) {
    return Error{ErrorKind::kUsage, "the virtual rig refuses a command", line, *answer,
                 "use one that it has"};
  }
  return answer;
}

}  // namespace weft::virtual_rig
