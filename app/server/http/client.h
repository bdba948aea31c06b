// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// The command line's end of a RigServer's interface. Every call has a deadline and a connection of its own,
/// so that calls may come from several threads.
class RigClient {
 public:
  /// `address` as RigServer::address() or address_of_owner() give it; `token` empty: none. Asks for the
  /// server's health. Errors: kUsage (no such address), kTryAgain (nothing answers there), and those of
  /// get().
  static Result<RigClient> connect(const std::string& address, const std::string& token = "");

  /// The Error that the server answered with; kTryAgain if it did not answer within 10 s, kProtocol if it
  /// answered anything but JSON.
  Result<Json> get(const std::string& path) const;
  /// The answer as it is, such as a picture's. The same errors.
  Result<std::string> bytes(const std::string& path) const;
  Result<Json> post(const std::string& path, const Json& body = Json::object()) const;

  struct Event {
    std::string name;  ///< "status" (as things are, first of all), "frame"
    Json data;
  };
  /// Calls `take` for each event until it returns false or `stop` is requested. kTryAgain where the server
  /// ends or is silent for longer than its heartbeat.
  Result<void> follow(const std::function<bool(const Event&)>& take, const std::stop_token& stop) const;

 private:
  RigClient(std::string host, int port, std::string token)
      : host_(std::move(host)), port_(port), token_(std::move(token)) {}
  std::string host_;
  int port_ = 0;
  std::string token_;
};

}  // namespace weft::app
