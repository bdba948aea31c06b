// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/scan_offers.h"

#include <algorithm>
#include <utility>

#include "calibration/guide/known_rig.h"
#include "capture/scan/scan_plan.h"

namespace weft::app {

std::optional<calibration::ShotCost> last_shot_cost(const RigParts& parts) {
  library::Query query;
  query.rig = parts.rig.name;
  query.state = "complete";
  query.limit = 1;
  const Result<library::CataloguePage> newest = parts.library.find(query);
  if (!newest || newest->entries.empty()) return {};
  const Result<Session> session = read_session(newest->entries.front().folder);
  return session ? calibration::shot_cost_of(*session) : std::nullopt;
}

Result<calibration::ScanPrices> offers_for(const RigParts& parts, const capture::ScanRequest& request,
                                           const ShotAims& aims) {
  calibration::ScanPriceOptions options = {capture::asked_shots(request), aims.cloth, last_shot_cost(parts)};
  options.has_two_films = parts.rig.polariser.states.size() > 1;
  options.wish = aims.wish;
  const Result<calibration::KnownRig> known = calibration::read_known_rig(parts.rig.file);
  if (!known) return price_scan({}, options);
  options.may_bracket = known->calibration && known->calibration->response &&
                        !known->calibration->response->exposure_ratios.empty();
  const Result<solver::ForeseenRig> foreseen = calibration::foreseen_of(*known);
  if (!foreseen) return price_scan({}, options);
  return price_scan(*foreseen, options);
}

Result<void> take_chosen_shots(const RigParts& parts, const ShotAims& aims, capture::ScanRequest& request) {
  const Result<calibration::ScanPrices> offers = offers_for(parts, request, aims);
  if (!offers) return offers.error();
  const auto chosen = std::ranges::find_if(offers->rows, &calibration::ShotsPrice::is_chosen);
  request.leds = chosen->list.leds;
  request.repeat = chosen->list.repeat;
  request.bracket = chosen->list.bracket;
  request.polariser.states = chosen->list.polariser;
  return {};
}

}  // namespace weft::app
