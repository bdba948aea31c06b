// SPDX-License-Identifier: Apache-2.0
#include "report/verdict.h"

namespace weft::report {

Json json_of(const std::vector<Verdict>& verdicts) {
  Json all = Json::array();
  for (const Verdict& v : verdicts) all.push_back({{"name", v.name}, {"text", v.text}, {"remedy", v.remedy}});
  return all;
}

}  // namespace weft::report
