// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/server/http/event_log.h"
#include "app/server/http/http_door.h"
#include "app/server/http/http_guard.h"
#include "app/server/http/routes.h"
#include "core/base/result.h"

namespace weft::app {

/// What clients may take of the server, so that no number of them keeps the others out.
struct HttpLimits {
  DoorLimits door;
  std::map<Pool, std::size_t> threads = {{Pool::kQuick, 8}, {Pool::kDisk, 16}, {Pool::kPictures, 24},
                                         {Pool::kTiles, 4}, {Pool::kFiles, 8}, {Pool::kDevices, 4}};
  std::size_t waiting = 32;  ///< requests that wait for a thread of their pool; one more is answered with 503
  std::size_t streams = 16;  ///< of events at once; one more is answered with 503
  double heartbeat_s = 1;    ///< between events of a stream at most
};

/// The HTTP interface over a table of routes: HttpDoor before cpp-httplib, which parses, routes and answers.
class HttpServer {
 public:
  static Result<std::unique_ptr<HttpServer>> start(int port, GuardRules rules, std::vector<Route> routes,
                                                   EventLog& events, const HttpLimits& limits);
  ~HttpServer();

  int port() const;
  /// Ends every stream and connection and joins all threads, within door.write_deadline_s.
  void stop();

 private:
  class Parser;
  HttpServer(std::unique_ptr<HttpDoor> door, std::unique_ptr<Parser> parser);

  std::unique_ptr<Parser> parser_;
  std::unique_ptr<HttpDoor> door_;
};

}  // namespace weft::app
