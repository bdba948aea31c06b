// SPDX-License-Identifier: Apache-2.0
#include "solve/session/left_out_shots.h"

namespace weft::solve {

std::vector<int> left_out(const Session& session) {
  std::vector<int> shots;
  const auto list = session.document.find("left_out");
  if (list == session.document.end() || !list->is_array()) return shots;
  for (const Json& shot : *list) {
    if (shot.is_number_integer()) shots.push_back(shot.get<int>());
  }
  return shots;
}

}  // namespace weft::solve
