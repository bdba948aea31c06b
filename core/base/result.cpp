// SPDX-License-Identifier: Apache-2.0
#include "core/base/result.h"

namespace weft {

std::string Error::message() const {
  std::string text = what;
  if (!where.empty()) text += ": " + where;
  if (!why.empty()) text += ": " + why;
  text += '.';
  if (!remedy.empty()) text += ' ' + remedy + '.';
  return text;
}

}  // namespace weft
