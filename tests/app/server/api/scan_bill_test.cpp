// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/scan_bill.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <utility>

#include "capture/scan/plan.h"
#include "core/files.h"

namespace weft::app {
namespace {

capture::ScanRequest everything() {
  capture::ScanRequest request;
  request.leds = {1, 2, 3, 4};
  request.bracket = 16;
  request.polariser.states = {Polariser::kCrossed, Polariser::kParallel};
  request.below = true;
  return request;
}

TEST(ScanBill, CountsEveryShotOfThePlan) {
  const capture::ScanRequest request = everything();
  int shots = 0;
  for (const BillLine& line : bill_of(request, 2.0)) {
    shots += line.shots;
    EXPECT_EQ(line.seconds, 2.0 * line.shots) << line.what;
  }
  const capture::ShotList list = {request.leds, request.repeat, request.bracket, request.polariser.states,
                                  request.below};
  EXPECT_EQ(shots, list.count());
}

TEST(ScanBill, NamesWhatIsPhotographedAndNothingElse) {
  capture::ScanRequest request;
  request.leds = {1, 2, 3};
  request.repeat = false;
  const std::vector<BillLine> bill = bill_of(request, {});
  ASSERT_EQ(bill.size(), 2U);
  EXPECT_EQ(bill[0].what, "lit");
  EXPECT_EQ(bill[1].what, "dark");
  EXPECT_EQ(json_of(bill[1])["seconds"], Json()) << "no scan has told";
}

/// Errors without and with a correction, of every row of docs/conditions.md that has both.
std::set<std::pair<double, double>> measured() {
  const std::string page = read_text(WEFT_SOURCE_DIR "/docs/conditions.md").value();
  const std::regex row(R"(\| ([0-9.]+)° \| ([0-9.]+)°)");
  std::set<std::pair<double, double>> rows;
  for (std::sregex_iterator match(page.begin(), page.end(), row), end; match != end; ++match)
    rows.emplace(std::stod((*match)[1]), std::stod((*match)[2]));
  return rows;
}

TEST(ScanBill, HasTheDegreesOfThePageOnConditions) {
  capture::ScanRequest bright = everything(), dark = everything();
  bright.bracket = 0.2;
  for (const capture::ScanRequest& request : {bright, dark}) {
    for (const BillLine& line : bill_of(request, {})) {
      if (!line.without_deg) continue;
      EXPECT_TRUE(measured().contains({*line.without_deg, *line.with_deg})) << line.what;
    }
  }
}

}  // namespace
}  // namespace weft::app
