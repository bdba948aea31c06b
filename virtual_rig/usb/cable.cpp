// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/usb/cable.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace weft::virtual_rig::usb {
namespace {

template <typename T>
std::span<std::uint8_t> bytes_of(T& value) {
  return {reinterpret_cast<std::uint8_t*>(&value), sizeof value};
}

}  // namespace

Cable::Cable(const std::string& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) return;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  fd_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
  close(fd_);
  fd_ = -1;
}

Cable::~Cable() {
  if (fd_ >= 0) close(fd_);
}

std::optional<Cable::Answer> Cable::call(UsbCall call, std::span<const std::uint8_t> out,
                                         std::span<std::uint8_t> in, std::uint32_t timeout_ms,
                                         std::uint32_t value) {
  const std::lock_guard lock(mutex_);
  const std::size_t length = call == UsbCall::kBulkOut ? out.size() : in.size();
  CallHead head = {call, static_cast<std::uint32_t>(length), timeout_ms, value};
  if (!write(bytes_of(head)) || !write(out)) return std::nullopt;
  return event(in);
}

bool Cable::listen() {
  CallHead head = {UsbCall::kEvents, 0, 0, 0};
  return write(bytes_of(head));
}

std::optional<Cable::Answer> Cable::event(std::span<std::uint8_t> in) {
  ReplyHead head = {};
  if (!read(bytes_of(head)) || head.length > in.size() || !read(in.first(head.length))) return std::nullopt;
  return Answer{head.status, head.length};
}

bool Cable::write(std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool Cable::read(std::span<std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace weft::virtual_rig::usb
