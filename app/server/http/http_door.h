// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "app/server/http/request_frame.h"
#include "core/descriptor.h"
#include "core/result.h"

namespace weft::app {

/// How long and how many the door lets wait.
struct DoorLimits {
  FrameLimits frame;
  double request_deadline_s = 5;  ///< from the connection to the last byte of its request
  std::size_t waiting = 256;      ///< connections without a whole request; the oldest gives way
  std::size_t in_service = 256;   ///< requests being answered; more wait outside
};

/// A connection with one whole request, which is within the limits.
struct WholeRequest {
  Descriptor socket;  ///< non-blocking
  std::string bytes;
};

/// Where connections wait until their request is whole. One thread watches all of them, so a silent, slow or
/// endless client takes a descriptor and nothing else: cpp-httplib by itself gives each connection a thread
/// of its pool, and 64 silent ones would be the whole pool. What breaks the rules is answered and dropped
/// here.
class HttpDoor {
 public:
  /// Called for each request, on the door's thread: hand it on. Call left() when it is done with.
  using Enter = std::function<void(WholeRequest)>;

  /// Listens on `host` (an address, or a name for one) and `port` (0: any free one). Errors: kTryAgain if the
  /// port is in use, kUsage if the host is no address, kCannotCreate if it is not this machine's.
  static Result<std::unique_ptr<HttpDoor>> open(const std::string& host, int port, const DoorLimits& limits);
  ~HttpDoor();
  /// Lets requests in.
  void begin(Enter enter);

  int port() const { return port_; }
  int socket() const { return listening_.get(); }
  void left() { --in_service_; }
  /// Ends all that wait; no request enters any more once this returns.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Descriptor socket;
    std::string received;
    Clock::time_point deadline;
    bool answered = false;  ///< refused: its answer is out, what it still sends is dropped
    bool gone = false;
  };

  HttpDoor(Descriptor listening, int port, const DoorLimits& limits);
  void run();
  void accept_all();
  void receive(Waiting& client);
  void refuse(Waiting& client, int status, std::string_view why);
  void drop_overdue();

  Descriptor listening_, wake_;
  int port_ = 0;
  DoorLimits limits_;
  Enter enter_;
  std::list<Waiting> waiting_;  ///< oldest first
  std::atomic<std::size_t> in_service_ = 0;
  std::atomic<bool> closing_ = false;
  std::thread thread_;
};

/// The whole answer to who is refused before anything is parsed.
std::string refusal(int status, std::string_view why);

/// Whether `host`, as it is listened on, can be reached from this machine only.
bool is_loopback(const std::string& host);

}  // namespace weft::app
