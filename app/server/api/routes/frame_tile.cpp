// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/frame_tile.h"

#include <memory>
#include <optional>
#include <utility>

#include "app/server/api/routes/tile_query.h"

namespace weft::app {
namespace {

void balance(Image<float>& planes, const std::optional<std::array<float, 3>>& gains) {
  for (int c = 0; gains && c < 3; ++c) {
    for (int y = 0; y < planes.height(); ++y) {
      for (int x = 0; x < planes.width(); ++x) planes(x, y, c) *= (*gains)[static_cast<std::size_t>(c)];
    }
  }
}

}  // namespace

Result<Reply> tile_of_frame(const RigParts& parts, const FrameFile& frame, const std::string& level,
                            const std::string& tile, const Call& call) {
  const Result<TileName> name = tile_name_of(tile);
  if (!name) return name.error();
  const Result<Look> look = look_of(call, 1);
  if (!look) return look.error();
  const Result<std::shared_ptr<Pyramid>> pyramid = parts.views.frame(frame.file, frame.sha256);
  if (!pyramid) return pyramid.error();
  const int number = level_of(level, (*pyramid)->top());
  const std::optional<Rect> part = (*pyramid)->tile(number, name->column, name->row);
  if (!part) return no_such_tile(tile, "it is beyond the frame");
  Result<Image<float>> planes = (*pyramid)->read(number, *part);
  if (!planes) return planes.error();
  if (name->form != TileName::Form::kRaw)
    balance(*planes, frame_gains(frame.file, capture::calibration_now(parts.rig)));
  Result<std::string> bytes = name->form == TileName::Form::kRaw
                                  ? raw_tile(LayerKind::kColor, *planes)
                                  : picture_tile(LayerKind::kColor, *planes, *look, name->picture());
  if (!bytes) return std::move(bytes).error();
  Reply reply = {200, name->type()};
  reply.body = std::move(*bytes);
  return reply;
}

}  // namespace weft::app
