// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/scan_bill.h"

#include <map>

#include "capture/scan/scan_plan.h"

namespace weft::app {
namespace {

std::string kind_of(const capture::DueShot& shot, const capture::ShotList& list) {
  const bool is_other_state = !list.polariser.empty() && shot.polariser != list.polariser.front();
  return shot.role == ShotRole::kLit && is_other_state ? "polariser" : name_of(shot.role);
}

/// What a kind of shot is for, with the degrees of docs/conditions.md.
BillLine purpose_of(const std::string& what, std::optional<double> bracket) {
  if (what == "lit") return {what, 0, {}, "Each LED once: normals and albedo.", {}, {}};
  if (what == "dark")
    return {what, 0,
            {},   "Light of the room and hot photosites are taken out; the error is that of hot ones.",
            30.4, 0.24};
  if (what == "repeat")
    return {what, 0,     {}, "LEDs that fade, here by 5 percent, and a lamp that changed are seen.",
            0.40, 0.0013};
  if (what == "bracket" && bracket && *bracket < 1)
    return {what, 0, {}, "Places that are full are read, here of a scan five times too bright.", 15.0, 0.16};
  if (what == "bracket")
    return {what, 0, {}, "Dark cloth is read, here of albedo 0.01 by sixteen times.", 1.92, 0.45};
  if (what == "polariser") return {what, 0, {}, "What is gloss and what is not.", {}, {}};
  if (what == "blade")
    return {what, 0, {}, "How light spreads in the cloth is measured, here in white cotton.", 6.28, 1.72};
  return {what, 0, {}, "Light that comes through the cloth.", {}, {}};
}

}  // namespace

std::vector<BillLine> bill_of(const capture::ScanRequest& request, std::optional<double> pace_s) {
  const capture::ShotList list = capture::asked_shots(request);
  std::map<std::string, int> shots;
  for (const capture::DueShot& shot : capture::plan_shots(list, {}, {})) ++shots[kind_of(shot, list)];
  std::vector<BillLine> bill;
  for (const char* what : {"lit", "dark", "repeat", "bracket", "polariser", "below", "blade"}) {
    if (!shots.contains(what)) continue;
    BillLine& line = bill.emplace_back(purpose_of(what, request.bracket));
    line.shots = shots.at(what);
    if (pace_s) line.seconds = line.shots * *pace_s;
  }
  return bill;
}

Json json_of(const BillLine& line) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"what", line.what},
          {"shots", line.shots},
          {"seconds", number(line.seconds)},
          {"for", line.purpose},
          {"without_deg", number(line.without_deg)},
          {"with_deg", number(line.with_deg)}};
}

}  // namespace weft::app
