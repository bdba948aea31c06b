// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/scan_bill.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>

#include "core/base/files.h"
#include "tests/core/places.h"

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

TEST(ScanBill, CountsEachKindOfShot) {
  std::map<std::string, int> shots;
  for (const BillLine& line : bill_of(everything(), 2.0)) {
    shots[line.what] = line.shots;
    EXPECT_EQ(line.seconds, 2.0 * line.shots) << line.what;
  }
  EXPECT_EQ(shots,
            (std::map<std::string, int>{
                {"lit", 4}, {"dark", 1}, {"repeat", 2}, {"bracket", 4}, {"polariser", 4}, {"below", 1}}));
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
  const std::string page = read_text(in_sources("docs/conditions.md")).value();
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
