// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/server/http/routes.h"
#include "app/server/view/pyramid.h"
#include "app/server/view/tile_picture.h"
#include "core/base/result.h"

namespace weft::app {

/// What the last segment of a tile's path says: "3_1.png".
struct TileName {
  enum class Form { kRaw, kPng, kJpeg };
  int column = 0, row = 0;
  Form form = Form::kRaw;

  PictureFormat picture() const { return form == Form::kJpeg ? PictureFormat::kJpeg : PictureFormat::kPng; }
  const char* type() const;  ///< of the answer
};
/// kNoInput for what names no tile.
Result<TileName> tile_name_of(const std::string& segment);

/// A level of so many, from 0 to `top`; -1 for what is none.
int level_of(const std::string& segment, int top);

/// A finite number of the query, within limits; `otherwise` where it is not there. kUsage.
Result<double> number_of(const Call& call, const char* key, double least, double most, double otherwise);
/// The same, which must be there, without a fraction.
Result<int> whole_number_of(const Call& call, const char* key, int least, int most);

/// How a tile is to be shown, by the query: exposure (stops), least, most, light (x,y,z). `gain` is what
/// stands for an exposure of 0. kUsage.
Result<Look> look_of(const Call& call, double gain);

/// kNoInput: there is no such tile.
Error no_such_tile(const std::string& where, const std::string& why);

}  // namespace weft::app
