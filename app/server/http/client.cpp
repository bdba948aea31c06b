// SPDX-License-Identifier: Apache-2.0
#include "app/server/http/client.h"

#include <fmt/format.h>
#include <httplib.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "app/server/http/error_reply.h"

namespace weft::app {
namespace {

constexpr int kConnectS = 2, kAnswerS = 10, kSilenceS = 25;  // of a machine that is busy
constexpr const char* kHealth = "/api/v1/healthz";
constexpr const char* kEvents = "/api/v1/events";

void prepare(httplib::Client& client, const std::string& token, int silence_s) {
  client.set_connection_timeout(kConnectS);
  client.set_read_timeout(silence_s);
  client.set_write_timeout(kAnswerS);
  if (!token.empty()) client.set_bearer_token_auth(token);
}

Error no_answer(const std::string& where, httplib::Error error) {
  return {ErrorKind::kTryAgain, "the daemon does not answer", where, httplib::to_string(error),
          "start it with 'weft serve --rig RIG.toml'"};
}

Result<Json> document_of(const httplib::Result& result, const std::string& where) {
  if (!result) return no_answer(where, result.error());
  if (result->status >= 400) return error_of_document(result->body, where);
  Json document = Json::parse(result->body, nullptr, false);
  if (document.is_discarded()) return error_of_document(result->body, where);
  return document;
}

/// Takes the bytes of a text/event-stream and gives its events (WHATWG HTML, 9.2.6), as far as weft sends
/// them.
class EventReader {
 public:
  bool add(std::string_view bytes, const std::function<bool(const RigClient::Event&)>& take) {
    pending_ += bytes;
    for (std::size_t end = 0; (end = pending_.find('\n')) != std::string::npos; pending_.erase(0, end + 1)) {
      if (!take_line(std::string_view(pending_).substr(0, end), take)) return false;
    }
    return true;
  }

 private:
  bool take_line(std::string_view line, const std::function<bool(const RigClient::Event&)>& take) {
    constexpr std::string_view kName = "event: ", kData = "data: ";
    if (line.starts_with(kName)) event_.name = line.substr(kName.size());
    if (line.starts_with(kData)) event_.data = Json::parse(line.substr(kData.size()), nullptr, false);
    if (!line.empty()) return true;
    const RigClient::Event event = std::exchange(event_, {});
    const bool known = event.name == "status" || event.name == "frame";
    return !known || !event.data.is_object() || take(event);
  }

  std::string pending_;
  RigClient::Event event_;
};

}  // namespace

Result<RigClient> RigClient::connect(const std::string& address, const std::string& token) {
  constexpr std::string_view kScheme = "http://";
  const std::size_t colon = address.rfind(':');
  int port = 0;
  if (address.starts_with(kScheme) && colon != std::string::npos && colon > kScheme.size()) {
    std::from_chars(address.data() + colon + 1, address.data() + address.size(), port);
  }
  if (port <= 0 || port > 65535) {
    return Error{ErrorKind::kUsage, "this is no address of a daemon", address, "",
                 "give it as weft serve prints it, http://127.0.0.1:8470"};
  }
  std::string host = address.substr(kScheme.size(), colon - kScheme.size());
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  RigClient client(std::move(host), port, token);
  if (const Result<Json> health = client.get(kHealth); !health) return health.error();
  return client;
}

Result<Json> RigClient::get(const std::string& path) const {
  httplib::Client client(host_, port_);
  prepare(client, token_, kAnswerS);
  return document_of(client.Get(path), fmt::format("GET http://{}:{}{}", host_, port_, path));
}

Result<std::string> RigClient::bytes(const std::string& path) const {
  httplib::Client client(host_, port_);
  prepare(client, token_, kAnswerS);
  const std::string where = fmt::format("GET http://{}:{}{}", host_, port_, path);
  httplib::Result result = client.Get(path);
  if (!result) return no_answer(where, result.error());
  if (result->status >= 400) return error_of_document(result->body, where);
  return std::move(result->body);
}

Result<Json> RigClient::post(const std::string& path, const Json& body) const {
  httplib::Client client(host_, port_);
  prepare(client, token_, kAnswerS);
  return document_of(client.Post(path, line_of(body), "application/json"),
                     fmt::format("POST http://{}:{}{}", host_, port_, path));
}

Result<void> RigClient::follow(const std::function<bool(const Event&)>& take,
                               const std::stop_token& stop) const {
  httplib::Client client(host_, port_);
  prepare(client, token_, kSilenceS);
  const std::stop_callback ends_waiting(stop, [&] { client.stop(); });
  EventReader reader;
  std::string refusal;
  int status = 0;
  bool enough = false;
  const httplib::Result result = client.Get(
      kEvents, httplib::Headers{},
      [&](const httplib::Response& response) {
        status = response.status;
        return true;
      },
      [&](const char* bytes, std::size_t count) {
        const std::string_view text(bytes, count);
        if (status != 200) {
          refusal += text;
          return true;
        }
        enough = stop.stop_requested() || !reader.add(text, take);
        return !enough;
      });
  if (enough || stop.stop_requested()) return {};
  const std::string where = fmt::format("http://{}:{}{}", host_, port_, kEvents);
  if (status != 0 && status != 200) return error_of_document(refusal, where);
  return Error{ErrorKind::kTryAgain, "the daemon ended", where,
               result ? "its stream of events ended" : httplib::to_string(result.error()),
               "start it again with 'weft serve --rig RIG.toml'; an unfinished scan can be resumed"};
}

}  // namespace weft::app
