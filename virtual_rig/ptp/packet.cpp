// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/packet.h"

#include <algorithm>
#include <array>
#include <cstddef>

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

}  // namespace weft::virtual_rig::ptp
