// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/server/http/request_headers.h"
#include "core/base/descriptor.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// A request that the guard let in, as a handler sees it.
struct Call {
  std::vector<std::string> segments;         ///< what stands for {...} in the path, decoded
  std::map<std::string, std::string> query;  ///< decoded
  std::string body;
  int port = 0;                    ///< that the server listens on
  std::string if_none_match = {};  ///< the header
  std::string control = {};        ///< X-Weft-Control, or the query's: the id that its client commands by
  bool takes_gzip = false;         ///< the client says so

  /// Whether the client has what is tagged so: a reply of that tag needs no body.
  bool has(std::string_view tag) const { return !tag.empty() && names_tag(if_none_match, tag); }
};

/// A file that is answered with, open. Clients may ask for a range of it.
struct FileBody {
  Descriptor file;
  std::uint64_t bytes = 0;
};
/// kNoInput where it is no plain file or may not be read.
Result<std::shared_ptr<const FileBody>> open_file_body(const std::filesystem::path& file);

/// Whether clients may keep what they were answered.
enum class Keeping {
  kNever,
  kAskAgain,  ///< and ask by its tag each time whether it still holds
  kForever,   ///< another content would have another address
};

/// What is answered.
struct Reply {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< further ones
  Keeping keeping = Keeping::kNever;
  std::string tag = {};  ///< names the bytes (ETag, without quotes): who has them is answered with 304
  std::shared_ptr<const FileBody> file = {};  ///< instead of a body
};

Reply json_reply(const Json& document, int status = 200);

/// The threads that answer a call: what one kind waits for, others do not.
enum class Pool {
  kAtOnce,    ///< the door's own thread: nothing that could wait
  kQuick,     ///< what is in memory
  kDisk,      ///< files, on a disk that may hang
  kPictures,  ///< raw frames to be decoded
  kTiles,     ///< maps to be cut and asked about, after everything else that the machine does
  kFiles,     ///< files to be sent, for as long as their clients take
  kDevices,   ///< of the rig, which take seconds
  kStreams,   ///< of events
};

/// One call of the interface. `path` has {names} for segments. An Error is answered by error_document().
struct Route {
  std::string method;
  std::string path;
  std::function<Result<Reply>(const Call&)> handle;  ///< empty: the stream of events
  bool open = false;                                 ///< needs no token
  Pool pool = Pool::kDisk;
  std::function<void(const Call&)> follows =
      {};  ///< of the stream: called every few moments while it is open
};

}  // namespace weft::app
