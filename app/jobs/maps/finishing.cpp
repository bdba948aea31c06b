// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/finishing.h"

namespace weft::app {

Result<FinishingFacts> finish_surface(material::Surface& surface, const Recipe& recipe,
                                      const JobContext& context) {
  FinishingFacts facts;
  for (std::size_t i = 0; i < recipe.steps.size(); ++i) {
    if (context.stop.stop_requested()) return interrupted();
    context.progress("finish", static_cast<double>(i) / static_cast<double>(recipe.steps.size()));
    facts.steps.push_back(Json::object());
  }
  (void)surface;
  return facts;
}

}  // namespace weft::app
