// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/usb_link.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <utility>

namespace weft::virtual_rig::ptp {
namespace {

using usb::CallHead;
using usb::UsbCall;
using usb::UsbStatus;

constexpr std::size_t kContainerHead = 12, kLongestContainer = 65536;
enum ContainerType : std::uint16_t {
  kCommandContainer = 1,
  kDataContainer,
  kResponseContainer,
  kEventContainer
};
enum ClassRequest : std::uint32_t { kCancelRequest = 0x64, kDeviceReset = 0x66, kGetDeviceStatus = 0x67 };

Bytes container_head(std::size_t payload, ContainerType type, std::uint16_t code, std::uint32_t transaction) {
  return ByteWriter()
      .put(static_cast<std::uint32_t>(kContainerHead + payload))
      .put(static_cast<std::uint16_t>(type))
      .put(code)
      .put(transaction)
      .take();
}

Bytes container(ContainerType type, std::uint16_t code, std::uint32_t transaction,
                const std::vector<std::uint32_t>& parameters) {
  ByteWriter writer;
  writer.put(container_head(4 * parameters.size(), type, code, transaction));
  for (const std::uint32_t parameter : parameters) writer.put(parameter);
  return writer.take();
}

template <typename T>
BytesView bytes_of(const T& value) {
  return {reinterpret_cast<const std::uint8_t*>(&value), sizeof value};
}

bool reply(int fd, UsbStatus status, BytesView data = {}, BytesView more = {}) {
  const usb::ReplyHead head = {status, static_cast<std::uint32_t>(data.size() + more.size())};
  return write_all(fd, std::array{bytes_of(head), data, more});
}

bool hung_up(int fd) {
  pollfd one = {.fd = fd, .events = POLLRDHUP, .revents = 0};
  return poll(&one, 1, 0) > 0;
}

Result<sockaddr_un> address_of(const std::filesystem::path& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof address.sun_path)
    return Error{ErrorKind::kCannotCreate, "socket of a USB cable cannot be made", path.string(),
                 "its name is longer than a socket's may be", "choose a shorter folder"};
  path.native().copy(address.sun_path, sizeof address.sun_path - 1);
  return address;
}

Descriptor listening_at(const sockaddr_un& address) {
  Descriptor listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  unlink(address.sun_path);
  if (bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener.get(), 128) != 0)
    return Descriptor();
  return listener;
}

}  // namespace

Result<std::unique_ptr<UsbLink>> UsbLink::make(PtpBody& body, const std::filesystem::path& path,
                                               std::uint16_t product) {
  const Result<sockaddr_un> address = address_of(path);
  if (!address) return address.error();
  if (listening_at(*address).get() < 0)
    return Error{ErrorKind::kCannotCreate, "socket of a USB cable cannot be made", path.string(),
                 std::strerror(errno), "choose a folder that can be written to"};
  return std::unique_ptr<UsbLink>(new UsbLink(body, path, *address, product));
}

UsbLink::UsbLink(PtpBody& body, std::filesystem::path path, const sockaddr_un& address, std::uint16_t product)
    : body_(body),
      path_(std::move(path)),
      product_(product),
      acceptor_(
          [address] { return listening_at(address); },
          [this](Descriptor socket) { connections_.add(std::move(socket), [this](int fd) { serve(fd); }); }) {
}

UsbLink::~UsbLink() {
  unlink(path_.c_str());
}

/// Every time that it comes the bus gives it a new address.
void UsbLink::set_present(bool present) {
  {
    const std::lock_guard lock(mutex_);
    if (present == present_) return;
    present_ = present;
    if (present) address_ = static_cast<std::uint8_t>(address_ % 127 + 1);
    claimant_ = -1;
    clear();
  }
  acceptor_.set_open(present);
  if (!present) connections_.hang_up();
}

void UsbLink::announce(Event event, std::uint32_t parameter) {
  const Bytes bytes = container(kEventContainer, event, 0, {parameter});
  const usb::ReplyHead head = {UsbStatus::kDone, static_cast<std::uint32_t>(bytes.size())};
  const std::lock_guard lock(mutex_);
  if (events_fd_ >= 0) write_now(events_fd_, ByteWriter().put(bytes_of(head)).put(bytes).take());
}

void UsbLink::serve(int fd) {
  bool admitted = false;
  CallHead call = {};
  Bytes data;
  while (read_all(fd, {reinterpret_cast<std::uint8_t*>(&call), sizeof call})) {
    data.resize(call.call == UsbCall::kBulkOut ? std::min<std::size_t>(call.length, kLongestContainer) : 0);
    if (!read_all(fd, data) || !answer(fd, call, data, admitted)) break;
  }
  const std::lock_guard lock(mutex_);
  if (claimant_ == fd) claimant_ = -1;
  if (events_fd_ == fd) events_fd_ = -1;
}

/// False: the connection ends here.
bool UsbLink::answer(int fd, const CallHead& call, BytesView data, bool& admitted) {
  if (call.call == UsbCall::kDescribe) {
    const std::lock_guard lock(mutex_);
    return reply(fd, UsbStatus::kDone, bytes_of(usb::Description{product_, address_}));
  }
  if (call.call == UsbCall::kEvents) {
    const std::lock_guard lock(mutex_);
    events_fd_ = fd;
    return true;
  }
  if (call.call == UsbCall::kConfigure) {  // which the kernel wants without a claim, of whomever
    const std::lock_guard lock(mutex_);
    if (claimant_ >= 0 && claimant_ != fd) return reply(fd, UsbStatus::kBusy);
    clear();
    return reply(fd, UsbStatus::kDone);
  }
  if (call.call == UsbCall::kClaim)
    return reply(fd, claim(fd, admitted) ? UsbStatus::kDone : UsbStatus::kBusy);
  if (!claimed_by(fd)) return reply(fd, UsbStatus::kBusy);
  switch (call.call) {
    case UsbCall::kRelease: {
      const std::lock_guard lock(mutex_);
      claimant_ = -1;
      return reply(fd, UsbStatus::kDone);
    }
    case UsbCall::kReset: {
      body_.reset();
      const std::lock_guard lock(mutex_);
      clear();
      return reply(fd, UsbStatus::kDone);
    }
    case UsbCall::kControl: {
      if (call.value == kGetDeviceStatus)
        return reply(fd, UsbStatus::kDone,
                     ByteWriter().put(std::uint16_t{4}).put(static_cast<std::uint16_t>(kOk)).take());
      if (call.value == kDeviceReset) body_.reset();
      if (call.value != kDeviceReset && call.value != kCancelRequest) return reply(fd, UsbStatus::kStall);
      const std::lock_guard lock(mutex_);
      clear();
      return reply(fd, UsbStatus::kDone);
    }
    case UsbCall::kBulkOut:
      return reply(fd, take_out(data));
    case UsbCall::kBulkIn: {
      const Piece piece = next_piece(fd, call.length, call.timeout_ms);
      if (piece.breaks) body_.pull_cable();
      return reply(fd, piece.status, piece.head, piece.payload.bytes);
    }
    default:
      return false;
  }
}

bool UsbLink::claim(int fd, bool& admitted) {
  {
    const std::lock_guard lock(mutex_);
    if (!present_ || (claimant_ >= 0 && claimant_ != fd)) return false;
    claimant_ = fd;
  }
  if (!admitted) admitted = body_.admit_to_usb();
  if (admitted) return true;
  const std::lock_guard lock(mutex_);
  claimant_ = -1;
  return false;
}

bool UsbLink::claimed_by(int fd) {
  const std::lock_guard lock(mutex_);
  return claimant_ == fd;
}

void UsbLink::clear() {
  in_.clear();
  out_.clear();
  command_.reset();
  changed_.notify_all();
}

/// A host may send a container in several transfers.
UsbStatus UsbLink::take_out(BytesView bytes) {
  Bytes whole;
  {
    const std::lock_guard lock(mutex_);
    out_.insert(out_.end(), bytes.begin(), bytes.end());
    if (out_.empty()) return UsbStatus::kDone;
    const auto length = ByteReader(out_).get<std::uint32_t>();
    if (!length || *length < kContainerHead || *length > kLongestContainer || out_.size() > *length) {
      out_.clear();
      return UsbStatus::kStall;
    }
    if (out_.size() < *length) return UsbStatus::kDone;
    whole = std::exchange(out_, {});
  }
  take_container(whole);
  return UsbStatus::kDone;
}

void UsbLink::take_container(BytesView bytes) {
  ByteReader reader(bytes.subspan(4));
  const std::uint16_t type = *reader.get<std::uint16_t>(), code = *reader.get<std::uint16_t>();
  Command command = {.transaction = *reader.get<std::uint32_t>(), .request = {.operation = code}};
  BytesView data;
  {
    const std::lock_guard lock(mutex_);
    if (type == kCommandContainer) {
      for (std::uint32_t& parameter : command.request.parameters)
        parameter = reader.get<std::uint32_t>().value_or(0);
      command_.reset();
      if (code == kSetDevicePropValue) {
        command_ = command;
        return;
      }
    } else if (type == kDataContainer && command_ && command_->request.operation == code) {
      command = *std::exchange(command_, std::nullopt);
      data = reader.rest();
    } else {
      return;
    }
  }
  send(command, body_.transact(command.request, data));
}

void UsbLink::send(const Command& command, const Answer& answer) {
  using enum Delivery;
  const Delivery delivery = answer.delivery;
  if (delivery == kNothing || delivery == kHangUp) return;
  const std::lock_guard lock(mutex_);
  if (!present_) return;
  if (answer.data) {
    Transfer transfer = {.head = container_head(answer.data->bytes.size(), kDataContainer,
                                                command.request.operation, command.transaction),
                         .payload = *answer.data,
                         .delivery = delivery};
    const std::size_t payload = transfer.payload.bytes.size();
    transfer.most = transfer.head.size() + (delivery == kWhole ? payload : payload / 2);
    in_.push_back(std::move(transfer));
  }
  Transfer response = {
      .head = container(kResponseContainer, answer.code, command.transaction, answer.parameters)};
  response.most = response.head.size();
  in_.push_back(std::move(response));
  changed_.notify_all();
}

/// Waits for bytes to send; what the host does not take of them is its next.
UsbLink::Piece UsbLink::next_piece(int fd, std::size_t most, std::uint32_t timeout_ms) {
  using enum Delivery;
  constexpr std::chrono::milliseconds kLook{20};
  const auto end = RigClock::now() + std::chrono::milliseconds(timeout_ms);
  const auto stalled = [](const Transfer& t) { return t.left() == 0 && t.delivery == kHalfThenNothing; };
  std::unique_lock lock(mutex_);
  while (in_.empty() || stalled(in_.front())) {
    changed_.wait_for(lock, kLook);
    if (!present_ || hung_up(fd) || (timeout_ms && RigClock::now() >= end))
      return {.status = UsbStatus::kTimeOut};
  }
  Transfer& transfer = in_.front();
  if (transfer.delivery == kTimeOut) {
    in_.pop_front();
    return {.status = UsbStatus::kTimeOut};
  }
  const std::size_t length = std::min(most, transfer.left());
  const std::size_t head_sent = std::min(transfer.sent, transfer.head.size());
  const std::size_t of_head = std::min(length, transfer.head.size() - head_sent);
  const std::size_t payload_sent = transfer.sent - head_sent;
  const auto head = BytesView(transfer.head).subspan(head_sent, of_head);
  Piece piece = {.head = {head.begin(), head.end()}, .payload = transfer.payload};
  piece.payload.bytes = piece.payload.bytes.subspan(payload_sent, length - of_head);
  transfer.sent += length;
  piece.breaks = transfer.left() == 0 && transfer.delivery == kHalfThenHangUp;
  const bool short_packet = length < most || transfer.most % usb::kPacket != 0;
  if (transfer.left() == 0 && short_packet && transfer.delivery != kHalfThenNothing) in_.pop_front();
  return piece;
}

}  // namespace weft::virtual_rig::ptp
