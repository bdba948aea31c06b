// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/json_document.h"
#include "core/result.h"

namespace weft::app {

/// A request that the guard let in, as a handler sees it.
struct Call {
  std::vector<std::string> segments;         ///< what stands for {...} in the path, decoded
  std::map<std::string, std::string> query;  ///< decoded
  std::string body;
  int port = 0;  ///< that the server listens on
};

/// What is answered.
struct Reply {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< further ones
};

Reply json_reply(const Json& document, int status = 200);

/// The threads that answer a call: what one kind waits for, others do not.
enum class Pool {
  kAtOnce,    ///< the door's own thread: nothing that could wait
  kQuick,     ///< what is in memory
  kDisk,      ///< files, on a disk that may hang
  kPictures,  ///< raw frames to be decoded
  kStreams,   ///< of events
};

/// One call of the interface. `path` has {names} for segments. An Error is answered by error_document().
struct Route {
  std::string method;
  std::string path;
  std::function<Result<Reply>(const Call&)> handle;  ///< empty: the stream of events
  bool open = false;                                 ///< needs no token
  Pool pool = Pool::kDisk;
};

}  // namespace weft::app
