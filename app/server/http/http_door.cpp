// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_door.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include "app/server/http/error_reply.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

constexpr int kBacklog = 512;
constexpr auto kFarewell = std::chrono::seconds(1);  // for a client to take its last answer

struct FreeAddresses {
  void operator()(addrinfo* first) const { freeaddrinfo(first); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

Addresses addresses_of(const std::string& host, int port) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  return Addresses(failed == 0 ? found : nullptr);
}

bool is_loopback(const sockaddr& address) {
  if (address.sa_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    return ntohl(v4.sin_addr.s_addr) >> 24 == 127;
  }
  return address.sa_family == AF_INET6 &&
         IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
}

Error cannot_listen(const std::string& where, int error_number) {
  if (error_number == EADDRINUSE) {
    return {ErrorKind::kTryAgain, "the port is in use", where, "another program listens on it",
            "end that program, or set another daemon.port in the rig file (0: any free one)"};
  }
  return {ErrorKind::kCannotCreate, "the port cannot be opened", where, system_reason(error_number),
          "set another daemon.host or daemon.port in the rig file"};
}

Result<Descriptor> listen_on(const addrinfo& address, const std::string& where) {
  Descriptor socket(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int yes = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);  // not SO_REUSEPORT: one listener
  if (bind(socket.get(), address.ai_addr, address.ai_addrlen) != 0 || listen(socket.get(), kBacklog) != 0) {
    return cannot_listen(where, errno);
  }
  return socket;
}

std::chrono::steady_clock::time_point in_s(double seconds) {
  const std::chrono::duration<double> patience(seconds);
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(patience);
}

int port_of(int socket) {
  sockaddr_storage address = {};
  socklen_t bytes = sizeof address;
  getsockname(socket, reinterpret_cast<sockaddr*>(&address), &bytes);
  // The port is at the same place in both families.
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

std::string refusal(int status, std::string_view why) {
  const bool is_busy = status == 503;
  const std::string body =
      line_of(error_document({is_busy ? ErrorKind::kTryAgain : ErrorKind::kUsage,
                              is_busy ? "too many requests wait already" : "the request is refused", "",
                              std::string(why), "see /api/v1/openapi.json for what is taken"}));
  return fmt::format(
      "HTTP/1.1 {} Refused\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: "
      "close\r\n\r\n{}",
      status, body.size(), body);
}

bool is_loopback(const std::string& host) {
  const Addresses addresses = addresses_of(host, 0);
  return addresses != nullptr && is_loopback(*addresses->ai_addr);
}

Result<std::unique_ptr<HttpDoor>> HttpDoor::open(const std::string& host, int port,
                                                 const DoorLimits& limits) {
  const std::string where = fmt::format("{}:{}", host, port);
  const Addresses addresses = addresses_of(host, port);
  if (addresses == nullptr) {
    return Error{ErrorKind::kUsage, "the host is no address", where, "",
                 "set daemon.host to 127.0.0.1 or an address of this machine"};
  }
  Result<Descriptor> listening = listen_on(*addresses, where);
  if (!listening) return std::move(listening).error();
  const int bound = port_of(listening->get());
  return std::unique_ptr<HttpDoor>(new HttpDoor(std::move(*listening), bound, limits));
}

HttpDoor::HttpDoor(Descriptor listening, int port, const DoorLimits& limits)
    : listening_(std::move(listening)),
      wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      port_(port),
      limits_(limits) {}

void HttpDoor::begin(Enter enter) {
  enter_ = std::move(enter);
  thread_ = std::thread([this] { run(); });
}

HttpDoor::~HttpDoor() {
  close();
}

void HttpDoor::close() {
  closing_ = true;
  eventfd_write(wake_.get(), 1);
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  returned_.clear();
}

void HttpDoor::take_back(AnsweredRequest answered) {
  Waiting client = {std::move(answered.socket), std::move(answered.rest)};
  client.last = answered.last;
  begin_answer(client, std::move(answered.answer));
  --in_service_;
  {
    const std::lock_guard lock(mutex_);
    if (!client.gone && !closing_) returned_.push_back(std::move(client));
  }
  eventfd_write(wake_.get(), 1);
}

void HttpDoor::run() {
  std::vector<pollfd> watched;
  while (!closing_) {
    take_returned();
    const bool room = in_service_ < limits_.in_service;
    watched = {{wake_.get(), POLLIN, 0}, {room ? listening_.get() : -1, POLLIN, 0}};
    for (const Waiting& client : waiting_) {
      watched.push_back(
          {client.socket.get(), static_cast<short>(client.answer.empty() ? POLLIN : POLLOUT), 0});
    }
    if (poll(watched.data(), watched.size(), next_deadline_ms()) < 0) continue;
    eventfd_t woken = 0;
    if (watched[0].revents != 0) eventfd_read(wake_.get(), &woken);
    std::size_t at = 2;
    for (Waiting& client : waiting_) {
      if (const short events = watched[at++].revents; events != 0) attend(client, events);
    }
    if (watched[1].revents != 0) accept_all();
    drop_overdue();
  }
  waiting_.clear();
}

int HttpDoor::next_deadline_ms() const {
  if (waiting_.empty()) return -1;
  const Clock::time_point next = std::ranges::min_element(waiting_, {}, &Waiting::deadline)->deadline;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now()).count();
  return static_cast<int>(std::max<std::int64_t>(left, 0));
}

void HttpDoor::take_returned() {
  std::vector<Waiting> returned;
  {
    const std::lock_guard lock(mutex_);
    returned.swap(returned_);
  }
  for (Waiting& client : returned) go_on(admit(std::move(client)));
  give_answers_up();
  waiting_.remove_if([](const Waiting& client) { return client.gone; });
}

void HttpDoor::accept_all() {
  for (int taken = 0; taken < kBacklog; ++taken) {
    Descriptor socket(accept4(listening_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    const bool out_of_descriptors = !socket && (errno == EMFILE || errno == ENFILE);
    if (out_of_descriptors && !waiting_.empty()) waiting_.pop_front();
    if (!socket) return;
    const int yes = 1;  // the pieces of a stream leave as they come
    setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    Waiting client = {std::move(socket), {}};
    client.deadline = in_s(limits_.request_deadline_s);
    receive(admit(std::move(client)));
  }
}

/// The oldest gives way where there are too many.
HttpDoor::Waiting& HttpDoor::admit(Waiting client) {
  if (waiting_.size() >= limits_.waiting) waiting_.pop_front();
  return waiting_.emplace_back(std::move(client));
}

/// Answers that began first give way where too much is not taken; the last of them never does.
void HttpDoor::give_answers_up() {
  std::vector<Waiting*> untaken;
  std::size_t bytes = 0;
  for (Waiting& client : waiting_) {
    if (client.answer.empty()) continue;
    untaken.push_back(&client);
    bytes += client.answer.size();
  }
  std::ranges::sort(untaken, {}, [](const Waiting* client) { return client->answer_end; });
  for (std::size_t i = 0; i + 1 < untaken.size() && bytes > limits_.answer_bytes; ++i) {
    bytes -= untaken[i]->answer.size();
    untaken[i]->gone = true;
  }
}

void HttpDoor::attend(Waiting& client, short events) {
  if (client.answer.empty()) return receive(client);
  if ((events & (POLLERR | POLLHUP)) != 0) {
    client.gone = true;
    return;
  }
  send_some(client);
  if (client.answer.empty()) go_on(client);
}

void HttpDoor::receive(Waiting& client) {
  std::array<char, 16384> block = {};
  const ssize_t bytes = recv(client.socket.get(), block.data(), block.size(), 0);
  if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (bytes <= 0) {
    client.gone = true;
    return;
  }
  if (client.ended) return;
  if (std::exchange(client.idle, false)) client.deadline = in_s(limits_.request_deadline_s);
  client.received.append(block.data(), static_cast<std::size_t>(bytes));
  take_in(client);
}

void HttpDoor::take_in(Waiting& client) {
  const RequestFrame frame = frame_request(client.received, limits_.frame);
  if (frame.status != 0) return refuse(client, frame.status, frame.why);
  if (frame.bytes == 0) return;
  std::string rest = client.received.substr(frame.bytes);
  client.received.resize(frame.bytes);
  client.gone = true;
  ++in_service_;
  enter_({std::move(client.socket), std::move(client.received), std::move(rest), frame.last});
}

void HttpDoor::refuse(Waiting& client, int status, std::string_view why) {
  client.last = true;
  begin_answer(client, refusal(status, why));
  go_on(client);
}

void HttpDoor::begin_answer(Waiting& client, std::string answer) const {
  client.answer = std::move(answer);
  client.answer_end = in_s(limits_.answer_deadline_s);
  client.deadline = std::min(in_s(limits_.write_deadline_s), client.answer_end);
  send_some(client);
}

void HttpDoor::send_some(Waiting& client) const {
  while (client.sent < client.answer.size()) {
    const ssize_t more = send(client.socket.get(), client.answer.data() + client.sent,
                              client.answer.size() - client.sent, MSG_NOSIGNAL);
    if (more < 0 && errno == EINTR) continue;
    if (more < 0 && errno == EAGAIN) return;
    if (more < 0) {
      client.gone = true;
      return;
    }
    client.sent += static_cast<std::size_t>(more);
    client.deadline = std::min(in_s(limits_.write_deadline_s), client.answer_end);
  }
  client.answer = {};
  client.sent = 0;
}

/// With what comes after an answer.
void HttpDoor::go_on(Waiting& client) {
  if (client.gone || !client.answer.empty()) return;
  if (client.last) {
    shutdown(client.socket.get(), SHUT_WR);
    client.ended = true;
    client.received = {};
    client.deadline = Clock::now() + kFarewell;
    return;
  }
  client.idle = client.received.empty();
  client.deadline = in_s(client.idle ? limits_.idle_s : limits_.request_deadline_s);
  if (!client.idle) take_in(client);
}

void HttpDoor::drop_overdue() {
  const Clock::time_point now = Clock::now();
  for (Waiting& client : waiting_) {
    if (client.gone || now < client.deadline) continue;
    const bool began = !client.received.empty() && client.answer.empty();
    if (began) {
      refuse(client, 408, "the request did not come in time");
    } else {
      client.gone = true;
    }
  }
  waiting_.remove_if([](const Waiting& client) { return client.gone; });
}

}  // namespace weft::app
