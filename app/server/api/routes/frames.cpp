// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/requests.h"
#include "app/server/api/bodies/scan_body.h"
#include "app/server/api/routes/frame_tile.h"
#include "app/server/api/routes/session_choice.h"
#include "app/server/http/error_reply.h"
#include "library/catalogue/session_files.h"

namespace weft::app {
namespace {

constexpr int kBusy = 503;

/// Too many pictures at once is this server's fault, not a conflict with the rig's state.
Result<Reply> busy_or(const Error& error) {
  if (error.kind == ErrorKind::kTryAgain) return json_reply(error_document(error), kBusy);
  return error;
}

Result<FrameFile> frame_of(const RigParts& parts, const Call& call) {
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  Result<library::StoredFrame> frame = library::stored_frame(*session, call.segments.at(1));
  if (!frame) return std::move(frame).error();
  return FrameFile{std::move(frame->file), std::move(frame->sha256)};
}

/// How long a reply about this frame may be kept, and by which tag. A frame that leaves its session gives its
/// index to another one, so that only a digest names for ever.
Result<Reply> kept_reply(const Call& call, const FrameFile& frame, const char* type, const char* tag) {
  Reply reply = {200, type};
  const bool is_digest = frame.sha256.size() == 64 &&
                         std::ranges::all_of(frame.sha256, [](unsigned char c) { return std::isxdigit(c); });
  if (is_digest) {
    reply.tag = tag + frame.sha256;
    reply.keeping = Keeping::kAskAgain;
  }
  const auto wanted = call.query.find("sha256");
  if (wanted == call.query.end()) return reply;
  if (!is_digest || wanted->second != frame.sha256) {
    return Error{ErrorKind::kNoInput, "there is no such frame", "sha256",
                 "the frame of this index is another one", "see the session for the frames there are"};
  }
  reply.keeping = Keeping::kForever;
  return reply;
}

Result<Reply> thumbnail(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of(parts, call);
  if (!frame) return frame.error();
  Result<Reply> reply = kept_reply(call, *frame, "image/png", "thumbnail-");
  if (!reply || call.has(reply->tag)) return reply;
  Result<std::string> png = parts.pictures.thumbnail(*frame);
  if (!png) return busy_or(png.error());
  reply->body = std::move(*png);
  return reply;
}

Result<Reply> frame_tile(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of(parts, call);
  if (!frame) return frame.error();
  const Result<Reply> kept = kept_reply(call, *frame, "", "tile-");
  if (!kept) return kept;
  if (kept->tag.empty()) {
    return Error{ErrorKind::kBadData, "the frame has no digest", frame->file.string(), "",
                 "check the session's session.json"};
  }
  Result<Reply> reply = tile_of_frame(parts, *frame, call.segments.at(2), call.segments.at(3), call);
  // One frame has many tiles, and each can be looked at in many ways: a tag would have to name them.
  if (reply && kept->keeping == Keeping::kForever) reply->keeping = Keeping::kForever;
  return reply;
}

/// The name that a downloaded frame gets: of its session and its file, without what a header does not take.
std::string file_name_of(const std::string& session, const std::filesystem::path& file) {
  std::string name = session + "_" + file.filename().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '_');
  return name;
}

Result<Reply> raw(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of(parts, call);
  if (!frame) return frame.error();
  Result<Reply> reply = kept_reply(call, *frame, "application/octet-stream", "");
  if (!reply) return reply;
  Result<std::shared_ptr<const FileBody>> file = open_file_body(frame->file);
  if (!file) return std::move(file).error();
  const std::string name = file_name_of(call.segments.at(0), frame->file);
  reply->headers.emplace_back("Content-Disposition", fmt::format("attachment; filename=\"{}\"", name));
  reply->file = std::move(*file);
  return reply;
}

Result<Reply> histogram(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of(parts, call);
  if (!frame) return frame.error();
  const Result<Json> histogram = parts.pictures.histogram(*frame);
  if (!histogram) return busy_or(histogram.error());
  return json_reply(*histogram);
}

/// The shot once more, which then stands for this one.
Result<Reply> again(const RigParts& parts, const Call& call) {
  const Result<Json> body = parse_body(call.body);
  if (!body) return body.error();
  const Result<std::string> by = parts.controls.commander(call.control);
  if (!by) return by.error();
  const Result<AgainRequest> wish = read_body<AgainRequest>(
      *body, {"the shot cannot be taken again", "a shot that is taken again", "frames/{index}/again"});
  if (!wish) return wish.error();
  if (wish->exposure_us > 0) {
    const Result<double> settable = parts.attendance.settable_us(wish->exposure_us);
    if (!settable) return settable.error();
  }
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  const Result<Shot> shot = library::stored_shot(*session, call.segments.at(1));
  if (!shot) return shot.error();
  Result<capture::ScanRequest> request = request_again(*session, parts.rig, *shot, wish->exposure_us);
  if (!request) return std::move(request).error();
  if (Result<void> begun = parts.keeper.begin(std::move(*request), *by); !begun)
    return std::move(begun).error();
  parts.library.watch(session->folder);
  return json_reply({{"session", call.segments.at(0)}, {"led", shot->led}}, kAccepted);
}

}  // namespace

Resource frames_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/sessions/{name}/frames/{index}/thumbnail",
            [&parts](const Call& call) { return thumbnail(parts, call); }, false, Pool::kPictures},
           {"GET", "/api/v1/sessions/{name}/frames/{index}/histogram",
            [&parts](const Call& call) { return histogram(parts, call); }, false, Pool::kPictures},
           {"GET", "/api/v1/sessions/{name}/frames/{index}/raw",
            [&parts](const Call& call) { return raw(parts, call); }, false, Pool::kFiles},
           {"GET", "/api/v1/sessions/{name}/frames/{index}/tiles/{level}/{tile}",
            [&parts](const Call& call) { return frame_tile(parts, call); }, false, Pool::kTiles},
           {"POST", "/api/v1/sessions/{name}/frames/{index}/again",
            [&parts](const Call& call) { return again(parts, call); }}}};
}

}  // namespace weft::app
