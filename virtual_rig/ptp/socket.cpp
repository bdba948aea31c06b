// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/socket.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace weft::virtual_rig::ptp {
namespace {

constexpr int kPatienceMs = 5000;
constexpr std::size_t kMostConnections = 32;

bool ready(int fd, short events, int timeout_ms) {
  pollfd one = {.fd = fd, .events = events, .revents = 0};
  int found = 0;
  do found = poll(&one, 1, timeout_ms);
  while (found < 0 && errno == EINTR);
  return found > 0;
}

/// The host's library leaves Nagle's algorithm on: an acknowledgement that waits costs it 40 ms.
void acknowledge_at_once(int fd) {
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);  // fails on other sockets, which need it not
}

}  // namespace

bool read_all(int fd, std::span<std::uint8_t> bytes) {
  bool begun = false;
  while (!bytes.empty()) {
    if (!ready(fd, POLLIN, begun ? kPatienceMs : -1)) return false;
    const ssize_t count = recv(fd, bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    acknowledge_at_once(fd);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    begun = true;
  }
  return true;
}

bool write_all(int fd, std::span<const BytesView> parts) {
  std::array<iovec, 4> vectors;
  std::size_t count = 0;
  for (const BytesView part : parts)
    if (!part.empty()) vectors.at(count++) = {const_cast<std::uint8_t*>(part.data()), part.size()};
  std::span<iovec> left(vectors.data(), count);
  while (!left.empty()) {
    msghdr message = {};
    message.msg_iov = left.data();
    message.msg_iovlen = left.size();
    const ssize_t sent = sendmsg(fd, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) {
      if (errno == EAGAIN && !ready(fd, POLLOUT, kPatienceMs)) return false;
      continue;
    }
    if (sent < 0) return false;
    auto rest = static_cast<std::size_t>(sent);
    while (!left.empty() && rest >= left[0].iov_len) {
      rest -= left[0].iov_len;
      left = left.subspan(1);
    }
    if (rest > 0) left[0] = {static_cast<std::uint8_t*>(left[0].iov_base) + rest, left[0].iov_len - rest};
  }
  return true;
}

void write_now(int fd, BytesView bytes) {
  [[maybe_unused]] const ssize_t sent = send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

Connections::~Connections() {
  hang_up();
  for (Connection& connection : connections_) connection.thread.join();
}

void Connections::add(Descriptor socket, std::function<void(int fd)> serve) {
  const std::lock_guard lock(mutex_);
  connections_.remove_if([](Connection& connection) {
    if (!connection.done) return false;
    connection.thread.join();
    return true;
  });
  if (connections_.size() >= kMostConnections) return;
  Connection& connection = connections_.emplace_back();
  connection.socket = std::move(socket);
  connection.thread = std::thread([&connection, serve = std::move(serve)] {
    serve(connection.socket.get());
    shutdown(connection.socket.get(), SHUT_RDWR);
    connection.done = true;
  });
}

void Connections::hang_up() {
  const std::lock_guard lock(mutex_);
  for (const Connection& connection : connections_) shutdown(connection.socket.get(), SHUT_RDWR);
}

Acceptor::Acceptor(std::function<Descriptor()> listen, std::function<void(Descriptor)> accepted)
    : listen_(std::move(listen)),
      accepted_(std::move(accepted)),
      wake_(eventfd(0, EFD_CLOEXEC)),
      thread_([this] { run(); }) {}

Acceptor::~Acceptor() {
  stopping_ = true;
  set_open(false);
  thread_.join();
}

void Acceptor::set_open(bool open) {
  const std::lock_guard lock(mutex_);
  if (open && !listener_) {
    listener_ = std::make_shared<const Descriptor>(listen_());
  } else if (!open && listener_) {
    shutdown(listener_->get(), SHUT_RDWR);
    listener_.reset();
  }
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(wake_.get(), &one, sizeof one);
}

std::shared_ptr<const Descriptor> Acceptor::listener() {
  const std::lock_guard lock(mutex_);
  return listener_;
}

void Acceptor::run() {
  while (!stopping_) {
    const std::shared_ptr<const Descriptor> at = listener();
    std::array<pollfd, 2> both = {{{.fd = wake_.get(), .events = POLLIN, .revents = 0},
                                   {.fd = at ? at->get() : -1, .events = POLLIN, .revents = 0}}};
    if (poll(both.data(), both.size(), -1) < 0) continue;
    std::uint64_t wakes = 0;
    if (both[0].revents) [[maybe_unused]]
      const ssize_t got = read(wake_.get(), &wakes, sizeof wakes);
    if (!at || !both[1].revents) continue;
    Descriptor connection(accept4(at->get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (connection.get() >= 0) accepted_(std::move(connection));
  }
}

}  // namespace weft::virtual_rig::ptp
