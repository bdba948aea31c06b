// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/http_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include "app/server/http/error_reply.h"
#include "app/server/http/path_pattern.h"
#include "app/server/http/request_headers.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kNotModified = 304;

/// A whole request to read from, and its client to write to: at once, where an answer is made as it leaves,
/// or once it is whole.
class RequestStream : public httplib::Stream {
 public:
  RequestStream(WholeRequest request, bool at_once, const DoorLimits& limits, const std::atomic<bool>& ending)
      : request_(std::move(request)),
        at_once_(at_once),
        patience_(limits.write_deadline_s),
        most_(limits.answer_deadline_s),
        ending_(ending) {}

  bool is_last() const { return request_.last; }
  AnsweredRequest answered(bool last) {
    return {std::move(request_.socket), std::move(request_.rest), std::move(answer_), last};
  }

  bool is_readable() const override { return at_ < request_.bytes.size(); }
  bool is_writable() const override {
    if (!at_once_) return true;
    pollfd socket = {request_.socket.get(), POLLRDHUP, 0};
    return poll(&socket, 1, 0) == 0;
  }
  ssize_t read(char* bytes, std::size_t most) override {
    const std::size_t count = request_.bytes.copy(bytes, most, at_);
    at_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* bytes, std::size_t count) override {
    if (!at_once_) {
      answer_.append(bytes, count);
      return static_cast<ssize_t>(count);
    }
    const auto end = Clock::now() + most_;
    auto deadline = std::min(end, Clock::now() + patience_);
    for (std::size_t sent = 0; sent < count;) {
      const ssize_t more = send(socket(), bytes + sent, count - sent, MSG_NOSIGNAL);
      if (more >= 0) {
        sent += static_cast<std::size_t>(more);
        if (!ending_) deadline = std::min(end, Clock::now() + patience_);
        continue;
      }
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
      if ((errno != EAGAIN && errno != EINTR) || left <= 0) return -1;
      pollfd socket_room = {socket(), POLLOUT, 0};
      poll(&socket_room, 1, static_cast<int>(left));
    }
    return static_cast<ssize_t>(count);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return request_.socket.get(); }

 private:
  WholeRequest request_;
  const bool at_once_;
  std::chrono::duration<double> patience_, most_;
  const std::atomic<bool>& ending_;  ///< the server is: no deadline begins again
  std::size_t at_ = 0;
  std::string answer_;
};

std::string_view path_of(std::string_view target) {
  return target.substr(0, target.find('?'));
}

/// From a file, or from a text that is not to be compressed: its tag names these bytes.
void give_bytes(const Reply& reply, std::uint64_t first, std::uint64_t bytes, httplib::Response& response) {
  if (const std::shared_ptr<const FileBody> file = reply.file) {
    response.set_content_provider(bytes, reply.type, [file, first](auto at, auto left, auto& sink) {
      std::array<char, 65536> block = {};
      const ssize_t read =
          pread(file->file.get(), block.data(), std::min(left, block.size()), static_cast<off_t>(first + at));
      return read > 0 && sink.write(block.data(), static_cast<std::size_t>(read));
    });
    return;
  }
  response.set_content_provider(bytes, reply.type, [text = reply.body](auto at, auto left, auto& sink) {
    return sink.write(text.data() + at, left);
  });
}

/// A file, or the range of it that is asked for.
void answer_file(const Reply& reply, const httplib::Request& request, httplib::Response& response) {
  const std::uint64_t size = reply.file->bytes;
  response.set_header("Accept-Ranges", "bytes");
  const std::string same = request.get_header_value("If-Range");
  const bool takes_part = same.empty() || same == '"' + reply.tag + '"';
  const AskedRange asked = asked_range(takes_part ? request.get_header_value("Range") : "", size);
  switch (asked.is) {
    case AskedRange::Is::kWhole:
      return give_bytes(reply, 0, size, response);
    case AskedRange::Is::kPart:
      response.status = 206;
      response.set_header("Content-Range",
                          fmt::format("bytes {}-{}/{}", asked.first, asked.first + asked.bytes - 1, size));
      return give_bytes(reply, asked.first, asked.bytes, response);
    case AskedRange::Is::kBeyond:
      response.status = 416;
      response.set_header("Content-Range", fmt::format("bytes */{}", size));
      response.set_content(
          line_of(error_document({ErrorKind::kUsage, "the range is beyond the file", request.path,
                                  fmt::format("it has {} bytes", size), "ask for a range within it"})),
          "application/json");
  }
}

/// `who` may keep it: "private", or "public" for what needs no token.
void answer(const Reply& reply, const char* who, const httplib::Request& request,
            httplib::Response& response) {
  response.status = reply.status;
  response.set_header("X-Content-Type-Options", "nosniff");
  const bool is_kept = reply.keeping == Keeping::kForever;
  response.set_header("Cache-Control", reply.keeping == Keeping::kNever ? std::string("no-store")
                                       : is_kept ? fmt::format("{}, max-age=31536000, immutable", who)
                                                 : fmt::format("{}, no-cache", who));
  for (const auto& [name, value] : reply.headers) response.set_header(name, value);
  if (!reply.tag.empty()) response.set_header("ETag", '"' + reply.tag + '"');
  const bool has_it = !reply.tag.empty() && names_tag(request.get_header_value("If-None-Match"), reply.tag);
  if (has_it) {
    response.status = kNotModified;
    return;
  }
  if (reply.file) return answer_file(reply, request, response);
  if (reply.tag.empty()) return response.set_content(reply.body, reply.type);
  give_bytes(reply, 0, reply.body.size(), response);
}

void answer(const Error& error, int status, const httplib::Request& request, httplib::Response& response) {
  if (status == 401) response.set_header("WWW-Authenticate", "Bearer");
  answer(json_reply(error_document(error), status), "private", request, response);
}

Call call_of(const httplib::Request& request) {
  Call call;
  for (const auto& [key, value] : request.params) call.query.emplace(key, value);
  call.body = request.body;
  call.if_none_match = request.get_header_value("If-None-Match");
  call.control = request.get_header_value("X-Weft-Control");
  if (const auto named = call.query.find("control"); named != call.query.end()) call.control = named->second;
  call.takes_gzip = takes_coding(request.get_header_value("Accept-Encoding"), "gzip");
  return call;
}

/// How cpp-httplib answers, put right: its Keep-Alive counts requests, and no body is not an empty one.
void finish_headers(const httplib::Request&, httplib::Response& response) {
  response.headers.erase("Keep-Alive");
  if (response.status == kNotModified) response.headers.erase("Content-Length");
}

constexpr const char* kGap = "event: gap\ndata: {}\n\n";

}  // namespace

Reply json_reply(const Json& document, int status) {
  return {status, "application/json", line_of(document)};
}

Result<std::shared_ptr<const FileBody>> open_file_body(const std::filesystem::path& file) {
  auto body = std::make_shared<FileBody>();
  body->file = Descriptor(file, O_RDONLY | O_NONBLOCK);
  if (!body->file) return cannot_read(file, errno);
  struct stat about = {};
  if (fstat(body->file.get(), &about) != 0 || !S_ISREG(about.st_mode)) {
    return Error{ErrorKind::kNoInput, "this is no file", file.string(), "", "name another"};
  }
  body->bytes = static_cast<std::uint64_t>(about.st_size);
  return std::shared_ptr<const FileBody>(std::move(body));
}

namespace {

/// A scan has the processor before those who look at maps.
void let_others_first() {
  constexpr int kNiceness = 19;
  thread_local const int done = setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  static_cast<void>(done);
}

}  // namespace

class HttpServer::Parser : public httplib::Server {
 public:
  Parser(GuardRules rules, std::vector<Route> routes, EventLog& events, const HttpLimits& limits)
      : rules_(std::move(rules)), routes_(std::move(routes)), events_(events), limits_(limits) {
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return guard(request, response) ? HandlerResponse::Handled : HandlerResponse::Unhandled;
    });
    set_post_routing_handler(finish_headers);
    set_error_handler(Handler([](const httplib::Request& request, httplib::Response& response) {
      if (response.body.empty()) explain(request, response);
    }));
    set_exception_handler([](const httplib::Request& request, httplib::Response& response,
                             const std::exception_ptr& thrown) { fail(request, response, thrown); });
    const Handler handle = [this](const httplib::Request& request, httplib::Response& response) {
      answer_call(request, response);
    };
    constexpr const char* kAnyPath = R"([\s\S]*)";
    Get(kAnyPath, handle).Post(kAnyPath, handle).Patch(kAnyPath, handle).Delete(kAnyPath, handle);
    for (const Route& route : routes_) {
      if (route.open) rules_.open.push_back(route.method + " " + route.path);
    }
  }

  /// Lets the streams of cpp-httplib run: it ends them where it does not listen.
  void begin(HttpDoor& door) {
    svr_sock_ = door.socket();
    limits_.threads[Pool::kStreams] = limits_.streams + 1;
    for (const auto& [pool, threads] : limits_.threads) {
      pools_[pool] = std::make_unique<Threads>(threads, threads + limits_.waiting);
    }
    door.begin([this, &door](WholeRequest request) { enter(std::move(request), door); });
  }

  void end() {
    ending_ = true;
    svr_sock_ = INVALID_SOCKET;
    for (const auto& [kind, threads] : pools_) threads->pool.shutdown();
    pools_.clear();
  }

 private:
  /// Threads, and the requests that are theirs.
  struct Threads {
    Threads(std::size_t threads, std::size_t most_requests) : pool(threads), most(most_requests) {}
    httplib::ThreadPool pool;
    const std::size_t most;
    std::atomic<std::size_t> requests = 0;
  };

  /// On the door's thread.
  void enter(WholeRequest request, HttpDoor& door) {
    const Pool pool = pool_of(request.bytes);
    if (pool == Pool::kAtOnce) return door.take_back(answered(std::move(request), pool));
    Threads& threads = *pools_.at(pool);
    if (threads.requests >= threads.most) {
      return door.take_back({std::move(request.socket), {}, refusal(503, "of this kind; ask again"), true});
    }
    ++threads.requests;
    // std::function wants to copy what it holds.
    auto held = std::make_shared<WholeRequest>(std::move(request));
    threads.pool.enqueue([this, &door, &threads, pool, held] {
      if (pool == Pool::kTiles) let_others_first();
      AnsweredRequest whole = answered(std::move(*held), pool);
      --threads.requests;
      door.take_back(std::move(whole));
    });
  }

  Pool pool_of(std::string_view request) const {
    const std::size_t space = request.find(' '), end = request.find(' ', space + 1);
    const Route* route = route_of(request.substr(0, space), request.substr(space + 1, end - space - 1));
    if (route == nullptr) return Pool::kQuick;
    return route->handle ? route->pool : Pool::kStreams;
  }

  /// By the path as it was sent, so that a call is answered by the threads that are its own.
  const Route* route_of(std::string_view method, std::string_view target) const {
    const std::string_view path = path_of(target);
    const auto route = std::ranges::find_if(routes_, [&](const Route& each) {
      return each.method == (method == "HEAD" ? "GET" : method) && segments_in(each.path, path);
    });
    return route == routes_.end() ? nullptr : &*route;
  }

  AnsweredRequest answered(WholeRequest request, Pool pool) {
    const bool is_stream = pool == Pool::kStreams, last = request.last || is_stream;
    RequestStream stream(std::move(request), is_stream || pool == Pool::kFiles, limits_.door, ending_);
    bool asked_to_close = false;
    const bool is_whole = process_request(stream, last, asked_to_close, [](httplib::Request& parsed) {
      parsed.ranges.clear();  // it would cut every answer by them
    });
    return stream.answered(last || !is_whole);
  }

  bool guard(const httplib::Request& request, httplib::Response& response) const {
    const auto refused =
        turned_away({request.method, request.get_header_value("Host"), request.get_header_value("Origin"),
                     request.get_header_value("Authorization"), request.get_header_value("Content-Type"),
                     request.path, request.get_header_value("Cookie"),
                     request.get_header_value("Sec-Fetch-Site"), request.get_header_value("Sec-Fetch-Mode")},
                    rules_);
    if (refused) answer(refused->error, refused->status, request, response);
    return refused.has_value();
  }

  void answer_call(const httplib::Request& request, httplib::Response& response) {
    const Route* route = route_of(request.method, request.target);
    auto segments = route == nullptr ? std::nullopt : segments_in(route->path, request.path);
    if (!segments) {
      const auto is_path = [path = path_of(request.target)](const Route& each) {
        return segments_in(each.path, path).has_value();
      };
      response.status = route == nullptr && std::ranges::any_of(routes_, is_path) ? 405 : 404;
      if (response.status == 404 && is_by_hand(request)) return answer_by_page(request, response);
      return explain(request, response);
    }
    Call call = call_of(request);
    call.segments = std::move(*segments);
    call.port = rules_.port;
    if (!route->handle) return stream_events(*route, std::move(call), request, response);
    const Result<Reply> reply = route->handle(call);
    if (reply) return answer(*reply, route->open ? "public" : "private", request, response);
    answer(reply.error(), http_status_of(reply.error().kind), request, response);
  }

  /// An address that somebody typed or followed, as far as a browser tells.
  static bool is_by_hand(const httplib::Request& request) {
    return request.method == "GET" && !request.path.starts_with("/api/") &&
           request.get_header_value("Accept").find("text/html") != std::string::npos;
  }

  /// The page says itself that it has none of this address.
  void answer_by_page(const httplib::Request& request, httplib::Response& response) {
    const Route* page = route_of("GET", "/");
    Call call = call_of(request);
    call.takes_gzip = false;
    Result<Reply> reply = page == nullptr ? Error{} : page->handle(call);
    if (!reply) return explain(request, response);
    reply->status = 404;
    reply->tag.clear();  // what has none goes out with its body, which cpp-httplib asks of an error
    answer(*reply, "public", request, response);
  }

  /// An error of routing or of cpp-httplib.
  static void explain(const httplib::Request& request, httplib::Response& response) {
    const int status = response.status;
    answer(Error{status == 404 ? ErrorKind::kNoInput : ErrorKind::kUsage,
                 status == 404   ? "there is no such call"
                 : status == 405 ? "this call has no such method"
                                 : "the request is refused",
                 request.path, fmt::format("HTTP status {}", status),
                 "see /api/v1/openapi.json for what there is"},
           status, request, response);
  }

  static void fail(const httplib::Request& request, httplib::Response& response,
                   const std::exception_ptr& thrown) {
    std::string why = "unknown";
    try {
      std::rethrow_exception(thrown);
    } catch (const std::exception& exception) {
      why = exception.what();
    } catch (...) {
    }
    answer(Error{ErrorKind::kInternal, "a bug in weft", request.path, why, "report it with the request"}, 500,
           request, response);
  }

  void stream_events(const Route& route, Call call, const httplib::Request& request,
                     httplib::Response& response) {
    if (++streams_ > limits_.streams) {
      --streams_;
      return answer(Error{ErrorKind::kTryAgain, "too many clients follow this rig", request.path,
                          fmt::format("{} streams are open", limits_.streams), "close one of them"},
                    503, request, response);
    }
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, &route, call = std::move(call), follower = follower_of(request)](
            std::size_t, httplib::DataSink& sink) mutable {
          if (route.follows) route.follows(call);
          return send_next(follower, sink);
        },
        [this](bool) { --streams_; });
  }

  struct Follower {
    std::uint64_t seen = 0;
    std::string greeting = {};
    Clock::time_point last = Clock::now();
  };

  /// One that names no event it has seen is told first how things are; so is one that names an event of an
  /// earlier daemon, or one so old that the next are gone, and of the gap.
  Follower follower_of(const httplib::Request& request) const {
    const std::string id = request.get_header_value("Last-Event-ID");
    if (const auto seen = events_.number_of(id)) return {*seen};
    const EventLog::Event current = events_.current();
    return {current.number, (id.empty() ? "" : kGap) + lines_of(current)};
  }

  std::string lines_of(const EventLog::Event& event) const {
    return fmt::format("id: {}\nevent: {}\ndata: {}\n\n", events_.id_of(event), event.name, event.data);
  }

  bool send_next(Follower& follower, httplib::DataSink& sink) const {
    constexpr auto kLook = std::chrono::milliseconds(200);  // how late a client that left is noticed
    if (!sink.is_writable()) return false;
    std::string text = std::exchange(follower.greeting, "");
    const auto events = events_.wait_after(follower.seen, text.empty() ? kLook : kLook * 0);
    if (events_.closed()) {
      sink.done();
      return true;
    }
    const bool missed_some = !events.empty() && events.front().number != follower.seen + 1;
    const EventLog::Event now = missed_some ? events_.current() : EventLog::Event();
    if (missed_some) text += kGap + lines_of(now);
    for (const EventLog::Event& event : events) {
      if (!missed_some) text += lines_of(event);
    }
    const auto silence = std::chrono::duration<double>(Clock::now() - follower.last);
    if (text.empty() && silence.count() >= limits_.heartbeat_s) text = "event: heartbeat\ndata: {}\n\n";
    if (text.empty()) return true;
    if (!events.empty()) follower.seen = missed_some ? now.number : events.back().number;
    follower.last = Clock::now();
    return sink.write(text.data(), text.size());
  }

  GuardRules rules_;
  std::vector<Route> routes_;
  EventLog& events_;
  HttpLimits limits_;
  std::atomic<std::size_t> streams_ = 0;
  std::atomic<bool> ending_ = false;
  std::map<Pool, std::unique_ptr<Threads>> pools_;
};

Result<std::unique_ptr<HttpServer>> HttpServer::start(int port, GuardRules rules, std::vector<Route> routes,
                                                      EventLog& events, const HttpLimits& limits) {
  if (rules.token.empty() && !is_loopback(rules.listening_host)) {
    return Error{ErrorKind::kUsage, "the rig would be open to the network", rules.listening_host,
                 "a host other than this machine's own needs a token",
                 "set daemon.token in the rig file to a file that holds one, or daemon.host to 127.0.0.1"};
  }
  Result<std::unique_ptr<HttpDoor>> door = HttpDoor::open(rules.listening_host, port, limits.door);
  if (!door) return std::move(door).error();
  rules.port = (*door)->port();
  auto parser = std::make_unique<Parser>(std::move(rules), std::move(routes), events, limits);
  return std::unique_ptr<HttpServer>(new HttpServer(std::move(*door), std::move(parser)));
}

HttpServer::HttpServer(std::unique_ptr<HttpDoor> door, std::unique_ptr<Parser> parser)
    : parser_(std::move(parser)), door_(std::move(door)) {
  parser_->begin(*door_);
}

HttpServer::~HttpServer() {
  stop();
}

int HttpServer::port() const {
  return door_->port();
}

void HttpServer::stop() {
  door_->close();
  parser_->end();
}

}  // namespace weft::app
