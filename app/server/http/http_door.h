// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/server/http/request_frame.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace weft::app {

/// How long and how many the door lets wait.
struct DoorLimits {
  FrameLimits frame;
  double request_deadline_s = 5;   ///< from the connection, or the first byte of a later request, to its last
  double idle_s = 30;              ///< between two requests of a connection
  double write_deadline_s = 2;     ///< without a byte of an answer leaving
  double answer_deadline_s = 300;  ///< for an answer, or a piece of a stream, to leave, however slowly
  std::size_t waiting = 256;       ///< connections that are not being answered; the oldest gives way
  std::size_t in_service = 256;    ///< requests being answered; more wait outside
  std::size_t answer_bytes = std::size_t{256} << 20;  ///< not yet taken by clients; the oldest gives way
};

/// A connection with one whole request, which is within the limits.
struct WholeRequest {
  Descriptor socket;  ///< non-blocking
  std::string bytes;
  std::string rest;   ///< what came after it
  bool last = false;  ///< its client takes no further answer
};

/// A connection whose request has been answered.
struct AnsweredRequest {
  Descriptor socket;
  std::string rest;    ///< of the WholeRequest
  std::string answer;  ///< or as much of it as is still to leave
  bool last = false;   ///< it is closed after that
};

/// Where connections wait until their request is whole, and again until their answer has left: HTTP/1.1,
/// several requests a connection, answered in their order. One thread watches all of them, so a silent, slow
/// or endless client takes a descriptor and nothing else: cpp-httplib by itself gives each connection a
/// thread of its pool, and 64 silent ones would be the whole pool. What breaks the rules is answered and
/// dropped here.
class HttpDoor {
 public:
  /// Called for each request, on the door's thread: hand it on. Call take_back() when it is answered.
  using Enter = std::function<void(WholeRequest)>;

  /// Listens on `host` (an address, or a name for one) and `port` (0: any free one). Errors: kTryAgain if the
  /// port is in use, kUsage if the host is no address, kCannotCreate if it is not this machine's.
  static Result<std::unique_ptr<HttpDoor>> open(const std::string& host, int port, const DoorLimits& limits);
  ~HttpDoor();
  /// Lets requests in.
  void begin(Enter enter);

  int port() const { return port_; }
  int socket() const { return listening_.get(); }
  /// From any thread. Never waits: what the client does not take at once leaves by the door's thread.
  void take_back(AnsweredRequest answered);
  /// Ends all that wait; no request enters any more once this returns.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Descriptor socket;
    std::string received;     ///< of the next request
    std::string answer = {};  ///< to the one before, which leaves first
    std::size_t sent = 0;     ///< of the answer
    bool last = false;        ///< no further request is taken
    bool ended = false;       ///< the last answer is out, what it still sends is dropped
    bool gone = false;
    bool idle = false;                  ///< between two requests
    Clock::time_point deadline = {};    ///< of what it is at
    Clock::time_point answer_end = {};  ///< the answer must be out by then
  };

  HttpDoor(Descriptor listening, int port, const DoorLimits& limits);
  void run();
  int next_deadline_ms() const;
  void take_returned();
  void accept_all();
  Waiting& admit(Waiting client);
  void give_answers_up();
  void attend(Waiting& client, short events);
  void receive(Waiting& client);
  void take_in(Waiting& client);
  void refuse(Waiting& client, int status, std::string_view why);
  void begin_answer(Waiting& client, std::string answer) const;
  void send_some(Waiting& client) const;
  void go_on(Waiting& client);
  void drop_overdue();

  Descriptor listening_, wake_;
  int port_ = 0;
  DoorLimits limits_;
  Enter enter_;
  std::list<Waiting> waiting_;  ///< oldest first
  std::atomic<std::size_t> in_service_ = 0;
  std::mutex mutex_;  ///< of returned_
  std::vector<Waiting> returned_;
  std::atomic<bool> closing_ = false;
  std::thread thread_;
};

/// The whole answer to who is refused before anything is parsed.
std::string refusal(int status, std::string_view why);

/// Whether `host`, as it is listened on, can be reached from this machine only.
bool is_loopback(const std::string& host);

}  // namespace weft::app
