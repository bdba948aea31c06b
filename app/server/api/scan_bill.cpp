// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/scan_bill.h"

namespace weft::app {

std::vector<BillLine> bill_of(const capture::ScanRequest& request, std::optional<double> pace_s) {
  const int leds = static_cast<int>(request.leds.size());
  std::vector<BillLine> bill = {
      {"lit", leds, {}, "Each LED once: normals and albedo.", {}, {}},
      {"dark",
       1,
       {},
       "Light of the room and hot photosites are taken out; the error is that of hot ones.",
       30.4,
       0.24}};
  if (request.repeat) {
    bill.push_back({"repeat",
                    2,
                    {},
                    "LEDs that fade, here by 5 percent, and a lamp that changed are seen.",
                    0.40,
                    0.0013});
  }
  if (request.bracket && *request.bracket < 1)
    bill.push_back({"bracket",
                    leds,
                    {},
                    "Places that are full are read, here of a scan five times too bright.",
                    15.0,
                    0.16});
  if (request.bracket && *request.bracket >= 1)
    bill.push_back(
        {"bracket", leds, {}, "Dark cloth is read, here of albedo 0.01 by sixteen times.", 1.92, 0.45});
  if (const auto states = static_cast<int>(request.polariser.states.size()); states > 1)
    bill.push_back({"polariser", (states - 1) * leds, {}, "What is gloss and what is not.", {}, {}});
  if (request.below) bill.push_back({"below", 1, {}, "Light that comes through the cloth.", {}, {}});
  for (BillLine& line : bill) {
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
