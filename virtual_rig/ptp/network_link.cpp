// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/network_link.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <utility>

namespace weft::virtual_rig::ptp {
namespace {

constexpr std::size_t kHead = 8, kLongestPacket = 65536, kDataPacket = 1 << 20;
constexpr std::uint32_t kDataComes = 2;

struct OperationCall {
  std::uint32_t transaction = 0;
  Request request = {};
  Bytes data = {};
};

/// The data phase from host to camera: a start, any number of packets, an end.
std::optional<Bytes> read_data(const ReadBytes& read) {
  const std::optional<Packet> start = read_packet(read);
  if (!start || start->type != kStartData) return std::nullopt;
  Bytes data;
  while (data.size() <= kLongestPacket) {
    const std::optional<Packet> packet = read_packet(read);
    if (!packet || (packet->type != kData && packet->type != kEndData) || packet->body.size() < 4)
      return std::nullopt;
    data.insert(data.end(), packet->body.begin() + 4, packet->body.end());
    if (packet->type == kEndData) return data;
  }
  return std::nullopt;
}

std::optional<OperationCall> read_operation(const Packet& packet, const ReadBytes& read) {
  ByteReader reader(packet.body);
  const auto phase = reader.get<std::uint32_t>();
  const auto code = reader.get<std::uint16_t>();
  const auto transaction = reader.get<std::uint32_t>();
  if (!phase || !code || !transaction) return std::nullopt;
  OperationCall operation = {.transaction = *transaction, .request = {.operation = *code}};
  for (std::uint32_t& parameter : operation.request.parameters)
    parameter = reader.get<std::uint32_t>().value_or(0);
  if (*phase != kDataComes) return operation;
  std::optional<Bytes> data = read_data(read);
  if (!data) return std::nullopt;
  operation.data = *std::move(data);
  return operation;
}

Bytes head(std::uint32_t type, std::uint32_t transaction, std::size_t payload) {
  const auto length = static_cast<std::uint32_t>(kHead + sizeof transaction + payload);
  return ByteWriter().put(length).put(type).put(transaction).take();
}

/// Announces all of the data and sends the first `sent` bytes of it, the last packet as the end if `ended`.
bool write_data(const WriteBytes& write, std::uint32_t transaction, BytesView data, std::size_t sent,
                bool ended) {
  const Bytes start = ByteWriter().put(transaction).put(static_cast<std::uint64_t>(data.size())).take();
  if (!write_packet(write, kStartData, start)) return false;
  BytesView rest = data.first(sent);
  do {
    const BytesView part = rest.first(std::min(rest.size(), kDataPacket));
    rest = rest.subspan(part.size());
    const Bytes before = head(rest.empty() && ended ? kEndData : kData, transaction, part.size());
    if (!write(std::array{BytesView(before), part})) return false;
  } while (!rest.empty());
  return true;
}

/// False: the stream ends here.
bool write_answer(const WriteBytes& write, std::uint32_t transaction, const Answer& answer) {
  using enum Delivery;
  const Delivery delivery = answer.delivery;
  if (delivery == kHangUp) return false;
  if (delivery == kNothing || delivery == kTimeOut) return true;
  if (answer.data) {
    const BytesView data = answer.data->bytes;
    const bool whole = delivery == kWhole;
    const std::size_t sent = whole ? data.size() : data.size() / 2;
    if (!write_data(write, transaction, data, sent, whole || delivery == kHalfAsWhole)) return false;
    if (delivery == kHalfThenHangUp) return false;
    if (delivery == kHalfThenNothing) return true;
  }
  ByteWriter response;
  response.put(static_cast<std::uint16_t>(answer.code)).put(transaction);
  for (const std::uint32_t parameter : answer.parameters) response.put(parameter);
  return write_packet(write, kOperationResponse, response.take());
}

constexpr std::uint32_t kVersion = 0x00010000, kRejected = 1, kConnectionNumber = 1;
/// For a host that has just gone to be seen gone.
constexpr std::chrono::milliseconds kSeatPatience{500};

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A socket that has the port together with others of this process.
Descriptor bound_to(std::uint16_t port) {
  Descriptor bound(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  setsockopt(bound.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const sockaddr_in address = loopback(port);
  if (bind(bound.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return bound;
  return Descriptor();
}

Descriptor listening_at(std::uint16_t port) {
  Descriptor listener = bound_to(port);
  listen(listener.get(), 128);
  return listener;
}

std::uint16_t port_of(int fd) {
  sockaddr_in address = {};
  socklen_t length = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length);
  return ntohs(address.sin_port);
}

Bytes command_ack() {
  ByteWriter writer;
  writer.put(kConnectionNumber);
  for (std::uint8_t i = 0; i < 16; ++i) writer.put(i);  // its GUID, which no host looks at
  for (const char c : {'D', '5', '1', '0', '0', '\0'}) writer.put(static_cast<std::uint16_t>(c));
  return writer.put(kVersion).take();
}

}  // namespace

std::optional<Packet> read_packet(const ReadBytes& read) {
  std::array<std::uint8_t, kHead> bytes;
  if (!read(bytes)) return std::nullopt;
  ByteReader reader(bytes);
  const std::uint32_t length = *reader.get<std::uint32_t>();
  Packet packet = {.type = *reader.get<std::uint32_t>(), .body = {}};
  if (length < kHead || length > kLongestPacket) return std::nullopt;
  packet.body.resize(length - kHead);
  if (!read(packet.body)) return std::nullopt;
  return packet;
}

bool write_packet(const WriteBytes& write, std::uint32_t type, BytesView body) {
  const Bytes bytes =
      ByteWriter().put(static_cast<std::uint32_t>(kHead + body.size())).put(type).put(body).take();
  return write(std::array{BytesView(bytes)});
}

void serve_operations(const ReadBytes& read, const WriteBytes& write, PtpBody& body) {
  for (;;) {
    const std::optional<Packet> packet = read_packet(read);
    if (!packet) return;
    if (packet->type == kPing && !write_packet(write, kPong, {})) return;
    if (packet->type != kOperationRequest) continue;
    const std::optional<OperationCall> operation = read_operation(*packet, read);
    if (!operation) return;
    const Answer answer = body.transact(operation->request, operation->data);
    if (!write_answer(write, operation->transaction, answer)) return;
  }
}

Result<std::unique_ptr<NetworkLink>> NetworkLink::make(PtpBody& body, std::uint16_t port) {
  Descriptor bound = bound_to(port);
  if (bound.get() < 0 || listening_at(port_of(bound.get())).get() < 0)
    return Error{ErrorKind::kTryAgain, "virtual camera cannot have its port",
                 "127.0.0.1:" + std::to_string(port), std::strerror(errno),
                 "choose another port, or 0 for a free one"};
  port = port_of(bound.get());
  return std::unique_ptr<NetworkLink>(new NetworkLink(body, std::move(bound), port));
}

NetworkLink::NetworkLink(PtpBody& body, Descriptor bound, std::uint16_t port)
    : body_(body),
      bound_(std::move(bound)),
      port_(port),
      acceptor_(
          [port] { return listening_at(port); },
          [this](Descriptor socket) { connections_.add(std::move(socket), [this](int fd) { serve(fd); }); }) {
}

void NetworkLink::announce(Event event, std::uint32_t parameter) {
  const Bytes body =
      ByteWriter().put(static_cast<std::uint16_t>(event)).put(std::uint32_t{0}).put(parameter).take();
  const std::lock_guard lock(mutex_);
  if (events_fd_ < 0) return;
  write_packet(
      [this](std::span<const BytesView> parts) {
        write_now(events_fd_, parts[0]);
        return true;
      },
      kEventPacket, body);
}

void NetworkLink::serve(int fd) {
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  const std::optional<Packet> first = read_packet([fd](auto bytes) { return read_all(fd, bytes); });
  if (first && first->type == kInitCommandRequest) serve_host(fd);
  if (first && first->type == kInitEventRequest) serve_events(fd);
}

void NetworkLink::serve_host(int fd) {
  const WriteBytes write = [fd](auto parts) { return write_all(fd, parts); };
  const auto turn_away = [&] {
    write_packet(write, PacketType::kInitFail, ByteWriter().put(kRejected).take());
  };
  if (!take_seat()) return turn_away();
  if (!body_.admit_to_network()) {
    turn_away();
  } else if (write_packet(write, kInitCommandAck, command_ack())) {
    serve_operations([fd](auto bytes) { return read_all(fd, bytes); }, write, body_);
    body_.end_session();
  }
  leave_seat();
}

void NetworkLink::serve_events(int fd) {
  const WriteBytes write = [fd](auto parts) { return write_all(fd, parts); };
  if (!write_packet(write, kInitEventAck, {})) return;
  {
    const std::lock_guard lock(mutex_);
    events_fd_ = fd;
  }
  while (const auto packet = read_packet([fd](auto bytes) { return read_all(fd, bytes); }))
    if (packet->type == kPing && !write_packet(write, kPong, {})) break;
  const std::lock_guard lock(mutex_);
  if (events_fd_ == fd) events_fd_ = -1;
}

bool NetworkLink::take_seat() {
  std::unique_lock lock(mutex_);
  if (!left_.wait_for(lock, kSeatPatience, [this] { return !taken_; })) return false;
  taken_ = true;
  return true;
}

/// The events of a host go when it goes.
void NetworkLink::leave_seat() {
  const std::lock_guard lock(mutex_);
  taken_ = false;
  if (events_fd_ >= 0) shutdown(events_fd_, SHUT_RDWR);
  events_fd_ = -1;
  left_.notify_one();
}

}  // namespace weft::virtual_rig::ptp
