// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/rig_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/guide/known_rig.h"
#include "report/hemisphere.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;
using solver::ForeseenSigma;
using solver::LedPlace;
using solver::LightPlan;
using solver::LightSet;
using solver::TriedPlace;

// Films before lights and lens let a quarter of the light pass.
constexpr double kFilmExposures = 4;
constexpr std::size_t kBoardLeds = 10;

std::string place_words(LedPlace place) {
  return fmt::format("{:.0f} degrees from the camera, azimuth {:.0f}", place.from_camera_deg,
                     place.azimuth_deg);
}

// Makes the rows of a plan.
class Rows {
 public:
  Rows(const LightPlan& plan, const KnownRig& rig, const RigPlanOptions& options)
      : plan_(plan), rig_(rig), options_(options), leds_(static_cast<int>(rig.lights.leds.size())) {}

  std::vector<RigPlanRow> take() { return std::move(rows_); }

  void as_it_is() {
    add({.name = "as-it-is", .what = "the LEDs as they are", .sigma = {}, .least = {}}, plan_.as_it_is());
  }

  void one_more(const TriedPlace& best) {
    add(with_place("one-more", "one more LED, " + place_words(best.place), best.place, 1),
        lit_with(best.place, false));
  }

  void near_camera(LedPlace place) {
    add(with_place("near-camera", "one more LED, " + place_words(place), place, 1), lit_with(place, false));
  }

  void polarisers() {
    RigPlanRow row = {
        .name = "polarisers", .what = "crossed and parallel polarisers", .sigma = {}, .least = {}};
    row.extra_shots = leds_;
    LightSet set = plan_.as_it_is();
    set.has_polarisers = true;
    add(std::move(row), set);
  }

  void polarisers_near_camera(LedPlace place) {
    add(with_place("polarisers-near-camera", "polarisers and a LED, " + place_words(place), place, leds_ + 2),
        lit_with(place, true));
  }

  void moved(const TriedPlace& best) {
    RigPlanRow row = with_place(
        "moved", fmt::format("LED {} moved to {}", *best.moved + 1, place_words(best.place)), best.place, 0);
    row.moved = *best.moved + 1;
    LightSet set = lit_with(best.place, false);
    set.leds.erase(set.leds.begin() + static_cast<std::ptrdiff_t>(*best.moved));
    add(std::move(row), set);
  }

 private:
  static RigPlanRow with_place(const char* name, std::string what, LedPlace place, int extra_shots) {
    RigPlanRow row = {.name = name, .what = std::move(what), .sigma = {}, .least = {}, .place = place};
    row.extra_shots = extra_shots;
    return row;
  }

  LightSet lit_with(LedPlace place, bool has_polarisers) const {
    LightSet set = plan_.as_it_is();
    set.added = solver::led_at(plan_.rig(), place);
    set.has_polarisers = has_polarisers;
    return set;
  }

  void add(RigPlanRow row, LightSet set) {
    row.sigma = plan_.sigma_of(set);
    row.extra_seconds = row.extra_shots * options_.seconds_a_shot;
    if (set.has_polarisers)
      row.extra_seconds += (leds_ + row.extra_shots) * (kFilmExposures - 1) * rig_.exposure_s;
    row.degrees_won = rows_.empty() ? 0 : rows_.front().sigma.normal_deg - row.sigma.normal_deg;
    set.errors = solver::RigErrors::kFitted;
    row.least = plan_.sigma_of(set);
    rows_.push_back(std::move(row));
  }

  const LightPlan& plan_;
  const KnownRig& rig_;
  const RigPlanOptions& options_;
  int leds_;
  std::vector<RigPlanRow> rows_;
};

// The best of the places next to the camera.
std::optional<LedPlace> beside_camera(std::vector<TriedPlace> tried, const RigPlanOptions& options) {
  std::erase_if(
      tried, [](const TriedPlace& each) { return each.place.from_camera_deg > solver::kNearestPlace_deg; });
  if (tried.empty()) return {};
  const auto badness_at = [&](const TriedPlace& each) {
    return solver::badness(each.sigma, options.cloth.cloth.lobe, options.aim);
  };
  return std::ranges::min_element(tried, {}, badness_at)->place;
}

// What costs least and makes it observable.
const RigPlanRow* what_shows(const std::vector<RigPlanRow>& rows) {
  const RigPlanRow* least = nullptr;
  for (const RigPlanRow& row : rows) {
    if (row.sigma.is_observable && (!least || row.extra_shots < least->extra_shots)) least = &row;
  }
  return least;
}

std::string plan_verdict(const RigPlan& plan) {
  const solver::Lobe& lobe = plan.cloth.cloth.lobe;
  if (!lobe.shines()) return "a matt cloth has no lobe that could be observed";
  const bool is_pile = lobe.family == solver::LobeFamily::kCloth;
  const std::string are = is_pile ? "the sheen is" : "roughness and f0 are";
  if (plan.rows.front().sigma.is_observable) return are + " observable with the LEDs as they are";
  const RigPlanRow* shown = what_shows(plan.rows);
  if (!shown) return are + " observable by none of these";
  return fmt::format("{} not observable with the LEDs as they are; what makes {} so: {}", are,
                     is_pile ? "it" : "them", shown->what);
}

std::vector<std::string> plan_notes(const RigPlan& plan) {
  std::vector<std::string> notes;
  const ForeseenSigma& today = plan.rows.front().sigma;
  if (!today.is_observable && today.correlation < solver::kTailOnly)
    notes.push_back("to these LEDs a stronger lobe and a rougher one look alike");
  if (today.unsolved > 0.005)
    notes.push_back(fmt::format("{:.0f} percent of the pixels have no normal to {:g} degrees",
                                100 * today.unsolved, solver::kWorstNormal_deg));
  if (plan.planned.leds.size() >= kBoardLeds)
    notes.push_back("the board lights ten LEDs: one more takes the place of one, or a second board");
  if (!plan.is_calibrated)
    notes.push_back(
        "no calibration says how far the LEDs are off; they count as known to 1 mm and half a percent");
  return notes;
}

}  // namespace

Result<RigPlan> plan_rig(const RigPlanOptions& options, const JobContext& context) {
  const Result<KnownRig> rig = read_known_rig(options.rig);
  if (!rig) return rig.error();
  Result<solver::ForeseenRig> planned = foreseen_of(*rig);
  if (!planned) return std::move(planned).error();
  const LightPlan plan(*planned, options.cloth.cloth);
  RigPlan result;
  result.rig = rig->name.empty() ? rig->where : rig->name;
  result.planned = *planned;
  result.cloth = options.cloth;
  result.is_calibrated = rig->calibration && rig->calibration->light_covariance;
  const std::vector<LedPlace> places = solver::free_places(*planned);

  context.progress("places", 0);
  Result<std::vector<TriedPlace>> tried = solver::try_places(plan, plan.as_it_is(), places, context);
  if (!tried) return std::move(tried).error();
  result.tried = std::move(*tried);
  const auto best = solver::best_place(plan, plan.as_it_is(), result.tried, options.aim, context);
  if (!best) return best.error();
  context.progress("places", 0.5);
  const auto moved = solver::best_move(plan, places, options.aim, context);
  if (!moved) return moved.error();
  context.progress("places", 1);

  const std::optional<LedPlace> beside = beside_camera(result.tried, options);
  Rows rows(plan, *rig, options);
  rows.as_it_is();
  if (*best) rows.one_more(**best);
  if (beside) rows.near_camera(*beside);
  rows.polarisers();
  if (beside) rows.polarisers_near_camera(*beside);
  if (*moved) rows.moved(**moved);
  result.rows = rows.take();
  result.verdict = plan_verdict(result);
  result.notes = plan_notes(result);
  return result;
}

namespace {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

const char* strength_key(const solver::Lobe& lobe) {
  return lobe.family == solver::LobeFamily::kCloth ? "sheen" : "f0";
}

Json sigma_json(const ForeseenSigma& sigma, const solver::Lobe& lobe) {
  Json json = {{"normal_deg", number_or_null(sigma.normal_deg)}};
  if (!lobe.shines()) return json;
  json["alpha"] = number_or_null(sigma.alpha);
  json[strength_key(lobe)] = number_or_null(sigma.f0);
  if (lobe.family == solver::LobeFamily::kAnisotropicGgx) {
    json["alpha_along"] = number_or_null(sigma.alpha_along);
    json["axis_deg"] = number_or_null(sigma.axis_deg);
  }
  json["correlation"] = sigma.correlation;
  return json;
}

Json place_json(LedPlace place) {
  return {{"from_camera_deg", place.from_camera_deg}, {"azimuth_deg", place.azimuth_deg}};
}

Json row_json(const RigPlanRow& row, const RigPlan& plan) {
  const solver::Lobe& lobe = plan.cloth.cloth.lobe;
  Json json = {{"name", row.name},
               {"what", row.what},
               {"sigma", sigma_json(row.sigma, lobe)},
               {"least_sigma", sigma_json(row.least, lobe)},
               {"observable", row.sigma.is_observable},
               {"unsolved_share", row.sigma.unsolved},
               {"extra_shots", row.extra_shots},
               {"extra_seconds", row.extra_seconds},
               {"degrees_won", number_or_null(row.degrees_won)}};
  if (row.moved) json["led"] = *row.moved;
  if (!row.place) return json;
  const Vec3 at = solver::led_at(plan.planned, *row.place).position_mm;
  json["place"] = place_json(*row.place);
  json["position_mm"] = {at.x, at.y, at.z};
  return json;
}

Json cloth_json(const NamedCloth& named) {
  const solver::ForeseenCloth& cloth = named.cloth;
  Json json = {{"name", named.name},
               {"family", name_of(cloth.lobe.family)},
               {"albedo", cloth.albedo},
               {"relief_deg", cloth.relief_deg},
               {"pixels", cloth.pixels}};
  if (!cloth.lobe.shines()) return json;
  json["alpha"] = cloth.lobe.alpha;
  if (cloth.lobe.family == solver::LobeFamily::kAnisotropicGgx) {
    json["alpha_along"] = cloth.lobe.alpha * cloth.lobe.along;
    json["weft_share"] = cloth.weft_share;
  }
  if (cloth.lobe.family == solver::LobeFamily::kTwoGgx) {
    json["alpha_broad"] = cloth.lobe.broad;
    json["broad_share"] = cloth.lobe.broad_share;
  }
  json[strength_key(cloth.lobe)] = cloth.lobe.f0;
  return json;
}

}  // namespace

Json json_of(const RigPlan& plan) {
  Json rows = Json::array();
  for (const RigPlanRow& row : plan.rows) rows.push_back(row_json(row, plan));
  return {{"rig", plan.rig},
          {"leds", plan.planned.leds.size()},
          {"cloth", cloth_json(plan.cloth)},
          {"rig_errors", plan.is_calibrated ? "calibration" : "typical"},
          {"full_well_electrons", plan.planned.full_well_electrons},
          {"read_noise_electrons", plan.planned.read_noise_electrons},
          {"observable", plan.rows.front().sigma.is_observable},
          {"verdict", plan.verdict},
          {"rows", std::move(rows)},
          {"notes", plan.notes}};
}

std::string picture_of(const RigPlan& plan) {
  const double today = plan.rows.front().sigma.normal_deg;
  const bool is_told = std::isfinite(today);
  const auto shown = [&](const ForeseenSigma& sigma) {
    return is_told ? today - sigma.normal_deg : sigma.normal_deg;
  };
  report::Hemisphere drawing;
  drawing.title = fmt::format("{}: one more LED for {}", plan.rig, plan.cloth.name);
  drawing.unit = is_told ? "degrees of the normal won" : "degrees, sigma of the normal";
  for (const TriedPlace& each : plan.tried)
    drawing.values.push_back({each.place.from_camera_deg, each.place.azimuth_deg, shown(each.sigma)});
  for (const NearLight& led : plan.planned.leds) {
    const LedPlace place = solver::place_of(plan.planned, led.position_mm);
    drawing.leds.push_back({place.from_camera_deg, place.azimuth_deg, 0});
  }
  for (const RigPlanRow& row : plan.rows) {
    if (row.name == "one-more")
      drawing.best = {row.place->from_camera_deg, row.place->azimuth_deg, shown(row.sigma)};
  }
  return report::hemisphere_svg(drawing);
}

}  // namespace weft::calibration
