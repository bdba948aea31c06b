// SPDX-License-Identifier: Apache-2.0
// Strangers at the camera's port: nothing that they send ends it.
#include "virtual_rig/ptp/network_link.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <random>

#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"

namespace weft::virtual_rig {
namespace {

using ptp::Bytes;
using ptp::BytesView;
using ptp::ByteWriter;

ptp::ReadBytes reading(BytesView& rest) {
  return [&rest](std::span<std::uint8_t> into) {
    if (rest.size() < into.size()) return false;
    std::ranges::copy(rest.first(into.size()), into.begin());
    rest = rest.subspan(into.size());
    return true;
  };
}

Bytes packet(std::uint32_t type, const Bytes& body) {
  return ByteWriter().put(static_cast<std::uint32_t>(8 + body.size())).put(type).put(body).take();
}

Bytes operation(std::uint16_t code, std::initializer_list<std::uint32_t> parameters,
                std::uint32_t phase = 1) {
  ByteWriter body;
  body.put(phase).put(code).put(std::uint32_t{7});
  for (const std::uint32_t parameter : parameters) body.put(parameter);
  return packet(ptp::kOperationRequest, body.take());
}

struct Talk {
  std::vector<std::uint32_t> types;
  std::vector<std::uint16_t> responses;
};

/// All that a body says to these bytes.
Talk talk(BytesView bytes) {
  ptp::PtpBody body({}, [](const CameraExposure&) -> Result<Bytes> { return Bytes(100); });
  Bytes said;
  const ptp::WriteBytes write = [&said](std::span<const BytesView> parts) {
    for (const BytesView part : parts) said.insert(said.end(), part.begin(), part.end());
    return true;
  };
  ptp::serve_operations(reading(bytes), write, body);
  Talk talk;
  BytesView rest = said;
  while (const auto one = ptp::read_packet(reading(rest))) {
    talk.types.push_back(one->type);
    if (one->type == ptp::kOperationResponse)
      talk.responses.push_back(*ptp::ByteReader(one->body).get<std::uint16_t>());
  }
  EXPECT_TRUE(rest.empty()) << "half a packet of the camera's own";
  return talk;
}

TEST(PtpPackets, AreAnsweredInOrder) {
  Bytes bytes;
  for (const Bytes& one : {operation(ptp::kGetStorageIds, {}), operation(ptp::kOpenSession, {1}),
                           operation(ptp::kGetStorageIds, {}), operation(0x1fff, {})})
    bytes.insert(bytes.end(), one.begin(), one.end());
  EXPECT_EQ(talk(bytes).responses, (std::vector<std::uint16_t>{ptp::kSessionNotOpen, ptp::kOk, ptp::kOk,
                                                               ptp::kOperationNotSupported}));
}

TEST(PtpPackets, CutOffAnywhereEndTheConversation) {
  Bytes bytes = operation(ptp::kOpenSession, {1});
  const std::size_t first = bytes.size();
  for (const Bytes& more : {operation(ptp::kSetDevicePropValue, {ptp::kIso}, 2),
                            packet(ptp::kStartData, ByteWriter().put(7u).put(std::uint64_t{2}).take()),
                            packet(ptp::kEndData, ByteWriter().put(7u).put(std::uint16_t{200}).take())})
    bytes.insert(bytes.end(), more.begin(), more.end());
  EXPECT_EQ(talk(bytes).responses.size(), 2u);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_EQ(talk(BytesView(bytes).first(length)).responses.size(), length >= first ? 1u : 0u) << length;
}

TEST(PtpPackets, OfImpossibleLengthEndTheConversation) {
  for (const std::uint32_t length : {0u, 7u, 65537u, 0xffffffffu}) {
    Bytes bytes = operation(ptp::kOpenSession, {1});
    std::ranges::copy(ByteWriter().put(length).take(), bytes.begin());
    bytes.resize(100'000);
    EXPECT_TRUE(talk(bytes).responses.empty()) << length;
  }
}

TEST(PtpPackets, AreReadAsTheyWereWritten) {
  EXPECT_EQ(talk(packet(ptp::kPing, {})).types, std::vector<std::uint32_t>{ptp::kPong});
  EXPECT_TRUE(talk(packet(ptp::kCancel, Bytes(4))).types.empty());
  EXPECT_TRUE(talk(packet(999, Bytes(40))).types.empty());
}

TEST(PtpPackets, OfNoiseNeverEndTheCamera) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    Bytes bytes = operation(ptp::kOpenSession, {1});
    for (int i = 0; i < 20; ++i) {
      const auto code = static_cast<std::uint16_t>((random() % 2 ? 0x1000 : 0x90c0) + random() % 32);
      const auto one =
          operation(code, {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())},
                    1 + random() % 2);
      bytes.insert(bytes.end(), one.begin(), one.end());
    }
    for (int i = 0; i < 4; ++i)
      bytes[bytes.size() - 1 - random() % (bytes.size() - 18)] = static_cast<std::uint8_t>(random());
    EXPECT_GE(talk(bytes).responses.size(), 1u);
  }
}

/// A stranger's connection that says these bytes and leaves.
void say(std::uint16_t port, BytesView bytes) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  close(fd);
}

TEST(VirtualCamera, OutlivesStrangersAtItsPort) {
  Studio studio;
  std::mt19937 random(7);
  for (int round = 0; round < 100; ++round) {
    Bytes bytes(random() % 200);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (round % 2 && bytes.size() >= 8)
      std::ranges::copy(ByteWriter().put(64u).put(static_cast<std::uint32_t>(1 + random() % 14)).take(),
                        bytes.begin());
    ASSERT_NO_FATAL_FAILURE(say(studio.camera().port(), bytes)) << round;
  }
  GphotoClient client(studio.network());
  EXPECT_EQ(client.init_within(5), GP_OK);
  EXPECT_TRUE(client.shoot().whole());
}

}  // namespace
}  // namespace weft::virtual_rig
