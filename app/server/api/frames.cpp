// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "app/server/http/error_json.h"

namespace weft::app {
namespace {

constexpr int kBusy = 503;

/// Too many pictures at once is this server's fault, not a conflict with the rig's state.
Result<Reply> busy_or(const Error& error) {
  if (error.kind == ErrorKind::kTryAgain) return json_reply(error_document(error), kBusy);
  return error;
}

Result<FrameFile> frame_of(const RigParts& parts, const Call& call) {
  Result<library::StoredFrame> frame = parts.sessions.frame(call.segments.at(0), call.segments.at(1));
  if (!frame) return std::move(frame).error();
  return FrameFile{std::move(frame->file), std::move(frame->sha256)};
}

Result<Reply> thumbnail(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of(parts, call);
  if (!frame) return frame.error();
  Result<std::string> png = parts.pictures.thumbnail(*frame);
  if (!png) return busy_or(png.error());
  return Reply{200, "image/png", std::move(*png)};
}

Result<Reply> histogram(const RigParts& parts, const Call& call) {
  const Result<FrameFile> frame = frame_of(parts, call);
  if (!frame) return frame.error();
  const Result<Json> histogram = parts.pictures.histogram(*frame);
  if (!histogram) return busy_or(histogram.error());
  return json_reply(*histogram);
}

}  // namespace

Resource frames_resource(const RigParts& parts) {
  return {{{"GET", "/api/v1/sessions/{name}/frames/{index}/thumbnail",
            [&parts](const Call& call) { return thumbnail(parts, call); }, false, Pool::kPictures},
           {"GET", "/api/v1/sessions/{name}/frames/{index}/histogram",
            [&parts](const Call& call) { return histogram(parts, call); }, false, Pool::kPictures}},
          frames_description()};
}

}  // namespace weft::app
