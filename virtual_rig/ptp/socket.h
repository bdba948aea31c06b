// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <thread>

#include "core/base/descriptor.h"
#include "virtual_rig/ptp/bytes.h"

namespace weft::virtual_rig::ptp {

/// Fills the bytes from a stream; false if it ends, or rests for 5 s in the middle. Waits for the first byte
/// as long as it takes: whoever wants that to end shuts the socket down.
bool read_all(int fd, std::span<std::uint8_t> bytes);
/// False if the other side is gone or takes nothing for 5 s.
bool write_all(int fd, std::span<const BytesView> parts);
/// Writes what fits without waiting.
void write_now(int fd, BytesView bytes);

/// Threads that serve a connection each, all joined at the end.
class Connections {
 public:
  Connections() = default;
  ~Connections();
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  /// Serves a socket and then closes it. One too many is closed at once.
  void add(Descriptor socket, std::function<void(int fd)> serve);
  /// All reads and writes of today's connections fail from now on.
  void hang_up();

 private:
  struct Connection {
    Descriptor socket;
    std::atomic<bool> done = false;
    std::thread thread;
  };

  std::mutex mutex_;
  std::list<Connection> connections_;
};

/// A thread that waits for connections at a socket, while there is one.
class Acceptor {
 public:
  /// `listen` makes the socket; `accepted` is called with each connection. Closed at first.
  Acceptor(std::function<Descriptor()> listen, std::function<void(Descriptor)> accepted);
  ~Acceptor();
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// When it returns, connecting succeeds, or fails at once.
  void set_open(bool open);

 private:
  void run();
  std::shared_ptr<const Descriptor> listener();

  const std::function<Descriptor()> listen_;
  const std::function<void(Descriptor)> accepted_;
  const Descriptor wake_;
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  std::shared_ptr<const Descriptor> listener_;
  std::thread thread_;
};

}  // namespace weft::virtual_rig::ptp
